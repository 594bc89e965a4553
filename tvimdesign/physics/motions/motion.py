"""The link on its springs and on a viscoelastic layer behind a flexible structure, with the layer's internal states.

I theta'' + K_s theta + M = T, with M the torque of the branch: the structure's stiffness S in series with the layer, a
generalised Maxwell body of modes (relaxation time tau_m, stiffness k_m). phi is the angle across the layer, q_m that
of mode m's dashpot: M = S (theta - phi) = sum k_m (phi - q_m), q_m' = (phi - q_m)/tau_m.
Source: Ferry, Viscoelastic Properties of Polymers, 3rd ed., ch. 1 and 3 (Maxwell elements and their internal states).
Natural frequency and damping are those of I theta'' + b theta' + K theta = T, one degree of freedom.

Back from a Laplace transform to time, by a weighted sum of its values at a few real places.

For what fades, or creeps, without ringing. Floats, arrays and symbols alike; no integration and no eigenvalues.
Source: Stehfest, Communications of the ACM 13 (1970) 47 and 624, algorithm 368.
"""

from collections.abc import Callable, Sequence
from functools import cache
from math import factorial, log
from typing import Any, NamedTuple

import numpy as np

Modes = Sequence[tuple[Any, Any]]  # (relaxation time [s], stiffness [N*m/rad]) of each Maxwell element of the layer


class Joint(NamedTuple):
    """Joint without its polymer: inertia [kg*m^2], springs and series structure [N*m/rad]."""

    inertia: Any
    spring_stiffness: Any
    structure_stiffness: Any


def layer_modes(spectrum: Modes, polar_moment: Any, thickness: Any) -> list[tuple[Any, Any]]:
    """Return the modes of a layer: k_m = G_m J/t [N*m/rad] from a spectrum of (relaxation time [s], modulus [Pa])."""
    return [(time, modulus * polar_moment / thickness) for time, modulus in spectrum]


def layer_angle(angle: Any, internal: Sequence[Any], joint: Joint, modes: Modes) -> Any:
    """Return the angle across the layer [rad], phi = (S theta + sum k_m q_m)/(S + sum k_m)."""
    pull = sum(stiffness * inner for (_, stiffness), inner in zip(modes, internal, strict=True))
    total = sum(stiffness for _, stiffness in modes)
    return (joint.structure_stiffness * angle + pull) / (joint.structure_stiffness + total)


def layer_pull(angle: Any, internal: Sequence[Any], modes: Modes) -> Any:
    """Return the torque of the modes if the layer stood at an angle [N*m], sum k_m (theta - q_m): with a rigid
    structure, M."""
    return sum(stiffness * (angle - inner) for (_, stiffness), inner in zip(modes, internal, strict=True))


def branch_torque(angle: Any, internal: Sequence[Any], joint: Joint, modes: Modes) -> Any:
    """Return the torque the branch takes [N*m], S (theta - phi) = S/(S + sum k_m) sum k_m (theta - q_m), which does not
    cancel."""
    total = sum(stiffness for _, stiffness in modes)
    return joint.structure_stiffness / (joint.structure_stiffness + total) * layer_pull(angle, internal, modes)


def module_torque(angle: Any, internal: Sequence[Any], joint: Joint, modes: Modes) -> Any:
    """Return the torque of the module on the link [N*m], -(K_s theta + M): it drives a deflected link back."""
    return -(joint.spring_stiffness * angle + branch_torque(angle, internal, joint, modes))


def internal_rates(angle: Any, internal: Sequence[Any], joint: Joint, modes: Modes) -> list[Any]:
    """Return the rates of the internal angles [rad/s], (phi - q_m)/tau_m."""
    phi = layer_angle(angle, internal, joint, modes)
    return [(phi - inner) / time for (time, _), inner in zip(modes, internal, strict=True)]


def rates(angle: Any, speed: Any, internal: Sequence[Any], external: Any, joint: Joint, modes: Modes) -> list[Any]:
    """Return the rates of angle, speed and internal angles under an external torque [N*m]."""
    torque = external + module_torque(angle, internal, joint, modes)
    return [speed, torque / joint.inertia, *internal_rates(angle, internal, joint, modes)]


def branch_energy_terms(angle: Any, internal: Sequence[Any], joint: Joint, modes: Modes) -> list[tuple[Any, Any]]:
    """Return what the branch stores energy in, as pairs (stiffness c, deflection d) that hold c d^2/2 each [J].

    Structure, then each mode's elastic angle phi - q_m.
    """
    phi = layer_angle(angle, internal, joint, modes)
    total = sum(stiffness for _, stiffness in modes)
    elastic = [(stiffness, phi - inner) for (_, stiffness), inner in zip(modes, internal, strict=True)]
    return [
        (joint.structure_stiffness, layer_pull(angle, internal, modes) / (joint.structure_stiffness + total)),
        *elastic,
    ]


def energy_terms(angle: Any, speed: Any, internal: Sequence[Any], joint: Joint, modes: Modes) -> list[tuple[Any, Any]]:
    """Return the terms of the whole joint: link [kg*m^2, rad/s], springs, structure, then each mode's elastic angle."""
    branch = branch_energy_terms(angle, internal, joint, modes)
    return [(joint.inertia, speed), (joint.spring_stiffness, angle), *branch]


def stored_energy(angle: Any, speed: Any, internal: Sequence[Any], joint: Joint, modes: Modes) -> Any:
    """Return the kinetic and elastic energy [J], sum of c d^2/2; at rest from outside it falls by the heat of the
    dashpots."""
    return 0.5 * sum(c * d**2 for c, d in energy_terms(angle, speed, internal, joint, modes))


def kelvin_voigt_rates(angle: Any, speed: Any, inertia: Any, damping: Any, stiffness: Any) -> list[Any]:
    """Return the rates of angle and speed of I theta'' + b theta' + K theta = 0 (textbook, one degree of freedom)."""
    return [speed, -(damping * speed + stiffness * angle) / inertia]


def kelvin_voigt_torque(angle: Any, speed: Any, damping: Any, stiffness: Any) -> Any:
    """Return the torque of a spring and a dashpot side by side on the link [N*m], -(b theta' + K theta)."""
    return -(damping * speed + stiffness * angle)


def natural_frequency(stiffness: Any, inertia: Any) -> Any:
    """Return the undamped natural frequency, sqrt(K/I)/(2 pi) [Hz]."""
    return np.sqrt(stiffness / inertia) / (2.0 * np.pi)


def critical_damping(stiffness: Any, inertia: Any) -> Any:
    """Return the damping above which nothing rings, 2 sqrt(K I) [N*m*s/rad]."""
    return 2.0 * np.sqrt(stiffness * inertia)


def damping_ratio(damping: Any, stiffness: Any, inertia: Any) -> Any:
    """Return the damping over the critical one [1]."""
    return damping / critical_damping(stiffness, inertia)


TERMS = 10
"""Terms of the sum, even. Each more pair brings a digit and takes one of rounding: within 4e-4 (tests), 1e-10."""


@cache
def weights(terms: int = TERMS) -> tuple[float, ...]:
    """Return the weights V_i of the transform at i ln(2)/t [1]; exact integers over integers, their sum is zero."""
    half = terms // 2
    weights = []
    for i in range(1, terms + 1):
        total = sum(
            k**half * factorial(2 * k)
            / (factorial(half - k) * factorial(k) * factorial(k - 1) * factorial(i - k) * factorial(2 * k - i))
            for k in range((i + 1) // 2, min(i, half) + 1)
        )  # fmt: skip
        weights.append((-1.0) ** (half + i) * total)
    return tuple(weights)


def inverse(transform: Callable[[Any], tuple[Any, ...]], time: Any, axes: int = 0) -> tuple[Any, ...]:
    """Return the values at a time [s] of what has the transforms F(s), s in 1/s: f(t) = ln(2)/t sum V_i F(i ln(2)/t).

    The transforms take all s at once, along the first axis; `axes` says how many axes the numbers in them have: none of
    floats and symbols.
    """
    along = (TERMS, *(1,) * axes)
    rate = log(2.0) / time
    places = np.reshape(np.arange(1.0, TERMS + 1.0), along) * rate
    scale = np.reshape(np.array(weights()), along)
    return tuple(rate * np.sum(scale * values, axis=0) for values in transform(places))
