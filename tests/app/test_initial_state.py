#!/usr/bin/env python3
# processors: 2
"""Flows that start from an earlier run on another mesh, with their turbulence, from a potential flow and from a Stokes flow."""
import csv
import os
import shutil
import subprocess
import sys
import tempfile

import h5py

SILT = os.path.abspath(sys.argv[1])
CHANNEL = """\
mesh: {{type: box, cell: {cell}, lower: [0, 0, 0], upper: [{length}, 1, 0], cells: {cells}}}
gravity: [0, 0, 0]
time: {{end: {end}, step: {step}}}
fluid: {{density: 1, viscosity: 0.1{fluid}}}
boundary:
  x_min: {{type: velocity, velocity: "{inflow}, 0, 0"{temperature}}}
  x_max: {{type: pressure}}
  y_min: {{type: {wall}}}
  y_max: {{type: {wall}}}
output: {{directory: {out}, interval: {end}}}
exact: {{velocity: "6*y*(1-y), 0, 0", pressure: "1.2*({length} - x)"}}
"""
ENERGY = ", energy: yes, heat_capacity: 1, conductivity: 0.1"
wrong = []


def expect(true, text):
    if not true:
        wrong.append(text)


def run(folder, *words, ranks=1, **values):
    values = dict(dict(cell="quadrilateral", length="2", cells="[24, 16]", end="10", step="0.1", fluid="", inflow="6*y*(1-y)", wall="no_slip", out="out", temperature=""), **values)
    with open(os.path.join(folder, "case.yaml"), "w") as file:
        file.write(CHANNEL.format(**values))
    command = (["mpiexec", "-n", str(ranks)] if ranks > 1 else []) + [SILT, "case.yaml", *words]
    return subprocess.run(command, cwd=folder, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)


def errors(folder, out, row):
    with open(os.path.join(folder, out, "errors.csv")) as file:
        found = list(csv.DictReader(file))[row]
    return float(found["velocity_error"]), float(found["pressure_error"])


with tempfile.TemporaryDirectory() as folder:
    done = run(folder, fluid=ENERGY + ', initial_temperature: "300 + y"', temperature=', temperature: {type: given, value: "300 + y"}')
    expect(done.returncode == 0, f"first run: {done.stdout[-300:]}")
    steady = errors(folder, "out", -1)
    files = sorted(name for name in os.listdir(os.path.join(folder, "out", "fluid")) if name[0] == "0")
    start = "out/fluid/" + files[-1]
    for ranks in (1, 3):
        for cell, cells in (("triangle", "[17, 23]"), ("quadrilateral", "[31, 12]")):
            for scheme in ("pressure_correction", "monolithic"):
                text = f"{cell}, {ranks} ranks, {scheme}"
                done = run(folder, ranks=ranks, cell=cell, cells=cells, out="on", end="0.002", step="0.001", fluid=f", scheme: {scheme}, initial_file: {start}" + ENERGY, temperature=', temperature: {type: given, value: "300 + y"}')
                expect(done.returncode == 0, f"{text}: {done.stdout[-300:]}")
                if done.returncode == 0:
                    # At the start: what the first run had, up to the interpolation between two meshes of about 1/16.
                    velocity, pressure = errors(folder, "on", 0)
                    expect(velocity < steady[0] + 0.01 and pressure < steady[1] + 0.02, f"{text}: errors {velocity}, {pressure} after {steady}")
                    with open(os.path.join(folder, "on", "diagnostics.csv")) as file:
                        mean = float(list(csv.DictReader(file))[0]["mean_temperature"])
                    expect(abs(mean - 300.5) < 1e-2, f"{text}: mean temperature {mean}")
    done = run(folder, length="3", out="wide", fluid=f", initial_file: {start}")
    expect(done.returncode == 2 and "outside the earlier one" in done.stdout, f"a larger domain is refused: {done.stdout[-300:]}")
    done = run(folder, out="both", fluid=f', initial_file: {start}, initial_velocity: "1, 0, 0"')
    expect(done.returncode == 2 and "exclude each other" in done.stdout, f"two starts are refused: {done.stdout[-300:]}")
    done = run(folder, out="none", fluid=", initial_file: out/fluid/999999.h5")
    expect(done.returncode == 2 and "does not exist" in done.stdout, f"a missing file is refused: {done.stdout[-300:]}")
    for name, spoil in (("far", lambda cells: cells + 10**7), ("negative", lambda cells: -cells)):
        os.makedirs(os.path.join(folder, name, "fluid"))
        shutil.copy(os.path.join(folder, start), os.path.join(folder, name, "fluid"))
        shutil.copy(os.path.join(folder, "out", "fluid", "mesh.h5"), os.path.join(folder, name, "fluid"))
        with h5py.File(os.path.join(folder, name, "fluid", "mesh.h5"), "r+") as file:
            file["cells"][...] = spoil(file["cells"][...])
        done = run(folder, out="damaged", fluid=f", initial_file: {name}/fluid/{files[-1]}")
        expect(done.returncode == 2 and "is damaged" in done.stdout, f"node numbers that are {name} are refused: {done.stdout[-300:]}")
    done = run(folder, out="cold", fluid=f", initial_file: {start}" + ENERGY.replace("energy: yes", "energy: no"))
    expect(done.returncode == 2, "energy options without energy are refused")

    # Stokes flow between the plates is Poiseuille's: the error is that of the mesh from the first instant.
    for scheme in ("pressure_correction", "monolithic"):
        done = run(folder, out="stokes", end="0.002", step="0.001", fluid=f", scheme: {scheme}, initial_solve: stokes")
        expect(done.returncode == 0, f"stokes, {scheme}: {done.stdout[-300:]}")
        if done.returncode == 0:
            velocity, pressure = errors(folder, "stokes", 0)
            expect(velocity < 0.01 and pressure < 0.05, f"stokes, {scheme}: errors {velocity}, {pressure}")
        # Potential flow between slip walls: whatever comes in, it leaves evenly at some distance.
        done = run(folder, out="potential", length="4", cells="[64, 16]", wall="slip", inflow="1 + cos(pi*y)", end="0.002", step="0.001", fluid=f", scheme: {scheme}, initial_solve: potential")
        expect(done.returncode == 0, f"potential, {scheme}: {done.stdout[-300:]}")
        if done.returncode == 0:
            with open(os.path.join(folder, "potential", "diagnostics.csv")) as file:
                first = list(csv.DictReader(file))[0]
            expect(abs(float(first["fluid_velocity_x"]) - 1) < 5e-3, f"potential, {scheme}: mean velocity {first['fluid_velocity_x']}")
            expect(abs(float(first["fluid_velocity_y"])) < 0.09, f"potential, {scheme}: cross flow {first['fluid_velocity_y']}")

    # Turbulence comes along, also to the other model, and a gas starts from a gas: linear fields arrive exactly.
    TURBULENT = """\
mesh: {{type: box, cell: {cell}, lower: [0, 0, 0], upper: [2, 1, 0], cells: {cells}}}
gravity: [0, 0, 0]
time: {{end: 1e-6, step: 1e-6}}
fluid: {{density: 2, viscosity: 0.001, turbulence: {model}, {start}}}
boundary:
  x_min: {{type: velocity, velocity: "1, 0, 0", turbulence_energy: 0.01, turbulence_viscosity_ratio: 10}}
  x_max: {{type: pressure}}
  y_min: {{type: slip}}
  y_max: {{type: slip}}
output: {{directory: {out}, interval: 1e-6}}
"""
    GAS = """\
mesh: {{type: box, cell: {cell}, lower: [0, 0, 0], upper: [2, 1, 0], cells: {cells}}}
gravity: [0, 0, 0]
time: {{end: 1e-7, step: 1e-7}}
fluid: {{type: compressible, viscosity: 2e-5, {start}}}
boundary:
  x_min: {{type: slip}}
  x_max: {{type: slip}}
  y_min: {{type: slip}}
  y_max: {{type: slip}}
output: {{directory: {out}, interval: 1e-7}}
"""

    def start_case(text, ranks=1, words=(), **values):
        with open(os.path.join(folder, "case.yaml"), "w") as file:
            file.write(text.format(**values))
        command = (["mpiexec", "-n", str(ranks)] if ranks > 1 else []) + [SILT, "case.yaml", *words]
        return subprocess.run(command, cwd=folder, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)

    def fields(out):
        """Fields of the first output by name, and the places of its nodes."""
        with h5py.File(os.path.join(folder, out, "fluid", "mesh.h5")) as mesh, h5py.File(os.path.join(folder, out, "fluid", "000000.h5")) as data:
            return {name: data[name][...] for name in data}, mesh["points"][...]

    formula = 'initial_velocity: "1, 0, 0", initial_turbulent_energy: "0.01*(1 + x)", initial_viscosity_ratio: 10'
    done = start_case(TURBULENT, model="realizable_k_epsilon", cell="quadrilateral", cells="[24, 16]", start=formula, out="turbulent")
    expect(done.returncode == 0, f"k-epsilon: {done.stdout[-300:]}")
    from_file = "initial_file: turbulent/fluid/000000.h5"
    for ranks, model, second, exact in ((1, "realizable_k_epsilon", "turbulent_dissipation", lambda k: 0.09 * k * k * 2 / 0.01), (3, "sst_k_omega", "specific_dissipation", lambda k: k * 2 / 0.01)):
        done = start_case(TURBULENT, ranks, model=model, cell="triangle", cells="[17, 13]", start=from_file, out="from_" + model)
        expect(done.returncode == 0, f"{model} from a file: {done.stdout[-300:]}")
        if done.returncode == 0:
            found, x = fields("from_" + model)
            k = 0.01 * (1 + x[:, 0])
            inside = x[:, 0] > 1e-9  # what enters there is given
            expect(abs(found["turbulent_energy"] / k - 1)[inside].max() < 1e-9, f"{model}: k differs by {abs(found['turbulent_energy'] / k - 1)[inside].max()}")
            expect(abs(found[second] / exact(k) - 1)[inside].max() < 2e-3, f"{model}: {second} differs by {abs(found[second] / exact(k) - 1)[inside].max()}")
    # The file is named as seen from the options file, which lies elsewhere than the run.
    os.makedirs(os.path.join(folder, "cases"), exist_ok=True)
    with open(os.path.join(folder, "cases", "beside.yaml"), "w") as file:
        file.write(TURBULENT.format(model="sst_k_omega", cell="triangle", cells="[17, 13]", start="initial_file: ../turbulent/fluid/000000.h5", out="beside"))
    done = subprocess.run([SILT, os.path.join(folder, "cases", "beside.yaml"), "-check"], cwd="/", stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    expect(done.returncode == 0, f"a file beside the case: {done.stdout[-300:]}")
    done = start_case(TURBULENT, model="sst_k_omega", cell="triangle", cells="[17, 13]", start=from_file + ", initial_turbulent_energy: 1", out="twice")
    expect(done.returncode == 2 and "exclude each other" in done.stdout, f"k by formula and file: {done.stdout[-300:]}")
    laminar = TURBULENT.replace("out/fluid", "out").replace("turbulence: {model}, {start}", "{start}").replace(", turbulence_energy: 0.01, turbulence_viscosity_ratio: 10", "")
    done = start_case(laminar, cell="quadrilateral", cells="[24, 16]", start='initial_velocity: "1, 0, 0"', out="laminar")
    expect(done.returncode == 0, f"laminar: {done.stdout[-300:]}")
    done = start_case(TURBULENT, model="sst_k_omega", cell="triangle", cells="[17, 13]", start="initial_file: laminar/fluid/000000.h5", out="lacks")
    expect(done.returncode == 2 and "has no turbulence" in done.stdout, f"a file without k: {done.stdout[-300:]}")

    done = start_case(GAS, cell="quadrilateral", cells="[12, 8]", start='initial_velocity: "x*(2 - x)*0, 0, 0", initial_pressure: "1e5*(1 + 0.01*x)", initial_temperature: "300 + 5*y"', out="gas")
    expect(done.returncode == 0, f"gas: {done.stdout[-300:]}")
    for ranks in (1, 2):
        done = start_case(GAS, ranks, cell="triangle", cells="[9, 11]", start="initial_file: gas/fluid/000000.h5", out="gas_on")
        expect(done.returncode == 0, f"gas from a file: {done.stdout[-300:]}")
        if done.returncode == 0:
            found, x = fields("gas_on")
            expect(abs(found["pressure"] / (1e5 * (1 + 0.01 * x[:, 0])) - 1).max() < 1e-12, "the gas's pressure arrives")
            expect(abs(found["temperature"] / (300 + 5 * x[:, 1]) - 1).max() < 1e-12, "the gas's temperature arrives")
    done = start_case(GAS, cell="triangle", cells="[9, 11]", start="initial_file: laminar/fluid/000000.h5", out="gas_off")
    expect(done.returncode == 2, f"a gas does not start from a liquid: {done.stdout[-300:]}")

print("\n".join(wrong) if wrong else "the starts are what they should be")
sys.exit(1 if wrong else 0)
