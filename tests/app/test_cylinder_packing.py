#!/usr/bin/env python3
"""Spheres packed into a cylinder of ten diameters: the void fraction near its wall is that of Mueller 1992 at the first minimum
and maximum, z = 0.5 and 1 diameters, within 0.05 (inputs/cylinder_packing.yaml says how), and the rings of its profile agree
with points on a grid."""
import csv
import glob
import math
import os
import subprocess
import sys
import tempfile

import h5py
import numpy as np

CASE = "inputs/cylinder_packing.yaml"
RADIUS, DIAMETER = 0.010, 0.002


def mueller(z, n):
    """Void fraction at z diameters from the wall of a cylinder of n diameters."""
    a = 8.243 - 12.98 / (n + 3.156) if n <= 13 else 7.383 - 2.932 / (n - 9.864)
    b, bulk = 0.304 - 0.724 / n, 0.379 + 0.078 / (n - 1.8)
    angles = (np.arange(2000) + 0.5) * math.pi / 2000  # J0 by its integral
    bessel = np.cos(a * z * np.sin(angles)).mean()
    return bulk + (1 - bulk) * bessel * math.exp(-b * z)


def de_klerk(z, bulk=0.40):
    if z <= 0.637:
        return 2.14 * z * z - 2.53 * z + 1
    return bulk + 0.29 * math.exp(-0.6 * z) * math.cos(2.3 * math.pi * (z - 0.16)) + 0.15 * math.exp(-0.9 * z)


def void_fraction(x, distance, low, high, thickness=0.1 * DIAMETER, shells=7):
    """Share of the ring about this distance from the wall that no sphere covers."""
    return np.mean([shell_void_fraction(x, d, low, high) for d in distance + thickness * ((np.arange(shells) + 0.5) / shells - 0.5)])


def shell_void_fraction(x, distance, low, high):
    """The same of a shell without thickness, by a grid of points."""
    radius = RADIUS - distance
    angle, height = np.linspace(0, 2 * math.pi, 400, endpoint=False), np.linspace(low, high, 1400)
    circle = radius * np.stack([np.cos(angle), np.sin(angle)], axis=1)
    covered = np.zeros((len(height), len(angle)), bool)
    for centre in x[np.abs(np.hypot(x[:, 0], x[:, 1]) - radius) < DIAMETER / 2]:
        first, last = np.searchsorted(height, [centre[2] - DIAMETER / 2, centre[2] + DIAMETER / 2])
        square = ((circle - centre[:2]) ** 2).sum(axis=1)[None, :] + ((height[first:last] - centre[2]) ** 2)[:, None]
        covered[first:last] |= square < DIAMETER**2 / 4
    return 1 - covered.mean()


def main():
    silt = os.path.abspath(sys.argv[1])
    with tempfile.TemporaryDirectory(prefix="silt_cylinder_") as folder:
        out = os.path.join(folder, "out")
        done = subprocess.run([silt, CASE, "-output_directory", out], stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, timeout=550)
        if done.returncode:
            sys.exit(done.stdout[-1000:])
        with h5py.File(sorted(glob.glob(os.path.join(out, "particles", "*.h5")))[-1]) as file:
            x = file["position"][...]
        profile = {}
        for name in ("half", "one"):
            with open(os.path.join(out, f"profile_{name}.csv")) as file:
                profile[name] = float(list(csv.DictReader(file))[0]["void_fraction"])
    low, high = 0.006, 0.070
    faults = 0
    for z, name in ((0.5, "half"), (1.0, "one")):
        computed, expected = void_fraction(x, z * DIAMETER, low, high), mueller(z, 10)
        good = abs(computed - expected) < 0.05
        faults += not good
        print(f"{'ok  ' if good else 'FAIL'} void fraction {z:g} d from the wall: {computed:.3f}, Mueller {expected:.3f}, de Klerk {de_klerk(z):.3f}")
        good = abs(profile[name] - computed) < 0.01
        faults += not good
        print(f"{'ok  ' if good else 'FAIL'} the ring of the profile: {profile[name]:.4f}, points on a grid: {computed:.4f}")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
