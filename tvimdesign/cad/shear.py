"""The parts of the shear module: arcs of PCL on pads that lie in pockets of the floor, with windows below them."""

from __future__ import annotations

from collections.abc import Mapping
from math import pi

import cadquery as cq

from tvimdesign.cad.dimensions import Dimensions
from tvimdesign.cad.parts import bare_housing, bare_rotor, link, retainer
from tvimdesign.cad.shapes import rounded, sector, turned

FIXED = ("housing", "peltier_pad", "pcl_arc", "bearing_outer")


def housing(dims: Dimensions) -> cq.Shape:
    """Housing with pockets for the pads and windows below them."""
    sharp = sector(
        dims.pcl_inner_radius + dims.window_ledge,
        dims.pcl_outer_radius - dims.window_ledge,
        dims.arc_span - 2.0 * dims.window_ledge / dims.pcl_inner_radius,
        -dims.floor_thickness,
        -dims.peltier_thickness,
    )
    pocket, window = peltier_pad(dims), rounded(sharp, dims.corner_radius)
    openings = [turned(shape, azimuth) for azimuth in _azimuths(dims) for shape in (pocket, window)]
    return bare_housing(dims, (), openings)


def pcl_arc(dims: Dimensions) -> cq.Shape:
    """One arc of PCL between floor and rotor, centred on the x axis."""
    return sector(dims.pcl_inner_radius, dims.pcl_outer_radius, dims.arc_span, 0, dims.pcl_thickness)


def peltier_pad(dims: Dimensions) -> cq.Shape:
    """One Peltier pad in its pocket under an arc, centred on the x axis."""
    sharp = sector(dims.pcl_inner_radius, dims.pcl_outer_radius, dims.arc_span, -dims.peltier_thickness, 0)
    return rounded(sharp, dims.corner_radius)


DRAWN = {
    "housing": housing,
    "rotor": bare_rotor,
    "link": link,
    "retainer": retainer,
    "pcl_arc": pcl_arc,
    "peltier_pad": peltier_pad,
}


def stand(dims: Dimensions, drawn: Mapping[str, cq.Solid], _rotor_angle: float) -> dict[str, cq.Shape]:
    """Place pads and arcs, by name. The arcs are drawn unsheared; the floor holds their lower face."""
    return {
        f"{kind}_{index + 1}": turned(drawn[kind], azimuth)
        for kind in ("peltier_pad", "pcl_arc")
        for index, azimuth in enumerate(_azimuths(dims))
    }


def _azimuths(dims: Dimensions) -> list[float]:
    """Middles of the PCL arcs [rad]: between the springs where there are as many of both."""
    return [azimuth + pi / dims.count("spring_count") for azimuth in dims.azimuths("arc_count")]
