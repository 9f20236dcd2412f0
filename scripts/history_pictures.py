"""Pictures of the laws that show in time rather than over a distance: a case of inputs/models beside its closed form, for
scripts/model_pictures."""
import csv
import os
import subprocess
import tempfile

import matplotlib.pyplot as plt
import numpy as np

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
OUT = os.path.join(ROOT, "docs", "models")


def history(silt, case, table="diagnostics.csv"):
    """{column: values} of a table of a run of the case."""
    with tempfile.TemporaryDirectory(prefix="silt_history_") as folder:
        subprocess.run([silt, os.path.join(ROOT, "inputs", "models", case + ".yaml"), "-output_directory", folder], stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, check=True)
        rows = list(csv.DictReader(open(os.path.join(folder, table))))
    return {name: np.array([float(row[name]) for row in rows]) for name in rows[0]}


def panel(axis, time, computed, exact, label, title):
    fine = np.linspace(0, time[-1], 200)
    axis.plot(fine, exact(fine), "k", linewidth=0.8, label="closed form")
    step = max(1, len(time) // 25)
    axis.plot(time[::step], computed[::step], "C3.", markersize=4, label="Silt")
    axis.set(xlabel="time, s", ylabel=label, title=title)
    axis.legend(fontsize=7)


def save(figure, name):
    figure.tight_layout()
    figure.savefig(os.path.join(OUT, name + ".png"), dpi=90)
    plt.close(figure)


def integrated(times, rates, start):
    """States at the times by the classical Runge-Kutta method, 20 steps between two of them."""
    states, y = [np.array(start)], np.array(start)
    for t, end in zip(times[:-1], times[1:]):
        h = (end - t) / 20
        for _ in range(20):
            a = rates(y)
            b = rates(y + h / 2 * a)
            c = rates(y + h / 2 * b)
            y = y + h / 6 * (a + 2 * b + 2 * c + rates(y + h * c))
        states.append(y)
    return np.array(states)


def wake_rates(y):
    """Of k, epsilon and the fluid's velocity, as the head of the case modulation_slip_production says."""
    k, epsilon, u = y
    D = 64 / (0.02**3 - 64 * np.pi / 6 * 1e-9) * 3 * np.pi * 1e-5 * 1e-3
    work = D * (0.5 - u) ** 2
    return np.array([-epsilon + work, -1.9 * epsilon**2 / (k + np.sqrt(1e-5 * epsilon)) + 1.2 * epsilon / k * work, D * (0.5 - u)])


def draw(silt):
    table = history(silt, "modulation_drag_dissipation", "probe_middle.csv")
    # k = k0 exp(-D t) (1 + 0.9 w0/b (1 - exp(-b t)))^(-1/0.9), b = 0.2 D: D from its number of particles and Stokes' drag
    D = 2 * 64 / (0.02**3 - 64 * np.pi / 6 * 1e-9) * 3 * np.pi * 1e-5 * 1e-3
    b = 0.2 * D
    k = lambda t, damping: 2 * np.exp(-damping * t) * (1 + (0.9 * 1.5 / b * (1 - np.exp(-b * t)) if damping else 0.9 * 1.5 * t)) ** (-1 / 0.9)
    figure, (axis, wakes) = plt.subplots(1, 2, figsize=(7.4, 2.7))
    panel(axis, table["time"], table["turbulent_energy"], lambda t: k(t, D), "k, m2/s2", "drag_dissipation")
    fine = np.linspace(0, 1, 100)
    axis.plot(fine, k(fine, 0), "k:", linewidth=0.8, label="without particles")
    axis.legend(fontsize=7)
    table = history(silt, "modulation_slip_production", "probe_middle.csv")
    panel(wakes, table["time"], table["turbulent_energy"], lambda t: integrated(t, wake_rates, (0.02, table["turbulent_dissipation"][0], 0.0))[:, 0], "k, m2/s2", "slip_production")
    save(figure, "modulation")

    table = history(silt, "dispersion")
    figure, axis = plt.subplots(figsize=(4.4, 2.7))
    panel(axis, table["time"], 1e6 * table["particle_kinetic_energy"], lambda t: np.full_like(t, 1.003473), "kinetic energy, 1e-6 J", "random_walk, 512 particles")
    save(figure, "dispersion")

    table = history(silt, "heat_source")
    figure, axis = plt.subplots(figsize=(4.4, 2.7))
    panel(axis, table["time"], table["mean_temperature_of_particles"], lambda t: 300 + 1e7 * t**2 / (2500 * 800), "temperature, K", "source: 2e7 W/(m3 s) t")
    save(figure, "heat_source")

    figure, axes = plt.subplots(1, 3, figsize=(8.4, 2.6))
    table = history(silt, "buoyancy")
    panel(axes[0], table["time"], table["particle_velocity_z"], lambda t: -9.81 * 0.6 * t, "speed, m/s", "buoyancy: g (1 - 1000/2500)")
    for axis, case, acceleration, title in ((axes[1], "pressure_gradient", 8.8, "pressure gradient"), (axes[2], "viscous_stress_solved", 0, "pressure and viscous stress")):
        table = history(silt, case)
        # A particle gets the pressure's impulse of a step in the next one: from the second step on.
        time, speed = table["time"][2:] - table["time"][2], table["particle_velocity_x"][2:] - table["particle_velocity_x"][2]
        panel(axis, time, speed, lambda t, a=acceleration: a * t, "gained speed, m/s", title)
    axes[2].set_ylim(-0.08, 0.08)
    save(figure, "coupling")
