#!/usr/bin/env python3
# processors: 2
"""What a user may get wrong: one line `silt: error: ...` that names the culprit, exit code 2, and nothing written."""
import concurrent.futures
import os
import subprocess
import sys
import tempfile

CASE = """\
mesh: {type: box, cell: hexahedron, lower: [0, 0, 0], upper: [0.01, 0.01, 0.04], cells: [4, 4, 16]}
gravity: [0, 0, -9.81]
time: {end: 1.0e-3, step: 5.0e-4}
fluid: {density: 1.2, viscosity: 1.8e-5, initial_velocity: "0, 0, 0.3"}
boundary:
  z_min: {type: velocity, velocity: "0, 0, 0.3"}
  z_max: {type: pressure}
  x_min: {type: no_slip}
  x_max: {type: no_slip}
  y_min: {type: no_slip}
  y_max: {type: no_slip}
material:
  bead: {density: 1000, young_modulus: 1.0e6, poisson_ratio: 0.3, restitution: 0.9, friction: 0.1}
normal: {type: tsuji}
tangential: {type: mindlin}
insertion:
  bed: {type: fill, material: bead, diameter: 1.2e-3, count: 30, lower: [0, 0, 0], upper: [0.01, 0.01, 0.02], seed: 1}
drag: {type: gidaspow}
output: {directory: out}
"""
NO_FRICTION = CASE.replace('fluid: {density: 1.2, viscosity: 1.8e-5, initial_velocity: "0, 0, 0.3"}', "fluid: {type: compressible, viscosity: 0, initial_pressure: 1e5, initial_temperature: 300}")
NO_FRICTION = NO_FRICTION.replace('{type: velocity, velocity: "0, 0, 0.3"}', "{type: slip}").replace("{type: pressure}", "{type: slip}")
BOX_ONLY = "mesh: {type: box, cells: [2, 2, 2]}\n"
GMSH_HEAD = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n"
FROM_FILE = ["-insertion_bed_type", "file", "-insertion_bed_file", "start.csv"]
HEADER = "x,y,z,diameter,material\n"


def remove(text):
    """The case without the line, or the words, given."""
    assert text in CASE
    return {"case.yaml": CASE.replace(text, "")}


def change(old, new):
    assert old in CASE
    return {"case.yaml": CASE.replace(old, new)}


def options(*words):
    return list(words)


def from_mesh(mesh, text=None):
    """The case with a Gmsh file, of the text given, in place of the box."""
    box = CASE.splitlines()[0]
    return {**change(box, f"mesh: {{{mesh}}}"), **({} if text is None else {"x.msh": text})}


# (what is wrong, files (over the right case), options, what the line must say)
WRONG = [
    # options as such
    ("a mistyped option on the command line", {}, options("-fluid_viscosty", "1e-5"), ["fluid_viscosty", "fluid_viscosity"]),
    ("a mistyped option in the file", change("viscosity:", "viscosty:"), [], ["fluid_viscosty", "fluid_viscosity", "case.yaml:4"]),
    ("a mistyped group", change("drag: {", "drgg: {"), [], ["drgg_type", "drag_type"]),
    ("a mistyped option of a boundary", change("z_min: {type: velocity, velocity:", "z_min: {type: velocity, velocty:"), [], ["velocty"]),
    ("a mistyped option of a material", change("poisson_ratio", "poison_ratio"), [], ["poison_ratio"]),
    ("a mistyped option of an insertion", change("diameter", "diametre"), [], ["diametre"]),
    ("a negative density", {}, options("-fluid_density", "-1"), ["-fluid_density", "'-1'", "> 0"]),
    ("a word for a number", {}, options("-fluid_density", "heavy"), ["-fluid_density", "'heavy'", "kg/m3"]),
    ("a number followed by rubbish", {}, options("-fluid_density", "1.2x"), ["-fluid_density", "1.2x"]),
    ("an infinite viscosity", {}, options("-fluid_viscosity", "inf"), ["-fluid_viscosity", "inf"]),
    ("a fraction for a whole number", {}, options("-insertion_bed_count", "30.5"), ["-insertion_bed_count", "30.5"]),
    ("a time step of zero", {}, options("-time_step", "0"), ["-time_step"]),
    ("an end before the start", {}, options("-time_end", "-1"), ["-time_end"]),
    ("a formula without a value", {}, options("-fluid_initial_velocity", "0, 0, sqrt(x - 0.005)"), ["-fluid_initial_velocity", "sqrt(x - 0.005)", "no finite number"]),
    ("a mass flow that depends on the place", change('z_min: {type: velocity, velocity: "0, 0, 0.3"}', 'z_min: {type: mass_flow, mass_flow: "1e-4*x"}'), [], ["-boundary_z_min_mass_flow", "1e-4*x", "-boundary_z_min_profile"]),
    ("gravity with two numbers", {}, options("-gravity", "0,-9.81"), ["-gravity", "three numbers"]),
    ("neither yes nor no", {}, options("-output_overwrite", "perhaps"), ["-output_overwrite", "perhaps"]),
    ("an unknown precision", {}, options("-output_precision", "quad"), ["-output_precision", "double, single"]),
    ("BDF of order 3", {}, options("-fluid_order", "3"), ["-fluid_order"]),
    # files
    ("a missing options file", {}, options("nowhere.yaml"), ["nowhere.yaml"]),
    ("a folder for an options file", {"folder/x": ""}, options("folder"), ["folder"]),
    ("malformed YAML", {"case.yaml": CASE + "time: {end: 1\n  step"}, [], ["case.yaml"]),
    ("a list for an options file", {"case.yaml": "- 1\n- 2\n"}, [], ["case.yaml"]),
    ("an option without a value", change("drag: {type: gidaspow}", "drag:\n  type:"), [], ["drag_type", "case.yaml"]),
    ("a list of maps", change("cells: [4, 4, 16]", "cells: [{a: 1}]"), [], ["mesh_cells", "case.yaml"]),
    ("an include that is not there", {"case.yaml": "include: other.yaml\n" + CASE}, [], ["other.yaml"]),
    ("includes in a circle", {"case.yaml": "include: case.yaml\n" + CASE}, [], ["case.yaml", "circle"]),
    # mesh
    ("an unknown kind of mesh", {}, options("-mesh_type", "ball"), ["-mesh_type", "box"]),
    ("an unknown cell", {}, options("-mesh_cell", "prism"), ["-mesh_cell", "hexahedron"]),
    ("no cells along x", {}, options("-mesh_cells", "0,4,16"), ["-mesh_cells"]),
    ("a box without volume", {}, options("-mesh_upper", "0.01,0,0.04"), ["-mesh_upper"]),
    ("a mesh file that is not there", from_mesh("file: nowhere.msh"), [], ["nowhere.msh"]),
    ("no mesh file named", from_mesh("type: file"), [], ["-mesh_file"]),
    ("a mesh file and a box", {}, options("-mesh_file", "x.msh"), ["-mesh_file", "-mesh_type box"]),
    ("a mesh file that is to be periodic", from_mesh("file: x.msh, periodic: [1, 0, 0]"), [], ["-mesh_periodic", "-mesh_type file"]),
    ("a mesh file that is not Gmsh's", from_mesh("file: x.msh", "solid body\nendsolid\n"), [], ["x.msh"]),
    ("an empty mesh file", from_mesh("file: x.msh", ""), [], ["x.msh"]),
    ("a mesh file cut off", from_mesh("file: x.msh", GMSH_HEAD + "$Nodes\n8\n1 0 0 0\n2 1 0"), [], ["x.msh"]),
    ("a mesh file of another version", from_mesh("file: x.msh", "$MeshFormat\n1.0 0 8\n$EndMeshFormat\n"), [], ["x.msh"]),
    ("a mesh of curved cells", from_mesh("file: x.msh", GMSH_HEAD + "$Nodes\n1\n1 0 0 0\n$EndNodes\n$Elements\n1\n1 9 2 1 1 1 1 1 1 1 1\n$EndElements\n"), [], ["x.msh", "line 10", "linear"]),
    ("a node that is not there", from_mesh("file: x.msh", GMSH_HEAD + "$Nodes\n1\n1 0 0 0\n$EndNodes\n$Elements\n1\n1 1 2 1 1 1 7\n$EndElements\n"), [], ["x.msh", "line 10", "node 7"]),
    ("periodic with one cell", {}, options("-mesh_cells", "1,4,16", "-mesh_periodic", "1,0,0"), ["periodic"]),
    # boundaries
    ("a boundary without a condition", remove("  x_min: {type: no_slip}\n"), [], ["x_min"]),
    ("a boundary that does not exist", {}, options("-boundary_lid_type", "no_slip"), ["lid", "x_min"]),
    ("an unknown condition", {}, options("-boundary_x_min_type", "sticky"), ["-boundary_x_min_type", "no_slip"]),
    ("a condition on a periodic side", {}, options("-mesh_periodic", "1,0,0"), ["x_m"]),
    ("an expression that does not end", {}, options("-boundary_z_min_velocity", "0, 0, sin("), ["boundary_z_min_velocity"]),
    ("an unknown variable", {}, options("-boundary_z_min_velocity", "0, 0, 0.3*q"), ["boundary_z_min_velocity", "q"]),
    ("a velocity of two components", {}, options("-boundary_z_min_velocity", "0, 0.3"), ["boundary_z_min_velocity"]),
    ("a velocity inlet without velocity", change('z_min: {type: velocity, velocity: "0, 0, 0.3"}', "z_min: {type: velocity}"), [], ["z_min", "velocity"]),
    ("an unknown wall for particles", {}, options("-boundary_x_min_particles", "sponge"), ["-boundary_x_min_particles"]),
    ("a wall of an unknown material", {}, options("-boundary_x_min_material", "steel"), ["steel"]),
    # materials and laws
    ("a material without a density", remove("density: 1000, "), [], ["density", "bead"]),
    ("a restitution above one", {}, options("-material_bead_restitution", "1.5"), ["-material_bead_restitution"]),
    ("a Poisson ratio above one half", {}, options("-material_bead_poisson_ratio", "0.7"), ["-material_bead_poisson_ratio"]),
    ("a pair of a material that is not there", {}, options("-pair_bead_steel_friction", "0.3"), ["steel"]),
    ("a pair of materials given twice", {}, options("-material_steel_density", "7800", "-pair_bead_steel_friction", "0.3", "-pair_steel_bead_friction", "0.4"), ["-pair_bead_steel", "-pair_steel_bead", "same pair"]),
    ("an unknown drag law", {}, options("-drag_type", "gidaspov"), ["-drag_type", "gidaspow"]),
    ("an unknown normal law", {}, options("-normal_type", "hooke"), ["-normal_type", "linear"]),
    ("an unknown rolling law", {}, options("-rolling_type", "square"), ["-rolling_type", "constant"]),
    ("an unknown scheme", {}, options("-fluid_scheme", "simple"), ["-fluid_scheme", "pressure_correction"]),
    ("Taylor-Hood with pressure correction", {}, options("-fluid_element", "taylor_hood"), ["taylor_hood"]),
    # particles
    ("an insertion of an unknown material", {}, options("-insertion_bed_material", "bean"), ["bean", "bead"]),
    ("an unknown kind of insertion", {}, options("-insertion_bed_type", "pour"), ["-insertion_bed_type", "fill"]),
    ("a disc of a stream without a direction", {}, options("-insertion_s_type", "stream", "-insertion_s_diameter", "1e-3", "-insertion_s_number_rate", "10", "-insertion_s_centre", "0.005,0.005,0.03", "-insertion_s_radius", "0.003", "-insertion_s_normal", "0,0,0"), ["-insertion_s_normal", "direction"]),
    ("a plane without a direction", {}, options("-wall_a_type", "plane", "-wall_a_point", "0,0,0.001", "-wall_a_normal", "0,0,0"), ["-wall_a_normal", "direction"]),
    ("a cylinder without a direction", {}, options("-wall_a_type", "cylinder", "-wall_a_point", "0.005,0.005,0", "-wall_a_radius", "0.004", "-wall_a_axis", "0,0,0"), ["-wall_a_axis", "direction"]),
    ("the depth of a mesh in space", {}, options("-coupling_depth", "0.01"), ["-coupling_depth", "2D"]),
    ("drag in a gas without viscosity", {"case.yaml": NO_FRICTION}, [], ["-fluid_viscosity 0", "drag"]),
    ("a negative diameter", {}, options("-insertion_bed_diameter", "-1e-3"), ["-insertion_bed_diameter"]),
    ("more particles than fit", {}, options("-insertion_bed_count", "5000"), ["insertion_bed", "5000"]),
    ("particles larger than the box", {}, options("-insertion_bed_diameter", "0.02"), ["insertion_bed"]),
    ("a region outside the mesh", {}, options("-insertion_bed_lower", "1,1,1", "-insertion_bed_upper", "2,2,2"), ["insertion_bed"]),
    ("a region upside down", {}, options("-insertion_bed_lower", "0,0,0.03"), ["insertion_bed"]),
    ("a particle file that is not there", {}, FROM_FILE, ["start.csv"]),
    ("a particle file without positions", {"start.csv": "a,b\n1,2\n"}, FROM_FILE, ["start.csv"]),
    ("a particle file with a word for a number", {"start.csv": HEADER + "0.005,oops,0.01,0.001,bead\n"}, FROM_FILE, ["start.csv", "oops"]),
    ("a particle file with a short line", {"start.csv": HEADER + "0.005,0.005\n"}, FROM_FILE, ["start.csv"]),
    ("a particle file with an unknown material", {"start.csv": HEADER + "0.005,0.005,0.01,0.001,bean\n"}, FROM_FILE, ["bean"]),
    ("a particle outside the mesh", {"start.csv": HEADER + "0.5,0.005,0.01,0.001,bead\n"}, FROM_FILE, ["start.csv:2"]),
    ("particles that overlap", {"start.csv": HEADER + "0.005,0.005,0.01,0.001,bead\n0.0052,0.005,0.01,0.001,bead\n"}, FROM_FILE, ["overlap"]),
    ("a particle in a wall", {"start.csv": HEADER + "0.0001,0.005,0.01,0.001,bead\n"}, FROM_FILE, ["overlap"]),
    ("a check of particles that overlap", {"start.csv": HEADER + "0.005,0.005,0.01,0.001,bead\n0.0052,0.005,0.01,0.001,bead\n"}, FROM_FILE + ["-check"], ["overlap"]),
    ("a check of a particle in a wall", {"start.csv": HEADER + "0.0001,0.005,0.01,0.001,bead\n"}, FROM_FILE + ["-check"], ["overlap"]),
    ("a particle file that is not HDF5", {"start.h5": "text"}, options("-insertion_bed_type", "file", "-insertion_bed_file", "start.h5"), ["start.h5"]),
    ("a particle step too long for the contacts", {}, options("-particles_step", "1e-3"), ["-particles_step"]),
    ("settling for a negative time", {}, options("-settle_time", "-1"), ["-settle_time"]),
    ("nothing to run", {"case.yaml": BOX_ONLY + "fluid: {type: none}\n"}, [], ["fluid_type", "insertion"]),
    ("nothing said of a fluid or particles", {"case.yaml": BOX_ONLY}, [], ["fluid_type", "insertion"]),
    # output and figures
    ("a file in place of the output directory", {"out": "mine"}, [], ["out", "-output_directory"]),
    ("an output directory below a file", {"mine": ""}, options("-output_directory", "mine/out"), ["mine/out"]),
    ("an output directory that takes no files", {}, options("-output_directory", "/proc/silt"), ["/proc/silt"]),
    ("an output directory of somebody else", {"out/diagnostics.csv": "mine"}, [], ["out", "diagnostics.csv"]),
    ("an earlier run that must stay", {"out/run.yaml": "mine"}, options("-output_overwrite", "no"), ["out", "-output_overwrite"]),
    ("an expectation of an unknown quantity", {}, options("-expect_a_quantity", "bed_hight", "-expect_a_value", "1", "-expect_a_tolerance", "1"), ["bed_hight", "bed_height"]),
    ("a ring of two thicknesses", {}, options("-profile_a_axis", "z", "-profile_a_from", "0.002,0,0.01", "-profile_a_to", "0.003,0,0.01", "-profile_a_size", "1e-3,2e-3,1e-2"), ["-profile_a_size", "thickness", "about z"]),
    ("an expectation of an unknown statistic of the particles", {}, options("-expect_a_quantity", "particles.diameter_mass_110", "-expect_a_value", "1", "-expect_a_tolerance", "1"), ["diameter_mass_110", "share_<material> of bead"]),
    ("an expectation without a tolerance", {}, options("-expect_a_quantity", "bed_height", "-expect_a_value", "1"), ["-expect_a_tolerance"]),
    ("a probe outside the mesh", {}, options("-probe_a_point", "1,1,1"), ["probe_a"]),
    ("a line outside the mesh", {}, options("-line_a_from", "0,0,0", "-line_a_to", "0,0,7", "-line_a_points", "5"), ["line_a"]),
    ("a tolerance of the ledger that is no number", {}, options("-ledger_tolerance", "strict"), ["-ledger_tolerance"]),
]
# Every rank must find the same fault, or one says it and takes the others along: no hang, still one line of ours.
ON_TWO_RANKS = {
    "a mistyped option on the command line", "a missing options file", "a mesh file that is not there",
    "a mesh file that is not Gmsh's", "a boundary without a condition", "a material without a density", "more particles than fit",
    "a particle outside the mesh", "particles that overlap", "a check of particles that overlap", "a particle file with a word for a number",
    "a file in place of the output directory", "a probe outside the mesh", "an expression that does not end",
}


def listing(folder):
    return sorted(os.path.relpath(os.path.join(at, name), folder) for at, folders, names in os.walk(folder) for name in folders + names)


def attempt(silt, ranks, files, words):
    """(exit code, stdout, stderr, files that appeared) of one run; exit code None when it did not end."""
    with tempfile.TemporaryDirectory(prefix="silt_bad_input_") as folder, tempfile.TemporaryDirectory(prefix="silt_mpi_") as sockets:
        for name, text in {"case.yaml": CASE, **files}.items():
            os.makedirs(os.path.dirname(os.path.join(folder, name)), exist_ok=True)
            with open(os.path.join(folder, name), "w") as file:
                file.write(text)
        before = listing(folder)
        command = (["mpiexec", "-n", str(ranks)] if ranks > 1 else []) + [silt, "case.yaml"] + words
        try:
            # Two programs that start at once must not share the folder of Open MPI's sockets.
            environment = dict(os.environ, OMPI_MCA_orte_tmpdir_base=sockets)
            done = subprocess.run(command, cwd=folder, env=environment, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, timeout=120)
        except subprocess.TimeoutExpired:
            return None, "", "", []
        return done.returncode, done.stdout, done.stderr, sorted(set(listing(folder)) - set(before))


def fault(silt, ranks, wrong):
    """What is wrong with the answer to a wrong input, or None."""
    _, files, words, must_say = wrong
    code, out, errors, appeared = attempt(silt, ranks, files, words)
    if code is None:
        return "did not end"
    lines = errors.strip().splitlines()
    said = [line for line in lines if line.startswith("silt: error: ")]
    shown = "\n    ".join(lines[:6] or out.splitlines()[-6:])
    if code != 2:
        return f"exit code {code} instead of 2\n    {shown}"
    # mpiexec adds its own lines about the exit code.
    if len(said) != 1 or (ranks == 1 and len(lines) != 1):
        return f"{len(said)} lines `silt: error:` among {len(lines)}\n    {shown}"
    missing = [word for word in must_say if word not in said[0]]
    if missing:
        return f"does not say {' and '.join(missing)}:\n    {said[0]}"
    if appeared:
        return f"wrote {' '.join(appeared)}"
    return None


def main():
    silt = os.path.abspath(sys.argv[1])
    only = sys.argv[2] if len(sys.argv) > 2 else ""
    code, out, errors, _ = attempt(silt, 1, {}, ["-check"])
    faults = []
    if code != 0 or errors.strip():
        faults.append(f"the right case is refused with {code}: {errors or out}")
    jobs = [(1, wrong) for wrong in WRONG] + [(2, wrong) for wrong in WRONG if wrong[0] in ON_TWO_RANKS]
    jobs = [job for job in jobs if only in job[1][0]]
    assert only or len(jobs) == len(WRONG) + len(ON_TWO_RANKS), "a name in ON_TWO_RANKS is not in WRONG"
    with concurrent.futures.ThreadPoolExecutor(2) as pool:
        for (ranks, wrong), answer in zip(jobs, pool.map(lambda job: fault(silt, *job), jobs)):
            if answer:
                faults.append(f"{wrong[0]} ({ranks} rank{'s' if ranks > 1 else ''}): {answer}")
    print("\n".join(faults))
    print(f"{len(jobs)} wrong inputs, {len(faults)} answered wrongly")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
