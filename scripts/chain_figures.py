#!/usr/bin/python3
"""Chains and clusters of particles from the series of a run; started by scripts/chain_figures.

Two particles are bonded when their surfaces are nearer than `gap` diameters. Of every output:
  clusters of bonded particles; their mean number of particles, by clusters and by particles (the size of the cluster that a particle is in);
  the mean length of a chain: of the clusters of two or more, the extent along the field over the diameter, plus one;
  the order parameter: mean cos^2 of the angle between bond and field (1/2 at random in a plane, 1/3 in space, 1 for straight chains).
At the last output: how many clusters of each size, and the pair correlation along the field and across it (within 45 degrees of each),
relative to the same number of particles spread evenly."""
import csv
import glob
import os
import re
import sys

import h5py
import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np


def periods(folder):
    """Lower corner, lengths and which directions are periodic, from the record of the run."""
    text = open(os.path.join(folder, "run.yaml")).read()

    def vector(key):
        return np.array([float(v) for v in re.search(rf"^(?:# )?mesh_{key}: '([^']*)'", text, re.M)[1].split(",")])

    lower, upper = vector("lower"), vector("upper")
    return lower, upper - lower, vector("periodic") > 0


def nearest(distance, length, periodic):
    return distance - np.where(periodic, length * np.round(distance / length), 0)


def clusters_of(count, bonds):
    root = np.arange(count)

    def find(i):
        while root[i] != i:
            root[i] = root[root[i]]
            i = root[i]
        return i

    for i, j in bonds:
        a, b = find(i), find(j)
        root[max(a, b)] = min(a, b)
    return np.array([find(i) for i in range(count)])


def extent(members, place, bonded, axis):
    """Length along the axis of a cluster, followed from bond to bond (it may lie across a periodic side)."""
    at, waiting = {members[0]: 0.0}, [members[0]]
    while waiting:
        i = waiting.pop()
        for j, step in bonded[i]:
            if j not in at:
                at[j] = at[i] + step[axis]
                waiting.append(j)
    return max(at.values()) - min(at.values())


def figures(x, radius, box, axis, gap):
    _, length, periodic = box
    count = len(x)
    apart = nearest(x[None] - x[:, None], length, periodic)
    distance = np.linalg.norm(apart, axis=2)
    near = distance < (radius[None] + radius[:, None]) * (1 + gap)
    i, j = np.nonzero(np.triu(near, 1))
    cluster = clusters_of(count, zip(i, j))
    sizes = np.bincount(cluster, minlength=count)
    sizes = sizes[sizes > 0]
    bonded = [[] for _ in range(count)]
    for a, b in zip(i, j):
        bonded[a].append((b, apart[a, b]))
        bonded[b].append((a, apart[b, a]))
    lengths = [extent(members, x, bonded, axis) / (2 * radius.mean()) + 1
               for members in (np.nonzero(cluster == c)[0] for c in np.unique(cluster)) if len(members) > 1]
    cosines = (apart[i, j, axis] / distance[i, j]) ** 2
    return {"bonds": len(i), "clusters": len(sizes), "mean_cluster_size": sizes.mean(), "cluster_size_of_a_particle": (sizes**2).sum() / count,
            "mean_chain_length": np.mean(lengths) if lengths else 1.0, "longest_chain": max(lengths) if lengths else 1.0,
            "order": cosines.mean() if len(i) else np.nan}, sizes, apart, distance


def pair_correlation(apart, distance, radius, box, axis):
    """r/d, g within 45 degrees of the axis, g within 45 degrees of the plane across: in a slab as thin as a few particles, by annuli of its plane."""
    _, length, periodic = box
    flat = [d for d in range(3) if periodic[d]] if periodic.sum() == 2 else [0, 1, 2]
    count, d = len(distance), 2 * radius.mean()
    edges = np.arange(0, min(6 * d, 0.5 * length[flat].min()), 0.1 * d)
    r = np.linalg.norm(apart[..., flat], axis=2)
    along = np.abs(apart[..., axis]) > np.sqrt(0.5) * r
    off = ~np.eye(count, dtype=bool)
    rows = []
    for low, high in zip(edges[:-1], edges[1:]):
        ring = off & (r >= low) & (r < high)
        if len(flat) == 2:
            room, share = np.pi * (high**2 - low**2), (0.5, 0.5)
        else:
            room, share = 4 / 3 * np.pi * (high**3 - low**3), (1 - np.sqrt(0.5), np.sqrt(0.5))
        even = count * (count - 1) * room / length[flat].prod()
        rows.append((0.5 * (low + high) / d, (ring & along).sum() / (even * share[0]), (ring & ~along).sum() / (even * share[1])))
    return np.array(rows)


def write(path, header, rows):
    with open(path, "w", newline="") as file:
        out = csv.writer(file)
        out.writerow(header)
        out.writerows(rows)
    print(path)


def main():
    words, options, rest = sys.argv[1:], {"axis": "y", "gap": "0.15", "plane": "xy"}, []
    while words:
        word = words.pop(0)
        if word.startswith("-") and word[1:] in options and words:
            options[word[1:]] = words.pop(0)
        else:
            rest.append(word)
    if len(rest) not in (1, 2):
        sys.exit("chain_figures: give the directory of a run and at most one picture")
    folder, axis, gap = rest[0], "xyz".index(options["axis"]), float(options["gap"])
    picture = rest[1] if len(rest) > 1 else os.path.join(folder, "chains.png")
    box, table, series = periods(folder), [], []
    for path in sorted(glob.glob(os.path.join(folder, "particles", "*.h5"))):
        with h5py.File(path) as file:
            order = np.argsort(file["id"][...])
            series.append((float(file.attrs["time"]), file["position"][...][order], file["radius"][...][order]))
    for time, x, radius in series:
        row, sizes, apart, distance = figures(x, radius, box, axis, gap)
        table.append((time, row))
    names = list(table[0][1])
    write(os.path.join(folder, "chains.csv"), ["time", *names], [[f"{t:.6g}", *(f"{row[n]:.6g}" for n in names)] for t, row in table])
    count = np.bincount(sizes)
    write(os.path.join(folder, "clusters.csv"), ["size", "clusters"], [[s, c] for s, c in enumerate(count) if c])
    g = pair_correlation(apart, distance, radius, box, axis)
    write(os.path.join(folder, "pair_correlation.csv"), ["r_over_d", "along", "across"], [[f"{v:.6g}" for v in row] for row in g])

    d = 2 * radius.mean()
    first, second = ("xyz".index(c) for c in options["plane"])
    figure, axes = plt.subplots(2, 3, figsize=(9.6, 6.2))
    middle = len(series) // 2
    for panel, (time, x, r) in zip(axes[0], (series[0], series[middle], series[-1])):
        for p, size in zip(x, r):
            panel.add_patch(plt.Circle((1e6 * p[first], 1e6 * p[second]), 1e6 * size, facecolor="steelblue", edgecolor="k", linewidth=0.3))
        panel.set(xlim=1e6 * (box[0][first] + np.array([0, box[1][first]])), ylim=1e6 * (box[0][second] + np.array([0, box[1][second]])),
                  aspect="equal", xlabel="um", title=f"{1e6 * time:.3g} us")
    times = np.array([t for t, _ in table])
    axes[1][0].plot(1e6 * times, [row["mean_chain_length"] for _, row in table], label="chain length / d")
    axes[1][0].plot(1e6 * times, [row["cluster_size_of_a_particle"] for _, row in table], label="cluster of a particle")
    axes[1][0].set(xlabel="time, us", ylim=(0, None))
    axes[1][0].legend(fontsize=7)
    axes[1][1].plot(1e6 * times, [row["order"] for _, row in table])
    axes[1][1].axhline(0.5 if box[2].sum() == 2 else 1 / 3, color="k", linewidth=0.6)
    axes[1][1].set(xlabel="time, us", ylabel="order, mean cos$^2$", ylim=(0, 1))
    axes[1][2].plot(g[:, 0], g[:, 1], label="along the field")
    axes[1][2].plot(g[:, 0], g[:, 2], label="across")
    axes[1][2].set(xlabel="r/d", ylabel="pair correlation")
    axes[1][2].legend(fontsize=7)
    figure.tight_layout()
    figure.savefig(picture, dpi=70)
    print(picture)
    print("  ".join(f"{name} {table[-1][1][name]:.4g}" for name in names))


if __name__ == "__main__":
    main()
