"""Draw springs for the solver without a module around them: python draw.py RATIO OUT [NAME ...].

The springs of results.yaml (all, or those named) with a bend of that inside radius over the wire's diameter, each in a
folder of OUT. Run it where CadQuery is installed; `tvimdesign/cad/fe/solvers/spring.py` runs where NGSolve is.
"""

from __future__ import annotations

import json
import sys
from math import hypot
from pathlib import Path

import cadquery as cq
import yaml

from tvimdesign.cad.geometry.spring_solids import Coil, spring_solid

PIN, OVERHANG, TANG = 4.0, 4.0, 4.0  # mm, as the inputs' defaults


def draw(case: dict[str, float], ratio: float, folder: Path) -> None:
    """Write one spring as STEP in its own frame, with the numbers that the solver needs."""
    wire, arm = case["wire_diameter"], case["arm"]
    coil = Coil(
        wire_diameter=wire, diameter=case["coil_diameter"], turns=case["turns"], pitch=case["pitch"],
        leg_length=arm + OVERHANG, tang_length=TANG, bend_radius=(ratio + 0.5) * wire, leg_azimuth=2.6,
    )  # fmt: skip
    reach = hypot(arm, 0.5 * (coil.diameter + wire + PIN))
    mm = {"wire_diameter": wire, "pin_diameter": PIN, "placement_radius": reach, "pin_radius": 0.0,
          "coil_pitch": case["pitch"]}  # fmt: skip
    numbers = {"mm": mm, "values": {"spring_youngs_modulus": 1e9 * case["modulus"]},
               "coil": {"turns": coil.turns, "diameter": coil.diameter, "leg_azimuth": coil.leg_azimuth,
                        "end_level": coil.end_level, "start_level": coil.start_level}}  # fmt: skip
    folder.mkdir(parents=True, exist_ok=True)
    cq.exporters.export(cq.Workplane(spring_solid(coil)), str(folder / "spring.step"))
    (folder / "inputs.json").write_text(json.dumps(numbers, indent=1))


def main(ratio: str, out: str, *names: str) -> None:
    """Draw the springs of results.yaml, or those that are named."""
    springs = yaml.safe_load((Path(__file__).parent / "results.yaml").read_text())["springs"]
    for name in names or springs:
        draw(springs[name], float(ratio), Path(out) / name)


if __name__ == "__main__":
    main(*sys.argv[1:])
