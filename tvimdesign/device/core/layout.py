"""Layout that all modes share: the design variables, and the radii and levels that follow.

The rotor axis is z. The floor's upper face is z = 0; the rotor plate stands above it, the PCL between the two, the
torsion springs around them with their axes parallel to z. Levels below the floor are negative.
"""

import numpy as np

from tvimdesign.device.table import Module, QuantityGroup, Scalar

materials = QuantityGroup("Materials")
quantities = QuantityGroup("Layout")

materials.choices("materials")
quantities.inputs()
quantities.formulas("layout")


quantities.same("foot_count", "spring_count", "Feet of the housing: one between each two springs", "1")


@quantities.output("mm", sprung=True)
def pin_radius(m: Module) -> Scalar:
    """Distance of the rotor pins from the axis."""
    return m.pin_radius_ratio * m.placement_radius


@quantities.output("mm", sprung=True)
def spring_reach(m: Module) -> Scalar:
    """Radius of the circle around a spring's axis that holds its coils and its tang."""
    # The tang leaves the coil along the tangent and turns down over its bend.
    return np.sqrt((0.5 * m.coil_diameter) ** 2 + m.tang_bend_radius**2) + 0.5 * m.wire_diameter


@quantities.output("mm", sprung=True)
def leg_offset(m: Module) -> Scalar:
    """Distance of the spring axis from the line through the pin along which the leg points."""
    return 0.5 * (m.coil_diameter + m.wire_diameter + m.pin_diameter)


@quantities.output("mm", sprung=True)
def leg_arm(m: Module) -> Scalar:
    """Length of the rotor-side leg from the coil to the pin."""
    return np.sqrt((m.placement_radius - m.pin_radius) ** 2 - m.leg_offset**2)


@quantities.output("mm")
def link_length(m: Module) -> Scalar:
    """Distance of the output link's end hole from the axis; the link's round end is flush with the housing."""
    return m.housing_outer_radius - m.link_half_width


@quantities.output("mm")
def link_bolt_circle_radius(m: Module) -> Scalar:
    """Radius of the circle of the link screws; zero of a single one."""
    return m.link_bolt_ratio * m.core_radius if m.link_screw_count > 1 else 0.0


@quantities.output("1", sprung=True)
def helix_slope(m: Module) -> Scalar:
    """Rise of the wire over its way around the coil, tan of the helix angle."""
    return m.coil_pitch / (np.pi * m.coil_diameter)


@quantities.output("mm", sprung=True)
def coil_end_level(m: Module) -> Scalar:
    """Level of the wire's centre where the coils of the preloaded spring end and the rotor-side leg begins."""
    return m.coil_start_level + m.coil_pitch * (m.coil_count + m.preload_angle / (2.0 * np.pi))


LEAST_FILLET = 1e-4
"""Fillet [m] that is drawn where there is no room for one: what a nozzle or an edge of a cutter leaves anyway."""
EVENED = 3e-4
"""Difference [m] of two rooms for the fillet below which it is smaller than either. What the fillet bears would have a
kink where one room becomes less than the other, and IPOPT went to and fro over it for 300 iterations from each start of
the study in the README."""


def evened_least(first: Scalar, second: Scalar) -> Scalar:
    """Return the less of two lengths [m]; where these are within w, `EVENED`, of one another, less than that by up to
    w/6.

    Two derivatives have no jump: min(a, b) - w/6 (1 - |a - b|/w)^3.
    """
    near = np.fmax(1.0 - np.fabs(first - second) / EVENED, 0.0)
    return np.fmin(first, second) - EVENED / 6.0 * near**3


@quantities.output("mm")
def foot_fillet(m: Module) -> Scalar:
    """Radius of the fillets at the feet of the core and of the pins on the rotor plate.

    As large as is asked for, but below the legs by a running clearance, and a tenth of a millimetre short of the
    plate's rim and of half of the way between core and pins: where two circles touch no mesh closes. Where two of these
    are within 0.3 mm of one another it is up to 0.05 mm smaller (`evened_least`).
    """
    to_rim = m.rotor_radius - m.pin_radius - 0.5 * m.pin_foot_diameter
    between = 0.5 * (m.pin_radius - 0.5 * m.pin_foot_diameter - m.core_radius)
    room = evened_least(m.room_below_legs, evened_least(to_rim, between) - LEAST_FILLET)
    return np.fmax(evened_least(m.largest_foot_fillet, room), LEAST_FILLET)


@quantities.output("mm", sprung=True)
def post_radius(m: Module) -> Scalar:
    """Radius of a spring's post: 90 % of the inner radius of the fully wound spring."""
    # Shigley, section 10-12: mandrel about 10 % under the inner diameter at full deflection.
    return 0.45 * (m.spring_wound_diameter - m.wire_diameter)


@quantities.output("mm", headline=True)
def envelope_diameter(m: Module) -> Scalar:
    """Diameter of the module, or of its motor where that is wider."""
    return 2.0 * (
        m.housing_outer_radius if m.drive_motor is None else np.fmax(m.housing_outer_radius, m.motor_outer_radius)
    )


@quantities.output("mm", headline=True)
def envelope_height(m: Module) -> Scalar:
    """Height of the module from the ground, below a motor, to the heads of the link screws."""
    below = m.drive_height + m.foot_height + m.floor_thickness
    return below + m.link_bottom_level + m.link_thickness + m.link_screw_head_height


@quantities.output("cm^3", headline=True)
def envelope_volume(m: Module) -> Scalar:
    """Volume of the cylinder that holds the module."""
    return 0.25 * np.pi * m.envelope_diameter**2 * m.envelope_height
