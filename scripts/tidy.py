"""clang-tidy over files of src that changed: tidy.py BUILD CORES [file.cpp ...], called by scripts/lint.

A file that passed leaves a stamp in BUILD/lint with a hash of what the verdict depends on: the file and the headers of
ours that it includes (the compiler's -MM list), .clang-tidy, the compile command and the version of clang-tidy.
"""

import concurrent.futures
import hashlib
import json
import pathlib
import shlex
import subprocess
import sys

root = pathlib.Path(__file__).resolve().parent.parent


def commands(build):
    """The compile command of every file, as words, without the compiler's precompiled headers; BUILD/lint has them for clang-tidy."""
    entries = json.loads((build / "compile_commands.json").read_text())
    for entry in entries:
        words = shlex.split(entry["command"])
        for k in [k for k, word in enumerate(words) if word == "-include" and "cmake_pch" in words[k + 1]]:
            words[k : k + 2] = []
        entry["command"] = shlex.join(word for word in words if word not in ("-Winvalid-pch", "-fpch-preprocess"))
    (build / "lint").mkdir(exist_ok=True)
    (build / "lint" / "compile_commands.json").write_text(json.dumps(entries))
    return {pathlib.Path(entry["file"]): shlex.split(entry["command"]) for entry in entries}


def dependencies(words):
    """The file of a compile command and our headers that it includes."""
    end = words.index("-o")  # -o OBJECT -c FILE
    rule = subprocess.run(words[:end] + ["-MM", words[-1]], capture_output=True, text=True, check=True).stdout
    return sorted(set(rule.split(":", 1)[1].replace("\\\n", " ").split()))


def key(words, common):
    """Hash of all that decides what clang-tidy says of a file."""
    digest = hashlib.sha256(common)
    digest.update(" ".join(words).replace(str(root), "").encode())
    for name in dependencies(words):
        digest.update(pathlib.Path(name).read_bytes())
    return digest.hexdigest()


def check(build, file, words, common):
    """(skipped, passed, what clang-tidy says)"""
    stamp = build / "lint" / str(file.relative_to(root)).replace("/", "__")
    now = key(words, common)
    if stamp.exists() and stamp.read_text() == now:
        return True, True, ""
    run = subprocess.run(["clang-tidy", "--quiet", "-p", str(build / "lint"), str(file)], capture_output=True, text=True)
    if run.returncode == 0:
        stamp.write_text(now)
        return False, True, ""
    stamp.unlink(missing_ok=True)
    return False, False, run.stdout or run.stderr


def main():
    build, cores = pathlib.Path(sys.argv[1]), int(sys.argv[2])
    known = commands(build)
    if len(sys.argv) > 3:
        files = [pathlib.Path(name).resolve() for name in sys.argv[3:]]
    else:
        # What is compiled for each instruction set includes the same code again; once is enough.
        files = sorted(file for file in known if file.is_relative_to(root / "src") and "_avx" not in file.name)
    for file in files:
        if file not in known:
            sys.exit(f"lint: error: {file} is not compiled (a header is checked with the files that include it)")
    version = subprocess.run(["clang-tidy", "--version"], capture_output=True, check=True).stdout
    common = version + (root / ".clang-tidy").read_bytes()
    failed, skipped = 0, 0
    with concurrent.futures.ThreadPoolExecutor(cores) as pool:
        for done in concurrent.futures.as_completed(pool.submit(check, build, file, known[file], common) for file in files):
            unchanged, passed, text = done.result()
            skipped += unchanged
            failed += not passed
            print(text, end="", flush=True)
    if failed:
        sys.exit(f"lint: clang-tidy finds fault with {failed} of {len(files)} files")
    print(f"lint: clang-tidy is clean over {len(files)} files ({skipped} unchanged since they passed)")


main()
