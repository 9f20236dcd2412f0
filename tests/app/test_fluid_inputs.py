#!/usr/bin/env python3
# labels: fast
"""Every boundary condition of the fluid, and every way to say one, stands in a case of inputs/fluid; every case says what it
asks, and has a picture in docs/gallery/fluid (families share one); every equation tag of the code stands in docs/theory."""
import glob
import os
import re
import sys

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))

# What the conditions can be given as, beside their types.
FORMS = {
    "a moving wall": r"type: no_slip, velocity:",
    "a turning wall": r"rotation_rate:",
    "a velocity in x, y and t": r"type: velocity, velocity: \"[^\"]*\b[xy]\b[^\"]*\bt\b",
    "a mass flow with a profile": r"type: mass_flow, mass_flow: [^}]*profile:",
    "a start from an earlier run": r"initial_file:",
    **{f"a start from a solution of type {name}": rf"initial_solve: {name}\b" for name in ("potential", "stokes")},
    "an inflow of turbulence by viscosity ratio": r"turbulence: \{[^}]*viscosity_ratio:",
    "a periodic direction": r"periodic: \[",
    "a driving pressure gradient": r"pressure_gradient:",
    "a driving mass flow": r"drive: \{[^}]*mass_flow:|drive_mass_flow:",
    **{f"the turbulence model {name}": rf"turbulence: {name}\b" for name in ("realizable_k_epsilon", "sst_k_omega", "smagorinsky", "wale")},
    "an axisymmetric flow": r"symmetry: axisymmetric",
}


def allowed(option):
    """The values of an option, from docs/options.md."""
    page = open(os.path.join(ROOT, "docs", "options.md")).read()
    row = re.search(r"^\| `-boundary_<name>_" + option + r"` \|(.*)$", page, re.M).group(1)
    return [value.strip() for value in row.split("|")[2].split(",")]


def tags(text):
    """Equation tags of the incompressible fluid: F1, E2, T10."""
    return set(re.findall(r"\b[FET]\d{1,2}\b", text))


def main():
    cases = {path: open(path).read() for path in sorted(glob.glob(os.path.join(ROOT, "inputs", "fluid", "*.yaml")))}
    everything = "\n".join(cases.values())
    faults = []
    for kind in allowed("type"):
        # A condition of the flow opens the braces of its boundary.
        if not re.search(r"^  \w+: \{type: " + kind + r"\b", everything, re.M):
            faults.append(f"no case of inputs/fluid has a boundary of type {kind}")
    for kind in allowed("temperature_type"):
        if kind != "adiabatic" and not re.search(r"temperature: \{type: " + kind + r"\b", everything):
            faults.append(f"no case of inputs/fluid has a temperature condition of type {kind}")
    for what, pattern in FORMS.items():
        if not re.search(pattern, everything):
            faults.append(f"no case of inputs/fluid has {what}")
    gallery = open(os.path.join(ROOT, "docs", "gallery", "fluid", "README.md")).read()
    for path, text in cases.items():
        name = os.path.splitext(os.path.basename(path))[0]
        if not re.match(r"# Question: ", text):
            faults.append(f"{name}.yaml does not begin with its question")
        shown = re.search(rf"^\| `{name}` \| .*!\[\]\((\S+\.png)\) \|$", gallery, re.M)
        if not shown or not os.path.exists(os.path.join(ROOT, "docs", "gallery", "fluid", shown[1])):
            faults.append(f"{name}.yaml has no picture in docs/gallery/fluid (scripts/fluid_pictures.py)")
    defined = tags("\n".join(open(path).read() for path in glob.glob(os.path.join(ROOT, "docs", "theory", "*.md"))))
    for path in glob.glob(os.path.join(ROOT, "src", "fluid", "**", "*.[ch]pp"), recursive=True):
        for number, line in enumerate(open(path), 1):
            missing = tags(line.partition("//")[2]) - defined
            if missing:
                faults.append(f"{os.path.relpath(path, ROOT)}:{number}: {', '.join(sorted(missing))} is no equation of docs/theory")
    print("\n".join(faults) or f"{len(cases)} cases of the fluid have every boundary condition, a question and a picture")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
