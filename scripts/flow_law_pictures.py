"""Pictures of the laws between fluid and particles, of dielectrophoresis and of heat, for scripts/model_pictures.

Every point is a particle of a run: a row of particles at the nodes of a mesh meets a prescribed flow, temperature or field for one
short step, and what it gained is the force, torque or heat."""
import glob
import os
import subprocess
import sys
import tempfile

import h5py
import matplotlib.pyplot as plt
import numpy as np

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
OUT = os.path.join(ROOT, "docs", "models")
RHO, MU, D, DENSITY = 1000.0, 1e-3, 1e-3, 2500.0
MASS = DENSITY * np.pi / 6 * D**3
COUNT = 60
FLUID = {"type": "prescribed", "density": RHO, "viscosity": MU}
REYNOLDS = 10 ** np.linspace(-2, 4, COUNT)


def yaml(value):
    """A value of an options file in YAML's flow style."""
    if isinstance(value, dict):
        return "{" + ", ".join(f"{key}: {yaml(item)}" for key, item in value.items()) + "}"
    return f'"{value}"' if isinstance(value, str) and not value.replace("_", "").isalnum() else str(value)


class Row:
    """Runs a row of particles, one at each inner node of a mesh along x (0 to 1), for one step, and keeps what came of them."""

    def __init__(self, silt, step, options, rows, spheres=None):
        with tempfile.TemporaryDirectory(prefix="silt_laws_") as folder:
            columns = ["x", "y", "z", "radius"] + list(rows)
            radius = rows.get("radius", np.full(COUNT, D / 2)) if spheres is None else None
            if spheres is None:
                place = (np.arange(COUNT) + 1.0) / (COUNT + 1)
                spheres = np.column_stack([place, np.full(COUNT, 0.05), np.full(COUNT, 0.05), radius])
            names = [name for name in columns[4:] if name != "radius"]
            table = np.column_stack([spheres] + [rows[name] for name in names]) if names else spheres
            np.savetxt(os.path.join(folder, "row.csv"), table, "%.17g", ",", header=",".join(columns[:4] + names), comments="")
            case = {"mesh": {"cells": f"[{COUNT + 1}, 2, 2]", "lower": "[0, 0, 0]", "upper": "[1, 0.1, 0.1]"}, "gravity": "[0, 0, 0]",
                    "time": {"end": step, "step": step}, "fluid": FLUID, "coupling": {"filter_length": 0},
                    "material": {"bead": {"density": DENSITY, "young_modulus": 1e5}},
                    "insertion": {"row": {"type": "file", "file": os.path.join(folder, "row.csv"), "largest_overlap": 0.2}},
                    "drag": {"type": "none"}, "output": {"directory": os.path.join(folder, "out"), "interval": step}}
            case.update({key: value for key, value in options.items() if value is not None})
            if case["fluid"].get("type") == "none":
                del case["coupling"], case["drag"]
            path = os.path.join(folder, "case.yaml")
            with open(path, "w") as file:
                file.write("".join(f"{key}: {yaml(value)}\n" for key, value in case.items()).replace('"[', "[").replace(']"', "]"))
            done = subprocess.run([silt, path, "-progress_quiet", "yes"], stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                                  stderr=subprocess.STDOUT, text=True)
            if done.returncode:
                sys.exit(open(path).read() + done.stdout)
            with h5py.File(sorted(glob.glob(os.path.join(folder, "out", "particles", "*.h5")))[-1]) as file:
                order = np.argsort(file["id"][...])
                self.values = {name: file[name][...][order] for name in file if file[name].shape[:1] == order.shape}

    def __getitem__(self, name):
        return self.values[name]


def save(figure, name):
    figure.tight_layout()
    figure.savefig(os.path.join(OUT, name + ".png"), dpi=90)
    plt.close(figure)
    print(f"docs/models/{name}.png", flush=True)


def panels(count, columns=4):
    columns = min(columns, count)
    rows = -(-count // columns)
    size = (2.3 * columns + 0.4, 1.9 * rows + 0.2) if count > 1 else (3.6, 2.6)
    figure, axes = plt.subplots(rows, columns, figsize=size, squeeze=False)
    for axis in axes.flat[count:]:
        axis.set_visible(False)
    return figure, axes.flat


def velocity_of(expression):
    return f"{expression}, 0, 0"


SPEEDS = REYNOLDS * MU / (RHO * D)
# The velocity of the fluid at the nodes, exact there: 10^(-5 + 6 s), s = 0 at the first particle and 1 at the last.
STREAM = f"10^(-5 + 6*(x*{COUNT + 1} - 1)/{COUNT - 1})"


def draw_drag(silt):
    laws = ["gidaspow", "stokes_cunningham", "schiller_naumann", "haider_levenspiel", "di_felice", "wen_yu", "ergun", "beetstra", "koch_hill",
            "rong", "tang", "mazza"]
    figure, axes = panels(len(laws))
    step = 1e-4
    for axis, law in zip(axes, laws):
        lone = law in ("stokes_cunningham", "schiller_naumann", "haider_levenspiel")
        for value, colour in zip((0.6, 0.8, 1.0) if law == "haider_levenspiel" else (1.0,) if lone else (0.4, 0.7, 1.0), ("C3", "C1", "C0")):
            drag = {"type": law}
            fluid = {**FLUID, "velocity": velocity_of(STREAM)}
            if law == "haider_levenspiel":
                drag["sphericity"] = value
                label = f"sphericity {value}"
            else:
                fluid["void_fraction"] = value
                label = f"a = {value}"
            if law == "ergun" and value == 1.0:
                value, label = 0.9, "a = 0.9"
                fluid["void_fraction"] = value
            row = Row(silt, step, {"fluid": fluid, "drag": drag}, {})
            factor = -np.log1p(-row["velocity"][:, 0] / SPEEDS) * MASS / step / (3 * np.pi * MU * D)
            axis.loglog(REYNOLDS, factor, colour, label=label)
        axis.set_title(law, fontsize=9)
        axis.set(ylim=(0.5, 2e4), xticks=[1e-2, 1, 100, 1e4])
        if not lone or law == "haider_levenspiel":
            axis.legend(fontsize=6, loc="upper left")
    figure.supxlabel("Re = rho d |u-v|/mu", fontsize=8)
    figure.supylabel("drag over Stokes'", fontsize=8)
    save(figure, "drag")


def draw_lift_and_torque(silt):
    step, slip = 1e-5, SPEEDS
    figure, axes = panels(1)
    for rate, colour in ((10, "C0"), (100, "C1"), (1000, "C3")):
        row = Row(silt, step, {"fluid": {**FLUID, "velocity": f"{rate}*(y - 0.05), 0, 0"}, "saffman": {"type": "saffman_mei"}},
                  {"vx": -slip, "vy": 0 * slip, "vz": 0 * slip})
        scale = 1.615 * D**2 * np.sqrt(RHO * MU * rate) * slip
        axes[0].loglog(REYNOLDS, np.abs(row["velocity"][:, 1]) * MASS / step / scale, colour, label=f"|curl u| = {rate} 1/s")
    axes[0].set(xlabel="Re = rho d |u-v|/mu", ylabel="force over Saffman's", title="saffman_mei")
    axes[0].legend(fontsize=6)
    save(figure, "saffman")
    figure, axes = panels(1)
    spin = np.full(COUNT, 10.0)
    for law, colour in (("rubinow_keller", "C0"), ("lun_liu", "C3")):
        row = Row(silt, step, {"magnus": {"type": law}}, {"vx": slip, "vy": 0 * slip, "vz": 0 * slip, "wx": 0 * spin, "wy": 0 * spin, "wz": spin})
        axes[0].loglog(REYNOLDS, row["velocity"][:, 1] * MASS / step / (np.pi / 8 * D**3 * RHO * spin * slip), colour, label=law)
    axes[0].set(xlabel="Re = rho d |u-v|/mu", ylabel="force over (pi/8) d^3 rho |w| |u-v|", title="lift by spin")
    axes[0].legend(fontsize=6)
    save(figure, "magnus")
    figure, axes = panels(1)
    spins, inertia = REYNOLDS * MU / (RHO * D**2), MASS * D**2 / 10
    for law, colour in (("stokes", "C0"), ("dennis", "C3")):
        row = Row(silt, step, {"viscous_torque": {"type": law}},
                  {"vx": 0 * spins, "vy": 0 * spins, "vz": 0 * spins, "wx": 0 * spins, "wy": 0 * spins, "wz": spins})
        axes[0].loglog(REYNOLDS, -np.log(row["spin"][:, 2] / spins) * inertia / step / (np.pi * MU * D**3), colour, label=law)
    axes[0].set(xlabel="Re_R = rho d^2 |w|/mu", ylabel="torque over pi mu d^3 |w|", title="viscous torque")
    axes[0].legend(fontsize=6)
    save(figure, "viscous_torque")


def draw_thermophoresis(silt):
    free, rho, mu, gradient, middle = 6.7e-8, 1.2, 1.81e-5, 100.0, 300.0
    knudsen = 10 ** np.linspace(-2.5, 2, COUNT)
    diameter, step = free / knudsen, 1e-9
    figure, axes = panels(1)
    gas = {"type": "prescribed", "density": rho, "viscosity": mu, "temperature": f"{middle} + {gradient}*(y - 0.05)", "heat_capacity": 1000,
           "conductivity": 0.026}
    for law, colour in (("waldmann", "C0"), ("talbot", "C3"), ("general", "C2")):
        options = {"type": law, "mean_free_path": free, "conductivity_ratio": 0.026}
        if law == "general":  # a user's function: Waldmann's limit, less with 1 + 1/(4 Kn)
            options["h"] = "64/(15*sqrt(pi))/(1 + 0.25/x)"
        row = Row(silt, step, {"fluid": gas, "thermophoresis": options}, {"radius": diameter / 2})
        force = -row["velocity"][:, 1] * DENSITY * np.pi / 6 * diameter**3 / step
        axes[0].loglog(knudsen, force / (mu**2 * diameter * gradient / (rho * middle)), colour, label=law + (", a function" if law == "general" else ""))
    axes[0].set(xlabel="Kn = lambda/d", ylabel="-F rho T/(mu^2 d grad T)", title="thermophoresis, k = 0.026")
    axes[0].legend(fontsize=6)
    save(figure, "thermophoresis")


def draw_heat(silt):
    heat, conductivity, warm, cold = 1000.0, 0.6, 310.0, 300.0
    step, laws = 1e-3, ("ranz_marshall", "gunn", "whitaker")
    fluid = {**FLUID, "velocity": velocity_of(STREAM), "temperature": str(cold), "heat_capacity": 4180, "conductivity": conductivity}
    bead = {"bead": {"density": DENSITY, "heat_capacity": heat, "conductivity": 1.0, "young_modulus": 1e5}}
    figure, axes = panels(len(laws))
    for axis, law in zip(axes, laws):
        for value, colour in zip((0.5, 0.7, 1.0) if law == "gunn" else (1.0,), ("C3", "C1", "C0") if law == "gunn" else ("C0",)):
            row = Row(silt, step, {"fluid": {**fluid, "void_fraction": value}, "material": bead, "particles": {"fixed": "yes"}, "nusselt": {"type": law},
                                   "heat": {"particles": "yes", "initial_temperature": str(warm)}}, {})
            exchange = -np.log((row["temperature"] - cold) / (warm - cold)) * MASS * heat / step
            axis.loglog(REYNOLDS, exchange / (np.pi * D * conductivity), colour, label=f"a = {value}")
        axis.set(xlabel="Re = rho d |u-v|/mu", ylabel="Nu" if law == "ranz_marshall" else "", title=f"{law}, Pr = 7", ylim=(1.5, 500))
        if law == "gunn":
            axis.legend(fontsize=6)
    save(figure, "nusselt")
    figure, axes = panels(2)
    share = np.linspace(0.002, 0.1, COUNT // 2)
    for kind, colour in (("hertz", "C0"), ("lens", "C3")):
        lower = np.column_stack([(np.arange(COUNT // 2) + 1.0) / (COUNT + 1), np.full(COUNT // 2, 0.05), np.full(COUNT // 2, 0.05), np.full(COUNT // 2, D / 2)])
        upper = lower + np.column_stack([0 * share, 0 * share, D - share * D / 2, 0 * share])
        row = Row(silt, step, {"fluid": {"type": "none"}, "material": bead, "particles": {"fixed": "yes", "overlap_limit": 0.3},
                               "heat": {"particles": "yes", "conduction": "yes", "contact_radius": kind, "initial_temperature": "z < 0.0502 ? 300 : 310"}},
                  {}, np.vstack([lower, upper]))
        gain = (row["temperature"][: COUNT // 2] - 300) * MASS * heat / step
        axes[0].plot(share, 1e3 * gain / 10, colour, label=f"contact radius {kind}")
    axes[0].set(xlabel="overlap x/R", ylabel="conduction, mW/K", title="conduction, 1 W/(m K), 1 mm")
    axes[0].legend(fontsize=6)
    row = Row(silt, step, {"fluid": {"type": "none"}, "material": bead, "particles": {"fixed": "yes"},
                           "heat": {"particles": "yes", "emissivity": 0.8, "environment": "300", "initial_temperature": "300 + 1200*x"}}, {})
    start = 300 + 1200 * (np.arange(COUNT) + 1.0) / (COUNT + 1)
    axes[1].plot(start, 1e3 * (row["temperature"] - start) * MASS * heat / step, "C0")
    axes[1].set(xlabel="temperature, K", ylabel="radiation, mW", title="radiation to 300 K, 1 mm")
    save(figure, "heat")


def draw_polarisation(silt):
    """Two panels of the picture of electric laws: K of a constant field by the permittivities, and Re K, Im K by the frequency."""
    field, slope, step, eps0 = 1e5, 1e6, 1e-5, 8.8541878128e-12
    scale = np.pi / 2 * eps0 * D**3

    def factor(options, fluid_permittivity, strength):
        electric = {"field": f"{field} + {slope}*(x - 0.5), -{slope}*(y - 0.05), 0", "fluid_permittivity": fluid_permittivity, **options}
        sphere = np.array([[0.5, 0.05, 0.05, D / 2]])
        row = Row(silt, step, {"fluid": {"type": "none"}, "electric": electric}, {}, sphere)
        force = row["velocity"][0, 0] * MASS / step / (scale * fluid_permittivity * field * slope)
        return force / strength, row["spin"][0, 2] * MASS * D**2 / 10 / step / (scale * fluid_permittivity * field**2)

    figure, axes = panels(2, 2)
    ratios = 10 ** np.linspace(-2, 2, 17)
    axes[0].semilogx(ratios, [factor({"type": "dc", "particle_permittivity": ratio * 10}, 10, 1)[0] for ratio in ratios], "C0.-", markersize=3)
    axes[0].set(xlabel="permittivity, particle over fluid", ylabel="force over (pi/2) e_f d^3 E grad E", title="dc: K")
    frequencies = 10 ** np.linspace(3, 8, 21)
    both = np.array([factor({"type": "ac", "particle_permittivity": 2.5, "particle_conductivity": 0.01, "fluid_conductivity": 0.001,
                             "frequency": f"{frequency:g}", "rotation": "[0, 0, 1]"}, 78, 1) for frequency in frequencies])
    axes[1].semilogx(frequencies, both[:, 0], "C0.-", markersize=3, label="force: Re K")
    axes[1].semilogx(frequencies, both[:, 1], "C3.-", markersize=3, label="torque: -Im K")
    axes[1].set(xlabel="frequency, Hz", title="ac: K of 0.01 S/m in 0.001 S/m")
    axes[1].legend(fontsize=6)
    for axis in axes:
        axis.axhline(0, color="k", linewidth=0.5)
    save(figure, "polarisation")


def draw_brownian(silt):
    """Mean square displacement of 1000 spheres of 100 nm that start at rest, and of over-damped ones."""
    diameter, mu, warm = 1e-7, 0.89e-3, 298.15
    tau, diffusivity = DENSITY * diameter**2 / (18 * mu), 1.380649e-23 * warm / (3 * np.pi * mu * diameter)
    figure, axes = panels(1)
    for damped, colour, label in (("no", "C0", "inertial"), ("yes", "C3", "over-damped")):
        step, end = 0.25 * tau, 20 * tau
        with tempfile.TemporaryDirectory(prefix="silt_laws_") as folder:
            words = [silt, "inputs/models/brownian.yaml", "-time_end", repr(end), "-time_step", repr(step), "-output_interval", repr(step),
                     "-output_directory", folder, "-brownian_overdamped", damped, "-progress_quiet", "yes", "-expect_kinetic_energy_window", f"0, {end!r}",
                     "-expect_kinetic_energy_tolerance", "1e9"]
            if damped == "yes":
                words += ["-particles_step", repr(step), "-particles_step_override", "yes"]
            done = subprocess.run(words, cwd=ROOT, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
            if done.returncode:
                sys.exit(done.stdout)
            places = []
            for path in sorted(glob.glob(os.path.join(folder, "particles", "*.h5"))):
                with h5py.File(path) as file:
                    places.append(file["position"][...][np.argsort(file["id"][...])])
        moved = np.array(places) - places[0]
        side = 1e-5
        moved -= side * np.round(moved / side)
        spread = (moved**2).sum(axis=2).mean(axis=1)[1:]
        time = step * np.arange(1, len(places))
        axes[0].loglog(time / tau, spread / (6 * diffusivity * tau), colour + ".", markersize=3, label=label)
    fine = np.logspace(np.log10(0.25), np.log10(20), 100)
    axes[0].loglog(fine, fine, "C3", linewidth=0.7)
    axes[0].loglog(fine, fine - 2 * (1 - np.exp(-fine)) + 0.5 * (1 - np.exp(-2 * fine)), "C0", linewidth=0.7)
    axes[0].set(xlabel="t k/m", ylabel="<x^2> k/(6 D m)", title="Brownian motion; lines: closed forms")
    axes[0].legend(fontsize=6)
    save(figure, "brownian")


def draw_virtual_mass(silt):
    """Acceleration from rest in a fluid at rest, by the ratio of densities."""
    ratios = 10 ** np.linspace(-3, 1, 9)
    step, gained = 1e-6, {"0.5": [], "0": []}
    for share, values in gained.items():
        for ratio in ratios:
            row = Row(silt, step, {"gravity": "[0, 0, -9.81]", "virtual_mass": {"coefficient": share} if share != "0" else None,
                                   "material": {"bead": {"density": ratio * RHO, "young_modulus": 1e5}}}, {}, np.array([[0.5, 0.05, 0.05, D / 2]]))
            values.append(row["velocity"][0, 2] / step / 9.81)
    figure, axes = panels(1)
    fine = np.logspace(-3, 1, 100)
    axes[0].semilogx(ratios, gained["0.5"], "C0.", label="C = 0.5")
    axes[0].semilogx(fine, (1 - fine) / (fine + 0.5), "C0", linewidth=0.7)
    axes[0].semilogx(ratios, gained["0"], "C3.", label="without")
    axes[0].semilogx(fine, (1 - fine) / fine, "C3", linewidth=0.7)
    axes[0].set(xlabel="rho_p/rho", ylabel="acceleration from rest/g", title="virtual mass; lines: closed forms", ylim=(-1.2, 4))
    axes[0].legend(fontsize=6)
    save(figure, "virtual_mass")


def draw(silt):
    draw_drag(silt)
    draw_lift_and_torque(silt)
    draw_thermophoresis(silt)
    draw_heat(silt)
    draw_polarisation(silt)
    draw_brownian(silt)
    draw_virtual_mass(silt)
