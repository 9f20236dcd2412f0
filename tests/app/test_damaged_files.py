#!/usr/bin/env python3
"""Files that were damaged anywhere - meshes, surfaces, particles, checkpoints, fields, options - are taken where they still
make sense, or refused with one line and exit code 2; never a crash, a hang or a heap of messages.

usage: test_damaged_files.py <silt> [damages of each file] [seed]"""
import os
import random
import re
import shutil
import subprocess
import sys
import tempfile

import h5py
import numpy as np

GEOMETRY = """\
SetFactory("OpenCASCADE");
Box(1) = {0, 0, 0, 0.02, 0.02, 0.02};
MeshSize{:} = 0.0066;
Periodic Surface {2} = {1} Translate {0.02, 0, 0};
Physical Surface("floor") = {5};
Physical Surface("lid") = {6};
Physical Surface("sides") = {1, 2, 3, 4};
Physical Volume("inside") = {1};
"""
FLOW = """\
gravity: [0, 0, -9.81]
time: {end: 2.0e-3, step: 1.0e-3}
fluid: {density: 1.2, viscosity: 1.8e-5, initial_velocity: "0, 0, 0.1"}
output: {directory: out}
progress: {quiet: yes}
"""
MESH = FLOW + """\
mesh: {file: box.msh}
boundary: {floor: {type: velocity, velocity: "0, 0, 0.1"}, lid: {type: pressure}, sides: {type: slip}}
"""
BOX = FLOW + """\
mesh: {type: box, lower: [0, 0, 0], upper: [0.02, 0.02, 0.02], cells: [2, 2, 2]}
boundary: {z_min: {type: velocity, velocity: "0, 0, 0.1"}, z_max: {type: pressure}, x_min: {type: slip}, x_max: {type: slip}, y_min: {type: slip}, y_max: {type: slip}}
"""
GRAINS = """\
mesh: {type: box, lower: [0, 0, 0], upper: [0.02, 0.02, 0.02], cells: [2, 2, 2]}
gravity: [0, 0, -9.81]
time: {end: 2.0e-3, step: 1.0e-3}
fluid: {type: none}
material: {bead: {density: 2500, young_modulus: 1.0e6, friction: 0.3}}
output: {directory: out}
progress: {quiet: yes}
checkpoint: {interval: 1.0e-3}
"""
FILL = GRAINS + "insertion: {bed: {type: fill, material: bead, diameter: 2.0e-3, count: 40, lower: [0, 0, 0], upper: [0.02, 0.02, 0.01]}}\n"
STL = FILL + "wall: {tile: {type: stl, file: tile.stl, side: both, offset: [0.005, 0.005, 0.012]}}\n"
LISTED = GRAINS + "insertion: {all: {type: file, file: start.FORMAT}}\n"
NASTY = ["nan", "inf", "-1", "0", "1e308", "-1e308", "99999999999999999999", "4294967297", "2147483647", "1e-320", "abc", "", "\0"]


class Folder:
    def __init__(self, silt, path):
        self.silt, self.path = silt, path

    def write(self, name, text):
        with open(os.path.join(self.path, name), "wb") as file:
            file.write(text.encode() if isinstance(text, str) else text)

    def read(self, name):
        with open(os.path.join(self.path, name), "rb") as file:
            return file.read()

    def run(self, *words):
        try:
            done = subprocess.run([self.silt, *words], cwd=self.path, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE, timeout=60)
        except subprocess.TimeoutExpired:
            return None, "", "does not end"
        return done.returncode, done.stdout.decode(errors="replace"), done.stderr.decode(errors="replace")


def facets():
    """Triangles of a closed box of 10 x 10 x 2 mm."""
    corner = [(x, y, z) for x in (0, 0.01) for y in (0, 0.01) for z in (0, 0.002)]
    sides = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    return [[corner[k] for k in t] for a, b, c, d in sides for t in ((a, b, c), (a, c, d))]


def stl_text():
    body = "".join("facet normal 0 0 0\n outer loop\n" + "".join(f"  vertex {x} {y} {z}\n" for x, y, z in t) + " endloop\nendfacet\n" for t in facets())
    return "solid tile\n" + body + "endsolid tile\n"


def stl_binary():
    rows = np.zeros(12, dtype=[("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("more", "<u2")])
    rows["corners"] = facets()
    return b"tile".ljust(80) + np.uint32(12).tobytes() + rows.tobytes()


def damage_text(text, chance):
    """Text with one word, line or byte changed, or cut off."""
    kind = chance.randrange(6)
    lines = text.split("\n")
    at = chance.randrange(len(lines))
    if kind == 0:
        return "\n".join(lines[:at] + lines[at + 1:])
    if kind == 1:
        return "\n".join(lines[:at + 1] + lines[at:])
    if kind == 2:
        return text[:chance.randrange(len(text))]
    if kind == 3:
        where = chance.randrange(len(text))
        return text[:where] + chr(chance.randrange(1, 127)) + text[where + 1:]
    words = list(re.finditer(r"[^\s,;:{}\[\]]+", text))
    word = chance.choice(words)
    return text[:word.start()] + chance.choice(NASTY) + text[word.end():]


def damage_bytes(blob, chance):
    """Bytes of which a few are changed, or that are cut off."""
    blob = bytearray(blob)
    kind = chance.randrange(4)
    if kind == 0:
        return bytes(blob[:chance.randrange(len(blob))])
    at = chance.randrange(len(blob))
    width = chance.choice((1, 4, 8))
    fill = chance.choice((b"\xff", b"\0", b"\x7f", bytes([chance.randrange(256)])))
    blob[at:at + width] = fill * min(width, len(blob) - at)
    return bytes(blob)


def damage_numbers(folder, name, chance):
    """An HDF5 file with one number of one array changed, or an array left out or cut."""
    with h5py.File(os.path.join(folder.path, name), "r+") as file:
        arrays = []
        file.visititems(lambda path, item: arrays.append(path) if isinstance(item, h5py.Dataset) else None)
        path = chance.choice(sorted(arrays))
        values = file[path][...]
        kind = chance.randrange(4)
        if kind == 0:
            del file[path]
        elif kind == 1 and values.shape and len(values) > 1:
            del file[path]
            file[path] = values[:-1]
        elif values.size and np.issubdtype(values.dtype, np.number):
            flat = values.reshape(-1)
            bad = [np.nan, np.inf, -1, 0, 1e300] if np.issubdtype(values.dtype, np.floating) else [-1, 0, 2**31 - 1, -(2**31)]
            flat[chance.randrange(flat.size)] = chance.choice(bad)
            file[path][...] = flat.reshape(values.shape)


def fault(answer):
    """What is wrong with the answer to a damaged file, or None."""
    code, out, errors = answer
    lines = errors.strip().splitlines()
    if code is None:
        return errors
    if code == 0:
        return None if not lines else "exit code 0 with errors"
    said = [line for line in lines if line.startswith("silt: error: ")]
    if code not in (1, 2):
        return f"exit code {code}"
    return None if len(said) == 1 and len(lines) == 1 else f"{len(lines)} lines"


def main():
    silt = os.path.abspath(sys.argv[1])
    count = int(sys.argv[2]) if len(sys.argv) > 2 else 6
    chance = random.Random(int(sys.argv[3]) if len(sys.argv) > 3 else 1)
    faults, tried, refused = [], 0, 0
    with tempfile.TemporaryDirectory(prefix="silt_damaged_") as path:
        folder = Folder(silt, path)
        folder.write("box.geo", GEOMETRY)
        for version in ("msh22", "msh41"):
            for binary in ("", "b"):
                subprocess.run(["gmsh", "-v", "1", "-3", "-format", version, *(["-bin"] if binary else []), "-o", f"{version}{binary}.msh", "box.geo"], cwd=path, check=True, stdin=subprocess.DEVNULL)
        folder.write("tile.txt", stl_text())
        folder.write("tile.bin", stl_binary())
        folder.write("start.csv", "x,y,z,diameter,material,vx,vy,vz\n" + "".join(f"{0.002 + 0.004 * (k % 4)},{0.002 + 0.004 * (k // 4)},0.005,0.002,bead,0,0,0.1\n" for k in range(16)))
        for name, text in (("mesh", MESH), ("stl", STL), ("flow", BOX), ("fill", FILL), ("csv", LISTED.replace("FORMAT", "csv")), ("h5", LISTED.replace("FORMAT", "h5"))):
            folder.write(f"{name}.yaml", text)
        # Whole files are taken, and what a run wrote is there to be damaged.
        code, _, errors = folder.run("fill.yaml", "-output_directory", "grains")
        assert code == 0, errors
        code, _, errors = folder.run("flow.yaml", "-output_directory", "flow", "-checkpoint_interval", "1e-3")
        assert code == 0, errors
        shutil.copy(os.path.join(path, "grains", "particles", "000000.h5"), os.path.join(path, "start.h5"))
        shutil.copy(os.path.join(path, "grains", "checkpoint.h5"), os.path.join(path, "grains.h5"))
        shutil.copy(os.path.join(path, "flow", "checkpoint.h5"), os.path.join(path, "flow.h5"))
        text, raw, numbers = damage_text, damage_bytes, None
        subjects = [
            ("msh22.msh", "box.msh", text, ["mesh.yaml"]), ("msh41.msh", "box.msh", text, ["mesh.yaml"]),
            ("msh22b.msh", "box.msh", raw, ["mesh.yaml"]), ("msh41b.msh", "box.msh", raw, ["mesh.yaml"]),
            ("tile.txt", "tile.stl", text, ["stl.yaml"]), ("tile.bin", "tile.stl", raw, ["stl.yaml"]),
            ("start.csv", "start.csv", text, ["csv.yaml"]), ("start.h5", "start.h5", raw, ["h5.yaml"]), ("start.h5", "start.h5", numbers, ["h5.yaml"]),
            ("grains.h5", "damaged.h5", raw, ["fill.yaml", "-restart", "damaged.h5", "-time_end", "0.003"]),
            ("flow.h5", "damaged.h5", numbers, ["flow.yaml", "-restart", "damaged.h5", "-time_end", "0.003"]),
            ("fill.yaml", "case.yaml", text, ["case.yaml"]), ("flow.yaml", "case.yaml", text, ["case.yaml"]), ("mesh.yaml", "case.yaml", text, ["case.yaml"])]
        originals = {source: folder.read(source) for source, *_ in subjects}
        for source, name, damage, words in subjects:
            folder.write("box.msh", originals["msh22.msh"])
            folder.write(name, originals[source])
            code, out, errors = folder.run(*words)
            if code != 0:
                faults.append(f"the whole {source} is refused: {errors or out[-300:]}")
                continue
            for _ in range(count):
                folder.write(name, originals[source])
                if damage is numbers:
                    damage_numbers(folder, name, chance)
                elif damage is text:
                    folder.write(name, damage(originals[source].decode(), chance))
                else:
                    folder.write(name, damage(originals[source], chance))
                answer = folder.run(*words)
                tried += 1
                refused += answer[0] != 0
                if wrong := fault(answer):
                    keep = os.environ.get("SILT_KEEP_DAMAGED")
                    if keep:
                        shutil.copy(os.path.join(path, name), os.path.join(keep, f"{tried}_{name}"))
                    shown = "\n    ".join(answer[2].strip().splitlines()[:6])
                    faults.append(f"{source}, damage {tried}: {wrong}\n    {shown}")
    print("\n".join(faults))
    print(f"{tried} damaged files, {refused} refused, {len(faults)} answered wrongly")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
