"""The PCL blocks of the compression module and what they press on: stiffness, damping, strain, torque they hold.

Of the 2 N blocks only the N that are pressed count. Small motions about rest keep every block touching, so no contact
is lost here; how a gap opens in large ones is a matter of time and history
(`device/core/impedance/creep_under_hold.py`).
"""

from __future__ import annotations

import numpy as np

from tvimdesign.base.record import Record
from tvimdesign.device.core.heat.heater_form import CUT
from tvimdesign.device.core.impedance.joint_impedance import quantities as shared
from tvimdesign.device.core.impedance.structure_stiffness import CORE_PARTS
from tvimdesign.device.core.impedance.warm_structure import Compliances
from tvimdesign.device.fixtures.bearing import with_bearings
from tvimdesign.device.fixtures.dowels import LINK_PARTS
from tvimdesign.device.fixtures.liner import traction_with_liner
from tvimdesign.device.table.quantity import Rule, Scalar
from tvimdesign.device.table.quantity_group import QuantityGroup
from tvimdesign.physics.layers import block, hold, layer
from tvimdesign.physics.motions.motion import Modes
from tvimdesign.physics.solids import structure, vane, wedge

quantities = QuantityGroup(shared.group)


@quantities.output("1")
def shape_factor(block_width: Scalar, block_height: Scalar, block_depth: Scalar) -> Scalar:
    """Loaded face of a block over its force-free sides, S."""
    return block.shape_factor(block_width, block_height, block_depth)


def blocks_moment(shape_factor: Scalar, vane_count: Scalar, block_area: Scalar, pcl_mean_radius: Scalar) -> Scalar:
    """Stiffness of the pressed blocks over shear modulus, times depth [m^4]: 3 (1 + 2 S^2) N A r^2."""
    return block.stiffness(3.0 * block.shape_stiffening(shape_factor), vane_count, block_area, pcl_mean_radius, 1.0)


@quantities.helper()
def pcl_moment(shape_factor: Scalar, vane_count: Scalar, block_area: Scalar, pcl_mean_radius: Scalar) -> Scalar:
    """What the PCL's shear modulus over its depth is multiplied with [m^4]."""
    return blocks_moment(shape_factor, vane_count, block_area, pcl_mean_radius)


@quantities.helper()
def volume_stiffness(
    pcl_flexural_modulus: Scalar,
    pcl_poissons_ratio: Scalar,
    shape_factor: Scalar,
    vane_count: Scalar,
    block_area: Scalar,
    pcl_mean_radius: Scalar,
    block_depth: Scalar,
) -> Scalar:
    """Stiffness of the blocks against a change of volume, in series with their shear modes [N*m/rad]."""
    bulk = block.bulk_modulus(pcl_flexural_modulus, pcl_poissons_ratio)
    modulus = block.volumetric_modulus(bulk, shape_factor)
    return block.stiffness(modulus, vane_count, block_area, pcl_mean_radius, block_depth)


@quantities.helper(per_point=True)
def pcl_dynamic_stiffness(
    pcl_moduli: tuple[Scalar, Scalar], pcl_moment: Scalar, block_depth: Scalar, volume_stiffness: Scalar
) -> tuple[Scalar, Scalar]:
    """Real and imaginary stiffness of the blocks [N*m/rad]."""
    storage, loss = (modulus * pcl_moment / block_depth for modulus in pcl_moduli)
    return layer.series_stiffness(storage, loss, volume_stiffness)


@quantities.output("N*m/rad", per_point=True, headline=True)
def pcl_stiffness(pcl_dynamic_stiffness: tuple[Scalar, Scalar]) -> Scalar:
    """Stiffness of the PCL blocks alone, those of one sense, K_PCL."""
    return pcl_dynamic_stiffness[0]


@quantities.output("N*m*s/rad", per_point=True, headline=True)
def pcl_damping(pcl_dynamic_stiffness: tuple[Scalar, Scalar], frequency: Scalar) -> Scalar:
    """Damping of the PCL blocks alone, those of one sense, b_PCL."""
    return pcl_dynamic_stiffness[1] / (2.0 * np.pi * frequency)


@quantities.output("mm")
def housing_vane_thickness(slot_angle: Scalar, pcl_mean_radius: Scalar) -> Scalar:
    """Thickness of the housing's vanes between their pads, at the mean radius."""
    return slot_angle * pcl_mean_radius


@quantities.helper()
def core_foot_rise(
    core_radius: Scalar,
    link_bottom_level: Scalar,
    rotor_top_level: Scalar,
    rotor_thickness: Scalar,
    core_screw_bores: structure.Bores,
    core_dowel_bores: structure.Bores,
    block_between: vane.BlockBetween,
    block_lean_out: Scalar,
    vanes_plate: wedge.PlateAround,
    foot_fillet: Scalar,
) -> Scalar:
    """Rise of the core's stress at its foot [1]: among the vanes that hang from its plate and cup it, with the link's
    holes."""
    length = link_bottom_level - rotor_top_level
    holes = core_screw_bores, core_dowel_bores
    turned = structure.foot_rise_among_vanes(core_radius, length, rotor_thickness, *holes, fillet=foot_fillet)
    cupped = wedge.foot_bending(block_lean_out, block_between.arm, core_radius, vanes_plate)
    return np.sqrt(turned**2 + cupped**2)


@quantities.helper()
def driven_share() -> Scalar:
    """Share of the circle on which the plate drives the PCL [1]: all of it, its vanes' roots are counted with them."""
    return 1.0


@quantities.helper()
def over_arcs_compliance(
    structure_shear_modulus: Scalar, rotor_thickness: Scalar, pcl_inner_radius: Scalar, pcl_mean_radius: Scalar
) -> Scalar:
    """What the rotor plate gives from the PCL's inner edge to its vanes' middle [rad/(N*m)]."""
    ring = structure.ring_stiffness(structure_shear_modulus, rotor_thickness, pcl_inner_radius, pcl_mean_radius)
    return 1.0 / ring


@quantities.helper()
def under_arcs_compliance() -> Scalar:
    """What the floor gives below the PCL [rad/(N*m)]: nothing, it is counted with the vanes that stand on it."""
    return 0.0


@quantities.helper()
def structure_compliances(
    core_stiffness: Scalar,
    plate_stiffness: Scalar,
    rotor_vane_stiffness: Scalar,
    housing_vane_stiffness: Scalar,
    floor_stiffness: Scalar,
    pcl_mean_radius: Scalar,
    vane_count: Scalar,
    pad_press_stiffness: Scalar,
    liner_compliance: Scalar,
) -> Compliances:
    """What is in series with the blocks: core, plate, vanes, floor up to its feet or its flange, pads and liners."""
    pads = vane_count * pad_press_stiffness * pcl_mean_radius**2
    return Compliances(1.0 / core_stiffness, 1.0 / plate_stiffness, 1.0 / rotor_vane_stiffness,
                       1.0 / housing_vane_stiffness, 1.0 / floor_stiffness, 1.0 / pads + liner_compliance)  # fmt: skip


@quantities.output("N*m/rad")
def structure_stiffness(structure_compliances: Compliances) -> Scalar:
    """Stiffness in series with the blocks, at 23 degC: core, plate, vanes, pads, and floor up to its feet or flange."""
    return 1.0 / sum(structure_compliances)


@quantities.helper()
def floor_ring(floor_thickness: Scalar, vane_count: Scalar, slot_angle: Scalar) -> Scalar:
    """Thickness of the floor within the PCL's outer radius, as if spread evenly [m].

    The floor is weakest where slots cut it: what is left of its circumference there counts.
    """
    return floor_thickness * (1.0 - vane_count * slot_angle / (2.0 * np.pi))


@quantities.helper()
def lossless_compliance(volume_stiffness: Scalar) -> Scalar:
    """What is in series with the PCL's shear modes and structure besides [rad/(N*m)]: the blocks' volume."""
    return 1.0 / volume_stiffness


_SQUEEZED = (
    "squeezed by more than half its depth, the molten block is pressed out of its place (assumed, 0.3 to 0.6; a study "
    "may require its own)"
)


@quantities.output("1", Rule(sense="<=", value=0.5, reason=_SQUEEZED), headline=True)
def block_strain(pcl_mean_radius: Scalar, stroke: Scalar, block_depth: Scalar) -> Scalar:
    """Compression of the molten block at full stroke, of its depth.

    Its volume stays, so a block squeezed by half has twice the face (textbook), which the running clearances beside it
    do not leave it. Where it is pressed out depends on how it is held, which nobody has measured: the limit is assumed.
    """
    return block.strain(pcl_mean_radius, stroke, block_depth)


@quantities.helper()
def largest_melt_strain(block_strain: Scalar, shape_factor: Scalar) -> Scalar:
    """Shear strain [1] that costs the molten block as much as its squeeze at full stroke."""
    return block.equivalent_shear_strain(block_strain, shape_factor)


@quantities.helper()
def stroke_strains(largest_melt_strain: Scalar) -> list[tuple[Scalar, Scalar]]:
    """Shear strain of the blocks at full stroke, and the share of the small-motion torque it bears: all [1]."""
    return [(largest_melt_strain, 1.0)]


@quantities.output("N*m")
def block_holding_torque(
    pcl_tensile_yield: Scalar,
    liner_material: Record | str,
    liner_strength: Scalar,
    vane_count: Scalar,
    block_area: Scalar,
    pcl_mean_radius: Scalar,
) -> Scalar:
    """Torque at which the frozen blocks, or the liners they press on, yield."""
    stress = traction_with_liner(liner_material, pcl_tensile_yield, liner_strength)
    return block.torque_at_stress(stress, vane_count, block_area, pcl_mean_radius)


@quantities.helper()
def vane_arm(block_height: Scalar, running_clearance: Scalar) -> Scalar:
    """Distance of the middle of a block from the root of the vane it presses on [m]."""
    return 0.5 * block_height + running_clearance


@quantities.output("N*m")
def rotor_vane_holding_torque(
    cold_layer_strength: Scalar,
    block_width: Scalar,
    vane_web: Scalar,
    vane_arm: Scalar,
    block_lean_out: Scalar,
    vane_count: Scalar,
    pcl_mean_radius: Scalar,
    holding_safety: Scalar,
) -> Scalar:
    """Torque at which the roots of the rotor's vanes yield, bent, sheared and twisted, cold, over `holding_safety`."""
    section = block_width, vane_web
    force = wedge.force_at_yield(cold_layer_strength, section, vane_arm, block_lean_out, pcl_mean_radius)
    return vane_count * force * pcl_mean_radius / holding_safety


@quantities.output("N*m")
def housing_vane_holding_torque(
    cold_layer_strength: Scalar,
    vane_webs: Scalar,
    housing_vane_thickness: Scalar,
    vane_arm: Scalar,
    vane_count: Scalar,
    pcl_mean_radius: Scalar,
    holding_safety: Scalar,
) -> Scalar:
    """Torque at which the roots of the housing's vanes yield in bending and shear, cold, over `holding_safety`."""
    force = wedge.force_at_yield(cold_layer_strength, (vane_webs, housing_vane_thickness), vane_arm)
    return vane_count * force * pcl_mean_radius / holding_safety


_PARTS = (
    "block_holding_torque", "heater_holding_torque", "rotor_vane_holding_torque", "housing_vane_holding_torque",
    *CORE_PARTS, *LINK_PARTS, "bearing_holding_torque",
)  # fmt: skip


@quantities.output("N*m", headline=True, least_of=_PARTS)
def holding_torque(
    block_holding_torque: Scalar,
    heater_form: str,
    heater_holding_torque: Scalar,
    rotor_vane_holding_torque: Scalar,
    housing_vane_holding_torque: Scalar,
    core_holding_torque: Scalar,
    link_holding_torque: Scalar,
    bearing: Record | str,
    bearing_holding_torque: Scalar,
) -> Scalar:
    """Torque the frozen joint holds: the least of what blocks, rigid modules, vanes, core, link and bearings bear."""
    vanes = np.fmin(rotor_vane_holding_torque, housing_vane_holding_torque)
    pressed = block_holding_torque if heater_form == CUT else np.fmin(block_holding_torque, heater_holding_torque)
    held = np.fmin(np.fmin(pressed, vanes), np.fmin(core_holding_torque, link_holding_torque))
    return with_bearings(bearing, held, bearing_holding_torque)


@quantities.output("1", headline=True)
def parting_share() -> Scalar:
    """Share of the PCL that can part from what presses on it: all, a block pushes and never pulls.

    It is bonded to one vane at most, and what a hold has crept of its depth is a gap when the load is gone.
    """
    return 1.0


@quantities.output("MPa", per_point=True)
def block_pressure(
    hold_torque: Scalar,
    spring_stiffness: Scalar,
    elastic_support: Scalar,
    pcl_modes: Modes,
    vane_count: Scalar,
    block_area: Scalar,
    pcl_mean_radius: Scalar,
) -> Scalar:
    """Highest mean pressure on the blocks' faces in a hold: when the load has just come on."""
    borne = hold.first_torque(hold_torque, spring_stiffness, elastic_support, pcl_modes)
    return block.stress(borne, vane_count, block_area, pcl_mean_radius)
