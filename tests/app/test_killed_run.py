#!/usr/bin/env python3
# processors: 2
"""A run that is killed, or whose disk is full, leaves every completed output readable; the next run replaces it."""
import csv
import os
import resource
import signal
import subprocess
import sys
import tempfile
import time

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "support"))
import series

CASE = """\
mesh: {type: box, cell: hexahedron, lower: [0, 0, 0], upper: [0.01, 0.01, 0.03], cells: [2, 2, 6]}
gravity: [0, 0, -9.81]
time: {end: 1000, step: 5.0e-4}
fluid: {density: 1.2, viscosity: 1.8e-5}
boundary:
  z_min: {type: no_slip}
  z_max: {type: pressure}
  x_min: {type: no_slip}
  x_max: {type: no_slip}
  y_min: {type: no_slip}
  y_max: {type: no_slip}
material:
  bead: {density: 1000, young_modulus: 1.0e5, poisson_ratio: 0.3, restitution: 0.5, friction: 0.1}
insertion:
  bed: {type: lattice, material: bead, diameter: 1.2e-3, count: 18, spacing: 2.0e-3, lower: [0.002, 0.002, 0.002], upper: [0.008, 0.008, 0.02]}
drag: {type: gidaspow}
output: {directory: out, interval: 1.0e-3}
"""
LEAST_OUTPUTS = 5
wrong = []


def expect(true, text):
    if not true:
        wrong.append(text)


def count_outputs(folder):
    try:
        return len(series.outputs(folder, "particles"))
    except FileNotFoundError:
        return 0


def fresh(out, started):
    """Whether the run that started then has made the directory its own."""
    record = os.path.join(out, "run.yaml")
    return os.path.exists(record) and os.path.getmtime(record) >= started


def check_left(folder, label):
    """What a stopped run must have left."""
    counts = [len(series.outputs(folder, name)) for name in ("fluid", "particles")]
    expect(abs(counts[0] - counts[1]) <= 1, f"{label}: {counts[0]} outputs of the fluid, {counts[1]} of the particles")
    for name in ("fluid", "particles"):
        wrong.extend(f"{label}: {fault}" for fault in series.faults(folder, name))
        for k, (moment, _) in enumerate(series.outputs(folder, name)):
            expect(abs(moment - 1e-3 * k) < 1e-12, f"{label}: output {k} of {name} is at {moment} s")
    with open(os.path.join(folder, "diagnostics.csv")) as file:
        text = file.read()
    table = list(csv.DictReader(text.splitlines()))
    expect(len(table) >= 2 * (counts[0] - 1), f"{label}: {len(table)} rows of diagnostics for {counts[0]} outputs")
    whole = text.rstrip("\n").splitlines()
    expect(all(len(line.split(",")) == len(whole[0].split(",")) for line in whole[:-1]), f"{label}: a torn row in diagnostics.csv")
    return table


def session(leader):
    """The processes of a session that this test started."""
    found = []
    for name in os.listdir("/proc"):
        try:
            with open(f"/proc/{name}/stat") as file:
                if name.isdigit() and int(file.read().rsplit(")", 1)[1].split()[3]) == leader:
                    found.append(int(name))
        except (OSError, IndexError):
            pass
    return found


def killed(silt, folder, ranks, label):
    out = os.path.join(folder, "out")
    started = time.time()
    run = subprocess.Popen(["mpiexec", "-n", str(ranks), silt, "case.yaml"], cwd=folder, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, start_new_session=True)
    while run.poll() is None and time.time() - started < 120 and not (fresh(out, started) and count_outputs(out) >= LEAST_OUTPUTS):
        time.sleep(0.02)
    ended = run.poll() is not None
    # mpiexec hands nothing on when it is killed itself: its ranks go with it here, all in the session started above.
    for process in session(run.pid):
        try:
            os.kill(process, signal.SIGKILL)
        except ProcessLookupError:
            pass
    text = run.communicate()[0]
    if ended:
        wrong.append(f"{label}: the run ended by itself with {run.returncode}:\n{text[-1500:]}")
        return
    expect(count_outputs(out) >= LEAST_OUTPUTS, f"{label}: {count_outputs(out)} outputs within two minutes:\n{text[-1500:]}")
    check_left(out, label)


def full_disk(silt, folder):
    """Once it runs, no file may grow beyond 60 kB: the next output does."""
    # Python ignores SIGXFSZ, and with restore_signals off so does the run: a write then fails as on a full disk.
    started = time.time()
    run = subprocess.Popen([silt, "case.yaml"], cwd=folder, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, restore_signals=False)
    out = os.path.join(folder, "out")
    while run.poll() is None and time.time() - started < 120 and not (fresh(out, started) and count_outputs(out) >= 2):
        time.sleep(0.02)
    if run.poll() is None:
        resource.prlimit(run.pid, resource.RLIMIT_FSIZE, (60_000, 60_000))
    try:
        errors = run.communicate(timeout=120)[1]
    except subprocess.TimeoutExpired:
        run.kill()
        wrong.append(f"full disk: the run goes on: {run.communicate()}")
        return
    lines = errors.strip().splitlines()
    expect(run.returncode == 1, f"full disk: exit code {run.returncode}: {errors[-500:]}")
    expect(len(lines) == 1 and lines[0].startswith("silt: error: cannot write out/"), f"full disk: {len(lines)} lines on stderr:\n{errors[-1000:]}")
    check_left(out, "full disk")


def main():
    silt = os.path.abspath(sys.argv[1])
    with tempfile.TemporaryDirectory(prefix="silt_killed_") as folder:
        with open(os.path.join(folder, "case.yaml"), "w") as file:
            file.write(CASE)
        killed(silt, folder, 2, "killed on two ranks")
        if wrong:
            print("\n".join(wrong))
            return 1
        note = os.path.join(folder, "out", "notes.txt")
        with open(note, "w") as file:
            file.write("mine")
        # The same directory again: the old outputs are replaced, what is not ours stays.
        killed(silt, folder, 1, "killed on one rank")
        expect(os.path.exists(note), "a file that is not Silt's was removed")
        full_disk(silt, folder)
        # ... and a full run over the remains of a stopped one.
        done = subprocess.run([silt, "case.yaml", "-time_end", "2e-3"], cwd=folder, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        expect(done.returncode == 0, f"after a stopped run: exit code {done.returncode}: {done.stdout[-1000:]}")
        table = check_left(os.path.join(folder, "out"), "after a stopped run")
        expect(len(table) == 5, f"after a stopped run: {len(table)} rows of diagnostics instead of 5")
        numbers = sorted(os.listdir(os.path.join(folder, "out", "particles")))
        expect(numbers == ["000000.h5", "000001.h5", "000002.h5"], f"after a stopped run: {numbers}")
        done = subprocess.run([silt, "case.yaml", "-output_overwrite", "no"], cwd=folder, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        expect(done.returncode == 2 and "holds an earlier run" in done.stderr, f"-output_overwrite no: {done.returncode} {done.stderr}")
    print("\n".join(wrong) if wrong else "stopped runs leave their outputs in order")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
