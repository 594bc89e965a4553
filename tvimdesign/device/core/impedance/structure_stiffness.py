"""What carries the PCL's torque out to the link: stiffness of core, plate, floor and link, and when the core yields.

Holes of screws and dowel pins count as empty. The link stands in series beyond the core's top: `joint_stiffness` is
told there, at the hub, and `joint_stiffness_at_link` at the link's tool hole.
"""

from __future__ import annotations

import numpy as np

from tvimdesign.device.core.impedance.joint_impedance import quantities as shared
from tvimdesign.device.core.mass_properties import LINK_SCREWS
from tvimdesign.device.table.quantity import Scalar
from tvimdesign.device.table.quantity_group import QuantityGroup
from tvimdesign.physics.layers.layer import series_stiffness
from tvimdesign.physics.solids import structure, warm

quantities = QuantityGroup(shared.group)


@quantities.helper()
def frozen_shear_modulus(pcl_flexural_modulus: Scalar, pcl_poissons_ratio: Scalar) -> Scalar:
    """Shear modulus of the frozen PCL at 23 degC [Pa]."""
    return structure.shear_modulus(pcl_flexural_modulus, pcl_poissons_ratio)


@quantities.helper()
def core_screw_bores(
    link_screw_hole: Scalar, link_bolt_circle_radius: Scalar, core_radius: Scalar, link_screw_depth: Scalar
) -> structure.Bores:
    """Holes of the link screws in the core."""
    share = structure.hole_weakening(0.5 * link_screw_hole, link_bolt_circle_radius, LINK_SCREWS, core_radius)
    return structure.Bores(share, link_screw_depth, link_bolt_circle_radius)


@quantities.helper()
def core_dowel_bores(
    link_dowel_diameter: Scalar,
    link_dowel_circle_radius: Scalar,
    dowels_fitted: Scalar,
    core_radius: Scalar,
    link_dowel_depth: Scalar,
) -> structure.Bores:
    """Holes of the dowel pins in the core; they cost nothing where there are none."""
    share = structure.hole_weakening(0.5 * link_dowel_diameter, link_dowel_circle_radius, dowels_fitted, core_radius)
    return structure.Bores(share, link_dowel_depth, link_dowel_circle_radius)


@quantities.output("N*m/rad")
def core_stiffness(
    structure_shear_modulus: Scalar,
    core_radius: Scalar,
    rotor_thickness: Scalar,
    link_bottom_level: Scalar,
    rotor_top_level: Scalar,
    core_screw_bores: structure.Bores,
    core_dowel_bores: structure.Bores,
    foot_fillet: Scalar,
) -> Scalar:
    """Torsional stiffness of the core between rotor plate and output link."""
    length = link_bottom_level - rotor_top_level
    shorter = structure.shorter_by_fillet(core_radius, rotor_thickness, foot_fillet)
    return structure.bored_shaft_stiffness(
        structure_shear_modulus, core_radius, length, core_screw_bores, core_dowel_bores, shorter
    )


@quantities.output("N*m/rad")
def plate_stiffness(
    structure_shear_modulus: Scalar,
    rotor_thickness: Scalar,
    core_radius: Scalar,
    link_bottom_level: Scalar,
    rotor_top_level: Scalar,
    core_screw_bores: structure.Bores,
    core_dowel_bores: structure.Bores,
    pcl_inner_radius: Scalar,
    over_arcs_compliance: Scalar,
    foot_fillet: Scalar,
) -> Scalar:
    """Torsional stiffness of the rotor plate from the core to where the PCL takes the torque over."""
    length = link_bottom_level - rotor_top_level
    felt = structure.felt_at_foot(core_radius, length, core_screw_bores, core_dowel_bores)
    inside = structure.plate_stiffness(
        structure_shear_modulus, rotor_thickness, core_radius, pcl_inner_radius, felt, foot_fillet
    )
    return 1.0 / (1.0 / inside + over_arcs_compliance)


@quantities.output("N*m/rad")
def floor_stiffness(
    structure_youngs_modulus: Scalar,
    structure_poissons_ratio: Scalar,
    structure_shear_modulus: Scalar,
    under_arcs_compliance: Scalar,
    floor_flange: tuple[Scalar, Scalar] | None,
    floor_ring: Scalar,
    floor_thickness: Scalar,
    pcl_inner_radius: Scalar,
    pcl_mean_radius: Scalar,
    driven_share: Scalar,
    pcl_outer_radius: Scalar,
    placement_radius: Scalar,
    spring_count: Scalar,
    mount_boss_radius: Scalar,
    mount_hole: Scalar,
    foot_height: Scalar,
    adjuster_radius: Scalar,
    adjuster_thickness: Scalar,
    slip_clearance: Scalar,
) -> Scalar:
    """Stiffness of the floor from the PCL out to the ground under its feet, or in to its flange.

    Feet are screwed down between the springs; the skirt only stands on the ground. Beyond the PCL's outer rim the floor
    is whole but for the adjusters' pockets.
    """
    if floor_flange is not None:
        bore, outer = floor_flange
        web = structure.covered_ring_stiffness(
            structure_shear_modulus, floor_ring, pcl_inner_radius, pcl_mean_radius, driven_share
        )
        whole = structure.ring_stiffness(structure_shear_modulus, floor_thickness, outer, pcl_inner_radius)
        return structure.flanged_floor_stiffness(structure_shear_modulus, whole, web, (bore, outer), foot_height)
    left = structure.pocketed_thickness(floor_thickness, spring_count, adjuster_radius + slip_clearance,
                                        adjuster_thickness, placement_radius)  # fmt: skip
    ring = structure.ring_stiffness(structure_shear_modulus, left, pcl_outer_radius, placement_radius)
    tilt = structure.foot_tilt(mount_boss_radius, 0.5 * mount_hole, foot_height, floor_thickness)
    foot = structure.foot_stiffness(structure_youngs_modulus, structure_shear_modulus, mount_boss_radius,
                                    0.5 * mount_hole, foot_height, tilt)  # fmt: skip
    between = np.pi * placement_radius / spring_count
    spot = structure.spot_stiffness(structure_shear_modulus, structure_poissons_ratio, left,
                                    mount_boss_radius, between)  # fmt: skip
    footed = structure.footed_floor_stiffness(ring, spot, foot, spring_count, placement_radius)
    return 1.0 / (under_arcs_compliance + 1.0 / footed)


@quantities.output("N*m/rad")
def link_stiffness(
    structure_youngs_modulus: Scalar,
    structure_shear_modulus: Scalar,
    link_half_width: Scalar,
    link_thickness: Scalar,
    link_length: Scalar,
    core_radius: Scalar,
) -> Scalar:
    """Stiffness of the output link between the core and a force in its tool hole."""
    return structure.lever_stiffness(structure_youngs_modulus, structure_shear_modulus, 2.0 * link_half_width,
                                     link_thickness, link_length, core_radius)  # fmt: skip


@quantities.helper(per_point=True)
def stiffness_beyond_link(
    spring_stiffness: Scalar,
    branch_stiffness: tuple[Scalar, Scalar],
    link_stiffness: Scalar,
    core_temperature: Scalar,
    structure_softening: warm.Softening,
) -> tuple[Scalar, Scalar]:
    """Real and imaginary stiffness of the joint with its link, which is as warm as the core [N*m/rad]."""
    link = (link_stiffness * part for part in warm.complex_modulus(core_temperature, structure_softening))
    return series_stiffness(spring_stiffness + branch_stiffness[0], branch_stiffness[1], *link)


@quantities.output("N*m/rad", per_point=True, headline=True)
def joint_stiffness_at_link(stiffness_beyond_link: tuple[Scalar, Scalar]) -> Scalar:
    """Stiffness a force in the link's tool hole meets: the joint's at the hub in series with the link."""
    return stiffness_beyond_link[0]


@quantities.output("N*m*s/rad", per_point=True)
def joint_damping_at_link(stiffness_beyond_link: tuple[Scalar, Scalar], frequency: Scalar) -> Scalar:
    """Damping a force in the link's tool hole meets."""
    return stiffness_beyond_link[1] / (2.0 * np.pi * frequency)


@quantities.helper()
def core_shear_yield(cold_layer_strength: Scalar) -> Scalar:
    """Shear stress at which the core yields across its layers, cold [Pa]."""
    return structure.shear_yield(cold_layer_strength)


@quantities.output("N*m")
def core_foot_holding_torque(
    core_shear_yield: Scalar, core_radius: Scalar, core_foot_rise: Scalar, holding_safety: Scalar
) -> Scalar:
    """Torque the core bears at its foot, by `holding_safety` below yield."""
    return structure.bored_shaft_torque(core_shear_yield, core_radius, core_foot_rise) / holding_safety


@quantities.output("N*m")
def core_screws_holding_torque(
    core_shear_yield: Scalar, core_radius: Scalar, core_screw_bores: structure.Bores, holding_safety: Scalar
) -> Scalar:
    """Torque the core bears beside the holes of the link screws, by `holding_safety` below yield."""
    return structure.bored_shaft_torque(core_shear_yield, core_radius, 1.0, core_screw_bores) / holding_safety


@quantities.output("N*m")
def core_dowels_holding_torque(
    core_shear_yield: Scalar, core_radius: Scalar, core_dowel_bores: structure.Bores, holding_safety: Scalar
) -> Scalar:
    """Torque the core bears beside the holes of the dowel pins, by `holding_safety` below yield."""
    return structure.bored_shaft_torque(core_shear_yield, core_radius, 1.0, core_dowel_bores) / holding_safety


CORE_PARTS = ("core_foot_holding_torque", "core_screws_holding_torque", "core_dowels_holding_torque")
"""What `core_holding_torque` is the least of. A limit on it is one on each: where the least changes from one to another
it has a kink, and IPOPT goes from side to side of it until its iterations are over."""


@quantities.output("N*m", least_of=CORE_PARTS)
def core_holding_torque(
    core_foot_holding_torque: Scalar, core_screws_holding_torque: Scalar, core_dowels_holding_torque: Scalar
) -> Scalar:
    """Torque the core bears at its foot and beside its holes, by `holding_safety` below yield."""
    return np.fmin(core_foot_holding_torque, np.fmin(core_screws_holding_torque, core_dowels_holding_torque))
