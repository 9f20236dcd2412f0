#!/usr/bin/python3
"""Draws docs/models/*.png: the laws and fields by `silt -law_table_motion`, the others and the scenes by runs; started by scripts/model_pictures."""
import glob
import os
import subprocess
import sys
import tempfile

import h5py
import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

import flow_law_pictures
import history_pictures

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
OUT = os.path.join(ROOT, "docs", "models")
plt.rcParams.update({"font.size": 8, "axes.grid": True, "grid.alpha": 0.3, "lines.linewidth": 1.2})

BEAD = {"material_bead_density": 2500, "material_bead_young_modulus": 1e7, "material_bead_restitution": 0.6, "material_bead_friction": 0.5,
        "law_table_radius": 1e-3, "law_table_depth": 2e-5, "law_table_speed": 0.1, "law_table_rows": 300}
SMALL = {"law_table_radius": 50e-9, "law_table_depth": 1e-10, "law_table_speed": 1e-6, "material_bead_young_modulus": 1e7}
# Panels of a slot: title, motion, options, and the range of the first axis if not all of it.
LAWS = {
    "normal": [
        ("tsuji", "normal", {"normal_type": "tsuji"}, None),
        ("linear", "normal", {"normal_type": "linear", "normal_stiffness": 2e3}, None),
        ("lee_herrmann", "normal", {"normal_type": "lee_herrmann", "normal_damping": 0.05}, None),
        ("kuwabara_kono", "normal", {"normal_type": "kuwabara_kono", "normal_relaxation_time": 4e-5}, None),
        ("walton_braun", "normal", {"normal_type": "walton_braun", "normal_stiffness": 2e3}, None),
        ("thornton", "normal", {"normal_type": "thornton", "material_bead_yield_pressure": 3e5}, None),
        ("lennard_jones", "normal", {"normal_type": "lennard_jones", "normal_energy": 1e-6, "law_table_depth": 1e-4}, None),
        ("langston", "normal", {"normal_type": "langston", "normal_gravity": 1e3, "normal_damping_ratio": 0.2}, None),
    ],
    "tangential": [
        (name, "tangential", {"normal_type": "linear", "normal_stiffness": 2e3, "tangential_type": name, "law_table_amplitude": 4e-5, "law_table_speed": 0.02, **more}, None)
        for name, more in (("mindlin", {"normal_type": "tsuji"}), ("spring_dashpot", {"tangential_stiffness": 1e3, "tangential_damping": 0.03}),
                           ("spring", {"tangential_stiffness": 1e3}), ("viscous", {"tangential_damping": 0.1}), ("walton_braun", {}))
    ],
    "rolling": [
        (name, "rolling", {"rolling_type": name, "material_bead_rolling_friction": 0.1, "law_table_amplitude": 2e-4, **more}, None)
        for name, more in (("constant", {}), ("spring", {"rolling_stiffness": 2e-2, "rolling_critical_angle": 0.1}),
                           ("viscous_coulomb", {"rolling_damping": 5e-8}), ("epsd", {}))
    ],
    "twisting": [("twisting", "twisting", {"twisting_type": "twisting", "law_table_amplitude": 2e-4}, None)],
    "adhesion": [
        (name, "normal", {"adhesion_type": name, "material_bead_surface_energy": 0.02, "material_bead_restitution": 1, "law_table_depth": 2e-6,
                          "law_table_radius": 2e-4, "law_table_gap": 1.5e-6}, None) for name in ("jkr", "dmt", "auto")
    ],
    "dlvo": [
        ("vdw", "normal", {**SMALL, "dlvo_type": "vdw", "material_bead_hamaker": 1e-20}, (-1e-10, 1e-8)),
        ("electrostatic", "normal", {**SMALL, "dlvo_type": "electrostatic", "material_bead_surface_potential": 0.03, "dlvo_ionic_strength": 1}, (-1e-10, 4e-8)),
        ("full", "normal", {**SMALL, "dlvo_type": "full", "material_bead_hamaker": 1e-20, "material_bead_surface_potential": 0.03,
                            "dlvo_ionic_strength": 1}, (-1e-10, 4e-8)),
    ],
    "bridge": [
        ("capillary", "normal", {"bridge_type": "capillary", "bridge_surface_tension": 0.07, "bridge_liquid_content": 0.01, "law_table_depth": 2e-6,
                                 "law_table_speed": 0.02, "material_bead_restitution": 1}, (-2e-7, 2.2e-4)),
        ("capillary, Willett", "normal", {"bridge_type": "capillary", "bridge_surface_tension": 0.07, "bridge_liquid_content": 0.01, "law_table_depth": 2e-6,
                                          "bridge_force": "willett", "bridge_rupture": "willett", "law_table_speed": 0.02,
                                          "material_bead_restitution": 1}, (-2e-7, 2.2e-4)),
        ("capillary, viscous", "normal", {"bridge_type": "capillary", "bridge_surface_tension": 0.07, "bridge_liquid_content": 0.01, "law_table_depth": 2e-6,
                                          "bridge_viscosity": 1e-3, "bridge_roughness": 1e-5, "law_table_speed": 0.02,
                                          "material_bead_restitution": 1}, (-2e-7, 2.2e-4)),
    ],
    "interfacial": [
        (title, "normal", {"interfacial_type": "nicolson", "interfacial_surface_tension": 0.07, "interfacial_contact_angle": 120,
                           "interfacial_filling_angle": 100, "interfacial_cutoff": 2e-2, "law_table_depth": 1e-7, **more}, (1e-6, 1.9e-2))
        for title, more in (("nicolson", {"interfacial_density_difference": 1000}), ("small Bond number", {"interfacial_small_bond": "yes"}))
    ],
    "lubrication": [
        (title, "normal", {"lubrication_type": "squeeze", "lubrication_viscosity": 1e-3, "law_table_depth": 1e-7, "lubrication_shifted": shifted}, (2e-6, 3e-5))
        for title, shifted in (("squeeze", "yes"), ("squeeze, not shifted", "no"))
    ],
}


def table(silt, motion, options):
    words = [silt, "-law_table_motion", motion]
    given = {**BEAD, **options}
    if given.get("normal_type") in ("lee_herrmann", "kuwabara_kono", "langston", "lennard_jones", "thornton"):
        del given["material_bead_restitution"]  # these laws have their own damping
    for name, value in given.items():
        words += ["-" + name, str(value)]
    done = subprocess.run(words, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    if done.returncode:
        sys.exit(done.stderr + " ".join(words))
    return np.loadtxt(done.stdout.splitlines(), delimiter=",", skiprows=1)


MAGNET = {"material_bead_density": 2500, "law_table_radius": 1e-6, "law_table_gap": 4e-6, "law_table_rows": 60}
FIXED = {"magnetic_type": "fixed", "magnetic_magnetisation": 1e5, "magnetic_direction": "0, 0, 1"}
# Panels of a field: title, options, angle between the line of centres and the moment, and the columns drawn.
FIELDS = {
    "magnetic": [
        ("fixed, head to tail", FIXED, 0, ("radial",)),
        ("fixed, side by side", FIXED, 90, ("radial",)),
        ("fixed, oblique (45 degrees)", FIXED, 45, ("radial", "across")),
        ("saturated, oblique (60 degrees)", {"magnetic_type": "saturated", "magnetic_magnetisation": 1e5, "magnetic_field": "0, 0, 1e5"}, 60, ("radial", "across")),
        ("linear, head to tail", {"magnetic_type": "linear", "magnetic_susceptibility": 2, "magnetic_field": "0, 0, 1e5"}, 0, ("radial",)),
        ("linear, side by side", {"magnetic_type": "linear", "magnetic_susceptibility": 2, "magnetic_field": "0, 0, 1e5"}, 90, ("radial",)),
        ("langevin, head to tail", {"magnetic_type": "langevin", "magnetic_magnetisation": 2e5, "magnetic_susceptibility": 2, "magnetic_field": "0, 0, 1e5"}, 0, ("radial",)),
        ("permanent, oblique (45 degrees)", {**FIXED, "magnetic_type": "permanent"}, 45, ("torque",)),
    ],
    "electric": [
        ("coulomb, like charges", {"electric_type": "dc", "electric_charge": "1e-15", "electric_coulomb": "yes"}, 0, ("radial",)),
        ("coulomb, in water", {"electric_type": "dc", "electric_charge": "1e-15", "electric_coulomb": "yes", "electric_fluid_permittivity": 78.5}, 0, ("radial",)),
    ],
}
MU0 = 4e-7 * np.pi
EPS0 = 8.8541878128e-12


def closed_form(title, options, angle, distance):
    """Radial and transverse force and torque of the bare pair: dipoles that do not change each other, charges."""
    theta, radius = np.radians(angle), MAGNET["law_table_radius"]
    if "electric_type" in options:
        return {"radial": 1e-30 / (4 * np.pi * EPS0 * options.get("electric_fluid_permittivity", 1) * distance**2)}
    volume, x = 4 / 3 * np.pi * radius**3, 3 * 2 * 1e5 / 2e5
    moment = volume * {"linear": 2e5, "langevin": 2e5 * (1 / np.tanh(x) - 1 / x)}.get(options["magnetic_type"], 1e5)
    size = 3 * MU0 * moment**2 / (4 * np.pi * distance**4)
    return {"radial": size * (1 - 3 * np.cos(theta) ** 2), "across": -size * np.sin(2 * theta), "torque": 0.5 * size * distance * np.sin(2 * theta)}


def draw_fields(silt):
    for slot, panels in FIELDS.items():
        columns = min(4, len(panels))
        rows = -(-len(panels) // columns)
        figure, axes = plt.subplots(rows, columns, figsize=(2.3 * columns + 0.4, 1.9 * rows + 0.2), squeeze=False)
        for axis, (title, options, angle, drawn) in zip(axes.flat, panels):
            data = table(silt, "field", {**MAGNET, **options, "law_table_angle": angle})
            bare = closed_form(title, options, angle, data[:, 0])
            picked = [("radial", "across", "torque").index(name) + 1 for name in drawn]
            fx = scaled(axis.set_xlabel, data[:, 0], "distance", "m")
            fy = scaled(axis.set_ylabel, data[:, picked], "torque" if drawn == ("torque",) else "force", "N m" if drawn == ("torque",) else "N")
            for name, column, colour in zip(drawn, picked, ("C0", "C3")):
                axis.plot(fx * data[:, 0], fy * data[:, column], colour, label=name)
                axis.plot(fx * data[::6, 0], fy * bare[name][::6], "k.", markersize=3)
            axis.axhline(0, color="k", linewidth=0.5)
            axis.set_title(title, fontsize=8)
            axis.legend(fontsize=7)
        figure.tight_layout()
        figure.savefig(os.path.join(OUT, slot + ".png"), dpi=90)
        plt.close(figure)
        print("docs/models/" + slot + ".png", flush=True)


def scaled(axis, values, symbol, unit):
    """A label with a prefix that keeps the numbers between 1 and 1000, and the factor."""
    size = max(np.abs(values).max(), 1e-300)
    power = int(np.floor(np.log10(size) / 3)) * 3
    prefix = {0: "", -3: "m", -6: "u", -9: "n", -12: "p", -15: "f", 3: "k"}.get(power)
    if prefix is None:
        power, prefix = 0, ""
    axis(f"{symbol}, {prefix}{unit}")
    return 10.0**-power


def draw_laws(silt):
    for slot, panels in LAWS.items():
        columns = min(4, len(panels))
        rows = -(-len(panels) // columns)
        figure, axes = plt.subplots(rows, columns, figsize=(2.3 * columns + 0.4, 1.9 * rows + 0.2), squeeze=False)
        for axis in axes.flat[len(panels):]:
            axis.set_visible(False)
        for axis, (title, motion, options, window) in zip(axes.flat, panels):
            data = table(silt, motion, options)
            if motion == "normal":
                half = len(data) // 2
                legs = ((data[:half], "C0", "in"), (data[half:], "C3", "out"))
                names, units = ("gap h", "force"), ("m", "N")
            else:
                quarter = len(data) // 5
                legs = ((data[:quarter], "C0", "first"), (data[quarter:], "C3", "to and fro"))
                names = ("slip", "force") if motion == "tangential" else ("angle", "torque")
                units = ("m", "N") if motion == "tangential" else ("rad", "N m")
            inside = np.ones(len(data), bool) if window is None else (data[:, 0] >= window[0]) & (data[:, 0] <= window[1])
            seen = data[inside]
            fx, fy = scaled(axis.set_xlabel, seen[:, 0], names[0], units[0]), scaled(axis.set_ylabel, seen[:, 1], names[1], units[1])
            for leg, colour, label in legs:
                axis.plot(fx * leg[:, 0], fy * leg[:, 1], colour, label=label, linestyle="-" if colour == "C0" else "--")
            if window is not None:
                room = 0.08 * np.ptp(seen[:, 1])
                axis.set(xlim=(fx * window[0], fx * window[1]), ylim=(fy * (seen[:, 1].min() - room), fy * (seen[:, 1].max() + room)))
            axis.axhline(0, color="k", linewidth=0.5)
            axis.set_title(title, fontsize=9)
        axes[0, 0].legend(fontsize=7)
        figure.tight_layout()
        figure.savefig(os.path.join(OUT, slot + ".png"), dpi=90)
        plt.close(figure)
        print("docs/models/" + slot + ".png", flush=True)


class Scene:
    """A run of inputs/models/scene_<name>.yaml, with its series of positions and velocities sorted by id."""

    def __init__(self, silt, folder, name):
        target = os.path.join(folder, name)
        done = subprocess.run([silt, f"inputs/models/scene_{name}.yaml", "-output_directory", target, "-progress_quiet", "yes"], cwd=ROOT,
                              stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        if done.returncode:
            sys.exit(done.stdout)
        self.time, self.x, self.v = [], [], []
        for path in sorted(glob.glob(os.path.join(target, "particles", "*.h5"))):
            with h5py.File(path) as file:
                order = np.argsort(file["id"][...])
                self.x.append(file["position"][...][order])
                self.v.append(file["velocity"][...][order])
                self.radius = file["radius"][...][order]
        self.x, self.v = np.array(self.x), np.array(self.v)
        diagnostics = np.genfromtxt(os.path.join(target, "diagnostics.csv"), delimiter=",", names=True)
        self.end = diagnostics["time"][-1]
        self.time = np.linspace(0, self.end, len(self.x))


def save(figure, name):
    figure.tight_layout()
    figure.savefig(os.path.join(OUT, f"scene_{name}.png"), dpi=90)
    plt.close(figure)
    print(f"docs/models/scene_{name}.png", flush=True)


def discs(axis, x, radius, axes=(0, 2), scale=1e6, **style):
    for p, r in zip(x, radius):
        axis.add_patch(plt.Circle((scale * p[axes[0]], scale * p[axes[1]]), scale * r, **style))
    axis.set_aspect("equal")
    axis.grid(False)


def pairs(silt, folder, name, labels, window=None):
    scene = Scene(silt, folder, name)
    figure, axis = plt.subplots(figsize=(4.2, 2.6))
    for k, label in enumerate(labels):
        gap = np.linalg.norm(scene.x[:, 2 * k] - scene.x[:, 2 * k + 1], axis=1) - 2 * scene.radius[0]
        axis.plot(1e3 * scene.time, 1e6 * gap, label=label)
    axis.set(xlabel="time, ms", ylabel="gap, um")
    if window:
        axis.set(xlim=(0, window[0]), ylim=(-0.05 * window[1], window[1]))
    axis.legend()
    save(figure, name)


def draw_scenes(silt):
    with tempfile.TemporaryDirectory(prefix="silt_scenes_") as folder:
        pairs(silt, folder, "sticky", ("0.7 of the sticking speed", "1.5 of it"))
        pairs(silt, folder, "wet_pair", ("0.7 of the speed of rupture", "1.5 of it"), (20, 300))
        for name in ("high_field", "low_field"):
            scene = Scene(silt, folder, name)
            figure, axis = plt.subplots(figsize=(3.2, 3.1))
            for p in range(scene.x.shape[1]):
                axis.plot(1e6 * scene.x[:, p, 0], 1e6 * scene.x[:, p, 1], "0.5", linewidth=0.6)
            discs(axis, scene.x[0], scene.radius, (0, 1), facecolor="none", edgecolor="C0", linewidth=0.7)
            discs(axis, scene.x[-1], scene.radius, (0, 1), facecolor="C3", edgecolor="none", alpha=0.8)
            axis.set(xlabel="x, um", ylabel="y, um", xlim=(-105, 105), ylim=(-105, 105), title="start blue, end red; weak field in the middle")
            axis.title.set_fontsize(8)
            save(figure, name)
        scene = Scene(silt, folder, "thermophoresis")
        figure, axis = plt.subplots(figsize=(4.2, 2.6))
        drift, tau = 5.6876197e-5, 3.1210675e-4
        fine = np.linspace(0, scene.end, 200)
        axis.plot(1e3 * fine, -1e6 * drift * (1 - np.exp(-fine / tau)), "k", linewidth=0.8, label="closed form")
        axis.plot(1e3 * scene.time, 1e6 * scene.v[:, 0, 0], "C3.", markersize=3, label="Silt")
        axis.set(xlabel="time, ms", ylabel="speed, um/s")
        axis.legend()
        save(figure, "thermophoresis")
        figure, axes = plt.subplots(3, 1, figsize=(6, 3.6))
        start = None
        for axis, name, label in ((axes[1], "heap_spring", "spring, at the end"), (axes[2], "heap_viscous", "viscous, at the end")):
            scene = Scene(silt, folder, name)
            start = scene.x[0]
            discs(axis, scene.x[-1], scene.radius, (0, 2), 1e3, facecolor="peru", edgecolor="saddlebrown", linewidth=0.5)
            axis.set_ylabel(label.split(",")[0])
        discs(axes[0], start, scene.radius, (0, 2), 1e3, facecolor="peru", edgecolor="saddlebrown", linewidth=0.5)
        axes[0].set_ylabel("start")
        for axis in axes:
            axis.set(xlim=(-80, 80), ylim=(0, 15))
            axis.set_yticks([])
        axes[2].set_xlabel("x, mm")
        save(figure, "heap")
        scene = Scene(silt, folder, "chains")
        figure, axes = plt.subplots(1, 2, figsize=(5.4, 2.9))
        for axis, x, title in ((axes[0], scene.x[0], "start"), (axes[1], scene.x[-1], "end")):
            order = np.argsort(-x[:, 1])
            discs(axis, x[order], scene.radius[order], (0, 2), facecolor="steelblue", edgecolor="k", linewidth=0.4, alpha=0.8)
            axis.set(xlim=(0, 120), ylim=(0, 120), xlabel="x, um", ylabel="z, um (field)", title=title)
        save(figure, "chains")


def main():
    silt, wanted = os.path.abspath(sys.argv[1]), sys.argv[2:] or ["laws", "fields", "flows", "histories", "scenes"]
    os.makedirs(OUT, exist_ok=True)
    for word in wanted:
        {"laws": draw_laws, "fields": draw_fields, "flows": flow_law_pictures.draw, "histories": history_pictures.draw, "scenes": draw_scenes}[word](silt)


if __name__ == "__main__":
    main()
