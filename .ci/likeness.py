#!/usr/bin/env python3
"""likeness.py FILE.json: fails if a view of a forest is not like its model. FILE.json is what judge.py --json wrote."""
import json
import sys

# Share of rays that meet the forest; degrees between the normals of forest and model.
LEAST_HIT, MOST_MEAN, MOST_MEDIAN = 0.9999, 16.0, 10.0

views = json.load(open(sys.argv[1]))
if not views:
    sys.exit("no views were judged")
wrong = []
for v in views:
    if not v["hit"] >= LEAST_HIT:
        wrong.append(f"{v['view']}: hit {v['hit']:.5f}, wanted {LEAST_HIT} or more")
    if not v["mean"] <= MOST_MEAN:
        wrong.append(f"{v['view']}: mean error {v['mean']:.2f} degrees, wanted {MOST_MEAN} or less")
    if not v["median"] <= MOST_MEDIAN:
        wrong.append(f"{v['view']}: median error {v['median']:.2f} degrees, wanted {MOST_MEDIAN} or less")
if wrong:
    sys.exit("\n".join(wrong))
print(f"likeness: {len(views)} view{'s'[:len(views) > 1]} within bounds")
