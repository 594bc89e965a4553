"""Winding of a spring as the rotor turns: its leg at radius r bears on a pin at radius p of the rotor.

The rotor axis is O, the coil centre C lies at distance r on the x axis, the pin P at p (cos f, sin f). The line of the
leg passes C at the distance e (its offset) and runs through P. The winding angle w counts positive where it winds the
coil up. Derivation: with s = |CP|, the leg's direction is atan2(P - C) + c asin(e/s), c = +-1 the hand.
"""

from __future__ import annotations

from typing import Any

import numpy as np


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
