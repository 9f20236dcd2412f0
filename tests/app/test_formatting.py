#!/usr/bin/env python3
# labels: fast
"""Every source is as clang-format leaves it."""
import os
import shutil
import subprocess
import sys

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))


def main():
    if not shutil.which("clang-format"):
        print("skipped: clang-format is not installed (scripts/setup)")
        return 0
    files = sorted(os.path.join(folder, name) for top in ("src", "tests") for folder, _, names in os.walk(os.path.join(ROOT, top))
                   for name in names if name.endswith((".cpp", ".hpp")))
    done = subprocess.run(["clang-format", "--dry-run", "-Werror"] + files, cwd=ROOT, stderr=subprocess.PIPE, text=True)
    bad = sorted({line.split(":")[0] for line in done.stderr.splitlines() if "clang-format-violations" in line})
    for path in bad:
        print(f"{os.path.relpath(path, ROOT)}: run clang-format -i on it")
    if done.returncode and not bad:
        print(done.stderr)
    return 1 if done.returncode else 0


if __name__ == "__main__":
    sys.exit(main())
