#!/usr/bin/python3
"""Writes inputs/fluid/manufactured_*.yaml: flows made up from formulas, with the forces and heat sources that make them solutions.

The void fraction varies in space and time; every element of the fluid has a case. Also the turbulence of a given flow
(manufactured_<cell>_k_epsilon, _k_omega) and a gas (manufactured_<cell>_gas). Needs sympy.
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


def write(name, lines):
    with open(os.path.join(ROOT, "inputs", "fluid", name + ".yaml"), "w") as file:
        file.write("\n".join(lines) + "\n")


def parser_formula(expression):
    """The same with the names of muParser; squares of roots and the like are left to it."""
    return formula(expression).replace("Abs(", "abs(").replace("Max(", "max(").replace("Min(", "min(")


def turbulence(cell, model):
    """k and epsilon or omega in a plane flow and a void fraction that are given: the sources are what (T2), (T3) leave.

    The flow has S_ij S_jk S_ki = 0 (it is plane and without divergence), and no walls: A_s = sqrt(6) cos(pi/6), F1 = F2 = 0.
    S is positive everywhere. C1 has both its branches in the domain; P stays below its bound.
    """
    pi, rho, mu = sp.pi, sp.Rational(13, 10), sp.Rational(1, 50)
    alpha = sp.Rational(4, 5) + (x - y) / 10
    u = [2 + 3 * y + sp.sin(pi * y) / 5, 1 + x + sp.sin(pi * x) / 5]
    k = sp.Rational(1, 2) + sp.sin(pi * x) * sp.cos(pi * y) / 5
    second = (sp.Rational(4, 5) + sp.cos(pi * x) * sp.sin(pi * y) / 5) * (1 if model == "k_epsilon" else 10)
    S = sp.diff(u[0], y) + sp.diff(u[1], x)
    W = sp.diff(u[1], x) - sp.diff(u[0], y)
    gradient = lambda f: [sp.diff(f, x), sp.diff(f, y)]
    if model == "k_epsilon":
        U = sp.sqrt((S**2 + W**2) / 2)
        C_mu = 1 / (sp.Float("4.04", 15) + sp.sqrt(6) * sp.cos(pi / 6) * U * k / second)
        mu_t = rho * C_mu * k**2 / second
        eta = S * k / second
        eddy = [mu + mu_t, mu + mu_t / sp.Rational(12, 10)]
        gained = [mu_t * S**2 - rho * second,
                  rho * sp.Max(sp.Rational(43, 100), eta / (eta + 5)) * S * second - rho * sp.Rational(19, 10) * second**2 / (k + sp.sqrt(mu / rho * second))]
        name, options, ratio = "turbulent_dissipation", "realizable_k_epsilon", sp.Rational(9, 100) * rho * k**2 / second / mu
    else:
        beta_star, beta, gamma = sp.Rational(9, 100), sp.Rational(828, 10000), sp.Rational(44, 100)
        mu_t = rho * k / second
        produced = sp.Min(mu_t * S**2, 10 * beta_star * rho * k * second)
        cross = sum(a * b for a, b in zip(gradient(k), gradient(second)))
        eddy = [mu + mu_t, mu + mu_t * sp.Rational(856, 1000)]
        gained = [produced - beta_star * rho * k * second,
                  gamma * rho * produced / mu_t - beta * rho * second**2 + 2 * rho * sp.Rational(856, 1000) / second * cross]
        name, options, ratio = "specific_dissipation", "sst_k_omega", rho * k / second / mu
    source = []
    for phi, diffusivity, gain in zip((k, second), eddy, gained):
        carried = alpha * rho * sum(ui * slope for ui, slope in zip(u, gradient(phi)))
        spread = sum(sp.diff(alpha * diffusivity * slope, xi) for slope, xi in zip(gradient(phi), (x, y)))
        source.append(parser_formula(carried - spread - alpha * gain))
    case_name = f"manufactured_{cell}_{model}"
    lines = [
        f"# Question: do k and {'epsilon' if model == 'k_epsilon' else 'omega'} converge with order 2 in a given flow and void fraction, on {cell}s?",
        "# Reference: manufactured solution; made by scripts/manufactured.py.",
        f"# order: turbulent_energy_error 2 {name}_error 2",
    ]
    lines += [f"# level: -mesh_cells {n},{n}" for n in (16, 32, 64)]
    lines += [
        "# ranks: 1",
        f"title: Manufactured turbulence, {cell}, {options}",
        f"mesh: {{type: box, cell: {cell}, lower: [0, 0, 0], upper: [1, 1, 0], cells: [16, 16]}}",
        "gravity: [0, 0, 0]",
        "time: {end: 6, step: 0.3}",
        "fluid:",
        "  type: prescribed",
        f"  density: {float(rho)}",
        f"  viscosity: {float(mu)}",
        f'  velocity: "{formula(u[0])}, {formula(u[1])}, 0"',
        f'  void_fraction: "{formula(alpha)}"',
        f"  turbulence: {options}",
        f'  initial_turbulent_energy: "{formula(k)}"',
        f'  initial_viscosity_ratio: "{formula(ratio)}"',
        f'  turbulent_energy_source: "{source[0]}"',
        f'  turbulent_dissipation_source: "{source[1]}"',
        "boundary:",
    ]
    for side in ("x_min", "x_max", "y_min", "y_max"):
        lines.append(f'  {side}: {{type: velocity, turbulence: {{energy: "{formula(k)}", viscosity_ratio: "{formula(ratio)}"}}}}')
    lines += ["exact:", f'  turbulent_energy: "{formula(k)}"', f'  {name}: "{formula(second)}"', f"output: {{directory: output/{case_name}, interval: 6}}"]
    write(case_name, lines)


def gas(cell):
    """A smooth subsonic gas, with a steady density and a mass flux without divergence that changes in time.

    Reynolds number 5. Where it enters, a viscous gas needs its pressure besides velocity and temperature (docs/theory/compressible.md, C6a).
    """
    pi, gamma, mu, prandtl = sp.pi, sp.Rational(7, 5), sp.Rational(1, 10), sp.Rational(71, 100)
    dimension = 2 if cell in ("triangle", "quadrilateral") else 3
    axes = [x, y, z][:dimension]
    rho = 1 + sp.sin(pi * x) * sp.cos(pi * y) / 10
    T = 1 + sp.cos(pi * x) * sp.cos(pi * y) * sp.cos(2 * t) / 10
    flux = [sp.Rational(2, 5) + sp.sin(pi * y) * sp.cos(2 * t) / 10, sp.Rational(1, 5) + sp.cos(pi * x) * sp.sin(2 * t) / 10]
    if dimension == 3:
        flux = [flux[0], flux[1] + sp.cos(pi * z) / 10, sp.Rational(1, 10) + sp.sin(pi * x) * sp.cos(2 * t) / 10]
    p = rho * T
    u = [m / rho for m in flux]
    energy = p / (gamma - 1) + rho * sum(v**2 for v in u) / 2
    divergence = sum(sp.diff(v, xi) for v, xi in zip(u, axes))
    stress = [[mu * (sp.diff(u[i], axes[j]) + sp.diff(u[j], axes[i]) - (sp.Rational(2, 3) * divergence if i == j else 0)) for j in range(dimension)] for i in range(dimension)]
    conductivity = mu * gamma / (gamma - 1) / prandtl
    force = [sp.diff(flux[i], t) + sum(sp.diff(flux[j] * u[i] - stress[i][j], axes[j]) for j in range(dimension)) + sp.diff(p, axes[i]) for i in range(dimension)]
    heat = sp.diff(energy, t) + sum(
        sp.diff((energy + p) * u[j] - sum(u[i] * stress[i][j] for i in range(dimension)) - conductivity * sp.diff(T, axes[j]), axes[j])
        for j in range(dimension)) - sum(f * v for f, v in zip(force, u))
    assert sp.simplify(sum(sp.diff(m, xi) for m, xi in zip(flux, axes))) == 0
    zero = ["0"] * (3 - dimension)
    vector = lambda components: ", ".join([formula(c) for c in components] + zero)
    at_start = lambda expression: expression.subs(t, 0)
    levels = [(16, 0.04), (32, 0.02)] if dimension == 2 else [(6, 0.08), (12, 0.04)]
    name = f"manufactured_{cell}_gas"
    lines = [
        f"# Question: does a smooth, viscous subsonic gas that changes in time converge with order 2 on {cell}s?",
        "# Reference: manufactured solution; made by scripts/manufactured.py.",
        "# order: velocity_error 2 pressure_error 1 temperature_error 2 density_error 1",
    ]
    lines += [f"# level: -mesh_cells {','.join([str(n)] * dimension)} -time_step {dt}" for n, dt in levels]
    lines += [
        "# ranks: 1",
        f"title: Manufactured gas, {cell}",
        f"mesh: {{type: box, cell: {cell}, lower: [0, 0, 0], upper: {'[1, 1, 0]' if dimension == 2 else '[1, 1, 1]'}, cells: [{', '.join([str(levels[0][0])] * dimension)}]}}",
        "gravity: [0, 0, 0]",
        f"time: {{end: 0.48, step: {levels[0][1]}}}",
        "fluid:",
        "  type: compressible",
        "  gas_constant: 1",
        f"  viscosity: {float(mu)}",
        f'  initial_velocity: "{vector([at_start(v) for v in u])}"',
        f'  initial_pressure: "{formula(at_start(p))}"',
        f'  initial_temperature: "{formula(at_start(T))}"',
        f'  body_force: "{vector(force)}"',
        f'  heat_source: "{formula(heat)}"',
    ]
    lines.append("boundary:")
    for axis in "xyz"[:dimension]:
        for side in ("min", "max"):
            lines.append(f'  {axis}_{side}: {{type: velocity, velocity: "{vector(u)}", pressure: "{formula(p)}", temperature: {{type: given, value: "{formula(T)}"}}}}')
    lines += ["exact:", f'  velocity: "{vector(u)}"', f'  pressure: "{formula(p)}"', f'  temperature: "{formula(T)}"', f'  density: "{formula(rho)}"',
              f"output: {{directory: output/{name}, interval: 0.48}}"]
    write(name, lines)


if __name__ == "__main__":
    for shape in ("triangle", "quadrilateral", "tetrahedron", "hexahedron"):
        for order in ("equal_order", "taylor_hood"):
            case(shape, order)
        gas(shape)
    for shape in ("triangle", "quadrilateral"):
        for equations in ("k_epsilon", "k_omega"):
            turbulence(shape, equations)
