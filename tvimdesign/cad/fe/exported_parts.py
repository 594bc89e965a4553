"""The parts of a design as FE takes them: STEP files where they stand, one spring in its own frame, and numbers."""

from __future__ import annotations

import json
from pathlib import Path

import cadquery as cq

from tvimdesign.cad.assembly.module_parts import MODULES
from tvimdesign.cad.geometry.dimensions import dimensions
from tvimdesign.cad.geometry.spring_solids import installed_coil, spring_solid
from tvimdesign.study.design import Design


def export_parts(design: Design, folder: Path) -> None:
    """Write housing, rotor, link, all pads and PCL, one spring, and `inputs.json`: sizes in mm, values in SI."""
    folder.mkdir(parents=True, exist_ok=True)
    dims, module = dimensions(design), MODULES[design.mode]
    drawn = {kind: draw(dims) for kind, draw in module.made.items()}
    shapes = {kind: drawn[kind] for kind in ("housing", "rotor", "link")}
    shapes |= module.stand(dims, drawn, 0.0)
    shapes["spring"] = spring_solid(installed_coil(dims))
    for name, shape in shapes.items():
        cq.exporters.export(cq.Workplane(shape), str(folder / f"{name}.step"))
    coil = installed_coil(dims)
    numbers = {"mode": design.mode, "name": design.name, "values": design.values, "mm": dict(dims.by_name),
               "coil": {"turns": coil.turns, "diameter": coil.diameter, "leg_azimuth": coil.leg_azimuth,
                        "end_level": coil.end_level, "start_level": coil.start_level}}  # fmt: skip
    (folder / "inputs.json").write_text(json.dumps(numbers, indent=1))
