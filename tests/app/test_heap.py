#!/usr/bin/env python3
"""The angle of repose of a poured heap rises with rolling friction. With an argument after the program, pictures of the
heaps are drawn into that folder."""
import glob
import os
import subprocess
import sys
import tempfile

import h5py
import numpy as np

CASE = """\
mesh: {type: box, lower: [-0.09, 0, 0], upper: [0.09, 0.012, 0.06], cells: [12, 3, 4], periodic: [0, 1, 0]}
gravity: [0, 0, -9.81]
time: {end: 1.5, step: 5.0e-3}
fluid: {type: none}
boundary: {x_min: {particles: outlet}, x_max: {particles: outlet}, z_max: {particles: outlet}}
material: {grain: {density: 2500, young_modulus: 2.0e6, restitution: 0.4, friction: 0.6, rolling_friction: %g}}
normal: {type: tsuji}
tangential: {type: mindlin}
rolling: {type: constant}
insertion:
  pour: {type: stream, diameter: 3.0e-3, number_rate: 700, count: 600, velocity: [0, 0, -0.3], lower: [-0.005, 0, 0.045], upper: [0.005, 0.012, 0.052]}
output: {directory: out}
progress: {quiet: yes}
"""
DIAMETER = 3.0e-3


def angle(x):
    """Inclination of the two flanks: a straight line through the tops of columns one diameter wide, from the middle to
    where the heap is one grain high."""
    columns = np.arange(-0.085, 0.0851, DIAMETER)
    tops = []
    for left in columns:
        inside = x[(x[:, 0] >= left) & (x[:, 0] < left + DIAMETER)]
        if len(inside):
            tops.append((abs(left + DIAMETER / 2), inside[:, 2].max()))
    tops = np.array(tops)
    flank = tops[(tops[:, 1] > 1.2 * DIAMETER) & (tops[:, 0] > 2 * DIAMETER)]
    if len(flank) < 4:
        return 0.0
    return np.degrees(np.arctan(-np.polyfit(flank[:, 0], flank[:, 1], 1)[0]))


def main():
    silt = os.path.abspath(sys.argv[1])
    found = []
    for rolling in (0.0, 0.1, 0.4):
        with tempfile.TemporaryDirectory(prefix="silt_heap_") as folder:
            with open(os.path.join(folder, "case.yaml"), "w") as file:
                file.write(CASE % rolling)
            done = subprocess.run([silt, "case.yaml"], cwd=folder, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, timeout=500)
            if done.returncode:
                sys.exit(done.stdout[-1000:])
            with h5py.File(sorted(glob.glob(os.path.join(folder, "out", "particles", "*.h5")))[-1]) as file:
                x = file["position"][...]
        found.append(angle(x))
        print(f"rolling friction {rolling:g}: {found[-1]:.1f} degrees, {len(x)} grains, {x[:, 2].max() / DIAMETER:.1f} d high")
        if len(sys.argv) > 2:
            import matplotlib
            matplotlib.use("Agg")
            import matplotlib.pyplot as plt
            figure, axes = plt.subplots(figsize=(9, 3))
            axes.set_aspect("equal")
            for p in x[np.argsort(-x[:, 1])]:
                axes.add_patch(plt.Circle((1e3 * p[0], 1e3 * p[2]), 500 * DIAMETER, facecolor="peru", edgecolor="saddlebrown", linewidth=0.5))
            axes.set(xlim=(-90, 90), ylim=(0, 45), xlabel="x, mm", ylabel="z, mm", title=f"rolling friction {rolling:g}: {found[-1]:.0f} degrees")
            figure.savefig(os.path.join(sys.argv[2], f"heap_{rolling:g}.png"), dpi=100, bbox_inches="tight")
    monotone = all(b > a + 2 for a, b in zip(found, found[1:]))
    print(("ok  " if monotone else "FAIL") + " the angle of repose rises with rolling friction")
    return 0 if monotone else 1


if __name__ == "__main__":
    sys.exit(main())
