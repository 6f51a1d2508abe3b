#!/usr/bin/env python3
"""one_part.py FILE.txt: fails unless every solid in the text that printable.py printed is one connected part."""
import re
import sys

parts = [int(n) for n in re.findall(r"\bparts=(\d+)", open(sys.argv[1]).read())]
if not parts or any(n != 1 for n in parts):
    sys.exit(f"parts: {parts or 'not told'}, wanted 1")
print("parts: 1")
