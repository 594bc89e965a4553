"""Arcs of the shear module, pads under them and windows below: volumes, rules, and the torque along frozen arcs.

Pads cut to the PCL lie on the floor's ledges, so that plate and floor are the two sheets of the lap. Above rigid
modules lies a spreader of metal, stiffer than a printed plate, which is the lower sheet; its seat of adhesive hands
over to the floor what it has taken (`spreader_seat`).
"""

from math import pi

import numpy as np

from tvimdesign.device.components.liner_and_adhesive import WITH_LINER
from tvimdesign.device.core.clearances import MM, POCKET_WIDTH
from tvimdesign.device.core.heater_form import CUT, WITH_CUTOUT, WITH_TILES
from tvimdesign.device.table import Module, QuantityGroup, Scalar, at_least, at_most
from tvimdesign.physics.layers import shear_lag
from tvimdesign.physics.solids import structure
from tvimdesign.physics.solids.shapes import NOTHING, Section, inner_corner, outer_corner, rectangle_at, sector, stacked

weights = QuantityGroup("Size and weight")
_SPANDREL = (5.0 / 6.0 - 0.25 * pi) / (1.0 - 0.25 * pi)


@weights.helper()
def pcl_section(m: Module) -> Section:
    """Plan view of all PCL arcs together."""
    return sector(m.arc_count * m.arc_span, m.pcl_inner_radius, m.pcl_outer_radius)


weights.field("pcl_area", "pcl_section", "area", "Contact area of all PCL arcs together", "mm^2", headline=True)


weights.formulas("arcs")


def _rounded_sector(span: Scalar, inner_radius: Scalar, outer_radius: Scalar, corner_radius: Scalar) -> Section:
    """Return the annular sector less what fillets take from its corners, which counts where its middle is in a square
    corner.

    That is (5/6 - pi/4)/(1 - pi/4) of the fillet's radius from either side (a square less a quarter of a disc).
    """
    beside = _SPANDREL * corner_radius
    outer, inner = outer_corner(corner_radius, outer_radius, 0.0), inner_corner(corner_radius, inner_radius, 0.0)
    moment = outer * ((outer_radius - beside) ** 2 + beside**2) + inner * ((inner_radius + beside) ** 2 + beside**2)
    return sector(span, inner_radius, outer_radius) - Section(2.0 * (outer + inner), 2.0 * moment)


@weights.helper()
def pad_section(m: Module) -> Section:
    """Plan view of all heaters: the outline of the PCL, its corners as round as those of the pockets."""
    return _rounded_sector(m.arc_span, m.pcl_inner_radius, m.pcl_outer_radius, m.corner_radius).times(m.arc_count)


@weights.output("mm^3")
def heater_volume(m: Module) -> Scalar:
    """Volume of all heaters together: cut to the pockets' outline, or rectangular tiles."""
    if m.heater_form == CUT:
        return m.pad_section.area * m.heater_thickness
    return m.heater_count * m.heater_width * (m.heater_length - 0.5 * m.heater_porch) * m.heater_thickness


@weights.helper()
def window_section(m: Module) -> Section:
    """Plan view of the windows below the heaters: arcs or tiles, less a ledge on every side, rounded."""
    if m.heater_form != CUT:
        sides = (m.heater_width - 2.0 * m.window_ledge, m.cold_plate_length - 2.0 * m.window_ledge)
        away = np.sqrt(m.tile_radius**2 + (0.5 * m.heater_porch) ** 2)
        return rectangle_at(*sides, away, m.corner_radius).times(m.heater_count)
    inner, outer = m.pcl_inner_radius + m.window_ledge, m.pcl_outer_radius - m.window_ledge
    return _rounded_sector(m.window_span, inner, outer, m.corner_radius).times(m.arc_count)


@weights.helper()
def floor_openings(m: Module) -> Section:
    """Volume of the floor's openings and its polar moment: pockets, windows, slots for leads, thermistor's seat."""
    pocket = _rounded_sector(m.pocket_span, m.pocket_inner_radius, m.pocket_outer_radius, m.corner_radius)
    pockets = (pocket.times(m.arc_count), m.pad_depth)
    opened = stacked(pockets, (m.window_section, m.floor_web), (m.lead_hole_section, m.floor_web))
    return opened.plus(m.thermistor_seat_moments)


@weights.helper(requires=WITH_LINER, default=NOTHING)
def liner_moments(m: Module) -> Section:
    """Volume of all liners and its polar moment about the axis; a liner goes into its recess with a slip clearance."""
    inner, outer = m.pcl_inner_radius + m.slip_clearance, m.pcl_outer_radius - m.slip_clearance
    return _rounded_sector(m.liner_span, inner, outer, m.corner_radius).times(m.arc_count * m.liner_thickness)


@weights.helper(requires=WITH_LINER, default=NOTHING)
def liner_recess(m: Module) -> Section:
    """Volume of the recesses for the liners, which have the outline of the PCL, and its polar moment about the axis."""
    return m.pad_section.times(m.liner_depth)


@weights.helper()
def rotor_moments(m: Module) -> Section:
    """Volume and its polar moment about the axis, of the rotor with its lips, less pockets for keys and for liners."""
    return m.bare_rotor_moments.plus(m.melt_lip_moments) - m.key_moments - m.liner_recess


rules, places = QuantityGroup("Gaps"), QuantityGroup("Layout")


rules.after("leg_reach_gap")


rules.margins("arcs")


@rules.output("mm", at_least(3.0 * MM, "the floor needs a web between two heaters", 0.0))
def arc_gap(m: Module) -> Scalar:
    """Web between neighbouring PCL arcs at their inner radius."""
    return (2.0 * np.pi / m.arc_count - m.arc_span) * m.pcl_inner_radius


@rules.output("mm", at_least(2.0 * MM, "the heater needs its ledges and a window for its cold side", 0.0))
def arc_width(m: Module) -> Scalar:
    """Radial width of the PCL arcs."""
    return m.pcl_outer_radius - m.pcl_inner_radius


@places.output("mm", at_least(0.0, "a heater needs a window behind its ledges for its cold side", 0.0))
def window_depth(m: Module) -> Scalar:
    """Radial width of the windows below the heaters."""
    return (m.arc_width if m.heater_form == CUT else m.heater_width) - 2.0 * m.window_ledge


@rules.output("mm", at_least(0.0, "there must be a floor below a heater", 0.0))
def floor_web(m: Module) -> Scalar:
    """Thickness of the floor below the heaters."""
    return m.floor_thickness - m.pad_depth


rules.after("retainer_gap")


@places.output("mm", at_least(2.0 * MM, "the window below a heater must have a width", 0.0))
def window_width(m: Module) -> Scalar:
    """Width of the windows below the heaters, along the arc: of an arc's at its inner radius."""
    return (m.arc_span * m.pcl_inner_radius if m.heater_form == CUT else m.cold_plate_length) - 2.0 * m.window_ledge


rules.after("mount_wall_gap")


@places.output("mm", requires=WITH_CUTOUT)
def cutout_radius(m: Module) -> Scalar:
    """Distance of the thermal cut-out's middle from the axis: below the middle of the window; zero without."""
    return m.pcl_mean_radius if m.heater_form == CUT else m.tile_radius


@places.output("mm", hidden=True, requires=WITH_CUTOUT)
def cutout_drop(m: Module) -> Scalar:
    """Distance of the thermal cut-out from the floor, which a pad's leads pass; zero with tiles, or without one."""
    return m.lead_diameter + 2.0 * m.lead_clearance if m.heater_form == CUT else 0.0


rules.same("liner_web", "backing_depth", "Rotor plate above a liner; zero without", "mm", requires=WITH_LINER)


_KEYED = "keys of the PCL would stand in the liner: key_count 0, or liner_material: none"


@rules.output("1", at_most(0.5, _KEYED), requires=WITH_LINER)
def keys_in_liner(m: Module) -> Scalar:
    """Keys of an arc that would have to go through its liner; zero without."""
    return m.key_count


_NARROW = "a window must be wider than the cutter of its corners: widen it, or choose a smaller corner_radius"


@rules.gap(_NARROW)
def window_width_margin(m: Module) -> Scalar:
    """Width of the windows at their inner radius beyond what their corners need."""
    return m.window_width - POCKET_WIDTH * m.corner_radius


@rules.gap(_NARROW)
def window_depth_margin(m: Module) -> Scalar:
    """Radial width of the windows beyond what their corners need."""
    return m.window_depth - POCKET_WIDTH * m.corner_radius


quantities = QuantityGroup("Impedance")


@quantities.helper()
def driven_share(m: Module) -> Scalar:
    """Share of the circle that the arcs cover [1]."""
    return m.arc_count * m.arc_span / (2.0 * np.pi)


@quantities.helper(requires=WITH_LINER)
def liner_areal_compliance(m: Module) -> Scalar:
    """Shear of a liner under a traction [m/Pa]; zero without."""
    return m.liner_thickness / m.liner_shear_modulus


@quantities.helper()
def lap_of_arcs(m: Module) -> tuple[Scalar, Scalar, Scalar]:
    """Frozen layer and pads per area [Pa/m], and the sheets on both sides, plate and floor [1/(Pa*m)]."""
    layer = m.pcl_thickness / m.frozen_shear_modulus + m.liner_areal_compliance
    per_area = 1.0 / (layer + m.heater_thickness / m.heater_shear_modulus)
    sheet = (
        np.sqrt(m.driven_share) / m.structure_shear_modulus
    )  # of the circle the arcs take up a share: as in the plate
    return per_area, sheet / m.backing_depth, sheet / m.floor_web


@quantities.helper(requires=WITH_TILES)
def windowed_share(m: Module) -> Scalar:
    """Share of the circle through their middles that the windows below rigid modules take up [1]."""
    return m.heater_count * (m.cold_plate_length - 2.0 * m.window_ledge) / (2.0 * np.pi * m.tile_radius)


@quantities.helper(requires=WITH_TILES, default=None)
def lap_on_spreader(m: Module) -> shear_lag.AnnularLap:
    """Frozen layer between the plate and a spreader, whose inner rim takes a share of the torque.

    The plate bears all around, and gives over its thickness besides.
    """
    plate = m.structure_shear_modulus * m.backing_depth
    metal = m.driven_share * m.spreader_shear_modulus * m.spreader_depth
    radii = m.pcl_inner_radius, m.pcl_outer_radius
    layer = m.driven_share * _foundation_below_plate(m)
    return shear_lag.annular_lap(layer, 1.0 / plate, 1.0 / metal, radii, m.seat_path.inward)


def _foundation_below_plate(m: Module) -> Scalar:
    """Return the stiffness per area of frozen layer and liner, and of the plate over its thickness [Pa/m]."""
    over_thickness = m.backing_depth / (3.0 * m.structure_shear_modulus)
    return 1.0 / (m.pcl_thickness / m.frozen_shear_modulus + m.liner_areal_compliance + over_thickness)


@quantities.helper()
def over_arcs_compliance(m: Module) -> Scalar:
    """Compliance of the rotor plate above the arcs [rad/(N*m)]: as it leads the torque on, and over its thickness.

    The layer relieves it evenly, or as a spreader takes the torque over.
    """
    radii = m.pcl_inner_radius, m.pcl_outer_radius
    whole = structure.covered_ring_stiffness(m.structure_shear_modulus, m.backing_depth, *radii, m.driven_share)
    over_thickness = structure.face_compliance(m.structure_shear_modulus, m.backing_depth, m.layer_polar_moment)
    if m.lap_on_spreader is None:
        return structure.evenly_relieved(*radii) / whole + over_thickness
    return shear_lag.upper_share(m.lap_on_spreader) / whole + shear_lag.unevenness(m.lap_on_spreader) * over_thickness


def _under_pads_compliance(m: Module) -> Scalar:
    """Return the compliance of the floor between the ledges of pads cut to the PCL, and up to its rim [rad/(N*m)].

    The inner half of an arc hangs on the inner ledge, the outer half on the outer; between arcs the floor is whole.
    """
    inner, outer = m.pcl_inner_radius + 0.5 * m.window_ledge, m.pcl_outer_radius - 0.5 * m.window_ledge
    per_area, polar = m.lap_of_arcs[0], 0.25 * m.arc_count * m.arc_span
    halves = m.pcl_mean_radius**4 - m.pcl_inner_radius**4, m.pcl_outer_radius**4 - m.pcl_mean_radius**4
    seats = 1.0 / (per_area * polar * halves[0]), 1.0 / (per_area * polar * halves[1])
    opened = m.arc_count * m.window_span / (2.0 * np.pi)
    beside = (1.0 - m.driven_share) * m.floor_thickness + (m.driven_share - opened) * m.floor_web
    ribs = structure.ring_stiffness(m.structure_shear_modulus, beside, inner, outer)
    hoop = structure.hoop_compliance(
        m.structure_youngs_modulus, m.floor_web * m.window_ledge, m.window_span * inner, m.arc_count, inner
    )
    rims = m.pcl_outer_radius - m.window_ledge, m.pcl_outer_radius
    beyond = structure.ring_stiffness(m.structure_shear_modulus, m.driven_share * m.floor_web, *rims)
    return structure.under_ledges_compliance(seats, 1.0 / ribs + hoop, 1.0 / beyond)


@quantities.helper()
def under_arcs_compliance(m: Module) -> Scalar:
    """Compliance of the floor below the arcs, or around spreaders, out to their rim [rad/(N*m)]."""
    return _under_pads_compliance(m) if m.heater_form == CUT else m.seat_path.floor


@quantities.helper(requires=WITH_LINER)
def liner_in_layer(m: Module) -> Scalar:
    """Compliance of a liner over that of the layer, and of pads that are sheared [1]; zero without."""
    on_tiles = m.lap_on_spreader is not None
    others = m.pcl_thickness / m.frozen_shear_modulus if on_tiles else 1.0 / m.lap_of_arcs[0] - m.liner_areal_compliance
    return m.liner_areal_compliance / others


@quantities.helper(requires=WITH_LINER, default=1.0)
def liner_wall_rise(m: Module) -> Scalar:
    """Traction beside a wall around a liner, a mean over a thickness of the layer, over that far from it [1].

    The adhesive that fills the gap around a liner holds it on the walls of its recess, so that it gives less below the
    layer's rims.
    """
    return shear_lag.rim_rise(m.liner_in_layer, m.pcl_thickness / m.liner_thickness)


@quantities.helper(requires=WITH_LINER, default=1.0)
def liner_rim_rise(m: Module) -> Scalar:
    """Traction along the rims of the arcs over that without walls around the liners [1].

    What these bear more, all of the layer bears less.
    """
    inner, outer = m.pcl_inner_radius, m.pcl_outer_radius
    rims = m.arc_count * (m.arc_span * (inner**3 + outer**3) + 2.0 / 3.0 * (outer**3 - inner**3))  # of r^2, all around
    more = m.liner_thickness * shear_lag.rim_width(m.liner_in_layer) * rims / m.layer_polar_moment
    return m.liner_wall_rise / (1.0 + more)


@quantities.output("1")
def layer_edge_rise(m: Module) -> Scalar:
    """Highest traction of the frozen layer along the rims of its arcs over T r/J at the outer, a mean over a thickness.

    Plate and floor stretch, so that the torque leaves at the outer rim, and what is above the windows bears little. On
    a spreader that is stiffer than the plate it leaves at the inner rim, and most at its ends. Beside the walls around
    a liner it is higher.
    """
    radii = m.pcl_inner_radius, m.pcl_outer_radius
    if m.lap_on_spreader is not None:
        layer, sheet = _foundation_below_plate(m), m.structure_youngs_modulus * m.backing_depth
        halves = [(0.5 * m.arc_span * radius, np.pi / m.arc_count * radius) for radius in radii]
        ends = [shear_lag.end_rise(layer, sheet, arc, pitch - arc) for arc, pitch in halves]
        rims = shear_lag.edge_rises(m.lap_on_spreader, m.pcl_thickness)
        return m.liner_wall_rise * m.liner_rim_rise * np.fmax(rims[0] * ends[0], rims[1] * ends[1])
    held = m.held_polar_moment / m.layer_polar_moment
    layer, plate, floor = m.lap_of_arcs
    return m.liner_rim_rise * shear_lag.arc_edge_rise(layer, plate, floor, radii, held)
