#!/usr/bin/env python3
# labels: fast
"""`silt -models` lists every law by slot, name, equation and source; a law of the chapter that is missing fails, and so
does one that no case of `scripts/verify models` verifies."""
import os
import re
import subprocess
import sys

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "scripts"))
from models_page import declared, verifying  # noqa: E402

# Laws that must be there, by slot.
LAWS = {
    "normal": "lennard_jones langston linear lee_herrmann kuwabara_kono tsuji walton_braun thornton",
    "tangential": "viscous spring spring_dashpot mindlin walton_braun",
    "twisting": "none twisting",
    "rolling": "none spring viscous_coulomb constant epsd",
    "adhesion": "none jkr dmt auto",
    "dlvo": "none vdw electrostatic full",
    "bridge": "none capillary",
    "interfacial": "none nicolson",
    "lubrication": "none squeeze",
    "drag": "stokes_cunningham schiller_naumann di_felice haider_levenspiel gidaspow ergun wen_yu beetstra koch_hill rong tang mazza",
    "saffman": "none saffman_mei",
    "magnus": "none rubinow_keller lun_liu",
    "viscous_torque": "none stokes dennis",
    "thermophoresis": "none waldmann general talbot",
    "dispersion": "none random_walk",
    "nusselt": "ranz_marshall gunn whitaker",
    "magnetic": "none saturated linear langevin permanent fixed",
    "electric": "dc ac coulomb solved",
    "brownian": "inertial overdamped",
    "virtual_mass": "sphere",
    "coupling": "pressure_gradient viscous_stress buoyancy",
    "heat": "convection source conduction radiation",
}
# What a fluid does to particles, which a case must verify in a prescribed flow and another in one that is solved for.
IN_FLOWS = ("drag", "saffman", "magnus", "viscous_torque", "thermophoresis", "dispersion", "virtual_mass", "coupling")
# Slots whose laws must name the paper they come from, `none` apart.
SOURCED = ("normal", "tangential", "twisting", "rolling", "adhesion", "dlvo", "bridge", "interfacial", "lubrication", "drag", "saffman", "magnus", "viscous_torque", "thermophoresis", "dispersion", "nusselt", "magnetic")


def flow_of(case):
    """prescribed, none or solved: the fluid of a case."""
    for folder in ("models", "verification"):
        path = os.path.join(ROOT, "inputs", folder, case + ".yaml")
        if os.path.exists(path):
            found = re.search(r"^fluid:[^\n]*?\btype: (prescribed|none|compressible)", open(path).read(), re.M)
            return found[1] if found and found[1] != "compressible" else "solved"
    return "none"


def main():
    text = subprocess.run([sys.argv[1], "-models"], stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, text=True, check=True).stdout
    there = {}
    for line in text.splitlines():
        slot, name, rest = line.split(None, 2)
        there[slot, name] = rest
    missing = [f"{slot} {name}" for slot, names in LAWS.items() for name in names.split() if (slot, name) not in there]
    nameless = [f"{slot} {name}" for (slot, name), rest in there.items() if slot in SOURCED and name != "none" and not any(c.isdigit() for c in rest)]
    verified = verifying(declared(sys.argv[1]))
    unverified = [f"{slot} {name}" for slot, name in there if name != "none" and (slot, name) not in verified]
    flows = {key: {flow_of(case) for case in cases} for key, cases in verified.items()}
    dry = [f"{slot} {name}" for slot, name in there if slot in IN_FLOWS and name != "none" and "prescribed" not in flows.get((slot, name), ())]
    still = [f"{slot} {name}" for slot, name in there if slot in IN_FLOWS and name != "none" and "solved" not in flows.get((slot, name), ())]
    for what, laws in (("not in -models", missing), ("without a source", nameless), ("without a case of scripts/verify models", unverified),
                       ("without a case in a prescribed flow", dry), ("without a case in a solved flow", still)):
        for law in laws:
            print(f"{law} is {what}")
    return 1 if missing or nameless or unverified or dry or still else 0


if __name__ == "__main__":
    sys.exit(main())
