"""Parts that carry the PCL's torque to the link: stiffness of core, plate, floor and link, and yield of the core.

Holes of screws and dowel pins count as empty. The link stands in series beyond the core's top: `joint_stiffness` is
that at the hub, and `joint_stiffness_at_link` that at the link's tool hole.
"""

import numpy as np

from tvimdesign.base.record import own_data
from tvimdesign.device.table import Module, QuantityGroup, Scalar, at_most
from tvimdesign.physics.layers.layer import series_stiffness
from tvimdesign.physics.polymers import plastics
from tvimdesign.physics.solids import plates, structure

quantities = QuantityGroup("Impedance")


@quantities.helper()
def frozen_shear_modulus(m: Module) -> Scalar:
    """Shear modulus of the frozen PCL at 23 degC [Pa]."""
    return structure.shear_modulus(m.pcl_flexural_modulus, m.pcl_poissons_ratio)


@quantities.helper()
def core_screw_bores(m: Module) -> structure.Bores:
    """Holes of the link screws in the core."""
    hole, circle = 0.5 * m.link_screw_hole, m.link_bolt_circle_radius
    share = structure.hole_weakening(hole, circle, m.link_screw_count, m.core_radius)
    return structure.Bores(share, m.link_screw_depth + (m.link_bottom_level - m.link_screw_mouth_level), circle)


@quantities.helper()
def core_dowel_bores(m: Module) -> structure.Bores:
    """Holes of the dowel pins in the core; they cost nothing where there are none."""
    share = structure.hole_weakening(
        0.5 * m.link_dowel_diameter, m.link_dowel_circle_radius, m.dowels_fitted, m.core_radius
    )
    return structure.Bores(share, m.link_dowel_depth, m.link_dowel_circle_radius)


@quantities.output("N*m/rad")
def core_stiffness(m: Module) -> Scalar:
    """Torsional stiffness of the core between rotor plate and output link."""
    length = m.link_bottom_level - m.rotor_top_level
    shorter = structure.shorter_by_fillet(m.core_radius, m.rotor_thickness, m.foot_fillet) - m.spigot_longer
    return structure.bored_shaft_stiffness(
        m.structure_shear_modulus, m.core_radius, length, m.core_screw_bores, m.core_dowel_bores, shorter
    )


@quantities.output("N*m/rad")
def plate_stiffness(m: Module) -> Scalar:
    """Torsional stiffness of the rotor plate from the core to where the PCL takes the torque over."""
    length = m.link_bottom_level - m.rotor_top_level
    felt = structure.felt_at_foot(m.core_radius, length, m.core_screw_bores, m.core_dowel_bores)
    inside = structure.plate_stiffness(
        m.structure_shear_modulus, m.rotor_thickness, m.core_radius, m.pcl_inner_radius, felt, m.foot_fillet
    )
    return 1.0 / (1.0 / inside + m.over_arcs_compliance)


@quantities.output("N*m/rad")
def floor_stiffness(m: Module) -> Scalar:
    """Stiffness of the floor from the PCL out to the ground under its feet.

    Feet are screwed down between the springs; the skirt only stands on the ground. Beyond the PCL's outer rim the floor
    is whole but for the adjusters' pockets.
    """
    left = structure.pocketed_thickness(
        m.floor_thickness,
        m.spring_count,
        m.adjuster_radius + m.slip_clearance,
        m.adjuster_thickness,
        m.placement_radius,
    )
    ring = structure.ring_stiffness(m.structure_shear_modulus, left, m.pcl_outer_radius, m.placement_radius)
    between = np.pi * m.placement_radius / m.foot_count
    spot = structure.spot_stiffness(
        m.structure_shear_modulus, m.structure_poissons_ratio, left, m.mount_boss_radius, between
    )
    footed = structure.footed_floor_stiffness(ring, spot, 1.0 / m.foot_sway, m.foot_count, m.placement_radius)
    return 1.0 / (m.under_arcs_compliance + 1.0 / footed)


@quantities.output("N*m/rad")
def link_stiffness(m: Module) -> Scalar:
    """Stiffness of the output link between the core and a force in its tool hole."""
    return structure.lever_stiffness(
        m.structure_youngs_modulus, m.structure_shear_modulus, 2.0 * m.link_half_width, m.link_thickness,
        m.link_length, m.core_radius,
    )  # fmt: skip


def _stiffness_beyond_link(m: Module) -> tuple[Scalar, Scalar]:
    """Real and imaginary stiffness of the joint with its link, which is as warm as the core [N*m/rad]."""
    link = (m.link_stiffness * part for part in plastics.complex_modulus(m.core_temperature, m.structure_softening))
    return series_stiffness(m.spring_stiffness + m.branch_stiffness[0], m.branch_stiffness[1], *link)


@quantities.output("N*m/rad", per_point=True, headline=True)
def joint_stiffness_at_link(m: Module) -> Scalar:
    """Stiffness a force in the link's tool hole meets: the joint's at the hub in series with the link."""
    return _stiffness_beyond_link(m)[0]


@quantities.helper()
def core_shear_yield(m: Module) -> Scalar:
    """Shear stress at which the core yields across its layers, cold [Pa]."""
    return structure.shear_yield(m.cold_layer_strength)


@quantities.output("N*m")
def core_foot_holding_torque(m: Module) -> Scalar:
    """Torque the core bears at its foot, by `holding_safety` below yield."""
    return structure.bored_shaft_torque(m.core_shear_yield, m.core_radius, m.core_foot_rise) / m.holding_safety


@quantities.output("N*m")
def core_screws_holding_torque(m: Module) -> Scalar:
    """Torque the core bears beside the holes of the link screws, by `holding_safety` below yield."""
    return structure.bored_shaft_torque(m.core_shear_yield, m.core_radius, 1.0, m.core_screw_bores) / m.holding_safety


@quantities.output("N*m")
def core_dowels_holding_torque(m: Module) -> Scalar:
    """Torque the core bears beside the holes of the dowel pins, by `holding_safety` below yield."""
    return structure.bored_shaft_torque(m.core_shear_yield, m.core_radius, 1.0, m.core_dowel_bores) / m.holding_safety


CORE_PARTS = ("core_foot_holding_torque", "core_screws_holding_torque", "core_dowels_holding_torque")
"""`core_holding_torque` is the least of them. A limit on it is one on each: where the least changes from
one to another it has a kink, and a solver goes from side to side of it until its iterations are over."""


@quantities.output("N*m", least_of=CORE_PARTS)
def core_holding_torque(m: Module) -> Scalar:
    """Torque the core bears at its foot and beside its holes, by `holding_safety` below yield."""
    return np.fmin(m.core_foot_holding_torque, np.fmin(m.core_screws_holding_torque, m.core_dowels_holding_torque))


@quantities.output("N*m/rad")
def structure_stiffness(m: Module) -> Scalar:
    """Stiffness in series with the PCL, at 23 degC: core, plate, vanes, pads, and floor up to its feet."""
    return 1.0 / sum(m.structure_compliances)


@quantities.helper()
def proportions(m: Module) -> dict[str, Scalar]:
    """Ratios of sizes that the stiffness of core, plate and floor hangs on [1], beside those of the mode's layer."""
    ratios = {
        "core_radius/rotor_thickness": m.core_radius / m.rotor_thickness,
        "pcl_inner_radius/core_radius": m.pcl_inner_radius / m.core_radius,
        "floor_thickness/rotor_thickness": m.floor_thickness / m.rotor_thickness,
        "pcl_outer_radius/rotor_thickness": m.pcl_outer_radius / m.rotor_thickness,
        "pcl_outer_radius/floor_thickness": m.pcl_outer_radius / m.floor_thickness,
    }
    return {**ratios, **m.layer_proportions}


@quantities.output(
    "1", advice=(at_most(0.0, "by that share a ratio of sizes exceeds those solved by FE: the stiffness may be off"),)
)
def structure_extrapolation(m: Module) -> Scalar:
    """Distance of proportions behind the structure's stiffness beyond those that FE solved (`fe_range.yaml`).

    Zero within their range; else how many times its limit a ratio is, less one, of the ratio that is farthest out.
    """
    ranges = own_data(__file__, "fe_range.yaml")
    beyond: Scalar = 1.0
    for name, ratio in m.proportions.items():
        low, high = ranges[name]
        beyond = np.fmax(beyond, np.fmax(low / ratio, ratio / high))
    return beyond - 1.0


@quantities.helper()
def branch_scale(m: Module) -> Scalar:
    """Stiffness of layer and structure over that of the model [1]; its range widens where the model extrapolates."""
    return 1.0 + (m.branch_factor - 1.0) * (1.0 + m.structure_extrapolation)


@quantities.helper()
def foot_sway(m: Module) -> Scalar:
    """Sideways compliance of one foot [m/N]."""
    tilt = structure.foot_tilt(m.mount_boss_radius, 0.5 * m.mount_hole, m.foot_height, m.floor_thickness)
    size = m.mount_boss_radius, 0.5 * m.mount_hole, m.foot_height
    return 1.0 / structure.foot_stiffness(m.structure_youngs_modulus, m.structure_shear_modulus, *size, tilt)


@quantities.helper()
def tilt_compliance(m: Module) -> Scalar:
    """Angle of the link over a torque at its end by which the force there bends core, leans the rotor and shifts it.

    Frozen, at 23 degC [rad/(N*m)], while the bearing's play leaves the core free.
    """
    length, beyond = m.link_bottom_level - m.rotor_top_level, 0.5 * m.link_thickness
    bore = 0.5 * m.mount_hole
    inertia = 0.25 * np.pi * (m.mount_boss_radius**4 - bore**4)
    per_foot = m.structure_youngs_modulus / m.foot_height
    at = plates.Leaning(
        m.core_radius, m.rotor_thickness, m.pcl_inner_radius, m.pcl_outer_radius, m.layer_against_leaning,
        m.hub_radius, m.floor_thickness, m.placement_radius,
        m.foot_count * per_foot * np.pi * (m.mount_boss_radius**2 - bore**2), m.foot_count * per_foot * inertia,
    )  # fmt: skip
    leaning = plates.leaning_compliance(m.structure_youngs_modulus, m.structure_poissons_ratio, at)
    bent = structure.bent_shaft_compliance(
        m.core_stiffness, m.structure_youngs_modulus, m.structure_poissons_ratio, m.core_radius, length, beyond
    )
    above = m.link_bottom_level + beyond - 0.5 * m.rotor_bottom_level  # the layer's middle
    shifts = bent + leaning * above**2 + m.layer_sideways + m.foot_sway / m.foot_count
    return m.tilt_factor * shifts / m.link_length**2


@quantities.output("N*m/rad", headline=True)
def joint_stiffness_in_play(m: Module) -> Scalar:
    """Stiffness a force in the frozen link's tool hole meets while the bearing's play leaves the core free to lean."""
    return 1.0 / (1.0 / m.joint_stiffness_at_link_at_cold + m.tilt_compliance)
