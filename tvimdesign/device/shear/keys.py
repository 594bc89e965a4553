"""Keys of the PCL arcs: pegs of PCL in blind pockets of the rotor plate, which hold the layer by form.

They stand on the mean radius of an arc, evenly over its span, and leave the plate the process's least wall above them,
so that nothing runs out there and pins may stand above. The pads' side has none: a pad is bought, and the bond alone
holds there. Keys turn with the plate. The heat model and the plate's stiffness leave them out: a few hundredths of the
plate's area, filled with a plastic like the one around.
"""

from __future__ import annotations

import numpy as np

from tvimdesign.device.core.clearances import quantities as gaps
from tvimdesign.device.core.impedance.joint_impedance import quantities as impedance
from tvimdesign.device.core.impedance.lost_motion import quantities as lost_motion
from tvimdesign.device.core.layout import quantities as layout
from tvimdesign.device.core.mass_properties import quantities as bodies
from tvimdesign.device.table.quantity import Scalar, at_least
from tvimdesign.device.table.quantity_group import QuantityGroup
from tvimdesign.physics.bodies.shapes import Section, disc_at
from tvimdesign.physics.motions.rigid_play import joint_play
from tvimdesign.physics.solids import peg, structure

places, strengths, play, weights, rules = (
    QuantityGroup(layout.group),
    QuantityGroup(impedance.group),
    QuantityGroup(lost_motion.group),
    QuantityGroup(bodies.group),
    QuantityGroup(gaps.group),
)
groups = (places, strengths, play, weights, rules)


@places.helper()
def has_keys(key_count: Scalar) -> Scalar:
    """One where the arcs have keys, zero where they have none."""
    return np.fmin(key_count, 1.0)


@places.output("mm")
def key_circle_radius(pcl_mean_radius: Scalar) -> Scalar:
    """Radius of the circle the keys stand on."""
    return pcl_mean_radius


@places.output("mm")
def key_depth(has_keys: Scalar, rotor_thickness: Scalar, minimum_wall: Scalar) -> Scalar:
    """Depth of the keys in the rotor plate, which keeps the process's least wall above them; zero without keys."""
    return has_keys * (rotor_thickness - minimum_wall)


@weights.helper()
def key_moments(
    arc_count: Scalar, key_count: Scalar, key_diameter: Scalar, key_circle_radius: Scalar, key_depth: Scalar
) -> Section:
    """Volume of all keys together and its polar moment about the axis."""
    return disc_at(0.5 * key_diameter, key_circle_radius).times(arc_count * key_count * key_depth)


# --- strength --------------------------------------------------------------------------------------------------------

strengths.after("layer_holding_torque")


@strengths.output("N*m")
def key_holding_torque(
    pcl_tensile_yield: Scalar,
    arc_count: Scalar,
    key_count: Scalar,
    key_diameter: Scalar,
    key_depth: Scalar,
    key_circle_radius: Scalar,
) -> Scalar:
    """Torque the frozen keys alone hold in the rotor plate, its bond gone; zero without keys.

    Sheared off, or pressed into their pockets' walls, whichever comes first. It does not add to what the bond holds,
    which gives way at a smaller displacement.
    """
    shear = peg.shear_force(structure.shear_yield(pcl_tensile_yield), key_diameter)
    bearing = peg.bearing_force(pcl_tensile_yield, key_diameter, key_depth)
    return arc_count * key_count * np.fmin(shear, bearing) * key_circle_radius


@strengths.output("1")
def key_safety(key_holding_torque: Scalar, layer_torque_at_cold: Scalar) -> Scalar:
    """What the frozen keys alone hold over what the layer bears in a hold at the cold point; zero without keys.

    Of no other point: the strength is that of frozen PCL at room temperature.
    """
    return key_holding_torque / layer_torque_at_cold


@play.output("rad")
def key_play(key_shrinkage: Scalar, key_diameter: Scalar, key_circle_radius: Scalar, has_keys: Scalar) -> Scalar:
    """Angle the frozen keys turn in their pockets, from which they shrink, once the bond is gone; zero without keys.

    No part of `lost_motion`: as long as the bond holds, it takes the torque.
    """
    return has_keys * joint_play(0.5 * key_shrinkage * key_diameter, key_circle_radius)


# --- rules -----------------------------------------------------------------------------------------------------------

rules.after("arc_width")


@rules.output("mm", at_least(0.0, "the keys are thinner than the process can make them"))
def key_margin(key_diameter: Scalar, has_keys: Scalar, minimum_feature: Scalar) -> Scalar:
    """Diameter of the keys beyond the process's least pin."""
    return key_diameter - has_keys * minimum_feature


@rules.output("mm", at_least(0.0, "the rotor plate is too thin for keys: a thicker plate, or key_count 0"))
def key_depth_margin(rotor_thickness: Scalar, has_keys: Scalar, minimum_wall: Scalar, key_diameter: Scalar) -> Scalar:
    """Rotor plate beyond the least wall and keys a quarter of their diameter deep."""
    return rotor_thickness - has_keys * (minimum_wall + 0.25 * key_diameter)


@rules.output("mm", at_least(0.0, "the arcs are too narrow for their keys: thinner ones, or key_count 0"))
def key_width_margin(arc_width: Scalar, has_keys: Scalar, key_diameter: Scalar, minimum_wall: Scalar) -> Scalar:
    """Radial width of the arcs beyond a key with half of the least wall on either side."""
    return arc_width - has_keys * (key_diameter + minimum_wall)


@rules.output("mm", at_least(0.0, "the keys stand too close in their arcs: fewer or thinner ones"))
def key_pitch_margin(
    key_circle_radius: Scalar,
    arc_span: Scalar,
    key_count: Scalar,
    has_keys: Scalar,
    key_diameter: Scalar,
    minimum_wall: Scalar,
) -> Scalar:
    """Distance of neighbouring keys beyond the least wall between their pockets, and half of it to the arc's ends."""
    apart = 2.0 * key_circle_radius * np.sin(0.5 * arc_span / np.fmax(key_count, 1.0))
    return apart - has_keys * (key_diameter + minimum_wall)
