"""Volumes of what only the shear module has: arcs of PCL, a floor with pockets for the pads and windows below them."""

from __future__ import annotations

from math import pi

from tvimdesign.device.core.heat.heater_form import CUT
from tvimdesign.device.core.mass_properties import quantities as shared
from tvimdesign.device.fixtures.liner import WITH_LINER
from tvimdesign.device.table.quantity import Scalar
from tvimdesign.device.table.quantity_group import QuantityGroup
from tvimdesign.physics.bodies.shapes import (
    NOTHING,
    Section,
    inner_corner,
    outer_corner,
    rectangle_at,
    sector,
    stacked,
)

quantities = QuantityGroup(shared.group)
_SPANDREL = (5.0 / 6.0 - 0.25 * pi) / (1.0 - 0.25 * pi)


@quantities.helper()
def pcl_section(arc_count: Scalar, arc_span: Scalar, pcl_inner_radius: Scalar, pcl_outer_radius: Scalar) -> Section:
    """Plan view of all PCL arcs together."""
    return sector(arc_count * arc_span, pcl_inner_radius, pcl_outer_radius)


@quantities.output("mm^2", headline=True)
def pcl_area(pcl_section: Section) -> Scalar:
    """Contact area of all PCL arcs together."""
    return pcl_section.area


@quantities.output("mm^3")
def pcl_volume(pcl_area: Scalar, pcl_thickness: Scalar, key_moments: Section) -> Scalar:
    """Volume of all PCL arcs together, keys included."""
    return pcl_area * pcl_thickness + key_moments.area


def _rounded_sector(span: Scalar, inner_radius: Scalar, outer_radius: Scalar, corner_radius: Scalar) -> Section:
    """Annular sector less what fillets take from its corners, which counts where its middle is in a square corner.

    That is (5/6 - pi/4)/(1 - pi/4) of the fillet's radius from either side (a square less a quarter of a disc).
    """
    beside = _SPANDREL * corner_radius
    outer, inner = outer_corner(corner_radius, outer_radius, 0.0), inner_corner(corner_radius, inner_radius, 0.0)
    moment = outer * ((outer_radius - beside) ** 2 + beside**2) + inner * ((inner_radius + beside) ** 2 + beside**2)
    return sector(span, inner_radius, outer_radius) - Section(2.0 * (outer + inner), 2.0 * moment)


@quantities.helper()
def pad_section(
    arc_count: Scalar, arc_span: Scalar, pcl_inner_radius: Scalar, pcl_outer_radius: Scalar, corner_radius: Scalar
) -> Section:
    """Plan view of all Peltier pads: the outline of the PCL, its corners as round as those of the pockets."""
    return _rounded_sector(arc_span, pcl_inner_radius, pcl_outer_radius, corner_radius).times(arc_count)


@quantities.helper()
def pocket_section(
    arc_count: Scalar,
    pocket_span: Scalar,
    pocket_inner_radius: Scalar,
    pocket_outer_radius: Scalar,
    corner_radius: Scalar,
) -> Section:
    """Plan view of all pockets for pads."""
    return _rounded_sector(pocket_span, pocket_inner_radius, pocket_outer_radius, corner_radius).times(arc_count)


@quantities.output("mm^3")
def peltier_volume(heater_form: str, pad_section: Section, tile_section: Section, peltier_thickness: Scalar) -> Scalar:
    """Volume of all Peltier modules together: cut to the pockets' outline, or rectangular tiles."""
    return (pad_section if heater_form == CUT else tile_section).area * peltier_thickness


@quantities.helper()
def window_section(
    heater_form: str,
    heater_count: Scalar,
    peltier_length: Scalar,
    peltier_width: Scalar,
    tile_radius: Scalar,
    arc_count: Scalar,
    window_span: Scalar,
    pcl_inner_radius: Scalar,
    pcl_outer_radius: Scalar,
    window_ledge: Scalar,
    corner_radius: Scalar,
) -> Section:
    """Plan view of the windows below the Peltier modules: arcs or tiles, less a ledge on every side, rounded."""
    if heater_form != CUT:
        sides = (peltier_width - 2.0 * window_ledge, peltier_length - 2.0 * window_ledge)
        return rectangle_at(*sides, tile_radius, corner_radius).times(heater_count)
    inner, outer = pcl_inner_radius + window_ledge, pcl_outer_radius - window_ledge
    return _rounded_sector(window_span, inner, outer, corner_radius).times(arc_count)


@quantities.helper()
def floor_openings(
    pocket_section: Section,
    pad_depth: Scalar,
    window_section: Section,
    lead_hole_section: Section,
    floor_web: Scalar,
    thermistor_seat_moments: Section,
) -> Section:
    """What the floor has not got, volume and its polar moment: pockets, windows, holes for leads, thermistor's seat."""
    opened = stacked((pocket_section, pad_depth), (window_section, floor_web), (lead_hole_section, floor_web))
    return opened.plus(thermistor_seat_moments)


@quantities.output("mm^3")
def floor_volume(floor_moments: Section) -> Scalar:
    """Volume of the housing's floor around the hub, less pad pockets, windows, tang holes and mounting holes."""
    return floor_moments.area


@quantities.helper()
def housing_moments(bare_housing_moments: Section) -> Section:
    """Volume and its polar moment about the axis, of the housing: nothing is added to what all modes have."""
    return bare_housing_moments


@quantities.output("mm^3")
def housing_volume(housing_moments: Section) -> Scalar:
    """Volume of the housing: skirt and floor, wall, hub and spring posts."""
    return housing_moments.area


@quantities.output("deg", requires=WITH_LINER)
def liner_span(arc_span: Scalar, slip_clearance: Scalar, pcl_inner_radius: Scalar) -> Scalar:
    """Angle a liner covers: at the arc's inner radius its recess is a slip clearance longer at each end; zero
    without."""
    return arc_span - 2.0 * slip_clearance / pcl_inner_radius


@quantities.helper(requires=WITH_LINER, default=NOTHING)
def liner_moments(
    arc_count: Scalar,
    liner_span: Scalar,
    pcl_inner_radius: Scalar,
    pcl_outer_radius: Scalar,
    slip_clearance: Scalar,
    corner_radius: Scalar,
    liner_thickness: Scalar,
) -> Section:
    """Volume of all liners and its polar moment about the axis; a liner goes into its recess with a slip clearance."""
    inner, outer = pcl_inner_radius + slip_clearance, pcl_outer_radius - slip_clearance
    return _rounded_sector(liner_span, inner, outer, corner_radius).times(arc_count * liner_thickness)


@quantities.helper(requires=WITH_LINER, default=NOTHING)
def liner_recess(pad_section: Section, liner_depth: Scalar) -> Section:
    """Volume of the recesses for the liners, which have the outline of the PCL, and its polar moment about the axis."""
    return pad_section.times(liner_depth)


@quantities.helper()
def rotor_moments(
    bare_rotor_moments: Section, key_moments: Section, melt_lip_moments: Section, liner_recess: Section
) -> Section:
    """Volume and its polar moment about the axis, of the rotor with its lips, less pockets for keys and for liners."""
    return bare_rotor_moments.plus(melt_lip_moments) - key_moments - liner_recess
