"""How far each part is lifted along the axis so that the module is seen apart, in the order it goes together."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from tvimdesign.cad.export.mesh import Instance
from tvimdesign.cad.geometry.kinds import kind_of

_ORDER = (
    "encoder_board", "encoder_magnet", "motor_screw", "motor_retainer", "motor_housing", "motor_stator",
    "motor_bearing", "motor_rotor", "motor_hub", "retainer_screw", "retainer", "retainer_insert", "adjuster_screw",
    "thermal_cutout", "thermistor", "housing", "cover_insert", "preload_spring", "bearing_outer", "bearing_inner",
    "adjuster_insert", "adjuster",
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
    """How far each part is lifted along the axis [mm], so that no kind reaches into the one below it."""
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
