"""The PCL layer of the shear module and what it works against: stiffness, damping, strain, and the torque it holds."""

from __future__ import annotations

import numpy as np

from tvimdesign.base.record import Record
from tvimdesign.device.core.heat.heater_form import CUT
from tvimdesign.device.core.impedance.joint_impedance import quantities as shared
from tvimdesign.device.core.impedance.structure_stiffness import CORE_PARTS
from tvimdesign.device.core.impedance.warm_structure import Compliances
from tvimdesign.device.fixtures.bearing import with_bearings
from tvimdesign.device.fixtures.dowels import LINK_PARTS
from tvimdesign.device.fixtures.liner import WITH_LINER, traction_with_liner
from tvimdesign.device.table.quantity import Rule, Scalar
from tvimdesign.device.table.quantity_group import QuantityGroup
from tvimdesign.physics.bodies.shapes import Section
from tvimdesign.physics.layers import hold, layer, shear_lag
from tvimdesign.physics.motions.motion import Modes
from tvimdesign.physics.polymers import large_strain
from tvimdesign.physics.solids import structure

quantities = QuantityGroup(shared.group)


@quantities.output("m^4")
def layer_polar_moment(pcl_section: Section) -> Scalar:
    """Polar second moment of area of the PCL layer."""
    return pcl_section.polar


@quantities.output("N*m/rad", per_point=True, headline=True)
def pcl_stiffness(storage_modulus: Scalar, layer_polar_moment: Scalar, pcl_thickness: Scalar) -> Scalar:
    """Stiffness of the PCL layer alone, K_PCL."""
    return storage_modulus * layer_polar_moment / pcl_thickness


@quantities.output("N*m*s/rad", per_point=True, headline=True)
def pcl_damping(loss_modulus: Scalar, layer_polar_moment: Scalar, pcl_thickness: Scalar, frequency: Scalar) -> Scalar:
    """Damping of the PCL layer alone, b_PCL."""
    return loss_modulus * layer_polar_moment / pcl_thickness / (2.0 * np.pi * frequency)


@quantities.helper()
def window_span(arc_span: Scalar, window_ledge: Scalar, pcl_inner_radius: Scalar) -> Scalar:
    """Angle that the window below an arc takes up [rad]."""
    return arc_span - 2.0 * window_ledge / pcl_inner_radius


@quantities.helper()
def held_pads(
    heater_form: str,
    layer_polar_moment: Scalar,
    window_section: Section,
    window_depth: Scalar,
    window_span: Scalar,
    pcl_mean_radius: Scalar,
    peltier_thickness: Scalar,
    peltier_shear_modulus: Scalar,
    peltier_bulk_modulus: Scalar,
) -> Scalar:
    """Polar moment of the pads [m^4] less what gives above the windows, along both rims and both ends of each.

    A spreader bridges the windows.
    """
    if heater_form != CUT:
        return layer_polar_moment
    fringe = shear_lag.end_fringe(peltier_shear_modulus, peltier_bulk_modulus)
    across = shear_lag.held_over_window(peltier_thickness, 0.5 * window_depth)
    along = shear_lag.held_over_window(peltier_thickness, 0.5 * window_span * pcl_mean_radius, fringe)
    return layer_polar_moment - (1.0 - across) * (1.0 - along) * window_section.polar


@quantities.helper()
def held_polar_moment(
    heater_form: str,
    layer_polar_moment: Scalar,
    window_section: Section,
    frozen_shear_modulus: Scalar,
    pcl_thickness: Scalar,
    peltier_shear_modulus: Scalar,
    peltier_thickness: Scalar,
    window_depth: Scalar,
    held_pads: Scalar,
) -> Scalar:
    """Polar moment of the frozen layer [m^4] less what it does not bear above the windows, which do not hold the pads.

    Under the layer a pad gives over a third of its own thickness, as a sheet that is sheared along its upper face. No
    less is held than of pads under a stiff layer, as one that gives evens out. A spreader bridges the windows, so it
    holds all of the layer.
    """
    if heater_form != CUT:
        return layer_polar_moment
    per_area = 1.0 / (pcl_thickness / frozen_shear_modulus + peltier_thickness / (3.0 * peltier_shear_modulus))
    sheet = 1.0 / (peltier_shear_modulus * peltier_thickness)
    borne = shear_lag.borne_over_window(per_area, sheet, 0.5 * window_depth)
    return np.fmax(layer_polar_moment - (1.0 - borne) * window_section.polar, held_pads)


@quantities.helper(requires=WITH_LINER)
def liner_shear_modulus(liner_youngs_modulus: Scalar, liner_poissons_ratio: Scalar) -> Scalar:
    """Shear modulus of the liner [Pa]."""
    return structure.shear_modulus(liner_youngs_modulus, liner_poissons_ratio)


@quantities.helper(requires=WITH_LINER, default=np.inf)
def liner_traction(liner_bond_strength: Scalar, liner_strength: Scalar) -> Scalar:
    """Shear that a liner and its bond bear [Pa]: nothing gives way where there is none."""
    return np.fmin(liner_bond_strength, structure.shear_yield(liner_strength))


@quantities.helper(requires=WITH_LINER)
def liner_compliance(liner_thickness: Scalar, liner_shear_modulus: Scalar, layer_polar_moment: Scalar) -> Scalar:
    """Compliance of the liners in shear about the axis [rad/(N*m)]; zero without."""
    return liner_thickness / (liner_shear_modulus * layer_polar_moment)


@quantities.helper()
def core_foot_rise(
    core_radius: Scalar,
    link_bottom_level: Scalar,
    rotor_top_level: Scalar,
    rotor_thickness: Scalar,
    core_screw_bores: structure.Bores,
    core_dowel_bores: structure.Bores,
    foot_fillet: Scalar,
) -> Scalar:
    """Rise of the core's stress at its foot [1]: on a plate that the arcs drive, with the holes of the link."""
    length = link_bottom_level - rotor_top_level
    holes = core_screw_bores, core_dowel_bores
    return structure.foot_rise_on_plate(core_radius, length, rotor_thickness, *holes, fillet=foot_fillet)


@quantities.helper()
def structure_compliances(
    core_stiffness: Scalar,
    plate_stiffness: Scalar,
    floor_stiffness: Scalar,
    over_arcs_compliance: Scalar,
    pad_compliance: Scalar,
    liner_compliance: Scalar,
) -> Compliances:
    """What is in series with the layer: core, rotor plate inside the arcs and above them, floor, pads and liners."""
    above, below = over_arcs_compliance, 1.0 / floor_stiffness
    sheets = pad_compliance + liner_compliance
    return Compliances(1.0 / core_stiffness, 1.0 / plate_stiffness - above, above, 0.0, below, sheets)


@quantities.output("N*m/rad")
def structure_stiffness(structure_compliances: Compliances) -> Scalar:
    """Stiffness in series with the layer, at 23 degC: core, plate, pads, and floor up to its feet or sensor flange."""
    return 1.0 / sum(structure_compliances)


@quantities.helper()
def floor_ring(floor_web: Scalar) -> Scalar:
    """Thickness of the floor within the PCL's outer radius [m]: its web, where pockets and windows thin it."""
    return floor_web


@quantities.helper()
def pcl_moment(layer_polar_moment: Scalar) -> Scalar:
    """What the PCL's shear modulus over its depth is multiplied with [m^4]: the layer's polar moment."""
    return layer_polar_moment


@quantities.helper()
def lossless_compliance() -> Scalar:
    """What is in series with the PCL's shear modes and structure besides [rad/(N*m)]: nothing."""
    return 0.0


@quantities.output("1", headline=True)
def layer_strain(pcl_outer_radius: Scalar, stroke: Scalar, pcl_thickness: Scalar) -> Scalar:
    """Shear strain of the molten layer at its outer radius at full stroke."""
    return layer.shear_strain(pcl_outer_radius, stroke, pcl_thickness)


@quantities.output("1", Rule(sense=">=", value=1.0, reason="the molten layer would tear or slip"))
def layer_strain_safety(pcl_melt_strain_limit: Scalar, layer_strain: Scalar) -> Scalar:
    """Strain the molten layer bears over the strain it sees."""
    return pcl_melt_strain_limit / layer_strain


@quantities.helper()
def largest_melt_strain(layer_strain: Scalar) -> Scalar:
    """Largest shear strain of the molten layer at full stroke [1]: that at its outer radius."""
    return layer_strain


@quantities.helper()
def stroke_strains(
    layer_strain: Scalar, pcl_inner_radius: Scalar, pcl_outer_radius: Scalar
) -> list[tuple[Scalar, Scalar]]:
    """Shear strains of the layer at full stroke, and the share of the small-motion torque borne at each [1]."""
    nodes = large_strain.ring(pcl_inner_radius / pcl_outer_radius)
    return [(layer_strain * reach, share) for reach, share in nodes]


@quantities.output("N*m")
def layer_holding_torque(
    pcl_bond_strength: Scalar,
    pcl_tensile_yield: Scalar,
    liner_material: Record | str,
    liner_traction: Scalar,
    layer_polar_moment: Scalar,
    pcl_outer_radius: Scalar,
) -> Scalar:
    """Torque at which the frozen layer's bond, its shear yield, or a liner on it gives way at its outer rim."""
    traction = np.fmin(pcl_bond_strength, structure.shear_yield(pcl_tensile_yield))
    traction = traction_with_liner(liner_material, traction, liner_traction)
    return layer.torque_at_traction(traction, layer_polar_moment, pcl_outer_radius)


_PARTS = ("layer_holding_torque", *CORE_PARTS, *LINK_PARTS, "bearing_holding_torque")


@quantities.output("N*m", headline=True, least_of=_PARTS)
def holding_torque(
    layer_holding_torque: Scalar,
    core_holding_torque: Scalar,
    link_holding_torque: Scalar,
    bearing: Record | str,
    bearing_holding_torque: Scalar,
) -> Scalar:
    """Torque the frozen joint holds: the least of what the layer, the core, what holds the link, and bearings bear."""
    held = np.fmin(np.fmin(layer_holding_torque, core_holding_torque), link_holding_torque)
    return with_bearings(bearing, held, bearing_holding_torque)


@quantities.output("MPa")
def layer_edge_traction(
    layer_edge_rise: Scalar, holding_torque: Scalar, layer_polar_moment: Scalar, pcl_outer_radius: Scalar
) -> Scalar:
    """Traction along the edge of an arc under the torque the joint holds, a mean over one thickness of the layer."""
    return layer_edge_rise * layer.traction(holding_torque, layer_polar_moment, pcl_outer_radius)


_PEELS = "the bond may give way along the arcs' edges before the joint bears what it is said to hold"


@quantities.output("1", advice=(Rule(sense=">=", value=1.0, reason=_PEELS),))
def layer_edge_safety(pcl_bond_strength: Scalar, layer_edge_traction: Scalar) -> Scalar:
    """Strength of the bond over the traction along the edge of an arc under the torque the joint holds."""
    return pcl_bond_strength / layer_edge_traction


@quantities.output("1", headline=True)
def parting_share() -> Scalar:
    """Share of the PCL that can part from what presses on it: none, the layer is bonded to both its faces.

    It pulls as well as it pushes, so no hold opens a gap and a swing loses no contact. The bond pays for it.
    """
    return 0.0


@quantities.output("N*m", per_point=True)
def layer_torque(hold_torque: Scalar, spring_stiffness: Scalar, elastic_support: Scalar, pcl_modes: Modes) -> Scalar:
    """What the layer bears in a hold when the load has just come on: the springs bear the rest."""
    return hold.first_torque(hold_torque, spring_stiffness, elastic_support, pcl_modes)


@quantities.output("MPa", per_point=True)
def bond_traction(layer_torque: Scalar, layer_polar_moment: Scalar, pcl_outer_radius: Scalar) -> Scalar:
    """Highest traction on the layer's bond in a hold: at its outer rim, when the load has just come on."""
    return layer.traction(layer_torque, layer_polar_moment, pcl_outer_radius)
