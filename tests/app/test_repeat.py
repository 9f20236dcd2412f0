#!/usr/bin/env python3
# labels: fast
"""A run is repeated from the record that it wrote, from another folder and with the same numbers, whatever was left to its default."""
import os
import shutil
import subprocess
import sys
import tempfile

MESH = """\
$MeshFormat
2.2 0 8
$EndMeshFormat
$PhysicalNames
3
1 1 "Inlet"
1 2 "Wall"
2 3 "domain"
$EndPhysicalNames
$Nodes
6
1 0 0 0
2 1 0 0
3 2 0 0
4 0 1 0
5 1 1 0
6 2 1 0
$EndNodes
$Elements
8
1 1 2 1 4 4 1
2 1 2 2 1 1 2
3 1 2 2 1 2 3
4 1 2 2 2 3 6
5 1 2 2 3 6 5
6 1 2 2 3 5 4
7 3 2 3 1 1 2 5 4
8 3 2 3 1 2 3 6 5
$EndElements
"""
FLOW = """\
title: "the pump's flow"
mesh: {type: file, file: square.msh}
time: {end: 0.2, step: 0.1}
fluid: {density: 1, viscosity: 0.1, initial_velocity: "0.1*y, 0, 0", pressure_ksp_rtol: 1e-9}
boundary:
  Inlet: {type: pressure}
  Wall: {type: no_slip}
output: {directory: out}
"""
# Switches without a value, a file of particles beside the case, and a bed in a gas.
BED = """\
mesh: {type: box, lower: [0, 0, 0], upper: [0.01, 0.01, 0.02], cells: [4, 4, 8]}
time: {end: 1.0e-3, step: 5.0e-4}
fluid: {density: 1.2, viscosity: 1.8e-5}
boundary:
  z_min: {type: velocity, velocity: "0, 0, 0.3"}
  z_max: {type: pressure}
  x_min: {type: slip}
  x_max: {type: slip}
  y_min: {type: no_slip}
  y_max: {type: symmetry}
material: {Bead: {density: 1000, young_modulus: 1.0e6}}
insertion: {bed: {type: file, file: start.csv, material: Bead}}
output: {directory: out}
"""
GAS = """\
mesh: {type: box, cell: quadrilateral, upper: [1, 1, 0], cells: [8, 2]}
time: {end: 2.0e-4, step: 1.0e-4}
fluid: {type: compressible, viscosity: 0, initial_pressure: "(x < 0.5) ? 1e5 : 5e4", initial_temperature: "300"}
boundary: {x_min: {type: slip}, x_max: {type: slip}, y_min: {type: slip}, y_max: {type: slip}}
output: {directory: out}
"""
SILT = os.path.abspath(sys.argv[1])
wrong = []


def run(folder, *words):
    done = subprocess.run([SILT, *words], cwd=folder, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    return done.returncode, done.stdout


for label, case, words in (("flow", FLOW, ()), ("bed", BED, ("-coupling_viscous_stress",)), ("gas", GAS, ())):
    with tempfile.TemporaryDirectory(prefix="silt_repeat_") as folder:
        os.makedirs(os.path.join(folder, "cases"))
        os.makedirs(os.path.join(folder, "elsewhere"))
        for name, text in (("case.yaml", case), ("square.msh", MESH), ("start.csv", "x,y,z,diameter\n0.005,0.005,0.01,0.001\n0.003,0.004,0.006,0.0012\n")):
            with open(os.path.join(folder, "cases", name), "w") as file:
                file.write(text)
        code, said = run(folder, "cases/case.yaml", *words)
        if code != 0:
            wrong.append(f"{label}: exit code {code}: {said[-300:]}")
            continue
        shutil.copy(os.path.join(folder, "out", "run.yaml"), os.path.join(folder, "elsewhere", "again.yaml"))
        code, said = run(os.path.join(folder, "elsewhere"), "again.yaml")
        if code != 0:
            wrong.append(f"{label}, from its record: exit code {code}: {said[-300:]}")
            continue
        tables = [open(os.path.join(folder, at, "out", "diagnostics.csv")).read() for at in ("", "elsewhere")]
        if tables[0] != tables[1]:
            wrong.append(f"{label}: the record gives other numbers")
        records = [open(os.path.join(folder, at, "out", "run.yaml")).read() for at in ("", "elsewhere")]
        if records[0] != records[1]:
            wrong.append(f"{label}: the record of the repeated run is another one")
print("\n".join(wrong) if wrong else "the records give the runs again")
sys.exit(1 if wrong else 0)
