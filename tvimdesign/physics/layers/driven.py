"""A link behind a viscoelastic joint: driven by a sine, turned with its base, or struck.

In the frequency domain the joint is a complex stiffness K* = K' + i K''; in time it is its springs beside a structure
in series with Maxwell elements. The base turns by theta_b, the link by theta_b + theta, J (theta'' + theta_b'') = -T.
Sources: Den Hartog, Mechanical Vibrations, 4th ed., ch. 2 (support that moves); Newmark, J. Eng. Mech. Div. ASCE 85
(1959) 67, with constant mean acceleration. Maxwell elements take the exact step of a constant rate, which is stable.
"""

from collections.abc import Callable, Sequence
from functools import reduce
from typing import Any, NamedTuple

import numpy as np

from tvimdesign.physics.layers import layer
from tvimdesign.physics.motions.motion import Joint, Modes
from tvimdesign.physics.polymers import polymer

Stiffness = Callable[[Any], tuple[Any, Any]]  # Real and imaginary stiffness [N*m/rad] at an angular frequency [rad/s]
GRAVITY = 9.80665  # Standard gravity [m/s^2]
INJURY_WINDOW = 0.015  # Longest time [s] over which a head's acceleration counts
ITERATIONS = 10  # Of a frequency that the stiffness depends on: each halves the error in its logarithm at least


def stiffening(support: tuple[Any, Any], angular_ratio: Any) -> Any:
    """Return the stiffness of a support over that at the frequency it is given for [1].

    A constant loss factor eta goes with a stiffness as w^(2 atan(eta)/pi) (Nashif, Vibration Damping, ch. 2).
    """
    return angular_ratio ** (2.0 / np.pi * np.arctan2(support[1], support[0]))


def complex_stiffness(springs: Any, support: tuple[Any, Any], given_at: Any, modes: Modes) -> Stiffness:
    """Return the complex stiffness of springs [N*m/rad] beside Maxwell elements behind a support.

    The support is `given_at` an angular frequency [rad/s] and has its loss factor at all.
    """

    def at(angular_frequency: Any) -> tuple[Any, Any]:
        moduli = polymer.maxwell_moduli(angular_frequency, modes)
        factor = stiffening(support, angular_frequency / given_at)
        real, imaginary = layer.series_stiffness(*moduli, factor * support[0], factor * support[1])
        return springs + real, imaginary

    return at


def magnitude(stiffness: tuple[Any, Any]) -> Any:
    """Return the magnitude of a complex stiffness [N*m/rad]."""
    return np.sqrt(stiffness[0] ** 2 + stiffness[1] ** 2)


def settled_frequency(of: Callable[[tuple[Any, Any]], Any], stiffness: Stiffness, inertia: Any, start: Any) -> Any:
    """Return the angular frequency [rad/s] with J w^2 = a stiffness that the complex one at w gives."""
    angular = start
    for _ in range(ITERATIONS):
        angular = np.sqrt(of(stiffness(angular)) / inertia)
    return angular


def resonance(stiffness: Stiffness, inertia: Any, start: Any) -> Any:
    """Return the angular frequency [rad/s] at which the link swings on the joint, J w^2 = K'(w)."""
    return settled_frequency(lambda complex_one: complex_one[0], stiffness, inertia, start)


def bandwidth(stiffness: Stiffness, inertia: Any, start: Any) -> Any:
    """Return the angular frequency [rad/s] above which the link follows its base by less than 1/sqrt(2).

    |K/(K - J w^2)|^2 = 1/2, so that J w^2 = K' + sqrt(2 K'^2 + K''^2).
    """

    def of(complex_one: tuple[Any, Any]) -> Any:
        real, imaginary = complex_one
        return real + np.sqrt(2.0 * real**2 + imaginary**2)

    return settled_frequency(of, stiffness, inertia, start)


def deflection(amplitude: Any, angular_frequency: Any, stiffness: tuple[Any, Any], inertia: Any) -> Any:
    """Return the amplitude of the joint's angle [rad] as its base turns by an amplitude, A J w^2/|K - J w^2|."""
    inertial = inertia * angular_frequency**2
    return amplitude * inertial / np.sqrt((stiffness[0] - inertial) ** 2 + stiffness[1] ** 2)


class Striker(NamedTuple):
    """Body that moves at a speed onto the link's end."""

    mass: Any  # [kg]
    speed: Any  # [m/s]
    lever: Any  # Of the end it strikes [m]
    stiffness: Any  # Of the contact, which pushes and never pulls [N/m]


class Followed(NamedTuple):
    """A link at each step of time; all but the start."""

    angles: list[Any]  # Of the joint [rad]
    torques: list[Any]  # Of the joint against its angle [N*m]
    forces: list[Any]  # Of the contact [N]


def followed(
    joint: Joint, modes: Modes, step: Any, count: int, speed: Any = 0.0,
    base: Sequence[Any] | None = None, striker: Striker | None = None, structure_damping: Any = 0.0,
) -> Followed:  # fmt: skip
    """Follow a link, at rest with its base and free of stress, over `count` steps [s].

    It starts with a speed [rad/s] relative to its base; `base` has the base's angular acceleration [rad/s^2] at the
    start and after each step. `structure_damping` [N*m*s/rad] is parallel to the structure's stiffness.
    """
    fading = [np.exp(-step / time) for time, _ in modes]
    gains = [-stiffness * time / step * np.expm1(-step / time) for time, stiffness in modes]
    total, viscous = sum(gains), 2.0 * structure_damping / step
    structure = joint.structure_stiffness + viscous
    share = structure / (structure + total)
    stiffness = joint.spring_stiffness + share * total
    quarter = 0.25 * step**2
    inertia = joint.inertia + quarter * stiffness
    angle: Any = 0.0
    across: Any = 0.0
    branch: Any = 0.0
    acceleration: Any = -base[0] if base is not None else 0.0
    pulls: list[Any] = [0.0] * len(modes)
    gap: Any = 0.0
    approach: Any = striker.speed if striker else 0.0
    slowing: Any = 0.0
    result = Followed([], [], [])
    for index in range(count):
        ahead = angle + step * speed + quarter * acceleration
        faded = [fade * pull for fade, pull in zip(fading, pulls, strict=True)]
        offset = sum(faded) - total * across
        lag = (viscous - joint.structure_stiffness) * (angle - across) + branch
        late = share * offset - (1.0 - share) * lag
        turning = -(joint.inertia * base[index + 1] if base is not None else 0.0) - stiffness * ahead - late
        force: Any = 0.0
        if striker:
            free = gap + step * approach + quarter * slowing
            compression = free - striker.lever * (ahead + quarter * turning / inertia)
            soft = 1.0 / striker.stiffness + quarter * (1.0 / striker.mass + striker.lever**2 / inertia)
            force = np.fmax(compression / soft, 0.0)
            turning = turning + striker.lever * force
            slowing, before = -force / striker.mass, slowing
            gap, approach = free + quarter * slowing, approach + 0.5 * step * (before + slowing)
        acceleration, before = turning / inertia, acceleration
        angle, speed = ahead + quarter * acceleration, speed + 0.5 * step * (before + acceleration)
        branch = share * total * angle + late
        across, last = angle - (branch + lag) / structure, across
        pulls = [pull + gain * (across - last) for pull, gain in zip(faded, gains, strict=True)]
        result.angles.append(angle)
        result.torques.append(joint.spring_stiffness * angle + branch)
        result.forces.append(force)
    return result


def largest(values: Sequence[Any]) -> Any:
    """Return the largest size of some values, without regard to sign."""
    most: Any = 0.0
    for value in values:
        most = np.fmax(most, np.fabs(value))
    return most


def head_injury(forces: Sequence[Any], mass: Any, step: Any) -> Any:
    """Return the Head Injury Criterion HIC15 of a head of a mass [kg] that is at rest and pushed by forces [N].

    The forces are those after each step [s]. It is the largest (t2 - t1) a^2.5 with the mean acceleration a between
    both times in multiples of gravity, over at most 15 ms (49 CFR 571.208); 700 is its limit there. A mean
    over more than 15 ms counts as one of 15 ms, which is less than the largest. Windows of up to half of the steps are
    tried.
    """
    gained: list[Any] = [0.0]
    for before, force in zip([0.0, *forces], forces, strict=False):
        gained.append(gained[-1] + 0.5 * step * (before + force) / (mass * GRAVITY))
    worst: Any = 0.0
    for length in range(1, len(gained) // 2 + 1):
        most = reduce(np.fmax, [end - start for start, end in zip(gained, gained[length:], strict=False)])
        seconds = length * step
        worst = np.fmax(worst, np.fmin(seconds, INJURY_WINDOW) * (most / seconds) ** 2.5)
    return worst
