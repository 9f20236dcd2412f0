#!/usr/bin/python3
"""Prints docs/models.md: what `silt -models_page` declares, with the pictures of docs/models and the cases that verify each model."""
import glob
import os
import re
import subprocess
import sys

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
HEAD = """# Models

Made by `scripts/options_page` from the lists of models in the code; do not edit. Each is chosen by name,
`normal: {type: tsuji}`; numbers such as (7.16) are equations of Yeoh & Tu, *Computational Techniques for Multiphase
Flows*, 2nd ed., chapter 7. The first of each list is the default. Overlap x, approach dx/dt, slip V_t, spins w. The
checks are made by the tests; `verified by` names cases of `scripts/verify models`, whose figures stand in
[verification.md](verification.md). The pictures are drawn by `scripts/model_pictures` from the solver's own loops
(`-law_table_motion`): in and out at constant speed, or to and fro under a constant load; dots in those of fields are the closed form of two bare
dipoles or charges, from which mutual magnetisation departs. In those of flows, heat and polarisation every point is a particle of a run.
The formula of a model stands here, from its header, and nowhere else.
"""


def chosen(text):
    """(slot, model) of every `slot: {type: model, ...}` of an options file, in either style of YAML."""
    found = re.findall(r"^(\w+):\s*\{[^{}]*?\btype:\s*(\w+)", text, re.M)
    return found + re.findall(r"^(\w+):\s*\n(?:  .*\n)*?  type:\s*(\w+)", text, re.M)


def declared(silt):
    """What the solver says of its models."""
    return subprocess.run([silt, "-models_page"], stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, text=True, check=True).stdout


def switches(page):
    """(slot, model, pattern) of every model that an option of its own switches on, as in an options file."""
    for slot, rows in re.findall(r"^## `-(\w+)_\.\.\.`\n((?:\n|\|.*\n?)+)", page, re.M):
        for name, option, value in re.findall(r"^\| `(\w+)` \|.*?\| `-(\w+)(?: (\w+))?` \|", rows, re.M):
            group, _, key = option.partition("_") if option != "virtual_mass_coefficient" else ("virtual_mass", "_", "coefficient")
            begin = rf"^{group}:[^\n]*(?:\n  [^\n]*)*?\b{key}:"
            if option == "gravity":  # a weight, in a fluid
                begin = r"\A(?=[\s\S]*^fluid: \{(?!type: none))[\s\S]*^gravity: \[[^\]]*[1-9]"
            if option == "fluid_pressure":  # or the gradient that drives a flow
                begin = rf"(?:{begin}|^fluid:[^\n]*\bpressure_gradient:)"
            yield slot, name, begin + (rf"\s*{value}\b" if value else "")


def verifying(page):
    """The cases of `scripts/verify models`, by (slot, model)."""
    cases = {}
    switched = list(switches(page))
    paths = glob.glob(os.path.join(ROOT, "inputs", "models", "*.yaml")) + glob.glob(os.path.join(ROOT, "inputs", "verification", "models_*.yaml"))
    for path in sorted(paths, key=os.path.basename):
        text = open(path).read()
        if not re.search(r"^expect:", text, re.M):
            continue
        found = chosen(text) + [(slot, name) for slot, name, pattern in switched if re.search(pattern, text, re.M)]
        for key in dict.fromkeys(found):
            cases.setdefault(key, []).append(os.path.basename(path)[:-5])
    return cases


def scenes():
    """Name, question and picture of every scene."""
    for path in sorted(glob.glob(os.path.join(ROOT, "inputs", "models", "scene_*.yaml"))):
        text = open(path).read()
        question = re.search(r"^# Question: (.*)$", text, re.M)[1]
        picture = re.search(r"^# Picture:\s+docs/(\S+\.png)", text, re.M)[1]
        yield os.path.basename(path)[:-5], question, picture


def page(silt):
    text = declared(silt)
    cases = verifying(text)
    lines, slot, pictured, drawn = [HEAD.rstrip()], "", None, set()
    for line in text.splitlines():
        heading = re.match(r"## `-(\w+)_(?:type|\.\.\.)`", line)
        row = re.match(r"\| `(\w+)` \|", line)
        if heading:
            slot, pictured = heading[1], os.path.exists(os.path.join(ROOT, "docs", "models", heading[1] + ".png"))
        if line.startswith("| name |"):
            if pictured and slot not in drawn:
                lines += [f"![each {slot} law](models/{slot}.png)", ""]
                lines += ["![Clausius and Mossotti's factor](models/polarisation.png)", ""] if slot == "electric" else []
                lines += ["![a source of heat](models/heat_source.png)", ""] if slot == "heat" else []
                drawn.add(slot)
            line += " verified by |"
        elif line.startswith("|---"):
            line += "---|"
        elif row:
            line += " " + ", ".join(f"`{case}`" for case in cases.get((slot, row[1]), [])) + " |"
        lines.append(line)
    lines += ["", "## Scenes", "", "Small cases of several particles, in `inputs/models`.", ""]
    shown = None
    for name, question, picture in scenes():
        lines.append(f"`{name}`: {question}" + ("" if picture == shown else f"\n\n![{name}]({picture})") + "\n")
        shown = picture
    return "\n".join(lines).rstrip() + "\n"


if __name__ == "__main__":
    sys.stdout.write(page(sys.argv[1]))
