"""Runs of one options file in a folder of its own, for the tests of the whole program."""
import os
import subprocess


def write_case(folder, text):
    with open(os.path.join(folder, "case.yaml"), "w") as file:
        file.write(text)


def run(silt, folder, *options):
    """(exit code, everything it printed) of case.yaml."""
    done = subprocess.run([silt, "case.yaml", *options], cwd=folder, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                          text=True, timeout=300)
    return done.returncode, done.stdout
