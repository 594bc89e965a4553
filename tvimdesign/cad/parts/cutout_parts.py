"""The thermal cut-out in the heater's leads: across a window, in there where it has room, else below the floor."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from math import sqrt, tan

import cadquery as cq

from tvimdesign.cad.geometry.dimensions import Dimensions
from tvimdesign.cad.geometry.solids import cylinder, turned


def body(dims: Dimensions) -> cq.Shape:
    """The body, below what is centred on the x axis and across it."""
    radius, length = 0.5 * dims.cutout_diameter, dims.cutout_length
    under = -dims.pad_depth if fits_in_window(dims) else -dims.floor_thickness
    lying = cq.Location(cq.Vector(dims.cutout_radius, -0.5 * length, under - radius), cq.Vector(1, 0, 0), -90)
    return cylinder(radius, 0.0, length).moved(lying)


def fits_in_window(dims: Dimensions) -> bool:
    """Whether body and a running clearance around it go into the window below the first heater."""
    if dims.mode != "shear":
        return False
    half, across = (
        0.5 * dims.cutout_length + dims.running_clearance,
        dims.cutout_diameter + 2.0 * dims.running_clearance,
    )
    if dims.spreader_depth:
        is_centred = dims.count("tiles_per_arc") % 2 == 1
        return is_centred and dims.window_width >= 2.0 * half and dims.window_depth >= across
    inner, outer = dims.pcl_inner_radius + dims.window_ledge, dims.pcl_outer_radius - dims.window_ledge
    near = dims.cutout_radius - 0.5 * across
    end = 0.5 * dims.arc_span - dims.window_ledge / dims.pcl_inner_radius
    reach = sqrt(max(outer**2 - half**2, 0.0))
    return near >= inner and reach >= near + across and near * tan(end) >= half + dims.corner_radius


def drawn(dims: Dimensions) -> dict[str, Callable[[Dimensions], cq.Shape]]:
    """How it is drawn, where a module has one."""
    return {"thermal_cutout": body} if dims.cutout_diameter else {}


def stand(drawn: Mapping[str, cq.Solid], azimuth: float) -> dict[str, cq.Shape]:
    """Place it below the heater at an azimuth [rad], by name."""
    return {"thermal_cutout": turned(drawn["thermal_cutout"], azimuth)} if "thermal_cutout" in drawn else {}
