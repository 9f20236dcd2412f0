#!/usr/bin/env python3
# processors: 3
"""The same case on 1, 2 and 3 ranks: the same particles, a clean ledger, the same bed; a dilute case to 1e-8. The same case on as
many ranks: the same bits."""
import csv
import glob
import os
import subprocess
import sys
import tempfile

import h5py
import numpy as np

# Wide and low, so that every rank has its share of the bed.
BED = """\
mesh: {type: box, cell: %s, lower: [0, 0, 0], upper: [0.048, 0.012, 0.024], cells: [16, 4, 8]}
gravity: [0, 0, -9.81]
time: {end: 0.02, step: 1.0e-3}
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
  bed: {type: fill, material: bead, diameter: 1.2e-3, count: 1200, lower: [0, 0, 0], upper: [0.048, 0.012, 0.012], seed: 1}
settle: {time: 0.05}
drag: {type: gidaspow}
output: {directory: out}
"""
# Far apart, so that no rounding is amplified by contacts; particles sit where ranks meet. Solved to round-off, so that
# the preconditioner, which differs with the ranks, leaves no trace.
TIGHT = ["-fluid_velocity_tolerance", "1e-13", "-fluid_pressure_ksp_rtol", "1e-13"]
DILUTE = BED.replace("type: fill, material: bead, diameter: 1.2e-3, count: 1200, lower: [0, 0, 0], upper: [0.048, 0.012, 0.012], seed: 1",
                     "type: file, file: start.csv").replace(
                         "upper: [0.048, 0.012, 0.024], cells: [16, 4, 8]", "upper: [0.012, 0.012, 0.048], cells: [4, 4, 16]").replace("settle: {time: 0.05}", "settle: {time: 0}")
START = "x,y,z,diameter,material\n" + "".join(f"{0.003 * i},{0.003 * j},{0.006 * k},0.0006,bead\n" for i in (1, 2, 3) for j in (1, 2, 3) for k in (2, 4, 6))
# Two cells: on three ranks one has none; one particle: two ranks have none.
TWO_CELLS = DILUTE.replace("cells: [4, 4, 16]", "cells: [1, 1, 2]")
ONE = "x,y,z,diameter,material\n0.006,0.006,0.03,0.0006,bead\n"


class Run:
    """Last row of the diagnostics, worst figures of the ledger, last particles by id."""

    def __init__(self, silt, case, start, ranks):
        with tempfile.TemporaryDirectory(prefix="silt_ranks_") as folder:
            for name, text in (("case.yaml", case), ("start.csv", start)):
                with open(os.path.join(folder, name), "w") as file:
                    file.write(text)
            command = (["mpiexec", "-n", str(ranks)] if ranks > 1 else []) + [silt, "case.yaml"] + ([] if "count:" in case else TIGHT)
            done = subprocess.run(command, cwd=folder, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, timeout=300)
            if done.returncode:
                sys.exit(f"{ranks} ranks: exit code {done.returncode}\n" + "\n".join(done.stdout.splitlines()[-12:]))
            with open(os.path.join(folder, "out", "diagnostics.csv")) as file:
                self.rows = [{key: float(value) for key, value in row.items()} for row in csv.DictReader(file)]
            with open(os.path.join(folder, "out", "ledger.csv")) as file:
                ledger = list(csv.DictReader(file))
            self.residual = max(float(row["residual"]) for row in ledger)
            self.volume_error = max(abs(float(row["deposited_volume"]) / float(row["particle_volume"]) - 1) for row in ledger)
            self.last = self.rows[-1]
            with h5py.File(sorted(glob.glob(os.path.join(folder, "out", "particles", "*.h5")))[-1]) as file:
                order = np.argsort(file["id"][...])
                self.holders = len(np.unique(file["rank"][...]))
                self.id = file["id"][...][order]
                self.rank = file["rank"][...][order]
                self.position, self.velocity = file["position"][...][order], file["velocity"][...][order]


def main():
    silt = os.path.abspath(sys.argv[1])
    faults = []

    def check(label, measured, allowed):
        print(f"{'ok  ' if measured <= allowed else 'FAIL'} {label}: {measured:.3g} (allowed {allowed:g})")
        if not measured <= allowed:
            faults.append(label)

    def same_particles(label, one, many):
        check(f"{label}: particles that differ", 0 if np.array_equal(one.id, many.id) else 1, 0)
        check(f"{label}: particles counted", abs(one.last["particles"] - many.last["particles"]), 0)

    for name, case, start in (("bed of hexahedra", BED % "hexahedron", ""), ("bed of tetrahedra", BED % "tetrahedron", ""),
                              ("dilute", DILUTE % "hexahedron", START), ("two cells", TWO_CELLS % "hexahedron", ONE)):
        runs = {ranks: Run(silt, case, start, ranks) for ranks in (1, 2, 3)}
        for ranks, run in runs.items():
            label = f"{name}, {ranks} ranks"
            check(f"{label}: ledger residual", run.residual, 1e-10)
            check(f"{label}: deposited volume", run.volume_error, 1e-12)
            one = runs[1]
            if ranks == 1:
                continue
            same_particles(label, one, run)
            check(f"{label}: ranks without particles", ranks - run.holders, {"two cells": ranks - 1, "dilute": 1}.get(name, 0))
            if name.startswith("bed"):
                # Contacts amplify rounding: compare what does not hang on single particles.
                check(f"{label}: bed height", abs(run.last["bed_height"] / one.last["bed_height"] - 1), 0.01)
                drop = [np.mean([row["pressure_drop"] for row in r.rows[len(r.rows) // 2:]]) for r in (one, run)]
                check(f"{label}: pressure drop", abs(drop[1] / drop[0] - 1), 0.03)
            else:
                check(f"{label}: positions", np.abs(run.position - one.position).max() / 0.048, 1e-8)
                check(f"{label}: velocities", np.abs(run.velocity - one.velocity).max() / 0.3, 1e-8)
                check(f"{label}: pressure drop", abs(run.last["pressure_drop"] - one.last["pressure_drop"]) / abs(one.last["pressure_drop"]), 1e-8)
    short = BED.replace("end: 0.02", "end: 0.003").replace("settle: {time: 0.05}", "settle: {time: 0.01}") % "hexahedron"
    first, *others = [Run(silt, short, "", 3) for _ in range(5)]
    for k, run in enumerate(others):
        same = all(np.array_equal(getattr(first, name), getattr(run, name)) for name in ("id", "rank", "position", "velocity"))
        check(f"run {k + 2} on 3 ranks: other bits than the first", 0 if same else 1, 0)
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
