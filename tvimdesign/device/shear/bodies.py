"""Volumes of what only the shear module has: arcs of PCL, a floor with pockets for the pads and windows below them."""

from __future__ import annotations

import numpy as np

from tvimdesign.device.bodies import book as shared
from tvimdesign.device.book import Book
from tvimdesign.device.rows import Scalar
from tvimdesign.physics import layer
from tvimdesign.physics.shapes import Section, corners, ring, sector

book = Book(shared.group)


@book.output("mm^2", headline=True)
def pcl_area(arc_count: Scalar, arc_span: Scalar, pcl_inner_radius: Scalar, pcl_outer_radius: Scalar) -> Scalar:
    """Contact area of all PCL arcs together."""
    return layer.area(arc_count * arc_span, pcl_inner_radius, pcl_outer_radius)


@book.output("mm^3")
def pcl_volume(pcl_area: Scalar, pcl_thickness: Scalar, key_moments: Section) -> Scalar:
    """Volume of all PCL arcs together, keys included."""
    return pcl_area * pcl_thickness + key_moments.area


@book.output("mm^3")
def peltier_volume(
    pcl_area: Scalar,
    arc_count: Scalar,
    corner_radius: Scalar,
    pcl_inner_radius: Scalar,
    pcl_outer_radius: Scalar,
    peltier_thickness: Scalar,
) -> Scalar:
    """Volume of all Peltier pads together: the outline of the PCL, its corners as round as those of the pockets."""
    rounded = arc_count * corners(corner_radius, pcl_inner_radius, pcl_outer_radius)
    return (pcl_area - rounded) * peltier_thickness


@book.helper()
def window_area(
    arc_count: Scalar,
    arc_span: Scalar,
    pcl_inner_radius: Scalar,
    pcl_outer_radius: Scalar,
    window_ledge: Scalar,
    corner_radius: Scalar,
) -> Scalar:
    """Area of the windows below the Peltier pads [m^2]: the arcs, smaller by the ledge on every side, and rounded."""
    span = arc_span - 2.0 * window_ledge / pcl_inner_radius
    inner, outer = pcl_inner_radius + window_ledge, pcl_outer_radius - window_ledge
    return arc_count * (sector(span, inner, outer).area - corners(corner_radius, inner, outer))


@book.output("mm^3")
def floor_volume(
    hub_radius: Scalar,
    housing_outer_radius: Scalar,
    floor_thickness: Scalar,
    floor_web: Scalar,
    peltier_volume: Scalar,
    window_area: Scalar,
    spring_count: Scalar,
    spring_hole_area: Scalar,
    mount_hole: Scalar,
) -> Scalar:
    """Volume of the housing's floor around the hub, less pad pockets, windows, tang holes and mounting holes."""
    disc = ring(hub_radius, housing_outer_radius).area
    holes = spring_hole_area + np.pi * (0.5 * mount_hole) ** 2
    return (disc - spring_count * holes) * floor_thickness - peltier_volume - window_area * floor_web


@book.helper()
def floor_openings_polar(
    arc_count: Scalar,
    arc_span: Scalar,
    pcl_inner_radius: Scalar,
    pcl_outer_radius: Scalar,
    pcl_mean_radius: Scalar,
    window_ledge: Scalar,
    corner_radius: Scalar,
    peltier_thickness: Scalar,
    floor_web: Scalar,
) -> Scalar:
    """Polar moment [m^5] of what the floor has not got: pockets of the pads, and the windows below them."""
    span = arc_span - 2.0 * window_ledge / pcl_inner_radius
    inner, outer = pcl_inner_radius + window_ledge, pcl_outer_radius - window_ledge
    rounded = [corners(corner_radius, *ends) for ends in ((pcl_inner_radius, pcl_outer_radius), (inner, outer))]
    pocket = sector(arc_span, pcl_inner_radius, pcl_outer_radius).polar - rounded[0] * pcl_mean_radius**2
    window = sector(span, inner, outer).polar - rounded[1] * pcl_mean_radius**2
    return arc_count * (pocket * peltier_thickness + window * floor_web)


@book.helper()
def housing_vanes_polar() -> Scalar:
    """Polar moment [m^5] of vanes on the floor: there are none."""
    return 0.0


@book.output("mm^3")
def housing_volume(bare_housing_volume: Scalar) -> Scalar:
    """Volume of the housing: skirt and floor, wall, hub and spring posts."""
    return bare_housing_volume


@book.helper()
def rotor_moments(bare_rotor_moments: Section, key_moments: Section) -> Section:
    """Volume and its polar moment about the axis, of the rotor less the pockets for the keys."""
    return bare_rotor_moments - key_moments
