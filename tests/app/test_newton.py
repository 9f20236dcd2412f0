#!/usr/bin/env python3
# labels: fast
"""Newton's method converges quadratically, as a user sees it by -fluid_snes_monitor: the last three norms of a step of a liquid and of a gas."""
import math
import os
import re
import subprocess
import sys
import tempfile

SILT = os.path.abspath(sys.argv[1])
CASE = """\
mesh: {{type: box, cell: quadrilateral, lower: [0, 0, 0], upper: [1, 1, 0], cells: [16, 16]}}
gravity: [0, 0, 0]
time: {{end: {step}, step: {step}}}
fluid: {{{fluid}}}
boundary:
  x_min: {{type: no_slip}}
  x_max: {{type: no_slip}}
  y_min: {{type: no_slip}}
  y_max: {{type: no_slip, velocity: "1, 0, 0"}}
output: {{directory: out, interval: {step}}}
"""
FLOWS = {"a cavity at Re 100 in one step from rest": ("scheme: monolithic, density: 1, viscosity: 0.01", "1.0e6"),
         "gas with a hot middle": ('type: compressible, gas_constant: 1, viscosity: 0.01, initial_pressure: "1", initial_temperature: "1 + exp(-20*((x-0.5)^2 + (y-0.5)^2))"', "0.05")}
EXACT = ["-fluid_pc_type", "lu", "-fluid_ksp_rtol", "1e-12", "-fluid_snes_rtol", "1e-13", "-fluid_snes_atol", "1e-30"]
wrong = []
for name, (fluid, step) in FLOWS.items():
    with tempfile.TemporaryDirectory() as folder:
        with open(os.path.join(folder, "case.yaml"), "w") as file:
            file.write(CASE.format(fluid=fluid, step=step))
        done = subprocess.run([SILT, "case.yaml", "-fluid_snes_monitor", *EXACT], cwd=folder, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        norms = [float(norm) for norm in re.findall(r"SNES Function norm (\S+)", done.stdout)]
        above = [norm for norm in norms if norm > 1e-13 * norms[0]]  # the rest is rounding
        last = above[-3:]
        order = math.log(last[2] / last[1]) / math.log(last[1] / last[0]) if len(last) == 3 else 0
        print(f"{name}: norms {', '.join(f'{norm:.3e}' for norm in norms)}; order of the last three above rounding {order:.2f}")
        # Three norms of quadratic convergence: (log e3 - log e2)/(log e2 - log e1) tends to 2 from either side.
        if done.returncode or order < 1.8:
            wrong.append(f"{name}: order {order:.2f}, end of the run: {done.stdout[-300:]}")
for text in wrong:
    print(text)
sys.exit(bool(wrong))
