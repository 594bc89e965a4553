"""A torsion spring as it is drawn: coil, straight leg on a pin, and a bend into a tang that is clamped.

The pin pushes across the leg at the arm a beyond the coil's end. So the moment about the coil's axis is not the same
everywhere: it is F (a + R sin f) at the angle f back along the coil, and the force acts above the coil, which tilts it
with the moment F z. Castigliano's theorem over the whole wire gives the rate; a post in the coil is not touched.
Source: [T] Timoshenko, Strength of Materials, part II, 3rd ed., ch. 1 (curved bars) and 7 (helical springs bent and
twisted); G I_p = E I/(1 + nu) for round wire. Compared with FE of the drawn springs in validation/fe_spring.
"""

from typing import Any, NamedTuple

import numpy as np

from tvimdesign.physics.springs.spring import inner_fibre_factor

BEND_ACROSS = 1.1
"""Rise of the stress where the bend is bent across its plane or twisted; calibrated to FE, validation/fe_spring."""
_SMOOTH = 6
"""Power by which the squared stresses at both ends of the bend join to one: the larger, at most 6 % above it."""


class DrawnSpring(NamedTuple):
    """Dimensions of a spring: lengths in m, angles in rad."""

    wire_diameter: Any
    coil_diameter: Any
    """Mean diameter of the coil."""
    wound: Any
    """Angle from one end of the coil to the other."""
    pitch: Any
    """Axial pitch of the coils."""
    arm: Any
    """Length of the leg from the coil to the pin."""
    bend_radius: Any
    """Mean radius of the quarter bend into the tang."""


def leg_rise(spring: DrawnSpring) -> Any:
    """Return the height of the pin's force above the coil's end [m]: the leg keeps rising as the coil does."""
    return spring.pitch / (np.pi * spring.coil_diameter) * spring.arm


def bending_length(spring: DrawnSpring, poissons_ratio: Any) -> Any:
    """Return the straight wire [m] that turns as far under the same moment: the rate is E I over it [T].

    Sum over coil, leg and bend of the integral of (m/a)^2 ds, m the bending moment of a unit force, torsion (1 + nu)
    times as much. The wire's slope along the coil is left out.
    """
    tilt, bend = _tilt(spring, poissons_ratio), _bend(spring, poissons_ratio)
    return (_coil(spring) + tilt + bend) / spring.arm**2 + spring.arm / 3.0


def active_coils(spring: DrawnSpring, poissons_ratio: Any) -> Any:
    """Return the coils without a leg that are as soft as the drawn spring [1]."""
    return bending_length(spring, poissons_ratio) / (np.pi * spring.coil_diameter)


def coil_stress_factor(spring: DrawnSpring, curvature_factor: Any) -> Any:
    """Return the largest stress in the coil over that of the moment F a in a straight wire [1].

    The moment about the axis is largest, F (a + R), where the coil reaches furthest from the pin; the tilting moment is
    that at the coil's far end, and adds at a right angle. The curvature raises both alike (FE: within 4 %).
    """
    about_axis = 1.0 + 0.5 * spring.coil_diameter / spring.arm
    return curvature_factor * np.sqrt(about_axis**2 + (_height(spring) / spring.arm) ** 2)


def bend_stress_factor(spring: DrawnSpring) -> Any:
    """Return the largest equivalent stress (von Mises) in the bend into the tang, over that of F a in a straight wire
    [1].

    Bending in the bend's plane has the handbook's inner-fibre factor for its index, all else a calibrated one. The
    stress is largest at one end or the other, at the coil or at the floor; the two join smoothly.
    """
    sine, cosine = np.sin(spring.wound), np.cos(spring.wound)
    lever, height, radius = _lever(spring), _height(spring), spring.bend_radius
    at_coil = _stress_squared(spring, height * sine, lever, height * cosine)
    lower, further = height + radius, lever + radius * cosine
    at_floor = _stress_squared(spring, lower * sine, lower * cosine, further)
    return (at_coil**_SMOOTH + at_floor**_SMOOTH) ** (0.5 / _SMOOTH) / spring.arm


def _stress_squared(spring: DrawnSpring, in_plane: Any, across: Any, twisting: Any) -> Any:
    """Return the square of the equivalent stress of three moments of a unit force [m], in units of that of bending
    [m^2]."""
    curved = inner_fibre_factor(2.0 * spring.bend_radius / spring.wire_diameter)
    return (curved * in_plane) ** 2 + BEND_ACROSS**2 * (across**2 + 0.75 * twisting**2)


def _lever(spring: DrawnSpring) -> Any:
    """Return the arm of the pin's force about the coil's start, along the leg [m]."""
    return spring.arm + 0.5 * spring.coil_diameter * np.sin(spring.wound)


def _height(spring: DrawnSpring) -> Any:
    """Return the height of the pin's force above the coil's start [m]."""
    return leg_rise(spring) + spring.pitch / (2.0 * np.pi) * spring.wound


def _coil(spring: DrawnSpring) -> Any:
    """Return the integral of (a + R sin f)^2 R df over the coil [m^3]."""
    radius, arm, angle = 0.5 * spring.coil_diameter, spring.arm, spring.wound
    even = arm**2 * angle + radius**2 * (0.5 * angle - 0.25 * np.sin(2.0 * angle))
    return radius * (even + 2.0 * arm * radius * (1.0 - np.cos(angle)))


def _tilt(spring: DrawnSpring, poissons_ratio: Any) -> Any:
    """Return the integral of z^2 (sin^2 f + (1 + nu) cos^2 f) R df over the coil [m^3], z = z0 + c f below the
    force."""
    first, climb = leg_rise(spring), spring.pitch / (2.0 * np.pi)
    last = first + climb * spring.wound
    double = 2.0 * spring.wound
    square = (last**3 - first**3) / (3.0 * climb)
    sine = (0.5 * last**2 - 0.25 * climb**2) * np.sin(double)
    wave = sine + 0.5 * climb * (last * np.cos(double) - first)
    mean = (1.0 + 0.5 * poissons_ratio) * square + 0.5 * poissons_ratio * wave
    return 0.5 * spring.coil_diameter * mean


def _bend(spring: DrawnSpring, poissons_ratio: Any) -> Any:
    """Return the integral over the quarter bend, from the coil's tangent down into the tang [m^3].

    At the angle t along the bend of radius r the force has the lever l + r cos(w) sin t and the height
    h + r (1 - cos t), w the wound angle. The two moments bend the wire but for the part along it,
    T = cos(w) cos t (height) - sin t (lever), which twists it: the integral of (lever^2 + height^2 + nu T^2) r dt.
    """
    radius, turned = spring.bend_radius, np.cos(spring.wound)
    lever, height = _lever(spring), _height(spring)
    quarter = 0.5 * np.pi
    levers = quarter * lever**2 + 2.0 * lever * radius * turned + 0.5 * quarter * (radius * turned) ** 2
    heights = quarter * height**2 + 2.0 * (quarter - 1.0) * height * radius + (1.5 * quarter - 2.0) * radius**2
    low = height + radius
    twist = 0.5 * quarter * ((turned * low) ** 2 + lever**2) + quarter * (radius * turned) ** 2
    twist = twist - 2.0 * turned**2 * radius * low - turned * lever * (low - 2.0 * radius)
    return radius * (levers + heights + poissons_ratio * twist)
