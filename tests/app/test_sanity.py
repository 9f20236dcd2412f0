#!/usr/bin/env python3
# processors: 2
"""Whatever goes wrong among the particles ends the run with one line that says where, or is warned about and gone past,
as the options say; the last good state is written before, and the mended case goes on from it."""
import csv
import os
import re
import shutil
import subprocess
import sys
import tempfile

CASE = """\
mesh: {type: box, lower: [0, 0, 0], upper: [0.02, 0.02, 0.02], cells: [2, 2, 2]}
gravity: [0, 0, -9.81]
time: {end: 0.03, step: 1.0e-3}
fluid: {type: none}
material: {bead: {density: 2500, young_modulus: 1.0e6}}
insertion: {ball: {type: file, file: ball.csv}}
output: {directory: out, interval: 0.01}
progress: {quiet: yes}
"""
HEAD = "x,y,z,diameter,vx,vy,vz,material\n"
# Two stacked balls, just apart, above the floor: the lower one touches it, then the upper one.
STACK = "0.005,0.01,0.001,0.002,0,0,0,bead\n0.005,0.01,0.0032,0.002,0,0,-0.3,bead\n"
FAR = "0.015,0.012,0.012,0.002,0,0,0,bead\n"

# name, balls, options that provoke it, what the line must say besides, options that mend it, options that warn only
TROUBLES = [
    ("an overlap with another beyond its limit", STACK, ["-particles_overlap_limit", "0.002"],
     ["overlaps", "touches [01]", "last wall z_min", "particles_overlap_limit"], ["-particles_overlap_limit", "0.5"], ["-particles_deep", "warn"]),
    ("an overlap with a wall beyond its limit", FAR.replace("0,0,0", "0,0,-0.3"), ["-particles_overlap_limit", "0.001"],
     ["overlaps the wall z_min", "touches the wall z_min", "last wall z_min", "particles_overlap_limit"], ["-particles_overlap_limit", "0.5"], ["-particles_deep", "warn"]),
    ("a particle that moves more than its radius in a step", "0.002,0.01,0.01,0.001,0.9,0,0,bead\n",
     ["-particles_step", "1e-3", "-particles_step_override", "yes", "-gravity", "0, 0, 0"],
     ["more than its radius", "particles_fast"], ["-particles_step", "0"], None),
    ("a particle lost through an open boundary", FAR.replace("0,0,0", "0.4,0,0"), ["-boundary_x_max_particles", "open"],
     ["lost particle", "open boundary x_max"], ["-boundary_x_max_particles", "outlet"], ["-particles_lost", "warn"]),
    ("a position that is not a number", "0.004,0.01,0.001,0.002,0,0,-0.01,bead\n",
     ["-electric_type", "dc", "-electric_charge", "1e-12", "-electric_field", "sqrt(0.0105 - t), 0, 0"],
     ["not a number", "last wall z_min"], ["-electric_field", "0.1, 0, 0"], None),
    ("a temperature that is not a number", FAR,
     ["-heat_particles", "yes", "-material_bead_heat_capacity", "800", "-heat_source", "1e3*sqrt(0.0105 - t)"],
     ["not a number: the temperature of", "option -heat_source: '.*' is no finite number at t = 0.01"], ["-heat_source", "0"], None),
    ("a wall whose speed is not a number", FAR,
     ["-wall_lid_type", "plane", "-wall_lid_point", "0, 0, 0.02", "-wall_lid_normal", "0, 0, -1", "-wall_lid_velocity", "0, 0, -0.01*sqrt(0.0105 - t)"],
     ["option -wall_lid_velocity: '.*' is no finite number at t = 0.01"], ["-wall_lid_velocity", "0, 0, 0"], None),
    ("a step that becomes too long when smaller particles come", FAR,
     ["-particles_step", "2e-5", "-insertion_rain_type", "stream", "-insertion_rain_diameter", "5e-4", "-insertion_rain_number_rate", "500",
      "-insertion_rain_start", "0.0155", "-insertion_rain_lower", "0.002, 0.002, 0.015", "-insertion_rain_upper", "0.018, 0.018, 0.018"],
     ["particles_step", "is longer than"], ["-particles_step", "0"], ["-particles_step_override", "yes"]),
]


def main():
    silt = os.path.abspath(sys.argv[1])
    faults = []

    def check(label, good, said=""):
        print(f"{'ok  ' if good else 'FAIL'} {label} {said if not good else ''}")
        if not good:
            faults.append(label)

    for name, balls, provoke, words, mend, warn in TROUBLES:
        for ranks in (1, 2):
            path = tempfile.mkdtemp(prefix="silt_sanity_")
            open(os.path.join(path, "case.yaml"), "w").write(CASE)
            open(os.path.join(path, "ball.csv"), "w").write(HEAD + balls)

            def run(*options):
                command = (["mpiexec", "-n", str(ranks)] if ranks > 1 else []) + [silt, "case.yaml", *options]
                done = subprocess.run(command, cwd=path, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, timeout=120)
                return done.returncode, done.stdout

            label = f"{name}, {ranks} rank{'s' * (ranks > 1)}"
            code, said = run(*provoke)
            lines = [line for line in said.splitlines() if line.startswith("silt: error:")]
            line = lines[0] if lines else ""
            check(f"{label}: exit code 1 and one line", code == 1 and len(lines) == 1, said[-400:])
            if "particles_step" not in words and "whose speed" not in name:
                words = words + [r"particle \d+ at \(.*\) m", r"velocity \(.*\) m/s", r"rank \d"]
            for word in words:
                check(f"{label}: the line says {word}", re.search(word, line) is not None, line)
            check(f"{label}: it names the last good state", "out/last_good.h5 (-restart)" in line, line)
            code, said = run(*provoke, *mend, "-restart", "out/last_good.h5")
            check(f"{label}: the mended case goes on from it", code == 0, said[-400:])
            if code == 0:
                with open(os.path.join(path, "out", "diagnostics.csv")) as file:
                    times = [float(row["time"]) for row in csv.DictReader(file)]
                check(f"{label}: to its end", abs(times[-1] - 0.03) < 1e-9 and all(a < b for a, b in zip(times, times[1:])), str(times[-3:]))
            if warn:
                code, said = run(*provoke, *warn, "-output_directory", "warned")
                check(f"{label}: with {' '.join(warn)} it goes on", code == 0, said[-400:])
                if "override" not in warn[0]:
                    check(f"{label}: and says so", "silt: warning" in said, said[-400:])
            shutil.rmtree(path, ignore_errors=True)
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
