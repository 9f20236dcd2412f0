# processors: 3
"""The fluid's volume closes to the solvers' tolerance in both schemes on 1, 2 and 3 ranks; a broken balance stops the run."""
import csv
import os
import subprocess
import sys
import tempfile

CASE = """
mesh: {upper: "0.02, 0.01, 0.01", cells: "8, 4, 4"}
time: {end: 0.005, step: 1e-3}
fluid: {density: 1, viscosity: 1e-3}
boundary:
  x_min: {type: velocity, velocity: "1, 0, 0"}
  x_max: {type: pressure}
  y_min: {type: no_slip}
  y_max: {type: no_slip}
  z_min: {type: slip}
  z_max: {type: slip}
"""


def run(silt, ranks, words):
    """(exit code, last line of stderr, largest mass_residual) of a run."""
    with tempfile.TemporaryDirectory(prefix="silt_mass_") as folder:
        with open(os.path.join(folder, "case.yaml"), "w") as file:
            file.write(CASE)
        command = (["mpiexec", "-n", str(ranks)] if ranks > 1 else []) + [silt, "case.yaml"] + words
        done = subprocess.run(command, cwd=folder, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        with open(os.path.join(folder, "output", "run", "ledger.csv")) as file:
            rows = list(csv.DictReader(file))
        said = [line for line in done.stderr.splitlines() if line.startswith("silt: error: ")]
        return done.returncode, said, max(abs(float(row["mass_residual"])) for row in rows), len(rows)


def main():
    silt = os.path.abspath(sys.argv[1])
    faults = []
    for ranks in (1, 2, 3):
        for scheme, allowed in (("pressure_correction", 1e-3), ("monolithic", 1e-5)):
            code, said, residual, steps = run(silt, ranks, ["-fluid_scheme", scheme])
            print(f"{ranks} ranks {scheme}: exit code {code}, largest mass residual {residual:.2g}")
            if code != 0 or not residual < allowed or steps < 5:
                faults.append(f"{scheme} on {ranks} ranks: {said}")
        # A pressure equation that is hardly solved does not conserve the volume.
        code, said, residual, _ = run(silt, ranks, ["-fluid_pressure_ksp_rtol", "0.9"])
        print(f"{ranks} ranks, pressure hardly solved: exit code {code}, {residual:.2g}, {said}")
        if code != 1 or len(said) != 1 or "-ledger_mass_tolerance" not in said[0]:
            faults.append(f"a broken balance on {ranks} ranks goes on: exit code {code}, {said}")
    print("\n".join(faults))
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
