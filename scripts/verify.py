#!/usr/bin/python3
"""Runs the verification cases and keeps the page of their figures; started by scripts/verify."""
import argparse
import math
import os
import re
import subprocess
import sys
import time

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
PAGE = os.path.join(ROOT, "docs", "verification.md")
FOLDERS = ("inputs", "inputs/verification", "inputs/fluid", "inputs/models", "inputs/particles", "tests/cases")
# case quantity expected computed error tolerance PASS|FAIL
FIGURE = re.compile(r"^(\S+) (\S+) (\S+) (\S+) (\S+) (\S+) (PASS|FAIL)\s*$", re.M)
HEAD = """# Verification

Made by `scripts/verify`; do not edit. Each case is an options file that carries its expected figures and their sources
under `expect:`; the solver itself compares. An error is relative unless the case says otherwise.

| case | quantity | expected | computed | error | tolerance | verdict | Silt |
|---|---|---|---|---|---|---|---|
"""

ORDER_SLACK = 0.1


class Case:
    """An options file with `expect:`; its header may say `# short`, `# ranks: N` and `# hours`: a case that runs only when
    the pattern is its name.

    An order of convergence is expected by the comments
      # order: <column of errors.csv> <order> ...
      # level: <options of the coarsest run>      (one line a run, each finer than the last by the factor `# refine: 2`)
    Such a case is run at every level and gives a line for each column: the order between the last two levels, which
    passes when it falls short of the expected one by no more than 0.1 (or what `# slack: 0` says).

    A mesh too large to be kept is made by Gmsh before the run, and an earlier run that the case goes on from is run, as the
    comments say:
      # gmsh: [options of gmsh] <file>.geo <file>.msh
      # before: <file>.yaml [options]
    """

    def __init__(self, path):
        self.path = path
        self.name = os.path.splitext(os.path.basename(path))[0]
        text = open(os.path.join(ROOT, path)).read()
        self.expects = re.search(r"^expect:", text, re.M) is not None
        self.short = re.search(r"^#\s*short\s*$", text, re.M) is not None
        self.hours = re.search(r"^#\s*hours\s*$", text, re.M) is not None
        orders = re.search(r"^#\s*order:(.*)$", text, re.M)
        words = orders.group(1).split() if orders else []
        self.orders = list(zip(words[::2], map(float, words[1::2])))
        self.levels = [line.split() for line in re.findall(r"^#\s*level:(.*)$", text, re.M)]
        slack = re.search(r"^#\s*slack:\s*(\S+)\s*$", text, re.M)
        self.slack = float(slack.group(1)) if slack else ORDER_SLACK
        refine = re.search(r"^#\s*refine:\s*(\S+)\s*$", text, re.M)
        self.refine = float(refine.group(1)) if refine else 2.0
        self.expects = self.expects or bool(self.orders)
        ranks = re.search(r"^#\s*ranks:\s*(\d+)\s*$", text, re.M)
        self.ranks = int(ranks.group(1)) if ranks else None
        gmsh = re.search(r"^#\s*gmsh:(.*)$", text, re.M)
        self.gmsh = gmsh.group(1).split() if gmsh else None
        self.before = [line.split() for line in re.findall(r"^#\s*before:(.*)$", text, re.M)]

    def prepare(self, silt):
        """Makes the mesh and the earlier runs that the case asks for; raises CalledProcessError when one fails."""
        if self.gmsh:
            self.make_mesh()
        for words in self.before:
            subprocess.run([silt, *words], cwd=ROOT, check=True, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL)

    def make_mesh(self):
        *options, geometry, mesh = self.gmsh
        os.makedirs(os.path.dirname(os.path.join(ROOT, mesh)), exist_ok=True)
        subprocess.run(["gmsh", "-v", "1", *([] if "-3" in options else ["-2"]), *options, "-format", "msh22", "-o", mesh, geometry], cwd=ROOT, check=True, stdin=subprocess.DEVNULL)


def find_cases():
    cases = []
    for folder in FOLDERS:
        full = os.path.join(ROOT, folder)
        names = sorted(os.listdir(full)) if os.path.isdir(full) else []
        cases += [Case(os.path.join(folder, name)) for name in names if name.endswith(".yaml")]
    return [case for case in cases if case.expects]



def last_row(path):
    """{column: value} of the last row of a table; empty when there is none."""
    if not os.path.exists(path):
        return {}
    lines = open(path).read().split()
    return dict(zip(lines[0].split(","), map(float, lines[-1].split(",")))) if len(lines) > 1 else {}


def run_orders(silt, case, ranks):
    """Rows of a case that expects orders of convergence."""
    started, errors, rows = time.time(), [], []
    for k, level in enumerate(case.levels):
        output = os.path.join(ROOT, "output", "verification", f"{case.name}_{k}")
        command = [silt, case.path, "-output_directory", output] + level
        if ranks > 1:
            command = ["mpiexec", "-n", str(ranks)] + command
        done = subprocess.run(command, cwd=ROOT, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        found = last_row(os.path.join(output, "errors.csv")) if done.returncode == 0 else {}
        if any(column not in found for column, _ in case.orders):
            print("\n".join(f"  | {line}" for line in done.stdout.splitlines()[-15:]))
            rows = [(case.name, "run", "complete", f"exit_{done.returncode}", "-", "-", "FAIL")]
            break
        errors.append(found)
    for column, order in case.orders if not rows else []:
        history = [found[column] for found in errors]
        measured = math.log(history[-2] / history[-1]) / math.log(case.refine)
        short = max(0.0, order - measured)
        rows.append((case.name, column.replace("error", "order"), f"{order:g}", f"{measured:.4g}", f"{short:.3g}", f"{case.slack:g}", "PASS" if short <= case.slack else "FAIL"))
        print("  | " + column + " " + " ".join(f"{e:.4g}" for e in history))
    for row in rows:
        print(*row)
    print(f"  ({case.name}: {time.time() - started:.0f} s, {len(case.levels)} levels, {ranks} rank{'s' if ranks > 1 else ''})", flush=True)
    return rows


def run(silt, case, ranks):
    """Rows (case, quantity, expected, computed, error, tolerance, verdict) of one case."""
    output = os.path.join(ROOT, "output", "verification", case.name)
    command = [silt, case.path, "-output_directory", output]
    if ranks > 1:
        command = ["mpiexec", "-n", str(ranks)] + command
    started = time.time()
    try:
        case.prepare(silt)
    except (subprocess.CalledProcessError, OSError) as error:
        print(f"  | {error}")
        rows = [(case.name, "before", "complete", "failed", "-", "-", "FAIL")]
        print(*rows[0], flush=True)
        return rows
    done = subprocess.run(command, cwd=ROOT, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    rows = [(case.name,) + match[1:] for match in FIGURE.findall(done.stdout)]
    failed = any(row[-1] == "FAIL" for row in rows)
    if done.returncode != 0 and not failed or not rows:
        # The run itself went wrong: that is a failure of the case whatever figures came before it.
        print("\n".join(f"  | {line}" for line in done.stdout.splitlines()[-15:]))
        rows.append((case.name, "run", "complete", f"exit_{done.returncode}" if rows or done.returncode else "no_figures", "-", "-", "FAIL"))
    for row in rows:
        print(*row)
    print(f"  ({case.name}: {time.time() - started:.0f} s, {ranks} rank{'s' if ranks > 1 else ''})", flush=True)
    return rows


def read_page():
    """Rows of the page as it is: (case, ..., verdict, version)."""
    if not os.path.exists(PAGE):
        return []
    rows = [tuple(cell.strip() for cell in line.strip().strip("|").split("|")) for line in open(PAGE) if line.startswith("| ")]
    return [row for row in rows if len(row) == 8 and row[0] != "case"]


def write_page(rows):
    os.makedirs(os.path.dirname(PAGE), exist_ok=True)
    with open(PAGE, "w") as page:
        page.write(HEAD)
        for row in rows:
            page.write("| " + " | ".join(row) + " |\n")


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("silt")
    parser.add_argument("pattern", nargs="?", default="")
    parser.add_argument("--short", action="store_true")
    parser.add_argument("--list", action="store_true")
    parser.add_argument("-n", "--ranks", type=int, default=0)
    arguments = parser.parse_args()

    known = find_cases()
    cases = [case for case in known if arguments.pattern in case.path and (case.short or not arguments.short)]
    cases = [case for case in cases if not case.hours or arguments.pattern == case.name]
    if arguments.list:
        for case in cases:
            print(case.path, "short" if case.short else "")
        return 0
    if not cases and (arguments.pattern or not arguments.short):
        print(f"verify: error: no case matches '{arguments.pattern}'; there are: {' '.join(case.name for case in known)}", file=sys.stderr)
        return 2
    twice = {case.name for case in known if sum(other.name == case.name for other in known) > 1}
    if twice:
        print(f"verify: error: two cases bear the name {', '.join(sorted(twice))}", file=sys.stderr)
        return 2

    default_ranks = 1 if arguments.short else min(2, os.cpu_count() or 1)
    rows = []
    for case in cases:
        rows += (run_orders if case.orders else run)(arguments.silt, case, arguments.ranks or case.ranks or default_ranks)
    passed = sum(row[-1] == "PASS" for row in rows)
    if not arguments.short:
        version = subprocess.run([arguments.silt, "-version"], stdout=subprocess.PIPE, text=True).stdout.split()[1]
        ran = {case.name for case in cases}
        order = [case.name for case in known]
        kept = [row for row in read_page() if row[0] not in ran and row[0] in order]
        write_page(sorted(kept + [row + (version,) for row in rows], key=lambda row: order.index(row[0])))
    print(f"{passed} passed, {len(rows) - passed} failed")
    return 0 if passed == len(rows) else 1


if __name__ == "__main__":
    sys.exit(main())
