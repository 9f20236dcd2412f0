#!/usr/bin/python3
"""Draws a picture of every case in inputs/fluid (or of those whose name contains a word) into docs/gallery/fluid.

usage: scripts/fluid_pictures.py [word] [--keep]    needs build/silt, numpy, h5py, matplotlib (Debian's Python)

Each case is run (--keep: only where it has no output yet); the picture shows its last output: the speed (the temperature where
there is one, the Mach number of a gas), in the plane or in the middle plane of a box. Families of cases that find an order of convergence
share one picture of their errors (FAMILIES). Also writes docs/gallery/fluid/README.md.
"""
import argparse
import glob
import os
import re
import subprocess
import sys

import h5py
import matplotlib
import numpy

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402
import matplotlib.tri as tri  # noqa: E402
from matplotlib.ticker import MaxNLocator  # noqa: E402

from verify import Case  # noqa: E402

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
FOLDER = os.path.join(ROOT, "docs", "gallery", "fluid")
# What of a mesh is worth seeing, where that is not all of it: heights, m.
HEIGHTS = {"flat_plate": (0, 0.05), "flat_plate_fine": (0, 0.05), "jet_k_epsilon": (0, 0.004), "round_jet": (0, 0.2)}
SINGULAR = ("flat_plate", "flat_plate_fine")  # corners without an end to the speed
# One picture of the errors for cases that differ in the cell or the model.
FAMILIES = {
    "orders_gas": ("manufactured_triangle_gas", "manufactured_quadrilateral_gas", "manufactured_tetrahedron_gas", "manufactured_hexahedron_gas"),
    "orders_turbulence": ("manufactured_triangle_k_epsilon", "manufactured_quadrilateral_k_epsilon", "manufactured_triangle_k_omega", "manufactured_quadrilateral_k_omega"),
    "orders_exact": ("isentropic_vortex_order", "sod_tube_order"),
}
THERMAL = ("natural_convection", "heated_couette", "heated_duct")


def triangles(cells):
    """Triangles of plane cells (XDMF order: around)."""
    if cells.shape[1] == 3:
        return cells
    return numpy.vstack([cells[:, [0, 1, 2]], cells[:, [0, 2, 3]]])


def middle_plane(points, cells, values):
    """Points (x, y) of the mesh near the middle plane in z, and their values, triangulated anew."""
    z = points[:, 2]
    levels = numpy.unique(numpy.round(z, 9))
    level = levels[len(levels) // 2]
    near = numpy.abs(z - level) < 1e-8 * max(1, abs(level)) + 1e-9
    return points[near, 0], points[near, 1], values[near]


def cut(points, cells, values):
    """The middle plane in z through tetrahedra of any shape: triangles (and halves of quadrilaterals), values on their corners."""
    level = 0.5 * (points[:, 2].min() + points[:, 2].max()) + 1e-6 * numpy.ptp(points[:, 2])  # past the nodes
    least = 1e-6 * numpy.ptp(points[:, 0]) * numpy.ptp(points[:, 1])  # slivers leave streaks
    x, y, found = [], [], []
    for cell in cells:
        below = [node for node in cell if points[node, 2] < level]
        above = [node for node in cell if points[node, 2] >= level]
        if not below or not above:
            continue
        edges = [(a, b) for a in below for b in above]
        if len(edges) == 4:  # around the quadrilateral
            edges = [edges[0], edges[1], edges[3], edges[2]]
        share = [(level - points[a, 2]) / (points[b, 2] - points[a, 2]) for a, b in edges]
        corner = [((1 - s) * points[a, :2] + s * points[b, :2], (1 - s) * values[a] + s * values[b]) for s, (a, b) in zip(share, edges)]
        for triangle in ([0, 1, 2], [0, 2, 3])[:len(corner) - 2]:
            (ax, ay), (bx, by), (cx, cy) = (corner[k][0] for k in triangle)
            if abs((bx - ax) * (cy - ay) - (by - ay) * (cx - ax)) < least:
                continue
            for k in triangle:
                x.append(corner[k][0][0]), y.append(corner[k][0][1]), found.append(corner[k][1])
    return tri.Triangulation(x, y, numpy.arange(len(x)).reshape(-1, 3)), numpy.array(found)


def picture(name, title, output):
    folder = os.path.join(output, "fluid")
    last = sorted(glob.glob(os.path.join(folder, "[0-9]*.h5")))[-1]
    with h5py.File(os.path.join(folder, "mesh.h5")) as mesh:
        points, cells = mesh["points"][:], mesh["cells"][:]
    with h5py.File(last) as fields:
        speed = numpy.linalg.norm(fields["velocity"][:], axis=1)
        label, values = "speed, m/s", speed
        if "mach" in fields:
            label, values = "Mach number", fields["mach"][:].ravel()
        elif name.startswith(THERMAL):
            label, values = "temperature, K", fields["temperature"][:].ravel()
        elif name == "wall_distance":
            label, values = "wall distance, m", fields["wall_distance"][:].ravel()
    if cells.shape[1] == 4 and numpy.ptp(points[:, 2]) > 0:
        mesh2, values = cut(points, cells, values)
    elif cells.shape[1] == 8:
        x, y, values = middle_plane(points, cells, values)
        mesh2 = tri.Triangulation(x, y)
    else:
        mesh2 = tri.Triangulation(points[:, 0], points[:, 1], triangles(cells))
    millimetres = numpy.ptp(mesh2.x) < 0.05
    width, height = numpy.ptp(mesh2.x), numpy.ptp(mesh2.y)
    size = (4.8, 3.0 if name in HEIGHTS else min(4.2, max(1.5, 4.0 * height / width + 0.8)))
    figure, axes = plt.subplots(figsize=size, dpi=80)
    lowest, highest = values.min(), numpy.percentile(values, 95 if name in SINGULAR else 99.9)
    if highest - lowest < 1e-3 * abs(highest):  # uniform: no colours for rounding errors
        lowest, highest = 0, 1.5 * highest
    if len(mesh2.triangles) * 3 == len(mesh2.x):  # cut: shading draws the tips of thin triangles too long
        drawn = axes.tricontourf(mesh2, values, levels=numpy.linspace(lowest, highest, 65), cmap="viridis", extend="max")
    else:
        drawn = axes.tripcolor(mesh2, values, shading="gouraud", cmap="viridis", vmin=lowest, vmax=highest)
    figure.colorbar(drawn, ax=axes, label=label, ticks=MaxNLocator(7))
    axes.set_aspect("equal" if max(width, height) < 12 * min(width, height) and height < 2 * width and name not in HEIGHTS else "auto")
    if name in HEIGHTS:
        axes.set_ylim(*HEIGHTS[name])
    for axis, label in ((axes.xaxis, "x"), (axes.yaxis, "y")):
        axis.set_major_locator(MaxNLocator(5))
        axis.set_major_formatter(lambda value, _: f"{1000 * value if millimetres else value:g}")
        axis.set_label_text(f"{label}, {'mm' if millimetres else 'm'}")
    figure.tight_layout()
    figure.savefig(os.path.join(FOLDER, name + ".png"))
    plt.close(figure)


def family_picture(family):
    """Errors of all levels of the family's cases over the cells along x, with a slope for comparison."""
    figure, axes = plt.subplots(figsize=(6.4, 3.6), dpi=80)
    colours = {}
    for marker, name in zip("o^sv", FAMILIES[family]):
        path = os.path.join(ROOT, "inputs", "fluid", name + ".yaml")
        errors = {}
        for level in re.findall(r"^# level:(.*)$", open(path).read(), re.M):
            output = os.path.join(ROOT, "output", "pictures", name)
            subprocess.run([os.path.join(ROOT, "build", "silt"), path, "-output_directory", output, *level.split()], cwd=ROOT, stdout=subprocess.DEVNULL, check=True)
            rows = open(os.path.join(output, "errors.csv")).read().split()
            cells = int(level.split()[level.split().index("-mesh_cells") + 1].split(",")[0])
            for column, value in list(zip(rows[0].split(","), rows[-1].split(",")))[1:]:
                errors.setdefault(column.removesuffix("_error"), []).append((cells, float(value)))
        for column, points in errors.items():
            colour = colours.setdefault(column, f"C{len(colours)}")
            axes.loglog(*zip(*points), marker=marker, color=colour, label=f"{name.removeprefix('manufactured_')}: {column}", markersize=4, linewidth=0.8)
    low, high = axes.get_xlim()
    top = axes.get_ylim()[1]
    for order, style in ((1, ":"), (2, "--")):
        axes.loglog([low, high], [top, top * (low / high) ** order], "k" + style, linewidth=0.7, label=f"order {order}")
    axes.set_xlabel("cells along x")
    axes.set_ylabel("error")
    axes.legend(fontsize=5.5, loc="center left", bbox_to_anchor=(1.0, 0.5))
    figure.tight_layout()
    figure.savefig(os.path.join(FOLDER, family + ".png"))
    plt.close(figure)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("word", nargs="?", default="")
    parser.add_argument("--keep", action="store_true")
    arguments = parser.parse_args()
    os.makedirs(FOLDER, exist_ok=True)
    cases = sorted(glob.glob(os.path.join(ROOT, "inputs", "fluid", "*.yaml")))
    failed = []
    for path in cases:
        name = os.path.splitext(os.path.basename(path))[0]
        if arguments.word not in name or any(name in members for members in FAMILIES.values()):
            continue
        output = os.path.join(ROOT, "output", "pictures", name)
        if not (arguments.keep and glob.glob(os.path.join(output, "fluid", "[0-9]*.h5"))):
            silt = os.path.join(ROOT, "build", "silt")
            Case(os.path.relpath(path, ROOT)).prepare(silt)
            subprocess.run([silt, path, "-output_directory", output], cwd=ROOT, stdout=subprocess.DEVNULL)
        try:
            picture(name, name, output)
        except (IndexError, OSError) as error:
            failed.append(f"{name}: {error}")
    shared = {name: family for family, members in FAMILIES.items() for name in members}
    for family, members in FAMILIES.items():
        if any(arguments.word in name for name in (family, *members)):
            family_picture(family)
    with open(os.path.join(FOLDER, "README.md"), "w") as page:
        page.write("# Cases of the carrier fluid\n\nMade by `scripts/fluid_pictures.py` from `inputs/fluid`; the figures they must give stand in [verification](../../verification.md).\n\n| case | question | picture |\n|---|---|---|\n")
        for path in cases:
            name = os.path.splitext(os.path.basename(path))[0]
            text = open(path).read()
            question = re.search(r"^# Question: ([^?]*\?)", text, re.M)
            image = shared.get(name, name)
            if os.path.exists(os.path.join(FOLDER, image + ".png")):
                page.write(f"| `{name}` | {re.sub(r'[ ]*[#][ ]', ' ', question.group(1).replace(chr(10), ' ')) if question else ''} | ![]({image}.png) |\n")
    print("\n".join(failed))
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
