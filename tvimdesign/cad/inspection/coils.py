"""How much room the springs have as they wind: to their posts, to each other, to the wall and between their coils."""

from __future__ import annotations

from collections.abc import Iterator
from math import cos, hypot, pi, sin

import numpy as np

from tvimdesign.cad.cad_report import SolidCheck
from tvimdesign.cad.geometry.dimensions import Dimensions
from tvimdesign.cad.geometry.solids import polar
from tvimdesign.cad.geometry.spring_solids import Coil, free_coil, installed_coil
from tvimdesign.cad.inspection.finding import at_least, finding

TIGHT = 0.04
"""Of its inner diameter, what a coil should leave free around its post; handbook: Shigley, section 10-12, takes 5 %."""


def coil_checks(dims: Dimensions) -> Iterator[SolidCheck]:
    """Hold the springs against their posts and each other, free and at five angles of the rotor; exact."""
    yield from _checks(dims, free_coil(dims), "as bought")
    for share in (-1.0, -0.5, 0.0, 0.5, 1.0):
        where = "at rest" if share == 0.0 else f"at {share * dims.stroke:+.4f} rad"
        yield from _checks(dims, installed_coil(dims, share * dims.stroke), where)


def _checks(dims: Dimensions, coil: Coil, where: str) -> Iterator[SolidCheck]:
    """The right-hand spring stands for both: the left-hand one does the same at the opposite angle."""
    d, inside, reach = coil.wire_diameter, 0.5 * (coil.diameter - coil.wire_diameter), spring_reach(coil)
    level = 0.5 * (coil.start_level + coil.end_level)
    half_pitch = pi / dims.count("spring_count")
    between = np.array([*polar(dims.placement_radius * cos(half_pitch), half_pitch), level])
    rooms = (
        ("post", inside - dims.post_radius, TIGHT * 2.0 * inside,
         np.array([dims.placement_radius - inside, 0.0, level]), "between coil and post, all round"),
        ("coils", coil.pitch * cos(coil.rise) - d, 0.0,
         np.array([dims.placement_radius + 0.5 * coil.diameter, 0.0, level]), "between one coil and the next"),
        ("neighbour", 2.0 * (dims.placement_radius * sin(half_pitch) - reach), 0.0, between,
         "between neighbouring springs"),
        ("wall", dims.housing_inner_radius - dims.placement_radius - reach, 0.0,
         np.array([dims.placement_radius + reach, 0.0, level]), "between spring and housing"),
        ("rotor", dims.placement_radius - reach - dims.rotor_radius, 0.0,
         np.array([dims.placement_radius - reach, 0.0, level]), "between spring and rotor plate"),
    )  # fmt: skip
    for what, room, wanted, place, words in rooms:
        text = f"{room:.3g} mm {words} {where}"
        if wanted:
            text += f"; {wanted:.3g} mm is a good fit"
        yield finding("spring", f"{what} {where}", room, wanted, "mm", at_least(room, wanted, 0.0), text, place=place)


def spring_reach(coil: Coil) -> float:
    """Radius of the circle around a spring's axis that holds its coils and its tang [mm]."""
    return max(0.5 * coil.diameter, hypot(*coil.tang_position)) + 0.5 * coil.wire_diameter
