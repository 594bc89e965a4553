"""Transfer of the torque along the frozen arcs: compliance of plate and floor there, and traction at the edges.

Pads cut to the PCL lie on the floor's ledges, so that plate and floor are the two sheets of the lap. Above rigid
modules lies a spreader of metal, stiffer than a printed plate, which is the lower sheet; its seat of adhesive hands
over to the floor what it has taken (`spreader_seat`).
"""

import numpy as np

from tvimdesign.device.components.liner import WITH_LINER
from tvimdesign.device.core.heat.heater_form import CUT, WITH_TILES
from tvimdesign.device.table.module import Module
from tvimdesign.device.table.quantity import Scalar
from tvimdesign.device.table.quantity_group import QuantityGroup
from tvimdesign.physics.layers import shear_lag
from tvimdesign.physics.solids import structure

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
    per_area = 1.0 / (layer + m.peltier_thickness / m.peltier_shear_modulus)
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
    """Frozen layer between the plate and a spreader, whose inner rim takes a share of the torque."""
    plate = np.sqrt(m.driven_share) * m.structure_shear_modulus * m.backing_depth
    metal = m.driven_share * m.spreader_shear_modulus * m.spreader_depth
    layer = m.driven_share / (m.pcl_thickness / m.frozen_shear_modulus + m.liner_areal_compliance)
    radii = m.pcl_inner_radius, m.pcl_outer_radius
    return shear_lag.annular_lap(layer, 1.0 / plate, 1.0 / metal, radii, m.seat_path.inward)


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


@quantities.helper(requires=WITH_LINER, default=1.0)
def liner_rim_rise(m: Module) -> Scalar:
    """Traction along the rims of the arcs over that without walls around the liners [1].

    The adhesive that fills the gap around a liner holds it on the walls of its recess, so that it gives less below the
    layer's rims. What these bear more, all of the layer bears less.
    """
    on_tiles = m.lap_on_spreader is not None
    others = m.pcl_thickness / m.frozen_shear_modulus if on_tiles else 1.0 / m.lap_of_arcs[0] - m.liner_areal_compliance
    held, inner, outer = m.liner_areal_compliance / others, m.pcl_inner_radius, m.pcl_outer_radius
    rims = m.arc_count * (m.arc_span * (inner**3 + outer**3) + 2.0 / 3.0 * (outer**3 - inner**3))  # of r^2, all around
    more = m.liner_thickness * shear_lag.rim_width(held) * rims / m.layer_polar_moment
    return shear_lag.rim_rise(held, m.pcl_thickness / m.liner_thickness) / (1.0 + more)


@quantities.output("1")
def layer_edge_rise(m: Module) -> Scalar:
    """Highest traction of the frozen layer along the rims of its arcs over T r/J at the outer, a mean over a thickness.

    Plate and floor stretch, so that the torque leaves at the outer rim, and what is above the windows bears little. On
    a spreader that is stiffer than the plate it leaves at the inner rim. Beside the walls around a liner it is higher.
    """
    if m.lap_on_spreader is not None:
        return m.liner_rim_rise * np.fmax(*shear_lag.edge_rises(m.lap_on_spreader))
    held = m.held_polar_moment / m.layer_polar_moment
    radii = m.pcl_inner_radius, m.pcl_outer_radius
    layer, plate, floor = m.lap_of_arcs
    return m.liner_rim_rise * shear_lag.arc_edge_rise(layer, plate, floor, radii, held)
