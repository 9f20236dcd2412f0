#!/usr/bin/env python3
# labels: fast
"""A flow that turns into nonsense in its step reaches the particles by the coupling's last kick: the run stops with one line, and the state
before that step is there to go on from."""
import csv
import os
import sys
import tempfile

from one_case import run, write_case

CASE = """\
mesh: {type: box, lower: [0, 0, 0], upper: [0.01, 0.01, 0.01], cells: [4, 4, 4]}
time: {end: 0.01, step: 0.001}
fluid: {type: prescribed, density: 1.2, viscosity: 1.8e-5, velocity: "t < 0.0055 ? 0.1 : 0/0, 0, 0"}
material: {bead: {density: 1000, young_modulus: 1.0e6}}
particles: {speed: 1}
insertion: {bed: {type: lattice, material: bead, count: 20, diameter: 1.0e-3}}
output: {directory: out, interval: 0.01}
progress: {quiet: yes}
"""


def main():
    silt = os.path.abspath(sys.argv[1])
    with tempfile.TemporaryDirectory() as folder:
        write_case(folder, CASE)
        code, text = run(silt, folder)
        assert code == 1 and "not a number" in text and "t = 0.005 s" in text and "last_good.h5" in text, (code, text)
        good = os.path.join(folder, "out", "last_good.h5")
        assert os.path.exists(good), text
        code, text = run(silt, folder, "-restart", good, "-fluid_velocity", "0.1, 0, 0", "-output_directory", "on")
        assert code == 0, (code, text)
        with open(os.path.join(folder, "on", "diagnostics.csv")) as file:
            rows = list(csv.DictReader(file))
        assert abs(float(rows[-1]["time"]) - 0.01) < 1e-12, rows[-1]
    return 0


if __name__ == "__main__":
    sys.exit(main())
