"""Parts of the module of each mode: how each is drawn, where it stands, and how far it is lifted to be seen apart."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import cadquery as cq
import numpy as np

from tvimdesign.cad.export.mesh import Instance
from tvimdesign.cad.geometry.dimensions import Dimensions
from tvimdesign.cad.geometry.kinds import MADE_TURNING, SPRINGS, kind_of
from tvimdesign.cad.geometry.solids import turned
from tvimdesign.cad.parts import compression_parts, fasteners, fittings, heater_parts, motor_parts, shear_parts

_IN_ALL_MODES = (fittings, fasteners, motor_parts)
"""Each says which of its parts a design has and how they are drawn (`drawn`), and places them (`stand`)."""


@dataclass(frozen=True, kw_only=True)
class ModuleParts:
    """The parts of a mode."""

    made: Mapping[str, Callable[[Dimensions], cq.Shape]]
    """How one of each kind is drawn, by kind: those that every module of the mode has, without screws and springs."""
    stand_heaters: Callable[[Dimensions, Mapping[str, cq.Solid], float], dict[str, cq.Shape]]
    """Places pads, PCL and what belongs to them, the rotor at an angle [rad], by name."""

    def drawn(self, dims: Dimensions) -> dict[str, Callable[[Dimensions], cq.Shape]]:
        """Return how one of each kind is drawn but the springs, of what a design has."""
        kinds = {**self.made, **heater_parts.drawn(dims)}
        for parts in _IN_ALL_MODES:
            kinds |= parts.drawn(dims)
        return kinds

    def kinds(self, dims: Dimensions) -> tuple[str, ...]:
        """Return all kinds of part a design has, springs and all."""
        return (*self.drawn(dims), *SPRINGS)

    def stand(self, dims: Dimensions, drawn: Mapping[str, cq.Solid], rotor_angle: float = 0.0) -> dict[str, cq.Solid]:
        """Place the drawn parts, all but the springs, by name."""
        placed = {"housing": turned(drawn["housing"], 0.0)}
        placed |= {name: turned(drawn[name], rotor_angle) for name in MADE_TURNING}
        for parts in _IN_ALL_MODES:
            placed |= parts.stand(dims, drawn, rotor_angle)
        return placed | self.stand_heaters(dims, drawn, rotor_angle)


MODULES = {
    "shear": ModuleParts(made=shear_parts.DRAWN, stand_heaters=shear_parts.stand),
    "compression": ModuleParts(made=compression_parts.DRAWN, stand_heaters=compression_parts.stand),
}
"""By mode."""


_ORDER = (
    "encoder_board", "encoder_magnet", "motor_screw", "motor_retainer", "motor_housing", "motor_stator",
    "motor_bearing", "motor_rotor", "motor_hub", "retainer_screw", "retainer", "retainer_insert", "adjuster_screw",
    "thermal_cutout", "thermistor", "heater_lead", "housing", "cover_insert", "preload_spring", "bearing_outer",
    "bearing_inner", "adjuster_insert", "adjuster",
    "peltier_pad", "spreader", "pcl_arc", "pcl_block", "liner", "rotor", "link_insert", "spring_right", "spring_left",
    "mount_screw", "cover", "cover_screw", "link", "link_screw", "link_dowel",
)  # fmt: skip
"""Along the axis from below; kinds that are not named come last."""
_LIDS = ("cover",)
"""Closed plates, which are lifted until all of what lies below them is seen."""
_TOGETHER = ({"spring_right", "spring_left"},)
VIEWED_FROM = (1.0, -1.35, 0.75)
"""Direction of the camera that looks down on the parts."""
_DOWN = VIEWED_FROM[2] / float(np.hypot(VIEWED_FROM[0], VIEWED_FROM[1]))
_APART = 0.12
"""Gap between kinds over the module's width."""


def lifts(placed: Mapping[str, Instance]) -> dict[str, float]:
    """Return how far each part is lifted along the axis [mm], so that no kind reaches into the one below it."""
    names = sorted(placed, key=lambda name: (_rank(kind_of(name)), name))
    points = {name: placed[name].points() for name in names}
    width = max(float(np.ptp(at[:, 0])) for at in points.values())
    floor, below, lifted = 0.0, 0.0, dict[str, float]()
    for rank in dict.fromkeys(_rank(kind_of(name)) for name in names):
        group = [name for name in names if _rank(kind_of(name)) == rank]
        low = min(float(points[name][:, 2].min()) for name in group)
        high = max(float(points[name][:, 2].max()) for name in group)
        reach = max(float(np.hypot(points[name][:, 0], points[name][:, 1]).max()) for name in group)
        # What is wider than the kind below it would hide it from a camera that looks down.
        hidden = reach + below if kind_of(group[0]) in _LIDS else max(reach - below, 0.0)
        floor += hidden * _DOWN if below else 0.0
        lifted |= dict.fromkeys(group, floor - low)
        floor += high - low + _APART * width
        below = reach
    return lifted


def _rank(kind: str) -> int:
    """Place of a kind along the axis; both hands of spring have one."""
    first = next((min(_ORDER.index(one) for one in group) for group in _TOGETHER if kind in group), None)
    return first if first is not None else _ORDER.index(kind) if kind in _ORDER else len(_ORDER)
