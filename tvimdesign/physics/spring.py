"""Helical torsion spring: rate, stress, strength, and size under load; rate and stress of a wave spring.

Sources: [S] Budynas and Nisbett, Shigley's Mechanical Engineering Design, 10th ed., section 10-12 (torsion springs);
[E] EN 13906-3; [T] Timoshenko, Strength of Materials, part II, 3rd ed. (bars bent beyond the elastic limit). Angles in
radians, except where a name says turns.

A single-turn wave spring is a ring of flat wire, waved along its circumference and pressed between two faces.

Winding of a spring as the rotor turns: its leg at radius r bears on a pin at radius p of the rotor.

The rotor axis is O, the coil centre C lies at distance r on the x axis, the pin P at p (cos f, sin f). The line of the
leg passes C at the distance e (its offset) and runs through P. The winding angle w counts positive where it winds the
coil up. Derivation: with s = |CP|, the leg's direction is atan2(P - C) + c asin(e/s), c = +-1 the hand.

A torsion spring as it is drawn: coil, straight leg on a pin, and a bend into a tang that is clamped.

The pin pushes across the leg at the arm a beyond the coil's end. So the moment about the coil's axis is not the same
everywhere: it is F (a + R sin f) at the angle f back along the coil, and the force acts above the coil, which tilts it
with the moment F z. Castigliano's theorem over the whole wire gives the rate; a post in the coil is not touched.
Source: [T] Timoshenko, Strength of Materials, part II, 3rd ed., ch. 1 (curved bars) and 7 (helical springs bent and
twisted); G I_p = E I/(1 + nu) for round wire. Compared with FE of the drawn springs in validation/fe_spring.
"""

from collections.abc import Sequence
from typing import Any, Literal, NamedTuple

import numpy as np

RateModel = Literal["bending", "smi"]
_MILLIMETRE = 1e-3


def rate(
    youngs_modulus: Any, wire_diameter: Any, coil_diameter: Any, active_coils: Any, model: RateModel = "bending"
) -> Any:
    """Return the torque per angle of a round-wire torsion spring [N*m/rad].

    `bending`: k = E d^4 / (64 D n), pure bending [S eq. 10-50]. `smi`: the handbook's E d^4 / (10.8 D n) per turn
    [S eq. 10-51], which counts the friction between coils and is 6 % softer.
    """
    divisor = {"bending": 64.0, "smi": 10.8 * 2.0 * np.pi}[model]
    return youngs_modulus * wire_diameter**4 / (divisor * coil_diameter * active_coils)


def active_coils(body_coils: Any, coil_diameter: Any, bending_leg_length: Any) -> Any:
    """Count of coils that bend, with the legs: n_a = n_b + (L1 + L2)/(3 pi D) [S eq. 10-48].

    `bending_leg_length` is L1 + L2 [m]: the length of both legs from coil to load; 0 where the legs are ignored.
    """
    return body_coils + bending_leg_length / (3.0 * np.pi * coil_diameter)


def spring_index(wire_diameter: Any, coil_diameter: Any) -> Any:
    """Return C = D/d [1]; cold coiling wants 4 <= C <= 20 [E]."""
    return coil_diameter / wire_diameter


def inner_fibre_factor(index: Any) -> Any:
    """Return the stress concentration at the inner fibre, K_bi = (4C^2 - C - 1)/(4C(C - 1)) [S eq. 10-43]."""
    return (4.0 * index**2 - index - 1.0) / (4.0 * index * (index - 1.0))


def inner_fibre_factor_en(index: Any) -> Any:
    """Return EN 13906-3 stress correction q = (C + 0.07)/(C - 0.75) [E]."""
    return (index + 0.07) / (index - 0.75)


def bending_stress(torque: Any, wire_diameter: Any, factor: Any) -> Any:
    """Return the stress at the inner fibre, sigma = K 32 M/(pi d^3) [Pa] [S eq. 10-44]."""
    return factor * 32.0 * torque / (np.pi * wire_diameter**3)


def tensile_strength(wire_diameter: Any, strength: Sequence[tuple[float, float]]) -> Any:
    """Return S_ut = A/d^m [Pa], d in mm [S eq. 10-14, table 10-4].

    `strength` holds (A [Pa], m) for each diameter range. The least of the curves is taken: they cross close to where
    the ranges meet (302 stainless at 2.37 and 4.94 mm for 2.5 and 5 mm), so it is at most 0.6 % low.
    """
    diameter_in_mm = wire_diameter / _MILLIMETRE
    curves = [coefficient * diameter_in_mm ** (-exponent) for coefficient, exponent in strength]
    lowest = curves[0]
    for curve in curves[1:]:
        lowest = np.fmin(lowest, curve)
    return lowest


def wound_coil_diameter(coil_diameter: Any, wire_diameter: Any, yield_strength: Any, youngs_modulus: Any) -> Any:
    """Return the mean diameter [m] of a coil on its mandrel that springs back to `coil_diameter` once it is let go.

    Cold wound, the whole section of the wire yields: its plastic moment is s d^3/6 [T]. Let go, the curvature falls by
    that moment over E I: D_w = D/(1 + (16/(3 pi)) C s/E), C the spring index and s the stress of the yielding wire,
    which is its tensile strength. The mandrel is a wire thinner. Stress relief afterwards is not in it.
    """
    index = spring_index(wire_diameter, coil_diameter)
    return coil_diameter / (1.0 + 16.0 / (3.0 * np.pi) * index * yield_strength / youngs_modulus)


def endurance_strength(tensile: Any, strength_ratio: Any) -> Any:
    """Return the gerber-equivalent endurance limit [Pa] from the repeated-bending strength S_r = ratio * S_ut [S eq.
    10-58].

    S_e = (S_r/2)/(1 - (S_r/(2 S_ut))^2).
    """
    half = strength_ratio * tensile / 2.0
    return half / (1.0 - (half / tensile) ** 2)


def gerber_safety(stress_amplitude: Any, stress_mean: Any, endurance: Any, tensile: Any) -> Any:
    """Return the fatigue safety n_f [1] of the Gerber line, n s_a/S_e + (n s_m/S_ut)^2 = 1 [S table 6-7]."""
    a = (stress_mean / tensile) ** 2
    b = stress_amplitude / endurance
    # The rationalised root: no cancellation, and finite for a mean stress of zero.
    return 2.0 / (b + np.sqrt(b**2 + 4.0 * a))


def loaded_coil_diameter(coil_diameter: Any, body_coils: Any, angle: Any) -> Any:
    """Return the mean coil diameter wound up by `angle`, D' = D n_b/(n_b + theta in turns) [m] [S eq. 10-53]."""
    return coil_diameter * body_coils / (body_coils + angle / (2.0 * np.pi))


def body_length(wire_diameter: Any, body_coils: Any, angle: Any, coil_gap: Any = 0.0) -> Any:
    """Return the axial length of the coil body wound up by `angle`, d (n_b + 1 + turns) [m], plus the gap between
    coils."""
    turns = body_coils + angle / (2.0 * np.pi)
    return wire_diameter * (turns + 1.0) + coil_gap * turns


def diameter_tolerance(wire_diameter: Any, coil_diameter: Any, grade_factor: float) -> Any:
    """Return the coil diameter tolerance A_D = 0.025 D d^-0.17 Q [m], D and d in mm in the formula (DIN 2194)."""
    return 0.025 * coil_diameter * (wire_diameter / _MILLIMETRE) ** -0.17 * grade_factor


def share_within(width: Any, tolerance: Any) -> Any:
    """Return the share [1] of springs whose deviation is within a width, of a normal one whose tolerance is 3 sigma.

    erf(x), x = 3 w/(sqrt(2) t), by Abramowitz and Stegun, Handbook of Mathematical Functions, eq. 7.1.26 (1.5e-7).
    """
    x = 3.0 * width / (np.sqrt(2.0) * tolerance)
    t = 1.0 / (1.0 + 0.3275911 * x)
    series = t * (0.254829592 + t * (-0.284496736 + t * (1.421413741 + t * (-1.453152027 + t * 1.061405429))))
    return 1.0 - series * np.exp(-(x**2))


def free_angle_tolerance(body_coils: Any, index: Any, grade_factor: float) -> Any:
    """Return the free-angle tolerance A_phi = 2.4 n^0.76 sqrt(C) Q degrees, returned in radians (DIN 2194)."""
    return np.pi / 180.0 * 2.4 * body_coils**0.76 * np.sqrt(index) * grade_factor


WAVE_FACTOR = np.pi**3 / 8.0
"""Deflection factor K [1] for two to four waves, which makers round to 3.88: half that of N beams in a ring, each of
the length of a wave, freely supported and loaded in the middle (pi^3/4)."""


def wave_spring_rate(
    youngs_modulus: Any, inner_diameter: Any, outer_diameter: Any, thickness: Any, waves: Any, factor: Any = WAVE_FACTOR
) -> Any:
    """Return the rate of the spring [N/m], E b t^3 N^4/(K D_m^3) D_o/D_i; modulus [Pa], lengths [m], two to four waves.

    Source: Rotor Clip, formulas for spiral wound wave springs, single turn with gap.
    """
    mean, wall = 0.5 * (inner_diameter + outer_diameter), 0.5 * (outer_diameter - inner_diameter)
    return youngs_modulus * wall * thickness**3 * waves**4 / (factor * mean**3) * outer_diameter / inner_diameter


def wave_spring_stress(force: Any, inner_diameter: Any, outer_diameter: Any, thickness: Any, waves: Any) -> Any:
    """Return the bending stress [Pa] under a force [N], 3 pi F D_m/(4 b t^2 N^2); lengths [m].

    Source: as `wave_spring_rate`.
    """
    mean, wall = 0.5 * (inner_diameter + outer_diameter), 0.5 * (outer_diameter - inner_diameter)
    return 3.0 * np.pi * force * mean / (4.0 * wall * thickness**2 * waves**2)


def pin_distance(pin_radius: Any, placement_radius: Any, azimuth: Any) -> Any:
    """Return the distance s of pin and coil centre [m], s^2 = p^2 + r^2 - 2 p r cos f."""
    return np.sqrt(pin_radius**2 + placement_radius**2 - 2.0 * pin_radius * placement_radius * np.cos(azimuth))


def leg_direction(pin_radius: Any, placement_radius: Any, azimuth: Any, offset: Any, hand: float = 1.0) -> Any:
    """Return the direction of the leg [rad], from the coil to the pin, against the x axis."""
    s = pin_distance(pin_radius, placement_radius, azimuth)
    # Measured from the inward radius, so that the branch of atan2 is never crossed for p < r.
    inward = np.arctan2(pin_radius * np.sin(azimuth), placement_radius - pin_radius * np.cos(azimuth))
    bearing = np.pi - inward
    return bearing + hand * np.arcsin(offset / s)


def leg_turned(pin_radius: Any, placement_radius: Any, azimuth: Any, offset: Any) -> Any:
    """Return the angle [rad] that the leg has turned since the pin was on the line of centres (azimuth 0)."""
    at_rest = leg_direction(pin_radius, placement_radius, 0.0, offset)
    return leg_direction(pin_radius, placement_radius, azimuth, offset) - at_rest


def leg_ratio(pin_radius: Any, placement_radius: Any, azimuth: Any, offset: Any, hand: float = 1.0) -> Any:
    """Return d(leg direction)/d(rotor angle) [1].

    g = p (p - r cos f)/s^2 - c e r p sin f/(s^2 sqrt(s^2 - e^2)).
    """
    p, r, e = pin_radius, placement_radius, offset
    s2 = pin_distance(p, r, azimuth) ** 2
    return p * (p - r * np.cos(azimuth)) / s2 - hand * e * r * p * np.sin(azimuth) / (s2 * np.sqrt(s2 - e**2))


def leg_curvature(pin_radius: Any, placement_radius: Any, azimuth: Any, offset: Any, hand: float = 1.0) -> Any:
    """Return the second derivative of the leg direction by the rotor angle [1/rad]; the derivative of `leg_ratio`."""
    p, r, e = pin_radius, placement_radius, offset
    s2 = pin_distance(p, r, azimuth) ** 2
    q2 = s2 - e**2
    sine, cosine = np.sin(azimuth), np.cos(azimuth)
    bearing = p * r * sine * (r**2 - p**2) / s2**2
    turn = cosine / (s2 * np.sqrt(q2)) - p * r * sine**2 * (2.0 * q2 + s2) / (s2**2 * q2 * np.sqrt(q2))
    return bearing - hand * e * p * r * turn


def pin_slip(pin_radius: Any, placement_radius: Any, offset: Any, pin_diameter: Any) -> Any:
    """Return how far a leg slides on its pin for each radian of the rotor, at rest [m]: d_p/2 (1 - w'), w' = -p/(r -
    p).

    There the pin's middle neither nears nor leaves the coil along the leg, as its distance from the coil is least. What
    slides is the surface: the pin turns with the rotor, and the leg the other way by w'. The same is h_O - w' h_C, the
    distances of the line of sliding from rotor axis and coil axis.
    """
    return 0.5 * pin_diameter * (1.0 - leg_ratio(pin_radius, placement_radius, 0.0, offset))


def output_stiffness(count: Any, spring_rate: Any, preload: Any, ratio: Any, curvature: Any) -> Any:
    """Return the stiffness of `count` springs about the rotor axis [N*m/rad], K_s = N k (w'^2 + a_pre w'').

    `ratio` is w' and `curvature` w'' at rest; unity transmission is w' = 1, w'' = 0. All N springs act only while the
    preload exceeds the unwinding of the opposing pair.
    """
    return count * spring_rate * (ratio**2 + preload * curvature)


def pair_turned(angle: Any, preload: Any, pin_radius: Any, placement_radius: Any, offset: Any) -> tuple[Any, Any]:
    """Return the torque [rad] and tangent stiffness [1] of a spring of either hand about the rotor axis, over the rate
    of one.

    The rotor stands at `angle` [rad] from rest. T = (a + w) w' and dT/dtheta = w'^2 + (a + w) w'' for each spring, the
    other hand being the mirror image at the opposite angle.
    """
    torque: Any = 0.0
    stiffness: Any = 0.0
    for sign in (-1.0, 1.0):
        where = (pin_radius, placement_radius, sign * angle, offset)
        wound = preload + leg_turned(*where)
        torque = torque - sign * wound * -leg_ratio(*where)
        stiffness = stiffness + leg_ratio(*where) ** 2 + wound * leg_curvature(*where)
    return torque, stiffness


BEND_ACROSS = 1.1
"""Rise of the stress where the bend is bent across its plane or twisted; calibrated to FE, validation/fe_spring."""
_SMOOTH = 6
"""Power by which the squared stresses at both ends of the bend join to one: the larger, at most 6 % above it."""


class DrawnSpring(NamedTuple):
    """Dimensions of a spring: lengths in m, angles in rad."""

    wire_diameter: Any
    coil_diameter: Any  # Mean diameter of the coil
    wound: Any  # Angle from one end of the coil to the other
    pitch: Any  # Axial pitch of the coils
    arm: Any  # Length of the leg from the coil to the pin
    bend_radius: Any  # Mean radius of the quarter bend into the tang


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
