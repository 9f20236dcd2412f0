#!/usr/bin/env python3
# processors: 2
"""ParaView opens both series of a coupled run, on two ranks, hexahedra and tetrahedra: times, counts, arrays, numbers; and the tables are whole."""
import csv
import json
import math
import os
import subprocess
import sys
import tempfile

import numpy

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "support"))
import series

CASE = """\
title: output test
mesh: {{type: box, cell: {cell}, lower: [0, 0, 0], upper: [0.01, 0.01, 0.04], cells: [3, 3, 12], periodic: [{periodic}, 0, 0]}}
gravity: [0, 0, -9.81]
time: {{end: 4.0e-3, step: 5.0e-4}}
fluid: {{density: 1.2, viscosity: 1.8e-5, initial_velocity: "0, 0, 0.3"}}
boundary:
  z_min: {{type: velocity, velocity: "0, 0, 0.3"}}
  z_max: {{type: pressure, particles: outlet}}
{sides}
  y_min: {{type: no_slip}}
  y_max: {{type: no_slip}}
material:
  bead: {{density: 1000, young_modulus: 1.0e6, poisson_ratio: 0.3, restitution: 0.9, friction: 0.1}}
insertion:
  bed: {{type: lattice, material: bead, diameter: 1.2e-3, count: 27, spacing: 2.0e-3, lower: [0.002, 0.002, 0.002], upper: [0.008, 0.008, 0.02]}}
  leaving: {{type: lattice, material: bead, diameter: 1.0e-3, count: 1, lower: [0.004, 0.004, 0.0383], upper: [0.0055, 0.0055, 0.0395], velocity: [0, 0, 2]}}
drag: {{type: gidaspow}}
output: {{directory: {folder}, interval: 2.0e-3{more}}}
probe: {{middle: {{point: [0.005, 0.005, 0.03]}}}}
line: {{axis: {{from: [0.005, 0.005, 0.0], to: [0.005, 0.005, 0.04], points: 5}}}}
profile: {{height: {{from: [0.005, 0.005, 0.005], to: [0.005, 0.005, 0.035], points: 4, size: [0.01, 0.01, 0.01]}}}}
expect:
  particles_left: {{quantity: particles, value: 27, tolerance: 0, mode: absolute, source: "one of 28 flies out"}}
  void: {{quantity: height.void_fraction, value: 1, tolerance: 0.2}}
"""
WALLS = "  x_min: {type: no_slip}\n  x_max: {type: no_slip}"
TIMES = [0, 2e-3, 4e-3]
wrong = []


def expect(true, text):
    if not true:
        wrong.append(text)


def rows(folder, name):
    with open(os.path.join(folder, name)) as file:
        return list(csv.DictReader(file))


def check_tables(folder, label):
    for name, count in (("diagnostics.csv", 9), ("boundaries.csv", 9), ("ledger.csv", 8), ("probe_middle.csv", 9), ("line_axis.csv", 15), ("profile_height.csv", 4), ("expectations.csv", 2)):
        table = rows(folder, name)
        expect(len(table) == count, f"{label}: {name} has {len(table)} rows, not {count}")
        for row in table:
            expect(None not in row and None not in row.values(), f"{label}: {name} has a torn row: {row}")
    diagnostics = rows(folder, "diagnostics.csv")
    expect(abs(float(diagnostics[-1]["time"]) - TIMES[-1]) < 1e-12, f"{label}: diagnostics end at {diagnostics[-1]['time']}")
    expect(diagnostics[0]["particles"] == "28" and diagnostics[-1]["particles"] == "27", f"{label}: particles in diagnostics: {[row['particles'] for row in diagnostics]}")
    expect(diagnostics[-1]["removed"] == "1", f"{label}: removed {diagnostics[-1]['removed']}")
    gone = rows(folder, "removed.csv")
    expect(len(gone) == 1 and gone[0]["id"] == "27" and 0.04 <= float(gone[0]["position_z"]) < 0.042 and abs(float(gone[0]["velocity_z"]) - 2) < 0.1
           and abs(float(gone[0]["mass"]) / (1000 * math.pi / 6 * 1e-9) - 1) < 1e-9, f"{label}: removed.csv has {gone}")
    expect(max(float(row["residual"]) for row in rows(folder, "ledger.csv")) < 1e-10, f"{label}: ledger residual")
    # Before the first step the line crosses the inlet's velocity and the initial one, which meets continuity: the nodes inside
    # of a section carry all of the flow, with 4/9 of its area (2/3 between two walls).
    start = [row for row in rows(folder, "line_axis.csv") if float(row["time"]) == 0]
    expect(abs(float(start[0]["velocity_z"]) - 0.3) < 0.02 and all(abs(float(row["velocity_z"]) - (0.45 if label == "periodic" else 0.675)) < 0.05 for row in start[1:]), f"{label}: velocity along the line at the start {[row['velocity_z'] for row in start]}")


def check_series(folder, label, seen, cells, points):
    for name in ("fluid", "particles"):
        wrong.extend(f"{label}: {fault}" for fault in series.faults(folder, name))
    for reader, moments in seen[os.path.join(folder, "fluid.xdmf")].items():
        expect(len(moments) == 3 and max(abs(m["time"] - t) for m, t in zip(moments, TIMES)) < 1e-12, f"{label}: fluid times in {reader}: {[m['time'] for m in moments]}")
        for number, m in enumerate(moments):
            where = f"{label}: fluid at {m['time']} in {reader}"
            expect((m["cells"], m["points"]) == (cells, points), f"{where}: {m['cells']} cells, {m['points']} points, expected {cells}, {points}")
            expect(abs(m["volume"] / 4e-6 - 1) < 1e-6, f"{where}: the cells enclose {m['volume']} m3 instead of 4e-6")
            expect({"velocity", "pressure", "void_fraction"} <= set(m["sums"]), f"{where}: arrays {sorted(m['sums'])}")
            for array, total in m["sums"].items():
                data = series.read(folder, "fluid", number, array)
                expect(numpy.allclose(total, data.reshape(len(data), -1).sum(axis=0), rtol=1e-5, atol=1e-6 * abs(data).sum()), f"{where}: {array} sums to {total}")
    for reader, moments in seen[os.path.join(folder, "particles.xdmf")].items():
        expect(len(moments) == 3 and max(abs(m["time"] - t) for m, t in zip(moments, TIMES)) < 1e-12, f"{label}: particle times in {reader}: {[m['time'] for m in moments]}")
        for number, m in enumerate(moments):
            where = f"{label}: particles at {m['time']} in {reader}"
            count = 28 if number == 0 else 27
            expect((m["points"], m["cells"]) == (count, count), f"{where}: {m['points']} points, {m['cells']} cells, expected {count}")
            expect({"velocity", "spin", "radius", "id", "material", "rank"} <= set(m["sums"]), f"{where}: arrays {sorted(m['sums'])}")
            expect(m["bounds"][0] > 0 and m["bounds"][5] < 0.04, f"{where}: bounds {m['bounds']}")
            expect(numpy.isclose(m["sums"]["velocity"][2], series.read(folder, "particles", number, "velocity")[:, 2].sum(), rtol=1e-5), f"{where}: velocity sums to {m['sums']['velocity']}")
            ids = series.read(folder, "particles", number, "id")
            expect(len(set(ids.tolist())) == count, f"{where}: ids {sorted(ids)}")


def main():
    silt = os.path.abspath(sys.argv[1])
    with tempfile.TemporaryDirectory(prefix="silt_output_") as folder:
        # label: cell, periodic in x, ranks, cells, points in the file, more options
        cases = {
            "hexahedra": ("hexahedron", 0, 2, 108, 4 * 4 * 13, ""),
            "tetrahedra": ("tetrahedron", 0, 3, 648, 4 * 4 * 13, ", precision: single"),
            "periodic": ("hexahedron", 1, 2, 108, 8 * 108, ""),
        }
        for label, (cell, periodic, ranks, _, _, more) in cases.items():
            with open(os.path.join(folder, label + ".yaml"), "w") as file:
                file.write(CASE.format(cell=cell, periodic=periodic, folder=label, more=more, sides="" if periodic else WALLS))
            done = subprocess.run(["mpiexec", "-n", str(ranks), silt, label + ".yaml"], cwd=folder, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
            expect(done.returncode == 0, f"{label}: exit code {done.returncode}:\n{done.stdout[-2000:]}")
            expect(f"{label} particles_left 27 27 0 0 PASS" in done.stdout, f"{label}: the figure expected is not printed:\n{done.stdout[-2000:]}")
        if wrong:
            print("\n".join(wrong))
            return 1
        files = [os.path.join(folder, label, name + ".xdmf") for label in cases for name in ("fluid", "particles")]
        result = os.path.join(folder, "seen.json")
        reader = os.path.join(os.path.dirname(series.__file__), "paraview_series.py")
        done = subprocess.run(["pvpython", reader, result] + files, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        if done.returncode != 0 or "ERR|" in done.stdout:
            print(f"ParaView complains (exit code {done.returncode}):\n{done.stdout[-4000:]}")
            return 1
        with open(result) as file:
            seen = json.load(file)
        for label, (_, _, _, cells, points, _) in cases.items():
            check_tables(os.path.join(folder, label), label)
            check_series(os.path.join(folder, label), label, seen, cells, points)
    print("\n".join(wrong) if wrong else "both series and all tables are as they must be")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
