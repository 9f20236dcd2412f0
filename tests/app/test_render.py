#!/usr/bin/env python3
"""scripts/render draws a run of a single particle, whose bounds are a point, and refuses a size that is none in one line."""
import os
import struct
import subprocess
import sys
import tempfile

CASE = """\
mesh: {type: box, upper: [0.01, 0.01, 0.01], cells: [3, 3, 3]}
time: {end: 2.0e-3, step: 1.0e-3}
material: {bead: {density: 1000, young_modulus: 1.0e6}}
insertion: {a: {type: lattice, diameter: 1.0e-3, count: 1, lower: [0.004, 0.004, 0.004], upper: [0.006, 0.006, 0.006]}}
output: {directory: out}
"""
SILT = os.path.abspath(sys.argv[1])
RENDER = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "scripts", "render")


def run(folder, *words):
    done = subprocess.run(words, cwd=folder, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    return done.returncode, done.stdout


with tempfile.TemporaryDirectory(prefix="silt_render_") as folder:
    with open(os.path.join(folder, "case.yaml"), "w") as file:
        file.write(CASE)
    code, said = run(folder, SILT, "case.yaml")
    assert code == 0, said
    code, said = run(folder, RENDER, "out", "picture.png", "-size", "400x300")
    assert code == 0 and "render: picture.png" in said, said
    with open(os.path.join(folder, "picture.png"), "rb") as file:
        assert struct.unpack(">II", file.read(24)[16:]) == (400, 300), "the picture has another size"
    code, said = run(folder, RENDER, "out", "other.png", "-size", "400")
    assert code != 0 and "render: error: -size 400" in said and "Traceback" not in said, said
    assert not os.path.exists(os.path.join(folder, "other.png"))
print("a single particle is drawn")
