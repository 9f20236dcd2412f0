#!/usr/bin/env python3
"""Hard starts of a flow: an impulsive inflow and a step 100 times too long recover, or stop with a clear reason and the last good state on disk."""
import csv
import os
import subprocess
import sys
import tempfile

SILT = os.path.abspath(sys.argv[1])
CASE = """\
title: hard start
mesh: {{type: box, cell: quadrilateral, lower: [0, 0, 0], upper: [2, 1, 0], cells: [32, 16]}}
gravity: [0, 0, 0]
time: {{end: {end}, step: {step}}}
fluid: {{density: 1, viscosity: 1.0e-3, scheme: {scheme}{more}}}
boundary:
  x_min: {{type: velocity, velocity: "{inflow}, 0, 0"}}
  x_max: {{type: pressure}}
  y_min: {{type: no_slip}}
  y_max: {{type: no_slip}}
output: {{directory: out, interval: {end}}}
"""
wrong = []


def expect(true, text):
    if not true:
        wrong.append(text)


def run(folder, *words, **values):
    values = dict(dict(end=1.0, step=0.02, scheme="pressure_correction", more="", inflow="1"), **values)
    with open(os.path.join(folder, "case.yaml"), "w") as file:
        file.write(CASE.format(**values))
    return subprocess.run([SILT, "case.yaml", *words], cwd=folder, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)


def rows(folder):
    with open(os.path.join(folder, "out", "diagnostics.csv")) as file:
        return list(csv.DictReader(file))


def flows_through(folder, text, end):
    last = rows(folder)[-1]
    expect(abs(float(last["time"]) - end) < 1e-9, f"{text}: the end is not reached")
    expect(abs(float(last["outflow"]) - float(last["inflow"])) < 2e-2 * float(last["inflow"]), f"{text}: what comes in does not leave")
    expect(float(last["largest_fluid_speed"]) < 3 * float(last["inflow"]), f"{text}: the speed {last['largest_fluid_speed']} is not that of the flow")


# An impulsive inflow into fluid at rest, in both schemes.
for scheme in ("pressure_correction", "monolithic"):
    with tempfile.TemporaryDirectory() as folder:
        done = run(folder, scheme=scheme)
        expect(done.returncode == 0, f"impulsive inflow, {scheme}: {done.stdout[-300:]}")
        if done.returncode == 0:
            flows_through(folder, f"impulsive inflow, {scheme}", 1.0)
    # Steps 100 times too long: Courant number 320.
    with tempfile.TemporaryDirectory() as folder:
        done = run(folder, scheme=scheme, end=40.0, step=10.0)
        if done.returncode == 0:
            flows_through(folder, f"step 100 times too long, {scheme}", 40.0)
        else:
            expect("-time_least_step" in done.stdout, f"step 100 times too long, {scheme}: no clear reason: {done.stdout[-300:]}")
            expect(os.path.exists(os.path.join(folder, "out", "last_good.h5")), f"step 100 times too long, {scheme}: no last good state")

# A Newton iteration that is not allowed to converge at long steps: the step is cut until it does.
with tempfile.TemporaryDirectory() as folder:
    done = run(folder, "-fluid_snes_max_it", "4", "-fluid_direct_snes_max_it", "4", "-time_least_step", "1e-6", scheme="monolithic", end=0.4, step=0.4)
    expect(done.returncode == 0, f"four Newton iterations: {done.stdout[-300:]}")
    expect("trying a step of" in done.stdout, "four Newton iterations: no step was cut")
    if done.returncode == 0:
        flows_through(folder, "four Newton iterations", 0.4)

# Where no step helps the run stops, says why, and its last good state can be gone on from.
with tempfile.TemporaryDirectory() as folder:
    done = run(folder, "-fluid_snes_max_it", "1", "-fluid_direct_snes_max_it", "1", "-time_least_step", "1e-3", scheme="monolithic", end=0.4, step=0.02)
    expect(done.returncode == 1, "a hopeless step: it should end the run")
    expect("-time_least_step" in done.stdout and "last_good.h5" in done.stdout, f"a hopeless step: no clear reason: {done.stdout[-300:]}")
    good = os.path.join(folder, "out", "last_good.h5")
    expect(os.path.exists(good), "a hopeless step: no last good state")
    if os.path.exists(good):
        on = run(folder, "-restart", "out/last_good.h5", "-output_directory", "on", scheme="monolithic", end=0.02)
        expect(on.returncode == 0, f"going on from the last good state: {on.stdout[-300:]}")

print("\n".join(wrong) if wrong else "hard starts end well")
sys.exit(1 if wrong else 0)
