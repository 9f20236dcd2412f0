#!/usr/bin/env python3
"""ParaView opens both series of a run: times, arrays, point counts and values as the run wrote them, cells that fill the box."""
import glob
import json
import os
import shutil
import subprocess
import sys
import tempfile

import h5py
import numpy as np

CASE = """\
mesh: {type: box, cell: %s, lower: [0, 0, 0], upper: [0.012, 0.012, 0.024], cells: [3, 4, 5]}
gravity: [0, 0, -9.81]
time: {end: 3.0e-3, step: 5.0e-4}
fluid: {density: 1.2, viscosity: 1.8e-5, initial_velocity: "0, 0, 0.3"}
boundary:
  z_min: {type: velocity, velocity: "0, 0, 0.3"}
  z_max: {type: pressure}
  x_min: {type: no_slip}
  x_max: {type: no_slip}
  y_min: {type: no_slip}
  y_max: {type: no_slip}
material:
  bead: {density: 1000, young_modulus: 1.0e6, poisson_ratio: 0.3, restitution: 0.9, friction: 0.1}
insertion:
  bed: {type: fill, material: bead, diameter: 1.2e-3, count: 50, lower: [0, 0, 0], upper: [0.012, 0.012, 0.012], seed: 1}
output: {directory: out, interval: 1.0e-3}
"""
READ = """
import json, sys
from paraview.simple import *
from paraview import servermanager
out = {}
for name in ("fluid", "particles"):
    reader = Xdmf3ReaderS(FileName=[sys.argv[1] + "/" + name + ".xdmf"])
    reader.UpdatePipeline()
    times = list(reader.TimestepValues)
    reader.UpdatePipeline(times[-1])
    info = reader.GetPointDataInformation()
    arrays = {}
    for k in range(info.GetNumberOfArrays()):
        array = info.GetArray(k)
        arrays[array.GetName()] = [array.GetNumberOfComponents(), list(array.GetRange(0))]
    data = reader.GetDataInformation()
    out[name] = {"times": times, "points": data.GetNumberOfPoints(), "cells": data.GetNumberOfCells(), "arrays": arrays}
    if name == "fluid":
        whole = IntegrateVariables(Input=CellSize(Input=reader), DivideCellDataByVolume=0)
        whole.UpdatePipeline(times[-1])
        out["volume"] = whole.CellData["Volume"].GetRange(0)[0]
print("ANSWER " + json.dumps(out))
"""


def read(folder):
    """What ParaView sees in the run's directory."""
    script = os.path.join(folder, "read.py")
    with open(script, "w") as file:
        file.write(READ)
    done = subprocess.run(["pvpython", "--force-offscreen-rendering", script, os.path.join(folder, "out")], stdin=subprocess.DEVNULL,
                          stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, timeout=300)
    answer = [line for line in done.stdout.splitlines() if line.startswith("ANSWER ")]
    if not answer:
        sys.exit("pvpython failed:\n" + done.stdout[-2000:])
    return json.loads(answer[0][len("ANSWER "):])


def main():
    silt = os.path.abspath(sys.argv[1])
    if not shutil.which("pvpython"):
        sys.exit("pvpython is not installed; run scripts/setup")
    faults = []

    def check(label, ok, seen):
        print(f"{'ok  ' if ok else 'FAIL'} {label}: {seen}")
        if not ok:
            faults.append(label)

    for cell, ranks in (("hexahedron", 2), ("tetrahedron", 1)):
        with tempfile.TemporaryDirectory(prefix="silt_paraview_") as folder:
            with open(os.path.join(folder, "case.yaml"), "w") as file:
                file.write(CASE % cell)
            command = (["mpiexec", "-n", str(ranks)] if ranks > 1 else []) + [silt, "case.yaml"]
            done = subprocess.run(command, cwd=folder, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, timeout=300)
            if done.returncode:
                sys.exit(f"the run failed with {done.returncode}\n{done.stdout[-2000:]}")
            seen = read(folder)
            for name in ("fluid", "particles"):
                check(f"{cell}: times of {name}", np.allclose(seen[name]["times"], [0, 1e-3, 2e-3, 3e-3], rtol=0, atol=1e-12), seen[name]["times"])
            check(f"{cell}: nodes", seen["fluid"]["points"] == 4 * 5 * 6, seen["fluid"]["points"])
            check(f"{cell}: cells", seen["fluid"]["cells"] % (3 * 4 * 5) == 0 and seen["fluid"]["cells"] > 0, seen["fluid"]["cells"])
            check(f"{cell}: volume of the cells", abs(seen["volume"] / (0.012 * 0.012 * 0.024) - 1) < 1e-10, seen["volume"])
            check(f"{cell}: particles", seen["particles"]["points"] == 50, seen["particles"]["points"])
            components = {name: array[0] for name, array in seen["fluid"]["arrays"].items()}
            check(f"{cell}: fluid arrays", components.items() >= {"velocity": 3, "pressure": 1, "void_fraction": 1}.items(), components)
            components = {name: array[0] for name, array in seen["particles"]["arrays"].items()}
            check(f"{cell}: particle arrays", components.items() >= {"velocity": 3, "spin": 3, "radius": 1, "id": 1, "material": 1}.items(), components)
            for name, field in (("fluid", "pressure"), ("particles", "id"), ("particles", "velocity")):
                with h5py.File(sorted(glob.glob(os.path.join(folder, "out", name, "0*.h5")))[-1]) as file:
                    values = file[field][...]
                values = values[:, 0] if values.ndim > 1 else values
                low, high = seen[name]["arrays"][field][1]
                check(f"{cell}: range of {name} {field}", np.isclose(low, values.min(), rtol=1e-12) and np.isclose(high, values.max(), rtol=1e-12), (low, high))
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
