#!/usr/bin/env python3
# labels: fast
"""docs/options.md and docs/models.md are what the program declares."""
import difflib
import os
import subprocess
import sys

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))


def compare(command, row, page):
    done = subprocess.run(command, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, text=True)
    declared = done.stdout.strip().splitlines()
    if done.returncode or not any(line.startswith(row) for line in declared):
        print(f"{command} failed with {done.returncode} or declared nothing")
        return 1
    lines = open(os.path.join(ROOT, page)).read().strip().splitlines()
    # Above the first section stands an introduction.
    first, begin = (next((k for k, line in enumerate(text) if line.startswith("## ")), len(text)) for text in (lines, declared))
    difference = list(difflib.unified_diff(lines[first:], declared[begin:], page, "declared in the code", lineterm="", n=0))
    if difference:
        print(f"{page} is stale, run scripts/options_page:\n" + "\n".join(difference[:40]))
    return 1 if difference else 0


def main():
    options = compare([sys.argv[1], "-options_page"], "| `-", "docs/options.md")
    models = compare([sys.executable, os.path.join(ROOT, "scripts", "models_page.py"), sys.argv[1]], "| `", "docs/models.md")
    return options or models


if __name__ == "__main__":
    sys.exit(main())
