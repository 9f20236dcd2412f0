"""The under-expanded jet of bench/fluid --jet: Silt beside OpenFOAM's rhoPimpleFoam and rhoCentralFoam, one core.

Air (0.69 MPa, 300 K at rest) leaves a choked nozzle of 0.46 mm into air at 101,325 Pa; realizable k-epsilon, around an axis, 30 x 12 mm.
OpenFOAM gets a wedge of 75,000 cells, Silt a mesh of 74,909 nodes. Each starts impulsively.
"""
import csv
import os
import re
import shutil
import subprocess
import tempfile

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
OPENFOAM = "/usr/share/openfoam"
FINE = (200, 300, 24, 56, 70)  # cells: x near, x far, r nozzle, r near, r far


def dictionary(name, kind, text):
    return f"FoamFile {{ version 2.0; format ascii; class {kind}; object {name}; }}\n{text}\n"


def field(name, kind, dimensions, inside, inlet, plate, farfield, outlet):
    patches = {"inlet": inlet, "plate": plate, "farfield": farfield, "outlet": outlet, "wedge1": "type wedge;", "wedge2": "type wedge;", "axis": "type empty;"}
    body = "\n".join(f"{patch} {{ {text} }}" for patch, text in patches.items())
    return dictionary(name, f"vol{kind}Field", f"dimensions {dimensions};\ninternalField uniform {inside};\nboundaryField\n{{\n{body}\n}}")


def scalar(name, dimensions, inside, inlet):
    away = f"type inletOutlet; inletValue uniform {inside}; value uniform {inside};"
    return field(name, "Scalar", dimensions, inside, f"type fixedValue; value uniform {inlet};", "type zeroGradient;", away, away)


def passive(name, dimensions):
    here = "type calculated; value uniform 0;"
    return field(name, "Scalar", dimensions, 0, here, here, here, here)


def mesh(cells):
    nx1, nx2, nr1, nr2, nr3 = cells
    x, r = (0, 2.5, 30), (0.23, 1.0, 12.0)
    cos, sin = 0.999048222, 0.0436193874  # 2.5 degrees
    points = [f"({a} 0 0)" for a in x]
    for sign in (-1, 1):
        points += [f"({a} {b * cos:.9g} {sign * b * sin:.9g})" for b in r for a in x]
    at = lambda side, row, column: column if row == 0 else 3 + 9 * side + 3 * (row - 1) + column  # rows from the axis out
    blocks, rows = [], ((nr1, 1), (nr2, 2), (nr3, 25))
    for row, (count, grade) in enumerate(rows):
        for column, (along, stretch) in enumerate(((nx1, 1), (nx2, 22))):
            corners = [at(side, row + up, column + over) for side in (0, 1) for up, over in ((0, 0), (0, 1), (1, 1), (1, 0))]
            blocks.append(f"hex ({' '.join(map(str, corners))}) ({along} {count} 1) simpleGrading ({stretch} {grade} 1)")
    face = lambda *c: "(" + " ".join(map(str, c)) + ")"
    across = lambda column, row: face(at(0, row, column), at(0, row + 1, column), at(1, row + 1, column), at(1, row, column))
    side = lambda s: " ".join(face(at(s, row, c), at(s, row, c + 1), at(s, row + 1, c + 1), at(s, row + 1, c)) for row in range(3) for c in range(2))
    patches = {
        "inlet": ("patch", across(0, 0)),
        "plate": ("patch", across(0, 1) + across(0, 2)),
        "outlet": ("patch", " ".join(across(2, row) for row in range(3))),
        "farfield": ("patch", " ".join(face(at(0, 3, c), at(0, 3, c + 1), at(1, 3, c + 1), at(1, 3, c)) for c in range(2))),
        "wedge1": ("wedge", side(0)),
        "wedge2": ("wedge", side(1)),
        "axis": ("empty", "(0 1 1 0) (1 2 2 1)"),
    }
    boundary = "\n".join(f"{name} {{ type {kind}; faces ({faces}); }}" for name, (kind, faces) in patches.items())
    return f"scale 0.001;\nvertices ({' '.join(points)});\nblocks ({' '.join(blocks)});\nboundary\n(\n{boundary}\n);"


def write_peer(folder, cells, application, step, end):
    adjust = "yes" if application == "rhoCentralFoam" else "no"
    files = {
        "system/controlDict": dictionary("controlDict", "dictionary", f"application {application}; startFrom startTime; startTime 0; stopAt endTime; endTime {end}; deltaT {step};\n"
                                         f"adjustTimeStep {adjust}; maxCo 0.4; maxDeltaT 1e-6; writeControl timeStep; writeInterval 1000000; writeFormat ascii; timePrecision 10; runTimeModifiable no;"),
        "system/fvSchemes": dictionary("fvSchemes", "dictionary", "fluxScheme Kurganov; ddtSchemes { default Euler; } gradSchemes { default Gauss linear; }\ndivSchemes { default none; div(tauMC) Gauss linear; "
                                       "div(phi,U) Gauss limitedLinearV 1; div(phi,e) Gauss limitedLinear 1; div(phid,p) Gauss limitedLinear 1;\ndiv(phi,K) Gauss limitedLinear 1; div(phiv,p) Gauss limitedLinear 1; "
                                       "div(phi,k) Gauss upwind; div(phi,epsilon) Gauss upwind; div(((rho*nuEff)*dev2(T(grad(U))))) Gauss linear; }\nlaplacianSchemes { default Gauss linear corrected; }\n"
                                       "interpolationSchemes { default linear; reconstruct(rho) vanLeer; reconstruct(U) vanLeerV; reconstruct(T) vanLeer; } snGradSchemes { default corrected; }"),
        "system/fvSolution": dictionary("fvSolution", "dictionary", 'solvers { "(rho|rhoU|rhoE)" { solver diagonal; } "(rho|rhoU|rhoE)Final" { solver diagonal; }\n'
                                        '"(U|e|k|epsilon).*" { solver smoothSolver; smoother symGaussSeidel; nSweeps 1; tolerance 1e-9; relTol 0.01; }\n"p.*" { solver PBiCGStab; preconditioner DILU; tolerance 1e-8; relTol 0.01; } }\n'
                                        "PIMPLE { momentumPredictor yes; transonic yes; nOuterCorrectors 1; nCorrectors 2; nNonOrthogonalCorrectors 0; }"),
        "system/blockMeshDict": dictionary("blockMeshDict", "dictionary", mesh(cells)),
        "constant/thermophysicalProperties": dictionary("thermophysicalProperties", "dictionary", "thermoType { type hePsiThermo; mixture pureMixture; transport sutherland; thermo hConst; equationOfState perfectGas; specie specie; energy sensibleInternalEnergy; }\n"
                                                        "mixture { specie { molWeight 28.96; } thermodynamics { Cp 1004.5; Hf 0; } transport { As 1.458e-06; Ts 110.4; Pr 0.71; } }"),
        "constant/turbulenceProperties": dictionary("turbulenceProperties", "dictionary", "simulationType RAS; RAS { RASModel realizableKE; turbulence on; printCoeffs off; }"),
        "0/T": scalar("T", "[0 0 0 1 0 0 0]", 300, 250),
        "0/k": scalar("k", "[0 2 -2 0 0 0 0]", 1, 377),
        "0/epsilon": scalar("epsilon", "[0 2 -3 0 0 0 0]", 1000, 3.7e7),
        "0/nut": passive("nut", "[0 2 -1 0 0 0 0]"),
        "0/alphat": passive("alphat", "[1 -1 -1 0 0 0 0]"),
        "0/U": field("U", "Vector", "[0 1 -1 0 0 0 0]", "(0 0 0)", "type fixedValue; value uniform (316.95 0 0);", "type slip;",
                     *2 * ["type pressureInletOutletVelocity; value uniform (0 0 0);"]),
        "0/p": field("p", "Scalar", "[1 -1 -2 0 0 0 0]", 101325, "type fixedValue; value uniform 364515;", "type zeroGradient;",
                     "type totalPressure; p0 uniform 101325; psi thermo:psi; gamma 1.4; value uniform 101325;",
                     "type waveTransmissive; field p; psi thermo:psi; gamma 1.4; fieldInf 101325; lInf 0.03; value uniform 101325;"),
    }
    for name, text in files.items():
        path = os.path.join(folder, name)
        os.makedirs(os.path.dirname(path), exist_ok=True)
        with open(path, "w") as file:
            file.write(text)


def peer(application, cells, step, steps):
    """Wall seconds a microsecond of flow, over the second half of the steps."""
    with tempfile.TemporaryDirectory() as folder:
        end = step * steps if application == "rhoPimpleFoam" else 1.0
        write_peer(folder, cells, application, step, end)
        env = dict(os.environ, WM_PROJECT_DIR=OPENFOAM)
        subprocess.run(["blockMesh"], cwd=folder, env=env, check=True, stdout=subprocess.DEVNULL)
        times = []
        process = subprocess.Popen([application], cwd=folder, env=env, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        now, log = 0.0, []
        for line in process.stdout:
            log.append(line)
            if found := re.match(r"Time = (\S+)", line):
                now = float(found.group(1))
            elif found := re.match(r"ExecutionTime = (\S+) s", line):
                times.append((now, float(found.group(1))))
                if len(times) >= steps:
                    break
        process.kill()
        process.wait()
        if len(times) < steps:
            raise SystemExit(f"bench/fluid --jet: {application} ended after {len(times)} steps:\n" + "".join(log[-10:]))
    (t0, s0), (t1, s1) = times[len(times) // 2 - 1], times[-1]
    return (s1 - s0) / (t1 - t0) * 1e-6, (t1 - t0) / (len(times) - len(times) // 2)


def silt_mesh(folder, n):
    gmsh = shutil.which("gmsh")
    if not gmsh:
        raise SystemExit("bench/fluid --jet needs gmsh (Debian package)")
    path = os.path.join(folder, "jet.msh")
    subprocess.run([gmsh, "-2", "-format", "msh22", "-setnumber", "n", str(n), os.path.join(ROOT, "inputs", "fluid", "jet_k_epsilon.geo"), "-o", path],
                   check=True, stdout=subprocess.DEVNULL)
    return path


def silt(case_options, folder, log_name):
    """Runs Silt on the mesh of 74,909 nodes; returns [(time, dt, wall)] from its own table and the parts of the wall time."""
    case = os.path.join(ROOT, "inputs", "fluid", "jet_k_epsilon.yaml")
    words = [os.path.join(ROOT, "build", "silt"), case, "-mesh_file", os.path.join(folder, "jet.msh"), "-output_directory", os.path.join(folder, log_name), "-log_view"]
    for name, value in case_options.items():
        words += ["-" + name, str(value)]
    done = subprocess.run(words, cwd=folder, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, env=dict(os.environ, OMP_NUM_THREADS="1", OPENBLAS_NUM_THREADS="1"))
    found = re.search(r"timing loop ([0-9.]+) s: .*?output ([0-9.]+); (\d+) steps", done.stdout)
    if not found:
        raise SystemExit("bench/fluid --jet: silt failed:\n" + "\n".join(done.stdout.splitlines()[-15:]))
    share = {name: float(value) for name, value in re.findall(r"^(KSPSolve|PCSetUp|SNESFunctionEval|SNESJacobianEval) +\d+ \S+ (\S+)", done.stdout, re.M)}
    return float(found.group(1)) - float(found.group(2)), int(found.group(3)), share


def gates():
    """The steady jet of inputs/fluid/jet_k_epsilon.yaml, read along its axis every 6.25 um, a third of a cell."""
    with tempfile.TemporaryDirectory() as folder:
        words = [os.path.join(ROOT, "build", "silt"), os.path.join(ROOT, "inputs", "fluid", "jet_k_epsilon.yaml"), "-output_directory", os.path.join(folder, "gates"), "-line_centreline_points", "4785"]
        subprocess.run(words, cwd=folder, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.STDOUT, env=dict(os.environ, OMP_NUM_THREADS="1", OPENBLAS_NUM_THREADS="1"))
        line = os.path.join(folder, "gates", "line_centreline.csv")  # the run's own verdicts may differ: they are not these
        if not os.path.exists(line):
            raise SystemExit("bench/fluid --jet: silt failed on inputs/fluid/jet_k_epsilon.yaml")
        with open(line) as file:
            rows = list(csv.DictReader(file))
    rows = [row for row in rows if row["time"] == rows[-1]["time"]]
    x, mach, pressure, speed = ([float(row[name]) for row in rows] for name in ("x", "mach", "pressure", "velocity_x"))
    at = lambda place: speed[min(range(len(x)), key=lambda k: abs(x[k] - place))]
    front = range(sum(place < 0.4e-3 for place in x), sum(place < 1.6e-3 for place in x))
    rises = [pressure[k + 1] - pressure[k] for k in front]
    steepest = [k for k, rise in zip(front, rises) if rise > 0.999 * max(rises)]  # within a cell the pressure is linear
    disk = 0.5e3 * (x[steepest[0]] + x[steepest[-1] + 1])
    peak = max(front, key=lambda k: mach[k])
    verdict = lambda value, low, high: f"{low:g} to {high:g}: {'met' if low <= value <= high else 'missed'}"
    print(f"jet 8008 mach_disk {1e3 * x[peak]:.3f} mm by the largest Mach number, as rhoCentralFoam's 0.80 mm was read ({verdict(1e3 * x[peak], 0.75, 0.85)}); "
          f"pressure rises most steeply at {disk:.3f} mm (rhoCentralFoam 0.876)")
    print(f"jet 8008 peak_mach {mach[peak]:.2f} ({verdict(mach[peak], 3.3, 3.8)})")
    for place, given in ((0.01, 244.3), (0.02, 110.9)):
        print(f"jet 8008 speed_at_{1e3 * place:g}_mm {at(place):.1f} m/s, rhoCentralFoam {given} ({verdict(at(place), 0.9 * given, 1.1 * given)})", flush=True)


def jet(end=6e-6):
    gates()
    pimple, pimple_step = peer("rhoPimpleFoam", FINE, 2e-8, 20)
    central, central_step = peer("rhoCentralFoam", FINE, 1e-9, 20)
    with tempfile.TemporaryDirectory() as folder:
        silt_mesh(folder, 2)
        wall, count, share = silt({"time_end": end, "output_interval": end}, folder, "march")
        cost = wall / (end * 1e6)
        print(f"jet 75000 wall seconds per microsecond of flow: rhopimplefoam {pimple:.3g} (step {pimple_step:.2g} s) rhocentralfoam {central:.3g} (step {central_step:.2g} s) "
              f"silt {cost:.3g} (marched to the steady state, mean step {end / count:.2g} s) ratio {cost / pimple:.3g} (at most 1.5) {cost / central:.3g} (at most {1 / 6:.3g})")
        parts = ", ".join(f"{name} {value:.3g} s" for name, value in share.items())
        print(f"jet silt {wall / count:.3g} s a step of {count}; of {wall:.3g} s in all: {parts}; the rest: what is held fixed in a step, turbulence, balances")
