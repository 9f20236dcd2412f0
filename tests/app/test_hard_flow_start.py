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

# A gas: the jet of a sonic nozzle starts at once, its pressure rises at once, the step is 100 times too long (Courant number 140).
JET = """\
title: sudden jet
mesh: {{type: box, cell: quadrilateral, lower: [0, 0, 0], upper: [4, 2, 0], cells: [32, 16]}}
gravity: [0, 0, 0]
time: {{end: {end}, step: {step}}}
fluid: {{type: compressible, symmetry: axisymmetric, gas_constant: 1, viscosity: 1e-3, initial_pressure: "1", initial_temperature: "1", {more}}}
boundary:
  x_min: {{type: far_field, pressure: "y < 0.5 ? {pressure} : 1", velocity: "y < 0.5 ? 1.0802 : 0, 0, 0", temperature: {{value: "y < 0.5 ? 0.8333 : 1"}}{entering}}}
  x_max: {{type: far_field, pressure: "1", temperature: {{value: "1"}}{entering}}}
  y_max: {{type: far_field, pressure: "1", temperature: {{value: "1"}}{entering}}}
  y_min: {{type: slip}}
output: {{directory: out, interval: {end}}}
"""
laminar = dict(end=3, step=0.1, pressure="3.6", more="order: 2", entering="")
turbulent = dict(more="turbulence: realizable_k_epsilon, initial_turbulent_energy: '1e-5'", entering=", turbulence: {energy: '1e-3', viscosity_ratio: '10'}")
for name, change in {
    "impulsive start": {},
    "impulsive start, k-epsilon": turbulent,
    "impulsive start at 16 times the pressure": dict(pressure="16"),
    "sudden rise of the pressure": dict(pressure="(t > 1 ? 16 : 1.9)"),
    "step 100 times too long": dict(step=10, end=40),
}.items():
    with tempfile.TemporaryDirectory() as folder:
        with open(os.path.join(folder, "case.yaml"), "w") as file:
            file.write(JET.format(**dict(laminar, **change)))
        done = subprocess.run([SILT, "case.yaml"], cwd=folder, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        expect(done.returncode == 0, f"gas, {name}: {done.stdout[-300:]}")
        if done.returncode == 0:
            table = rows(folder)
            expect(min(float(row["least_temperature"]) for row in table) > 0, f"gas, {name}: temperature {table[-1]['least_temperature']}")
            expect(name.endswith("epsilon") or any(float(row["first_order"]) for row in table), f"gas, {name}: first-order steps are not told")
            expect(not float(table[-1]["first_order"]), f"gas, {name}: first-order steps do not end")

print("\n".join(wrong) if wrong else "hard starts end well")
sys.exit(1 if wrong else 0)
