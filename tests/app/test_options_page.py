#!/usr/bin/env python3
# labels: fast
"""docs/options.md and docs/models.md are what the program declares."""
import difflib
import os
import subprocess
import sys

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))


def compare(silt, switch, row, page):
    done = subprocess.run([silt, switch], stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, text=True)
    declared = done.stdout.strip().splitlines()
    if done.returncode or not any(line.startswith(row) for line in declared):
        print(f"silt {switch} failed with {done.returncode} or declared nothing")
        return 1
    lines = open(os.path.join(ROOT, page)).read().strip().splitlines()
    # Above the first section stands the introduction that scripts/options_page writes.
    first = next((k for k, line in enumerate(lines) if line.startswith("## ")), len(lines))
    difference = list(difflib.unified_diff(lines[first:], declared, page, "declared in the code", lineterm="", n=0))
    if difference:
        print(f"{page} is stale, run scripts/options_page:\n" + "\n".join(difference[:40]))
    return 1 if difference else 0


def main():
    options = compare(sys.argv[1], "-options_page", "| `-", "docs/options.md")
    models = compare(sys.argv[1], "-models_page", "| `", "docs/models.md")
    return options or models


if __name__ == "__main__":
    sys.exit(main())
