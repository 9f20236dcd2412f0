#!/usr/bin/env python3
"""Writes inputs/fluid/manufactured_*.yaml: flows made up from formulas, with the forces and heat sources that make them solutions.

The void fraction varies in space and time; every element of the fluid has a case. Needs sympy.
"""
import os

import sympy as sp

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
x, y, z, t = sp.symbols("x y z t")
DENSITY, VISCOSITY, CAPACITY, CONDUCTIVITY = 1, sp.Rational(1, 20), 2, sp.Rational(1, 10)


def formula(expression):
    return str(expression.evalf(12, chop=True)).replace("**", "^").replace(" ", "").replace("3.14159265359", "pi")


def solution(dimension):
    """Superficial velocity, void fraction, pressure and temperature that obey d(alpha)/dt + div U = 0."""
    pi = sp.pi
    if dimension == 2:
        alpha = sp.Rational(4, 5) + (x - y) * sp.cos(t) / 10
        flux = [sp.sin(pi * y) * sp.cos(2 * t) + x**2 * sp.sin(t) / 20, sp.sin(pi * x) * sp.cos(2 * t) - y**2 * sp.sin(t) / 20]
        pressure = sp.cos(pi * x) * sp.cos(pi * y) * sp.cos(t)
        temperature = 300 + sp.cos(pi * x) * sp.sin(pi * y) * sp.cos(3 * t)
    else:
        alpha = sp.Rational(4, 5) + (x - y + z) * sp.cos(t) / 10
        flux = [sp.sin(pi * z) * sp.cos(2 * t) + x**2 * sp.sin(t) / 20, sp.sin(pi * x) * sp.cos(2 * t) - y**2 * sp.sin(t) / 20, sp.sin(pi * y) * sp.cos(2 * t) + z**2 * sp.sin(t) / 20]
        pressure = sp.cos(pi * x) * sp.cos(pi * y) * sp.cos(t) + sp.sin(pi * z)
        temperature = 300 + sp.cos(pi * x) * sp.sin(pi * y) * sp.cos(pi * z) * sp.cos(3 * t)
    return flux, alpha, pressure, temperature


def sources(flux, alpha, pressure, temperature):
    """Body force (F2, model A) and heat source (E1)."""
    axes = [x, y, z][: len(flux)]
    u = [U / alpha for U in flux]
    divergence = sum(sp.diff(u[i], axes[i]) for i in range(len(u)))
    force = []
    for i, xi in enumerate(axes):
        inertia = alpha * DENSITY * (sp.diff(u[i], t) + sum(u[j] * sp.diff(u[i], xj) for j, xj in enumerate(axes)))
        viscous = 0
        for j, xj in enumerate(axes):
            stress = sp.diff(u[i], xj) + sp.diff(u[j], xi) - (sp.Rational(2, 3) * divergence if i == j else 0)
            viscous += sp.diff(alpha * VISCOSITY * stress, xj)
        force.append(inertia + alpha * sp.diff(pressure, xi) - viscous)
    carried = alpha * DENSITY * CAPACITY * (sp.diff(temperature, t) + sum(u[j] * sp.diff(temperature, xj) for j, xj in enumerate(axes)))
    conducted = sum(sp.diff(alpha * CONDUCTIVITY * sp.diff(temperature, xj), xj) for xj in axes)
    assert sp.simplify(sp.diff(alpha, t) + sum(sp.diff(flux[i], axes[i]) for i in range(len(axes)))) == 0
    return u, force, carried - conducted


def case(cell, element):
    dimension = 2 if cell in ("triangle", "quadrilateral") else 3
    flux, alpha, pressure, temperature = solution(dimension)
    u, force, heat = sources(flux, alpha, pressure, temperature)
    zero = ["0"] * (3 - dimension)
    vector = lambda components: ", ".join([formula(c) for c in components] + zero)
    at_start = lambda expression: expression.subs(t, 0)
    quadratic = element == "taylor_hood"
    end = 0.24
    # The error in time, of second order, falls with that in space.
    if dimension == 2:
        levels = [(8, 0.02), (16, 0.0075)] if quadratic else [(16, 0.015), (32, 0.0075)]
    elif not quadratic:
        levels = [(8, 0.03), (16, 0.015)]
    else:
        levels = [(8, 0.015), (14, 0.0075)] if cell == "tetrahedron" else [(6, 0.02), (10, 0.01)]
    lines = [
        f"# Question: do velocity, pressure and temperature converge as they should, {'quadratic velocity' if quadratic else 'equal order'} on {cell}s?",
        "# Reference: manufactured solution, void fraction varying in space and time; made by scripts/manufactured.py.",
        f"# order: velocity_error {3 if quadratic else 2} pressure_error {2 if quadratic else 1} temperature_error 2",
    ]
    if dimension == 3 and quadratic:
        lines.append(f"# refine: {levels[1][0] / levels[0][0]:.8g}")
    lines += [f"# level: -mesh_cells {','.join([str(n)] * dimension)} -time_step {dt}" for n, dt in levels]
    upper = "[1, 1, 0]" if dimension == 2 else "[1, 1, 1]"
    lines += [
        "# ranks: 1",
        f"title: Manufactured flow, {cell}, {element}",
        f"mesh: {{type: box, cell: {cell}, lower: [0, 0, 0], upper: {upper}, cells: [{', '.join([str(levels[0][0])] * dimension)}]}}",
        "gravity: [0, 0, 0]",
        f"time: {{end: {end}, step: {levels[0][1]}}}",
        "fluid:",
        f"  density: {DENSITY}",
        f"  viscosity: {float(VISCOSITY)}",
    ]
    if quadratic:
        lines += ["  scheme: monolithic", "  element: taylor_hood"]
    lines += [
        f'  void_fraction: "{formula(alpha)}"',
        f'  initial_velocity: "{vector([at_start(c) for c in u])}"',
        f'  initial_pressure: "{formula(at_start(pressure))}"',
        f'  body_force: "{vector(force)}"',
        "  energy: yes",
        f"  heat_capacity: {CAPACITY}",
        f"  conductivity: {float(CONDUCTIVITY)}",
        f'  initial_temperature: "{formula(at_start(temperature))}"',
        f'  heat_source: "{formula(heat)}"',
        "boundary:",
    ]
    for axis in "xyz"[:dimension]:
        for side in ("min", "max"):
            lines.append(f'  {axis}_{side}: {{type: velocity, velocity: "{vector(flux)}", temperature: {{type: given, value: "{formula(temperature)}"}}}}')
    lines += [
        "exact:",
        f'  velocity: "{vector(u)}"',
        f'  pressure: "{formula(pressure)}"',
        f'  temperature: "{formula(temperature)}"',
        f"output: {{directory: output/manufactured_{cell}_{element}, interval: {end}}}",
    ]
    with open(os.path.join(ROOT, "inputs", "fluid", f"manufactured_{cell}_{element}.yaml"), "w") as file:
        file.write("\n".join(lines) + "\n")


if __name__ == "__main__":
    for shape in ("triangle", "quadrilateral", "tetrahedron", "hexahedron"):
        for order in ("equal_order", "taylor_hood"):
            case(shape, order)
