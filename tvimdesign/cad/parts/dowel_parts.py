"""The dowel pins between link and core, and the holes they are pressed into."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from math import pi

import cadquery as cq

from tvimdesign.cad.geometry.dimensions import Dimensions
from tvimdesign.cad.geometry.solids import blind_hole, cylinder, polar, turned

_AZIMUTHS = (0.0, pi, 0.5 * pi, 1.5 * pi)
"""In the order in which pins are added: on the link's long axis, then across it, all between the link screws."""


def azimuths(dims: Dimensions) -> tuple[float, ...]:
    """Azimuths [rad] of the dowel pins, the rotor at rest; none where screws alone hold the link."""
    return _AZIMUTHS[: dims.count("dowels_fitted")] if dims.dowels_fitted else ()


def places(dims: Dimensions) -> list[tuple[float, float]]:
    """Axes of the dowel pins."""
    return [polar(dims.link_dowel_circle_radius, azimuth) for azimuth in azimuths(dims)]


def holes_in_core(dims: Dimensions) -> list[cq.Shape]:
    """What is cut from the core for the pins."""
    top, point = dims.link_bottom_level, dims.drill_point_ratio
    return [
        hole
        for at in places(dims)
        for hole in blind_hole(dims.link_dowel_diameter, top, top - dims.link_dowel_depth, point, at)
    ]


def holes_in_link(dims: Dimensions) -> list[cq.Shape]:
    """What is cut from the link for the pins, right through."""
    bottom = dims.link_bottom_level
    top = bottom + dims.link_thickness
    return [cylinder(0.5 * dims.link_dowel_diameter, bottom, top, at) for at in places(dims)]


def link_dowel(dims: Dimensions) -> cq.Shape:
    """The first of the pins, flush with the link."""
    top = dims.link_bottom_level + dims.link_thickness
    return cylinder(0.5 * dims.link_dowel_diameter, top - dims.link_dowel_length, top, places(dims)[0])


def drawn(dims: Dimensions) -> dict[str, Callable[[Dimensions], cq.Shape]]:
    """How one of each kind is drawn, of what this module has."""
    return {"link_dowel": link_dowel} if dims.dowels_fitted else {}


def stand(dims: Dimensions, solids: Mapping[str, cq.Solid], rotor_angle: float) -> dict[str, cq.Shape]:
    """Place the pins, the rotor at an angle [rad], by name."""
    return {
        f"link_dowel_{index + 1}": turned(solids["link_dowel"], rotor_angle + azimuth)
        for index, azimuth in enumerate(azimuths(dims))
    }
