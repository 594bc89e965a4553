"""The parts of a design as FE takes them: STEP files where they stand, one spring in its own frame, and numbers."""

from __future__ import annotations

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import cadquery as cq
import numpy as np

from tvimdesign.cad.assembly.assembly import MODULES
from tvimdesign.cad.geometry.dimensions import dimensions
from tvimdesign.cad.geometry.spring_solids import installed_coil, spring_solid
from tvimdesign.study.design import Design

_FINE, _FINE_ANGLE = 0.02, 0.1
"""How far triangles may lie from the surface [mm], and turn from it [rad]."""


def export_parts(design: Design, folder: Path) -> None:
    """Write housing, rotor, link, all pads and PCL, one spring, and `inputs.json`: sizes in mm, values in SI.

    `surfaces.npz` has the surfaces of the parts that heat passes, as triangles.
    """
    folder.mkdir(parents=True, exist_ok=True)
    dims, module = dimensions(design), MODULES[design.mode]
    kinds = (*module.made, *(["spreader"] if dims.spreader_depth else []))
    drawn = {kind: module.drawn(dims)[kind](dims) for kind in kinds}
    shapes = {kind: drawn[kind] for kind in ("housing", "rotor", "link")}
    shapes |= module.stand_heaters(dims, drawn, 0.0)
    shapes["spring"] = spring_solid(installed_coil(dims))
    for name, shape in shapes.items():
        cq.exporters.export(cq.Workplane(shape), str(folder / f"{name}.step"))
    heated = {name: shape for name, shape in shapes.items() if name not in ("link", "spring")}
    np.savez_compressed(folder / "surfaces.npz", **_triangles(heated))
    coil = installed_coil(dims)
    numbers = {"mode": design.mode, "name": design.name, "values": design.values, "mm": dict(dims.by_name),
               "choices": design.choices, "current_profiles": design.current_profiles,
               "coil": {"turns": coil.turns, "diameter": coil.diameter, "leg_azimuth": coil.leg_azimuth,
                        "end_level": coil.end_level, "start_level": coil.start_level}}  # fmt: skip
    (folder / "inputs.json").write_text(json.dumps(numbers, indent=1))


def _triangles(shapes: Mapping[str, cq.Shape]) -> dict[str, Any]:
    """Return points and triangles of each shape, by its name."""
    found = {}
    for name, shape in shapes.items():
        points, triangles = shape.tessellate(_FINE, _FINE_ANGLE)
        found[f"{name}.points"] = np.array([point.toTuple() for point in points])
        found[f"{name}.triangles"] = np.array(triangles)
    return found
