"""Volumes of what only the shear module has: arcs of PCL, a floor with pockets for the pads and windows below them."""

from __future__ import annotations

from math import pi

import numpy as np

from tvimdesign.device.components.liner import WITH_LINER
from tvimdesign.device.core.heat.heater_form import CUT
from tvimdesign.device.table.module import Module
from tvimdesign.device.table.quantity import Scalar
from tvimdesign.device.table.quantity_group import QuantityGroup
from tvimdesign.physics.solids.shapes import NOTHING, Section, inner_corner, outer_corner, rectangle_at, sector, stacked

quantities = QuantityGroup("Size and weight")
_SPANDREL = (5.0 / 6.0 - 0.25 * pi) / (1.0 - 0.25 * pi)


@quantities.helper()
def pcl_section(m: Module) -> Section:
    """Plan view of all PCL arcs together."""
    return sector(m.arc_count * m.arc_span, m.pcl_inner_radius, m.pcl_outer_radius)


@quantities.output("mm^2", headline=True)
def pcl_area(m: Module) -> Scalar:
    """Contact area of all PCL arcs together."""
    return m.pcl_section.area


@quantities.output("mm^3")
def pcl_volume(m: Module) -> Scalar:
    """Volume of all PCL arcs together, keys included."""
    return m.pcl_area * m.pcl_thickness + m.key_moments.area


def _rounded_sector(span: Scalar, inner_radius: Scalar, outer_radius: Scalar, corner_radius: Scalar) -> Section:
    """Return the annular sector less what fillets take from its corners, which counts where its middle is in a square
    corner.

    That is (5/6 - pi/4)/(1 - pi/4) of the fillet's radius from either side (a square less a quarter of a disc).
    """
    beside = _SPANDREL * corner_radius
    outer, inner = outer_corner(corner_radius, outer_radius, 0.0), inner_corner(corner_radius, inner_radius, 0.0)
    moment = outer * ((outer_radius - beside) ** 2 + beside**2) + inner * ((inner_radius + beside) ** 2 + beside**2)
    return sector(span, inner_radius, outer_radius) - Section(2.0 * (outer + inner), 2.0 * moment)


@quantities.helper()
def pad_section(m: Module) -> Section:
    """Plan view of all Peltier pads: the outline of the PCL, its corners as round as those of the pockets."""
    return _rounded_sector(m.arc_span, m.pcl_inner_radius, m.pcl_outer_radius, m.corner_radius).times(m.arc_count)


def _pocket_section(m: Module) -> Section:
    """Return the plan view of all pockets for pads."""
    return _rounded_sector(m.pocket_span, m.pocket_inner_radius, m.pocket_outer_radius, m.corner_radius).times(
        m.arc_count
    )


@quantities.output("mm^3")
def peltier_volume(m: Module) -> Scalar:
    """Volume of all Peltier modules together: cut to the pockets' outline, or rectangular tiles."""
    if m.heater_form == CUT:
        return m.pad_section.area * m.peltier_thickness
    return m.heater_count * m.peltier_width * (m.peltier_length - 0.5 * m.peltier_porch) * m.peltier_thickness


@quantities.helper()
def window_section(m: Module) -> Section:
    """Plan view of the windows below the Peltier modules: arcs or tiles, less a ledge on every side, rounded."""
    if m.heater_form != CUT:
        sides = (m.peltier_width - 2.0 * m.window_ledge, m.cold_plate_length - 2.0 * m.window_ledge)
        away = np.sqrt(m.tile_radius**2 + (0.5 * m.peltier_porch) ** 2)
        return rectangle_at(*sides, away, m.corner_radius).times(m.heater_count)
    inner, outer = m.pcl_inner_radius + m.window_ledge, m.pcl_outer_radius - m.window_ledge
    return _rounded_sector(m.window_span, inner, outer, m.corner_radius).times(m.arc_count)


@quantities.helper()
def floor_openings(m: Module) -> Section:
    """Volume of the floor's openings and its polar moment: pockets, windows, slots for leads, thermistor's seat."""
    opened = stacked(
        (_pocket_section(m), m.pad_depth), (m.window_section, m.floor_web), (m.lead_hole_section, m.floor_web)
    )
    return opened.plus(m.thermistor_seat_moments)


@quantities.helper()
def housing_moments(m: Module) -> Section:
    """Volume and its polar moment about the axis, of the housing: nothing is added to what all modes have."""
    return m.bare_housing_moments


@quantities.output("deg", requires=WITH_LINER)
def liner_span(m: Module) -> Scalar:
    """Angle a liner covers: at the arc's inner radius its recess is a slip clearance longer at each end; zero
    without."""
    return m.arc_span - 2.0 * m.slip_clearance / m.pcl_inner_radius


@quantities.helper(requires=WITH_LINER, default=NOTHING)
def liner_moments(m: Module) -> Section:
    """Volume of all liners and its polar moment about the axis; a liner goes into its recess with a slip clearance."""
    inner, outer = m.pcl_inner_radius + m.slip_clearance, m.pcl_outer_radius - m.slip_clearance
    return _rounded_sector(m.liner_span, inner, outer, m.corner_radius).times(m.arc_count * m.liner_thickness)


@quantities.helper(requires=WITH_LINER, default=NOTHING)
def liner_recess(m: Module) -> Section:
    """Volume of the recesses for the liners, which have the outline of the PCL, and its polar moment about the axis."""
    return m.pad_section.times(m.liner_depth)


@quantities.helper()
def rotor_moments(m: Module) -> Section:
    """Volume and its polar moment about the axis, of the rotor with its lips, less pockets for keys and for liners."""
    return m.bare_rotor_moments.plus(m.melt_lip_moments) - m.key_moments - m.liner_recess
