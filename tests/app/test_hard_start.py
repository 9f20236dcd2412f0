#!/usr/bin/env python3
# labels: fast
"""A jet that starts all at once, with a step far too large: the march towards the steady state gets over it with pressure and
temperature above zero, and so does the march in time by first-order steps; where Newton's method may not iterate it stops
with the reason and leaves the last good state as a readable checkpoint."""
import csv
import os
import sys
import tempfile

from one_case import run, write_case

CASE = """\
mesh: {type: box, cell: quadrilateral, lower: [0, 0, 0], upper: [0.007, 0.0035, 0], cells: [28, 14]}
time: {end: 3.0e-5, step: 3.0e-5, least_step: 1.0e-9}
fluid:
  type: compressible
  symmetry: axisymmetric
  order: 1
  viscosity: 1.0e-4
  initial_pressure: "1e5"
  initial_temperature: "300"
boundary:
  x_min:
    type: far_field
    pressure: "y < 0.0005 ? 15.8485e5 : 1e5"
    velocity: "y < 0.0005 ? 316.97 : 0, 0, 0"
    temperature: {value: "y < 0.0005 ? 250 : 300"}
  x_max: {type: far_field, pressure: "1e5", temperature: {value: "300"}}
  y_max: {type: far_field, pressure: "1e5", temperature: {value: "300"}}
  y_min: {type: slip}
probe: {jet: {point: [0.001, 0, 0]}}
output: {directory: out, interval: 3.0e-5}
progress: {quiet: yes}
"""


def main():
    silt = os.path.abspath(sys.argv[1])
    with tempfile.TemporaryDirectory() as folder:
        write_case(folder, CASE)
        for march in ("steady", "time"):
            code, text = run(silt, folder, "-fluid_march", march)
            assert code == 0, text
            with open(os.path.join(folder, "out", "probe_jet.csv")) as file:
                rows = list(csv.DictReader(file))
            assert float(rows[-1]["time"]) > 2.999e-5 and all(float(r["pressure"]) > 0 and float(r["temperature"]) > 0 for r in rows), rows[-1]
            assert float(rows[-1]["mach"]) > 1.5, (march, rows[-1])

        code, text = run(silt, folder, "-fluid_snes_max_it", "1")
        assert code == 1 and "failed down to" in text and "(-time_least_step)" in text and "last_good.h5" in text, (code, text)
        good = os.path.join(folder, "out", "last_good.h5")
        assert os.path.exists(good), text
        code, text = run(silt, folder, "-restart", good, "-check")
        assert code == 0, text
    return 0


if __name__ == "__main__":
    sys.exit(main())
