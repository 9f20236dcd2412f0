#!/usr/bin/env python3
# labels: fast
"""docs/options.md is what the program declares."""
import difflib
import os
import subprocess
import sys

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))


def main():
    done = subprocess.run([sys.argv[1], "-options_page"], stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, text=True)
    declared = done.stdout.strip().splitlines()
    if done.returncode or not any(line.startswith("| `-") for line in declared):
        print(f"silt -options_page failed with {done.returncode} or declared nothing")
        return 1
    page = open(os.path.join(ROOT, "docs", "options.md")).read().strip().splitlines()
    # Above the first section stands the introduction that scripts/options_page writes.
    first = next((k for k, line in enumerate(page) if line.startswith("## ")), len(page))
    difference = list(difflib.unified_diff(page[first:], declared, "docs/options.md", "declared in the code", lineterm="", n=0))
    if difference:
        print("docs/options.md is stale, run scripts/options_page:\n" + "\n".join(difference[:40]))
    return 1 if difference else 0


if __name__ == "__main__":
    sys.exit(main())
