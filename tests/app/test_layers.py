#!/usr/bin/env python3
# labels: fast
"""The layers of the code: nobody includes upwards, physics knows no library of machinery, no file grows past 400 lines."""
import os
import re
import sys

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
MAY_INCLUDE = {
    "base": {"base"},
    "fluid": {"fluid", "base"},
    "particles": {"particles", "base"},
    "coupling": {"coupling", "fluid", "particles", "base"},
    "app": {"app", "coupling", "fluid", "particles", "base"},
}
MODELS = re.compile(r"^src/(particles/(normal|tangential|rolling|twisting|adhesion|field)|coupling/(drag|lift|heat))/")
MACHINERY = re.compile(r"^\s*#\s*include\s*[<\"](petsc\w*\.h(pp)?|mpi\.h|hdf5\.h|iostream|fstream|cstdio|base/(petsc|mesh|hdf5_file|csv|series|output_directory)\.hpp)[>\"]")
LONGEST = 400


def main():
    faults, files = [], 0
    for folder, _, names in os.walk(os.path.join(ROOT, "src")):
        for name in names:
            path = os.path.relpath(os.path.join(folder, name), ROOT)
            layer = path.split(os.sep)[1]
            lines = open(os.path.join(ROOT, path)).read().splitlines()
            files += 1
            if layer not in MAY_INCLUDE:
                faults.append(f"{path}: '{layer}' is no layer")
                continue
            if len(lines) > LONGEST:
                faults.append(f"{path}: {len(lines)} lines, more than {LONGEST}")
            for number, line in enumerate(lines, 1):
                included = re.match(r'^\s*#\s*include\s*"(\w+)/', line)
                if included and included.group(1) not in MAY_INCLUDE[layer]:
                    faults.append(f"{path}:{number}: {layer} must not include {included.group(1)}: {line.strip()}")
                if re.match(r'^\s*#\s*include\s*"\.\.', line):
                    faults.append(f"{path}:{number}: include from src/, not relative: {line.strip()}")
                if MODELS.match(path) and MACHINERY.match(line):
                    faults.append(f"{path}:{number}: a physical model includes machinery: {line.strip()}")
    print("\n".join(faults) if faults else f"{files} files keep to the layers")
    return 1 if faults or files == 0 else 0


if __name__ == "__main__":
    sys.exit(main())
