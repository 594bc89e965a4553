"""Whether what lies in a pocket goes in: the gap to the pocket's walls on every side, measured on the solids."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from math import atan2, cos, pi, sin

import cadquery as cq

from tvimdesign.cad.cad_report import SolidCheck
from tvimdesign.cad.geometry.dimensions import Dimensions
from tvimdesign.cad.inspection.finding import at_least, finding

_IN = {"peltier_pad": "housing", "spreader": "housing", "liner": "rotor"}
"""What lies in a pocket, and the part that has it."""
_ROUNDING = 1e-3
"""By which a measured gap may be short [mm]: a twentieth of the least clearance of any process."""


def fit_checks(dims: Dimensions, placed: Mapping[str, cq.Solid]) -> Iterator[SolidCheck]:
    """Hold the first of each kind against its pocket's walls, lifted off what it lies on by twice the clearance."""
    wanted = dims.slip_clearance
    for kind, host in _IN.items():
        name = f"{kind}_1"
        if name not in placed:
            continue
        gap = placed[name].moved(cq.Location(_off(dims, kind, placed[name]) * 2.0 * wanted)).distance(placed[host])
        level = at_least(gap, wanted - _ROUNDING)
        text = f"has {gap:.3g} mm to the walls of its pocket in the {host}; {wanted:.3g} are wanted to put it in"
        yield finding(kind, "goes into its pocket", gap, wanted, "mm", level, text)


def _off(dims: Dimensions, kind: str, solid: cq.Solid) -> cq.Vector:
    """From what a part lies on: off the floor, off the plate, or sideways off its vane and up from the floor."""
    if dims.mode == "shear":
        return cq.Vector(0.0, 0.0, -1.0 if kind == "liner" else 1.0)
    middle = solid.Center()
    around = atan2(middle.y, middle.x)
    pitch = 2.0 * pi / dims.count("vane_count")
    # The middle of a housing's vane is half a pitch beyond a rotor's; a liner leaves its rotor's vane.
    from_vane = (around / pitch) % 1.0 - (0.0 if kind == "liner" else 0.5)
    side = 1.0 if 0.0 < from_vane < 0.5 else -1.0
    return cq.Vector(-side * sin(around), side * cos(around), -1.0 if kind == "liner" else 1.0)
