#!/usr/bin/env python3
# labels: fast
"""A reader finds the formula of a model in one place, its note, from which docs/models.md is made: every model has a formula, a
source and a check, and no formula of theirs stands again in another model, in a docstring or comment, or in a page of theory."""
import glob
import os
import re
import subprocess
import sys

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
SHORTEST = 14  # characters without blanks of what counts as a formula rather than a symbol


def squeezed(text):
    """Without blanks, with one way of writing powers and constants."""
    text = re.sub(r"\s+|\\", "", text)
    return text.replace("^1/2", "^0.5").replace("^(1/2)", "^0.5").replace("eps_f", "e_f")


def clauses(formula):
    """The right-hand sides of a formula's equations, split at commas and the like outside of brackets."""
    depth, parts = 0, [""]
    for c in formula:
        depth += (c in "([") - (c in ")]")
        if c in ",;:" and depth == 0:
            parts.append("")
        else:
            parts[-1] += c
    for part in parts:
        for side in (part.split(" = ")[1:] if " = " in part else [part]):
            for piece in re.split(r" for | up to | or | unless | growing| falling| loading| back| above| at most ", side):
                text = squeezed(piece)
                if len(text) >= SHORTEST and re.search(r"[\^*/(]", text):
                    yield text


def comments(path):
    """The comments of a source file, each block as one text."""
    blocks, block = [], []
    for line in open(path):
        found = re.search(r"//[/<]*(.*)$", line)
        if found and not line.strip().startswith("#"):
            block.append(found[1])
        elif block:
            blocks.append(" ".join(block))
            block = []
    return "\n".join(blocks + [" ".join(block)])


def declared(silt):
    """(slot, name, formula, source, check) of every model."""
    page = subprocess.run([silt, "-models_page"], stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, text=True, check=True).stdout
    slot = ""
    for line in page.splitlines():
        heading = re.match(r"## `-(\w+)_(?:type|\.\.\.)`", line)
        row = re.match(r"\| `(\w+)` \|", line)
        if heading:
            slot = heading[1]
        elif row:
            name, formula, _, source, check = [cell.strip() for cell in re.split(r"(?<!\\)\|", line)[1:6]]
            yield slot, name.strip("`"), formula, source, check


def main():
    faults, seen = [], {}
    for slot, name, formula, source, check in declared(sys.argv[1]):
        if not formula:
            faults.append(f"{slot} {name} has no formula")
        if name == "none":
            continue
        faults += [f"{slot} {name} has no {what}" for what, text in (("source", source), ("check", check)) if not text]
        for clause in clauses(formula):
            if clause in seen and seen[clause] != (slot, name):
                faults.append(f"{clause} of {slot} {name} stands in {' '.join(seen[clause])} too")
            seen.setdefault(clause, (slot, name))
    pages = {path: squeezed(open(path).read()) for path in glob.glob(os.path.join(ROOT, "docs", "theory", "*.md"))}
    sources = glob.glob(os.path.join(ROOT, "src", "**", "*.[hc]pp"), recursive=True)
    texts = {**pages, **{path: squeezed(comments(path)) for path in sources}}
    for path, text in sorted(texts.items()):
        faults += [f"{os.path.relpath(path, ROOT)} repeats {clause} of {' '.join(model)}" for clause, model in seen.items() if clause in text]
    # A model's docstring has words, its note the formula; an equation of the chapter is not set out in a page of theory.
    for path in sources:
        for docstring in re.findall(r"((?:^///.*\n)+)struct \w+[^{]*\{\n(?:.*\n){0,3}?.*ModelNote note", open(path).read(), re.M):
            if " = " in docstring:
                faults.append(f"{os.path.relpath(path, ROOT)}: a docstring of a model with an equation")
    for path in pages:
        faults += [f"{os.path.relpath(path, ROOT)} sets out{line}" for line in re.findall(r"^ {4}.*\(7\.\d+\)\s*$", open(path).read(), re.M)]
    for fault in faults:
        print(fault)
    print(f"{len(seen)} formulas")
    return 1 if faults or len(seen) < 60 else 0


if __name__ == "__main__":
    sys.exit(main())
