"""Keys of the PCL arcs: pegs of PCL in blind pockets of the rotor plate, which hold the layer by form.

They stand on the mean radius of an arc, evenly over its span, and leave the plate the process's least wall above them,
so that nothing runs out there and pins may stand above. The pads' side has none: a pad is bought, and the bond alone
holds there. Keys turn with the plate. The heat model and the plate's stiffness leave them out: a few hundredths of the
plate's area, filled with a plastic like the one around.
"""

import numpy as np

from tvimdesign.device.components.dowels import WITH_LEG_PINS
from tvimdesign.device.table import Module, QuantityGroup, Scalar
from tvimdesign.physics.motions.contacts import joint_play
from tvimdesign.physics.solids import fasteners, structure
from tvimdesign.physics.solids.shapes import Section, disc_at

places = QuantityGroup("Layout")
strengths = QuantityGroup("Impedance")
play = QuantityGroup("Lost motion")
weights = QuantityGroup("Size and weight")
rules = QuantityGroup("Gaps")


places.formulas("keys")


places.same("key_circle_radius", "pcl_mean_radius", "Radius of the circle the keys stand on", "mm")


@weights.helper()
def key_moments(m: Module) -> Section:
    """Volume of all keys together and its polar moment about the axis."""
    return disc_at(0.5 * m.key_diameter, m.key_circle_radius).times(m.arc_count * m.key_count * m.key_depth)


strengths.after("layer_holding_torque")


@strengths.output("N*m")
def key_holding_torque(m: Module) -> Scalar:
    """Torque the frozen keys alone hold in the rotor plate, its bond gone; zero without keys.

    Sheared off, or pressed into their pockets' walls, whichever comes first. It does not add to what the bond holds,
    which fails at a smaller displacement.
    """
    shear = fasteners.peg_shear_force(structure.shear_yield(m.pcl_tensile_yield), m.key_diameter)
    bearing = fasteners.peg_bearing_force(m.pcl_tensile_yield, m.key_diameter, m.key_depth)
    return m.arc_count * m.key_count * np.fmin(shear, bearing) * m.key_circle_radius


@play.output("rad")
def key_play(m: Module) -> Scalar:
    """Angle the frozen keys turn in their pockets, from which they shrink, once the bond is gone; zero without keys.

    No part of `lost_motion`: as long as the bond holds, it takes the torque.
    """
    return m.has_keys * joint_play(0.5 * m.key_shrinkage * m.key_diameter, m.key_circle_radius)


rules.after("arc_width")


rules.margins("keys")


@rules.gap("the keys stand too close in their arcs: fewer or thinner ones")
def key_pitch_margin(m: Module) -> Scalar:
    """Distance of neighbouring keys beyond the least wall between printed pockets, and half of it to the arc's ends."""
    apart = 2.0 * m.key_circle_radius * np.sin(0.5 * m.arc_span / np.fmax(m.key_count, 1.0))
    return apart - m.has_keys * (m.key_diameter + 2.0 * m.hole_wall - m.minimum_wall)


@rules.gap(
    "the legs' dowel pins would meet the keys' pockets: shorter pins, or another pin_radius_ratio",
    requires=WITH_LEG_PINS,
    sprung=True,
)
def leg_pin_key_gap(m: Module) -> Scalar:
    """Wall between the holes of the legs' dowel pins and keys' pockets, beside or above, beyond the least; zero without
    either."""
    beside = np.fabs(m.key_circle_radius - m.pin_radius) - 0.5 * (m.key_diameter + m.pin_diameter) - m.hole_wall
    above = m.below_leg_pins - m.key_depth - m.minimum_wall
    return m.has_keys * np.fmax(beside, above)
