#!/usr/bin/python3
"""Draws the velocity of channels over the distance from the wall, in wall units, beside the law of the wall:
plot_wall_law.py out.png Re_tau:line_all.csv[:label] ...  Lines as the inputs channel_*.yaml write them (lengths in the
half height, speeds in the friction speed)."""
import csv
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np


def last_profile(file):
    rows = list(csv.DictReader(open(file)))
    last = [r for r in rows if r["time"] == rows[-1]["time"]]
    return np.array([[float(r["wall_distance"]), float(r["velocity_x"])] for r in last])


def main():
    figure, axes = plt.subplots(figsize=(6.4, 4.2), dpi=110)
    y = np.logspace(-0.3, 0.9, 50)
    axes.semilogx(y, y, "k:", lw=1, label="u+ = y+")
    y = np.logspace(1.3, 3.3, 50)
    axes.semilogx(y, np.log(y) / 0.41 + 5.2, "k--", lw=1, label="u+ = ln(y+)/0.41 + 5.2")
    for k, argument in enumerate(sys.argv[2:]):
        Re, file, *label = argument.split(":")
        profile = last_profile(file)
        profile = profile[profile[:, 0] > 0]
        style = "o-" if len(profile) < 50 else "-"
        axes.semilogx(float(Re) * profile[:, 0], profile[:, 1], style, ms=4, color=f"C{k}", label=label[0] if label else file)
    axes.set(xlabel="y+", ylabel="u+", xlim=(0.7, 2500), ylim=(0, 28))
    axes.legend(frameon=False)
    axes.grid(alpha=0.25)
    figure.tight_layout()
    figure.savefig(sys.argv[1])


if __name__ == "__main__":
    main()
