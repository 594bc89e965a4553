"""How the frozen layer takes the torque over along its arcs: what plate and floor give there, and the edges' traction.

Pads cut to the PCL lie on the floor's ledges, so that plate and floor are the two sheets of the lap. On rigid modules
lies a spreader of metal, stiffer than a printed plate, which is the lower sheet; the modules hand over to the ledges of
their windows what the spreader has taken.
"""

from __future__ import annotations

import numpy as np

from tvimdesign.device.core.heat.heater_form import CUT, WITH_TILES
from tvimdesign.device.core.impedance.joint_impedance import quantities as shared
from tvimdesign.device.fixtures.liner import WITH_LINER
from tvimdesign.device.table.quantity import Scalar
from tvimdesign.device.table.quantity_group import QuantityGroup
from tvimdesign.physics.layers import annular_lap, shear_lag, sheet_in_recess
from tvimdesign.physics.solids import structure

quantities = QuantityGroup(shared.group)


@quantities.helper()
def driven_share(arc_count: Scalar, arc_span: Scalar) -> Scalar:
    """Share of the circle that the arcs cover [1]."""
    return arc_count * arc_span / (2.0 * np.pi)


@quantities.helper(requires=WITH_LINER)
def liner_give(liner_thickness: Scalar, liner_shear_modulus: Scalar) -> Scalar:
    """How far a liner shears under a traction [m/Pa]; zero without."""
    return liner_thickness / liner_shear_modulus


@quantities.helper()
def lap_of_arcs(
    frozen_shear_modulus: Scalar,
    pcl_thickness: Scalar,
    peltier_shear_modulus: Scalar,
    peltier_thickness: Scalar,
    structure_shear_modulus: Scalar,
    backing_depth: Scalar,
    floor_web: Scalar,
    driven_share: Scalar,
    liner_give: Scalar,
) -> tuple[Scalar, Scalar, Scalar]:
    """Frozen layer and pads per area [Pa/m], and the sheets on both sides, plate and floor [1/(Pa*m)]."""
    layer = pcl_thickness / frozen_shear_modulus + liner_give
    per_area = 1.0 / (layer + peltier_thickness / peltier_shear_modulus)
    sheet = np.sqrt(driven_share) / structure_shear_modulus  # of the circle the arcs take up a share: as in the plate
    return per_area, sheet / backing_depth, sheet / floor_web


@quantities.helper(requires=WITH_TILES)
def tiled_share(heater_count: Scalar, peltier_length: Scalar, tile_radius: Scalar) -> Scalar:
    """Share of the circle through their middles that rigid modules take up [1]."""
    return heater_count * peltier_length / (2.0 * np.pi * tile_radius)


@quantities.helper(requires=WITH_TILES)
def windowed_share(heater_count: Scalar, peltier_length: Scalar, window_ledge: Scalar, tile_radius: Scalar) -> Scalar:
    """Share of the same circle that the windows below rigid modules take up [1]."""
    return heater_count * (peltier_length - 2.0 * window_ledge) / (2.0 * np.pi * tile_radius)


@quantities.helper(requires=WITH_TILES, default=None)
def lap_on_spreader(
    frozen_shear_modulus: Scalar,
    pcl_thickness: Scalar,
    spreader_shear_modulus: Scalar,
    spreader_depth: Scalar,
    peltier_shear_modulus: Scalar,
    peltier_thickness: Scalar,
    structure_shear_modulus: Scalar,
    backing_depth: Scalar,
    floor_web: Scalar,
    driven_share: Scalar,
    tiled_share: Scalar,
    windowed_share: Scalar,
    pcl_inner_radius: Scalar,
    pcl_outer_radius: Scalar,
    liner_give: Scalar,
) -> annular_lap.AnnularLap:
    """Frozen layer between the plate and a spreader with its modules, which are sheared between that and the floor."""
    plate = np.sqrt(driven_share) * structure_shear_modulus * backing_depth
    metal = driven_share * spreader_shear_modulus * spreader_depth
    modules = tiled_share * peltier_shear_modulus * peltier_thickness
    floor = (1.0 - windowed_share) * structure_shear_modulus * floor_web
    layer = driven_share / (pcl_thickness / frozen_shear_modulus + liner_give)
    below, radii = tiled_share * peltier_shear_modulus / peltier_thickness, (pcl_inner_radius, pcl_outer_radius)
    return annular_lap.lap_of_three((layer, below), (1.0 / plate, 1.0 / (metal + modules), 1.0 / floor), radii)


@quantities.helper()
def over_arcs_compliance(
    lap_on_spreader: annular_lap.AnnularLap | None,
    structure_shear_modulus: Scalar,
    backing_depth: Scalar,
    pcl_inner_radius: Scalar,
    pcl_outer_radius: Scalar,
    driven_share: Scalar,
    layer_polar_moment: Scalar,
) -> Scalar:
    """What the rotor plate gives above the arcs [rad/(N*m)]: as it leads the torque on, and over its thickness.

    The layer relieves it evenly, or as a spreader takes the torque over.
    """
    radii = pcl_inner_radius, pcl_outer_radius
    whole = structure.covered_ring_stiffness(structure_shear_modulus, backing_depth, *radii, driven_share)
    over_thickness = structure.face_compliance(structure_shear_modulus, backing_depth, layer_polar_moment)
    if lap_on_spreader is None:
        return structure.evenly_relieved(*radii) / whole + over_thickness
    return annular_lap.upper_share(lap_on_spreader) / whole + annular_lap.unevenness(lap_on_spreader) * over_thickness


@quantities.helper(requires=WITH_TILES)
def ledge_radii(tile_radius: Scalar, peltier_width: Scalar, window_ledge: Scalar) -> tuple[Scalar, Scalar]:
    """Radii of the middles of the ledges that a rigid module lies on, inner and outer [m]."""
    reach = 0.5 * (peltier_width - window_ledge)
    return tile_radius - reach, tile_radius + reach


@quantities.helper(requires=WITH_TILES)
def under_tiles_compliance(
    structure_youngs_modulus: Scalar,
    structure_shear_modulus: Scalar,
    floor_web: Scalar,
    ledge_radii: tuple[Scalar, Scalar],
    window_ledge: Scalar,
    pcl_outer_radius: Scalar,
    tiled_share: Scalar,
    windowed_share: Scalar,
    heater_count: Scalar,
    peltier_length: Scalar,
    peltier_shear_modulus: Scalar,
    peltier_thickness: Scalar,
) -> Scalar:
    """What the floor gives between the ledges of rigid modules, and from their windows to the arcs' rim [rad/(N*m)]."""
    inner, outer = ledge_radii
    on_ledge = heater_count * peltier_length * window_ledge * peltier_shear_modulus / peltier_thickness
    seats = 1.0 / (on_ledge * inner**2), 1.0 / (on_ledge * outer**2)
    ribs = structure.ring_stiffness(structure_shear_modulus, (1.0 - windowed_share) * floor_web, inner, outer)
    opened = peltier_length - 2.0 * window_ledge
    hoop = structure.hoop_compliance(structure_youngs_modulus, floor_web * window_ledge, opened, heater_count, inner)
    rims = outer - 0.5 * window_ledge, pcl_outer_radius
    beyond = structure.ring_stiffness(structure_shear_modulus, tiled_share * floor_web, *rims)
    return structure.under_ledges_compliance(seats, 1.0 / ribs + hoop, 1.0 / beyond)


@quantities.helper()
def under_pads_compliance(
    lap_of_arcs: tuple[Scalar, Scalar, Scalar],
    structure_youngs_modulus: Scalar,
    structure_shear_modulus: Scalar,
    floor_thickness: Scalar,
    floor_web: Scalar,
    window_ledge: Scalar,
    window_span: Scalar,
    arc_count: Scalar,
    arc_span: Scalar,
    driven_share: Scalar,
    pcl_inner_radius: Scalar,
    pcl_mean_radius: Scalar,
    pcl_outer_radius: Scalar,
) -> Scalar:
    """What the floor gives between the ledges of pads cut to the PCL, and from their windows to its rim [rad/(N*m)].

    The inner half of an arc hangs on the inner ledge, the outer half on the outer; between arcs the floor is whole.
    """
    inner, outer = pcl_inner_radius + 0.5 * window_ledge, pcl_outer_radius - 0.5 * window_ledge
    per_area, polar = lap_of_arcs[0], 0.25 * arc_count * arc_span
    halves = pcl_mean_radius**4 - pcl_inner_radius**4, pcl_outer_radius**4 - pcl_mean_radius**4
    seats = 1.0 / (per_area * polar * halves[0]), 1.0 / (per_area * polar * halves[1])
    opened = arc_count * window_span / (2.0 * np.pi)
    beside = (1.0 - driven_share) * floor_thickness + (driven_share - opened) * floor_web
    ribs = structure.ring_stiffness(structure_shear_modulus, beside, inner, outer)
    hoop = structure.hoop_compliance(
        structure_youngs_modulus, floor_web * window_ledge, window_span * inner, arc_count, inner
    )
    rims = pcl_outer_radius - window_ledge, pcl_outer_radius
    beyond = structure.ring_stiffness(structure_shear_modulus, driven_share * floor_web, *rims)
    return structure.under_ledges_compliance(seats, 1.0 / ribs + hoop, 1.0 / beyond)


@quantities.helper()
def under_arcs_compliance(heater_form: str, under_tiles_compliance: Scalar, under_pads_compliance: Scalar) -> Scalar:
    """What the floor gives below the arcs, out to their rim [rad/(N*m)]."""
    return under_pads_compliance if heater_form == CUT else under_tiles_compliance


@quantities.helper(requires=WITH_LINER, default=1.0)
def liner_rim_rise(
    lap_on_spreader: annular_lap.AnnularLap | None,
    lap_of_arcs: tuple[Scalar, Scalar, Scalar],
    liner_give: Scalar,
    liner_thickness: Scalar,
    frozen_shear_modulus: Scalar,
    pcl_thickness: Scalar,
    pcl_inner_radius: Scalar,
    pcl_outer_radius: Scalar,
    arc_count: Scalar,
    arc_span: Scalar,
    layer_polar_moment: Scalar,
) -> Scalar:
    """Traction along the rims of the arcs over that without walls around the liners [1].

    The adhesive that fills the gap around a liner holds it on the walls of its recess, so that it gives less below the
    layer's rims. What these bear more, all of the layer bears less.
    """
    on_tiles = lap_on_spreader is not None
    others = pcl_thickness / frozen_shear_modulus if on_tiles else 1.0 / lap_of_arcs[0] - liner_give
    held, inner, outer = liner_give / others, pcl_inner_radius, pcl_outer_radius
    rims = arc_count * (arc_span * (inner**3 + outer**3) + 2.0 / 3.0 * (outer**3 - inner**3))  # of r^2, all around
    more = liner_thickness * sheet_in_recess.rim_width(held) * rims / layer_polar_moment
    return sheet_in_recess.rim_rise(held, pcl_thickness / liner_thickness) / (1.0 + more)


@quantities.output("1")
def layer_edge_rise(
    lap_on_spreader: annular_lap.AnnularLap | None,
    lap_of_arcs: tuple[Scalar, Scalar, Scalar],
    pcl_inner_radius: Scalar,
    pcl_outer_radius: Scalar,
    layer_polar_moment: Scalar,
    held_polar_moment: Scalar,
    liner_rim_rise: Scalar,
) -> Scalar:
    """Highest traction of the frozen layer along the rims of its arcs over T r/J at the outer, a mean over a thickness.

    Plate and floor stretch, so that the torque leaves at the outer rim, and what is above the windows bears little. On
    a spreader that is stiffer than the plate it leaves at the inner rim. Beside the walls around a liner it is higher.
    """
    if lap_on_spreader is not None:
        return liner_rim_rise * np.fmax(*annular_lap.edge_rises(lap_on_spreader))
    held = held_polar_moment / layer_polar_moment
    radii = pcl_inner_radius, pcl_outer_radius
    return liner_rim_rise * shear_lag.arc_edge_rise(*lap_of_arcs, radii, held)
