#!/usr/bin/env python3
# processors: 2
"""Meshes of Gmsh that repeat themselves ($Periodic) are periodic for flow and particles, in either format, on any number of ranks; what cannot be
meant is refused with one line."""
import csv
import os
import subprocess
import sys
import tempfile

import h5py
import numpy as np

SILT = os.path.abspath(sys.argv[1])
PLANE = """\
SetFactory("OpenCASCADE");
Rectangle(1) = {0, 0, 0, 2, 1};
MeshSize{:} = 0.1;
Periodic Curve {2} = {4} Translate {2, 0, 0};
Physical Curve("low") = {1};
Physical Curve("high") = {3};
Physical Curve("ends") = {2, 4};
Physical Surface("inside") = {1};
"""
BOX = """\
SetFactory("OpenCASCADE");
Box(1) = {0, 0, 0, 2, 1, 1};
MeshSize{:} = 0.2;
Periodic Surface {2} = {1} Translate {2, 0, 0};
Periodic Surface {4} = {3} Translate {0, 1, 0};
Physical Surface("low") = {5};
Physical Surface("high") = {6};
Physical Surface("ends") = {1, 2, 3, 4};
Physical Volume("inside") = {1};
"""
COARSE = PLANE.replace("Physical Surface", "Transfinite Curve {1, 3} = 3;\nTransfinite Curve {2, 4} = 9;\nTransfinite Surface {1};\nRecombine Surface {1};\nPhysical Surface")
# Two blocks, one on the other, of which the ends of the lower one repeat each other; TO is how long that is.
LOWER = """\
SetFactory("OpenCASCADE");
Rectangle(1) = {0, 0, 0, TO, 1};
Rectangle(2) = {0, 1, 0, 2, 1};
BooleanFragments{ Surface{1}; Delete; }{ Surface{2}; Delete; }
MeshSize{:} = 0.2;
left() = Curve In BoundingBox{-0.01, -0.01, -0.01, 0.01, 1.01, 0.01};
right() = Curve In BoundingBox{TO - 0.01, -0.01, -0.01, TO + 0.01, 1.01, 0.01};
Periodic Curve {right(0)} = {left(0)} Translate {TO, 0, 0};
Physical Curve("sides") = Curve{:};
Physical Surface("inside") = {1, 2};
"""
SHORT, HALF = LOWER.replace("TO", "1"), LOWER.replace("TO", "2")
# Plane Poiseuille flow between low and high, G = 10 Pa/m, mu = 1 Pa s: 1.25 m/s in the middle, 20 N on the walls.
FLOW = """\
mesh: {{file: {mesh}}}
gravity: [0, 0, 0]
time: {{end: 4, step: 0.2}}
fluid: {{density: 1, viscosity: 1, velocity_tolerance: 1.0e-9, drive: {{direction: x, pressure_gradient: "10"}}}}
boundary:
  low: {{type: no_slip}}
  high: {{type: no_slip}}
output: {{directory: flow, interval: 4}}
probe: {{end: {{point: [1.99, 0.5, {z}]}}}}
"""
# One comes around alone; one runs against another over the end, which runs on and comes around to it; one bounces between the walls.
GRAINS = """\
mesh: {mesh}
gravity: [0, 0, 0]
time: {{end: 4, step: 0.1}}
fluid: {{type: none}}
material: {{bead: {{density: 1000, young_modulus: 1.0e6, restitution: 1, friction: 0}}}}
boundary: {walls}
insertion: {{all: {{type: file, file: start.csv}}}}
output: {{directory: grains, interval: 4}}
"""
START = """\
x,y,z,vx,vy,vz,diameter,material
0.1,0.5,0.5,1,0,0,0.1,bead
0.05,0.25,0.3,-0.5,0,0,0.1,bead
1.95,0.25,0.3,0,0,0,0.1,bead
1.0,0.9,0.7,0.3,0.7,0.2,0.1,bead
"""
wrong = []


def expect(true, text):
    if not true:
        wrong.append(text)


def mesh(name, geometry, dimension, version="41", binary=False):
    with open("mesh.geo", "w") as file:
        file.write(geometry)
    subprocess.run(["gmsh", "-v", "1", f"-{dimension}", "-format", f"msh{version}", *(["-bin"] if binary else []), "-o", name, "mesh.geo"], check=True, stdin=subprocess.DEVNULL)


def run(text, ranks):
    with open("case.yaml", "w") as file:
        file.write(text)
    command = (["mpiexec", "-n", str(ranks)] if ranks > 1 else []) + [SILT, "case.yaml"]
    return subprocess.run(command, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)


def last(path):
    with open(path) as file:
        return list(csv.DictReader(file))[-1]


def grains(mesh_text, walls, ranks):
    done = run(GRAINS.format(mesh=mesh_text, walls=walls), ranks)
    expect(done.returncode == 0, f"grains in {mesh_text} on {ranks} ranks: {done.stdout[-300:]}")
    names = [name for name in os.listdir("grains/particles") if name[0] == "0"]
    with h5py.File("grains/particles/" + max(names)) as file:
        order = file["id"][:].ravel().argsort()
        return np.hstack([file["position"][:][order], file["velocity"][:][order]])


with tempfile.TemporaryDirectory() as folder:
    os.chdir(folder)
    with open("start.csv", "w") as file:
        file.write(START)
    for geometry, dimension, walls in ((PLANE, 2, 2), (BOX, 3, 2)):
        for version, binary in (("22", False), ("22", True), ("41", False), ("41", True)):
            mesh("mesh.msh", geometry, dimension, version, binary)
            for ranks in (1, 3) if (version, binary) == ("41", False) else (1,):
                about = f"{dimension}D, format {version}, binary {binary}, {ranks} ranks"
                done = run(FLOW.format(mesh="mesh.msh", z="0" if dimension == 2 else "0.5"), ranks)
                expect(done.returncode == 0, f"{about}: {done.stdout[-300:]}")
                if done.returncode == 0:
                    rows = last("flow/boundaries.csv")
                    friction, middle = float(rows["low.force_x"]) + float(rows["high.force_x"]), float(last("flow/probe_end.csv")["velocity_x"])
                    expect(abs(friction - 20) < (1e-5 if dimension == 2 else 1e-3), f"{about}: the walls take {friction} N of 20")
                    expect(abs(middle - 1.25) < (0.015 if dimension == 2 else 0.04), f"{about}: {middle} m/s of 1.25 in the middle")
    # The grains in the mesh of tetrahedra move as in a periodic box of hexahedra.
    box = grains("{type: box, lower: [0, 0, 0], upper: [2, 1, 1], cells: [6, 4, 4], periodic: [1, 1, 0]}", "{z_min: {particles: wall, material: bead}, z_max: {particles: wall, material: bead}}", 1)
    for ranks in (1, 2, 3):
        away = np.abs(grains("{file: mesh.msh}", "{low: {particles: wall, material: bead}, high: {particles: wall, material: bead}}", ranks) - box).max()
        expect(away < 1e-9, f"grains on {ranks} ranks are {away} away from those in a periodic box")
    for geometry, name, text in ((COARSE, "two cells between the ends", "is periodic along x, where it needs at least 3 cells"),
                                 (SHORT, "ends within the mesh", "must be the whole opposite ends of the mesh"), (HALF, "half of the ends", "must be the whole opposite ends of the mesh")):
        mesh("mesh.msh", geometry, 2)
        for ranks in (1, 2):
            done = run(FLOW.format(mesh="mesh.msh", z=0), ranks)
            expect(done.returncode == 2 and text in done.stdout, f"{name} on {ranks} ranks: {done.returncode}, {done.stdout[-300:]}")
    mesh("mesh.msh", PLANE, 2, "22")
    with open("mesh.msh") as file:
        good = file.read().split("$Periodic\n")
    for broken, text in ((good[1].replace("\n2 1\n", "\n2 999\n", 1), "a periodic node 999, which is not there"), (good[1].replace("\n2 1\n", "\n2 1\n1 2\n", 1), "repeats itself"),
                         (good[1].replace("1\n", "7\n", 1), ""), (good[1][:40], "")):
        with open("mesh.msh", "w") as file:
            file.write(good[0] + "$Periodic\n" + broken)
        done = run(FLOW.format(mesh="mesh.msh", z=0), 1)
        expect(done.returncode == 2 and "is not a Gmsh mesh that can be read" in done.stdout and text in done.stdout, f"broken {text}: {done.returncode}, {done.stdout[-300:]}")
for text in wrong:
    print(text)
sys.exit(bool(wrong))
