#!/usr/bin/env python3
# processors: 3
"""A run that goes on from a checkpoint is the run that was never interrupted: with the same bits on the same ranks, to
round-off on others; a killed run and one that an error ended go on from what they left; bad files are refused."""
import csv
import glob
import os
import shutil
import signal
import subprocess
import sys
import tempfile
import time

import h5py
import numpy as np

GRAINS = """\
mesh: {type: box, lower: [0, 0, 0], upper: [0.024, 0.012, 0.03], cells: [6, 3, 6]}
gravity: [0, 0, -9.81]
time: {end: 0.04, step: 1.0e-3}
fluid: {type: none}
boundary: {z_max: {particles: outlet}}
material:
  bead: {density: 1000, young_modulus: 1.0e6, restitution: 0.9, friction: 0.3, rolling_friction: 0.02}
rolling: {type: constant}
wall:
  paddle: {type: box, side: outside, lower: [0.010, 0, 0.012], upper: [0.014, 0.012, 0.014], rotation_axis: [0, 1, 0], rotation_rate: "10"}
insertion:
  bed: {type: fill, material: bead, diameter: 1.5e-3, count: 250, lower: [0, 0, 0], upper: [0.024, 0.012, 0.018]}
profile: {layers: {from: [0.012, 0.006, 0.003], to: [0.012, 0.006, 0.015], size: [0.024, 0.012, 0.006], points: 3, start: 0.005}}
output: {directory: out, interval: 0.01}
checkpoint: {interval: 0.02}
progress: {quiet: yes}
"""
# A mean over the whole run, which half of it does not give.
EXPECT = ["-expect_swing_quantity", "particle_kinetic_energy", "-expect_swing_statistic", "mean", "-expect_swing_window", "0.005, 0.04", "-expect_swing_value", "1", "-expect_swing_tolerance", "1e9"]
# Laws that remember much: the deepest overlap, turning points of friction and rolling, necks and bridges.
REMEMBERING = GRAINS.replace("end: 0.04", "end: 0.02").replace("interval: 0.02", "interval: 0.01").replace("friction: 0.3,", "friction: 0.3, surface_energy: 0.05,")
PLASTIC = REMEMBERING.replace("rolling: {type: constant}", """normal: {type: walton_braun, stiffness: 5.0e+2}
tangential: {type: walton_braun}
rolling: {type: epsd}
twisting: {type: twisting}""")
STICKY = REMEMBERING.replace("rolling: {type: constant}", """adhesion: {type: jkr}
rolling: {type: spring}
bridge: {type: capillary, surface_tension: 0.05, liquid_content: 0.01}""")
BED = """\
mesh: {type: box, lower: [0, 0, 0], upper: [0.016, 0.008, 0.016], cells: [4, 2, 4]}
gravity: [0, 0, -9.81]
time: {end: 0.01, step: 1.0e-3}
fluid: {density: 1.2, viscosity: 1.8e-5, initial_velocity: "0, 0, 0.3"}
boundary:
  z_min: {type: velocity, velocity: "0, 0, 0.3"}
  z_max: {type: pressure}
  x_min: {type: slip}
  x_max: {type: slip}
  y_min: {type: slip}
  y_max: {type: slip}
material:
  bead: {density: 1000, young_modulus: 1.0e6, restitution: 0.9, friction: 0.1}
insertion:
  bed: {type: fill, material: bead, diameter: 1.2e-3, count: 150, lower: [0, 0, 0], upper: [0.016, 0.008, 0.010]}
settle: {time: 0.02}
drag: {type: gidaspow}
output: {directory: out, interval: 0.005}
checkpoint: {interval: 0.005}
progress: {quiet: yes}
"""
BALL = """\
mesh: {type: box, lower: [0, 0, 0], upper: [0.02, 0.02, 0.02], cells: [2, 2, 2]}
gravity: [0, 0, -9.81]
time: {end: 0.06, step: 1.0e-3}
fluid: {type: none}
material: {bead: {density: 2500, young_modulus: 1.0e6}}
particles: {overlap_limit: 0.001}
insertion: {ball: {type: file, file: ball.csv}}
output: {directory: out, interval: 0.01}
progress: {quiet: yes}
"""
# Settled, then held: what they touch of the walls is not looked at again.
HELD = """\
mesh: {type: box, lower: [0, 0, 0], upper: [0.012, 0.006, 0.012], cells: [4, 2, 4]}
gravity: [0, 0, -9.81]
time: {end: 0.2, step: 0.02}
fluid: {type: prescribed, density: 1.2, viscosity: 1.8e-5, velocity: "0, 0, 0", temperature: "300", heat_capacity: 1005, conductivity: 0.026}
boundary: {z_min: {material: iron, wall_temperature: "400"}}
material:
  bead: {density: 1000, young_modulus: 1.0e6, heat_capacity: 800, conductivity: 1}
  iron: {density: 7800, young_modulus: 1.0e9, conductivity: 50}
particles: {fixed: yes}
heat: {particles: yes, conduction: yes, initial_temperature: "300"}
insertion: {bed: {type: fill, material: bead, diameter: 1.5e-3, count: 100}}
settle: {time: 0.1}
output: {directory: out}
progress: {quiet: yes}
"""


class Folder:
    def __init__(self, silt, case):
        self.silt, self.path = silt, tempfile.mkdtemp(prefix="silt_restart_")
        self.write("case.yaml", case)
        self.write("ball.csv", "x,y,z,diameter,material\n0.01,0.01,0.012,0.002,bead\n")

    def write(self, name, text):
        with open(os.path.join(self.path, name), "w") as file:
            file.write(text)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        shutil.rmtree(self.path, ignore_errors=True)

    def command(self, ranks, options):
        return (["mpiexec", "-n", str(ranks)] if ranks > 1 else []) + [self.silt, "case.yaml", *options]

    def run(self, ranks, *options, expect=0):
        done = subprocess.run(self.command(ranks, options), cwd=self.path, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                              stderr=subprocess.STDOUT, text=True, timeout=300)
        if done.returncode != expect:
            sys.exit(f"{ranks} ranks, {' '.join(options)}: exit code {done.returncode}, expected {expect}\n"
                     + "\n".join(done.stdout.splitlines()[-12:]))
        return done.stdout

    def file(self, *names):
        return os.path.join(self.path, *names)

    def last(self, directory="out"):
        """Arrays of the last particle output by id."""
        with h5py.File(sorted(glob.glob(self.file(directory, "particles", "*.h5")))[-1]) as file:
            order = np.argsort(file["id"][...])
            return {name: file[name][...][order] for name in ("id", "position", "velocity", "spin")}

    def fluid(self, directory="out"):
        with h5py.File(sorted(glob.glob(self.file(directory, "fluid", "0*.h5")))[-1]) as file:
            return {name: file[name][...] for name in ("velocity", "pressure", "void_fraction")}

    def numbers(self, table):
        return np.loadtxt(self.file("out", table), delimiter=",", skiprows=1)

    def figure(self):
        with open(self.file("out", "expectations.csv")) as file:
            return float(next(csv.DictReader(file))["computed"])

    def column(self, table, name):
        with open(self.file("out", table)) as file:
            return np.array([float(row[name]) for row in csv.DictReader(file)])

    def times(self, table="diagnostics.csv"):
        return list(self.column(table, "time"))


def main():
    silt = os.path.abspath(sys.argv[1])
    faults = []

    def check(label, good, said=""):
        print(f"{'ok  ' if good else 'FAIL'} {label} {said}")
        if not good:
            faults.append(label)

    def difference(a, b, name):
        return np.abs(a[name] - b[name]).max() / max(np.abs(b[name]).max(), 1e-300)

    # Coupled runs add up over ranks in the order messages come in: the same bits on one rank, round-off on several.
    for name, case, half, end, tolerance in (("grains", GRAINS, "0.02", 0.04, 0), ("plastic", PLASTIC, "0.01", 0.02, 0),
                                              ("sticky", STICKY, "0.01", 0.02, 0), ("bed", BED, "0.005", 0.01, 1e-7)):
        with Folder(silt, case) as whole, Folder(silt, case) as parts:
            for ranks in (1, 2, 3):
                figures = EXPECT if name == "grains" else []
                whole.run(ranks, *figures)
                parts.run(ranks, "-time_end", half, *figures, expect=1 if figures else 0)
                keep = parts.file(f"half_{ranks}.h5")
                shutil.copy(parts.file("out", "checkpoint.h5"), keep)
                parts.run(ranks, "-restart", "out/checkpoint.h5", *figures)
                one, two = whole.last(), parts.last()
                label = f"{name}, {ranks} ranks"
                allowed = tolerance if ranks > 1 else 0
                check(f"{label}: same particles", np.array_equal(one["id"], two["id"]))
                for array in ("position", "velocity", "spin"):
                    far = difference(two, one, array)
                    check(f"{label}: {array} as without interruption", far <= allowed, f"{far:.2g}")
                if name == "bed":
                    for array in ("velocity", "pressure", "void_fraction"):
                        far = difference(parts.fluid(), whole.fluid(), array)
                        check(f"{label}: fluid {array} as without interruption", far <= allowed, f"{far:.2g}")
                for table in ("diagnostics.csv", "ledger.csv", "walls.csv"):
                    check(f"{label}: {table} is continued", parts.times(table) == whole.times(table))
                if name == "bed":
                    left = [f.column("ledger.csv", "unaccounted_z") for f in (whole, parts)]
                    far = np.abs(left[0] - left[1]).max() / np.abs(left[0]).max()
                    check(f"{label}: the ledger of the fluid is continued", far <= max(allowed, 1e-9), f"{far:.2g}")
                deepest = [f.column("diagnostics.csv", "largest_overlap").max() for f in (whole, parts)]
                check(f"{label}: particles that come from another rank touch walls as deep as they did", max(deepest) < 0.25, str(deepest))
                if name == "grains":
                    averages = [f.numbers("profile_layers.csv") for f in (whole, parts)]
                    check(f"{label}: averages go on", np.allclose(*averages, rtol=1e-10 if allowed == 0 else 1e-4, atol=1e-12), f"{np.abs(averages[0] - averages[1]).max():.2g}")
                    means = [f.figure() for f in (whole, parts)]
                    check(f"{label}: what is expected covers the whole run", abs(means[0] / means[1] - 1) < 1e-6, str(means))
                xdmf = [open(f.file("out", "particles.xdmf")).read().count("<Time") for f in (whole, parts)]
                check(f"{label}: the series is continued", xdmf[0] == xdmf[1], str(xdmf))
            one = parts.last()
            for ranks in (1, 2, 3):
                other = 1 + ranks % 3
                parts.run(other, "-restart", f"half_{ranks}.h5", "-output_directory", "moved")
                two = parts.last("moved")
                far = difference(two, one, "position")
                check(f"{name}: from {ranks} to {other} ranks", np.array_equal(one["id"], two["id"]) and far < 1e-5, f"{far:.2g}")

    with Folder(silt, GRAINS) as folder:
        # Killed at any instant, a run goes on from its last complete checkpoint.
        running = subprocess.Popen(folder.command(1, ["-time_end", "5"]), cwd=folder.path, stdin=subprocess.DEVNULL,
                                   stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        for _ in range(600):
            if os.path.exists(folder.file("out", "checkpoint.h5")):
                break
            time.sleep(0.1)
        time.sleep(0.05)
        running.send_signal(signal.SIGKILL)
        running.wait()
        with h5py.File(folder.file("out", "checkpoint.h5")) as file:
            reached = float(file.attrs["time"])
        folder.run(2, "-restart", "out/checkpoint.h5", "-time_end", f"{reached + 0.01:.6f}")
        times = folder.times()
        check("a killed run goes on", abs(times[-1] - reached - 0.01) < 1e-6 and all(a < b for a, b in zip(times, times[1:])))

        # What is no checkpoint of this case is refused with one line.
        shutil.copy(folder.file("out", "checkpoint.h5"), folder.file("good.h5"))
        blob = bytearray(open(folder.file("good.h5"), "rb").read())
        with h5py.File(folder.file("good.h5")) as file:
            offset = file["particle_motion"].id.get_offset()
        blob[offset + 100] ^= 1
        open(folder.file("flipped.h5"), "wb").write(blob)
        open(folder.file("cut.h5"), "wb").write(blob[: len(blob) // 2])
        folder.write("text.h5", "no checkpoint")
        foreign = sorted(glob.glob(folder.file("out", "particles", "*.h5")))[0]
        for file, words, options in (("flipped.h5", "damaged", []), ("cut.h5", "damaged", []), ("text.h5", "no HDF5 file", []),
                                     (foreign, "no checkpoint", []), ("nowhere.h5", "does not exist", []),
                                     ("good.h5", "nothing is left to run", ["-time_end", f"{reached:.6f}"]),
                                     ("good.h5", "materials", ["-material_sand_density", "2600"]),
                                     ("good.h5", "walls", ["-wall_extra_type", "sphere", "-wall_extra_side", "outside", "-wall_extra_point", "0.002, 0.002, 0.028", "-wall_extra_radius", "0.001"])):
            for ranks in (1, 2):
                said = folder.run(ranks, "-restart", file, "-output_directory", "refused", *options, expect=2)
                line = [text for text in said.splitlines() if text.startswith("silt: error:")]
                check(f"{os.path.basename(file)} {' '.join(options[:1])}, {ranks} ranks: {words}", len(line) == 1 and words in line[0] and "-restart" in line[0], said if not line else "")
                check("nothing is written", not os.path.exists(folder.file("refused")))

    with Folder(silt, HELD) as folder:
        # A checkpoint changes nothing, nor does a restart: not what a hot wall gives to particles that are held against it.
        for ranks in (1, 2, 3):
            warmth = []
            for options in ([], ["-checkpoint_interval", "0.06"], ["-time_end", "0.1", "-checkpoint_interval", "0.1"]):
                folder.run(ranks, *options)
                warmth.append(folder.column("diagnostics.csv", "mean_temperature_of_particles") - 300)
            other = ranks % 3 + 1
            folder.run(other, "-restart", "out/checkpoint.h5")
            warmth[2] = folder.column("diagnostics.csv", "mean_temperature_of_particles") - 300
            check(f"held particles, {ranks} ranks: warmed by their wall", 0.1 < warmth[0][-1] < 2, str(warmth[0][-1]))
            for label, found in (("with checkpoints", warmth[1]), (f"from {ranks} to {other} ranks", warmth[2])):
                far = np.abs(found - warmth[0]).max() / warmth[0][-1]
                check(f"held particles, {ranks} ranks: as warm {label}", far < 1e-6, f"{far:.2g}")

    with Folder(silt, BALL) as folder:
        for ranks in (1, 2):
            said = folder.run(ranks, expect=1)
            check(f"an error tells where the last good state is, {ranks} ranks", "overlaps" in said and "out/last_good.h5 (-restart)" in said, said[-300:])
            folder.run(ranks, "-restart", "out/last_good.h5", "-particles_overlap_limit", "0.5")
            check("the run goes on from it", abs(folder.times()[-1] - 0.06) < 1e-9)
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
