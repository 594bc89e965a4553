"""The cover on the housing's rim, and the screws that hold it between the springs."""

from __future__ import annotations

from collections.abc import Mapping

import cadquery as cq

from tvimdesign.cad.geometry.dimensions import Dimensions
from tvimdesign.cad.geometry.solids import cylinder, join, ring
from tvimdesign.cad.parts.common_parts import between_springs


def cover(dims: Dimensions) -> cq.Shape:
    """Ring around the core with every hole that the device's `cover_hole_circles` lists."""
    bottom, top = dims.rim_level, dims.rim_level + dims.cover_height
    holes = [cylinder(radius, bottom, top, at) for radius, places in dims.holes("cover_hole_circles") for at in places]
    return ring(dims.cover_hole_radius, dims.housing_outer_radius, bottom, top).cut(*holes)


def cover_screw(dims: Dimensions) -> cq.Shape:
    """One of the screws, on the module's axis."""
    top = dims.rim_level + dims.cover_height
    shank = cylinder(0.5 * dims.cover_screw_pilot, top - dims.cover_screw_length, top)
    return join(shank, [cylinder(0.5 * dims.cover_screw_head, top, top + dims.cover_screw_head_height)])


DRAWN = {"cover": cover, "cover_screw": cover_screw}


def stand(dims: Dimensions, solids: Mapping[str, cq.Solid]) -> dict[str, cq.Shape]:
    """Place the cover and its screws, by name."""
    placed: dict[str, cq.Shape] = {"cover": solids["cover"].moved(cq.Location())}
    for index, at in enumerate(_axes(dims)):
        placed[f"cover_screw_{index + 1}"] = solids["cover_screw"].moved(cq.Location(cq.Vector(*at, 0)))
    return placed


def _axes(dims: Dimensions) -> list[tuple[float, float]]:
    return between_springs(dims, dims.housing_inner_radius)
