#!/usr/bin/env python3
"""likeness.py FILE.json [MEAN MEDIAN P90]: fails if a view of a forest is not like its model. FILE.json is what judge.py --json wrote;
errors of its normals may be as large as these degrees."""
import json
import sys

# Share of rays that meet the forest; degrees between the normals of forest and model.
LEAST_HIT, MOST = 0.9999, {"mean": 3.0, "median": 1.2, "p90": 5.0}

if len(sys.argv) > 2:
    MOST = dict(zip(MOST, map(float, sys.argv[2:])))
views = json.load(open(sys.argv[1]))
if not views:
    sys.exit("no views were judged")
wrong = []
for v in views:
    if not v["hit"] >= LEAST_HIT:
        wrong.append(f"{v['view']}: hit {v['hit']:.5f}, wanted {LEAST_HIT} or more")
    for name, most in MOST.items():
        if not v[name] <= most:
            wrong.append(f"{v['view']}: {name} of the error {v[name]:.2f} degrees, wanted {most} or less")
if wrong:
    sys.exit("\n".join(wrong))
print(f"likeness: {len(views)} view{'s'[:len(views) > 1]} within bounds")
