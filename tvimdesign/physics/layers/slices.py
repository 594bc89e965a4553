"""A loaded layer while it melts or freezes: slices in series through its thickness, each a changing Maxwell body.

All slices carry the layer's torque M = sum over modes of m, m = k e, where e is a mode's elastic angle. A mode's law is
e' = delta' - e/tau - max(k'/k, 0) e: material that freezes does so free of stress, material that melts keeps its
strain and loses stress. In torques: m' = k delta' - (1/tau + max(-k'/k, 0)) m. With energy m^2/(2k) a mode never
gives back more than was put in, whichever way k goes.
Source: Ferry, Viscoelastic Properties of Polymers, 3rd ed., ch. 1 (Maxwell element); the law of a changing modulus is
the usual one of solidification, new material joins unstressed (Bazant and Prasannan, J. Eng. Mech. 115 (1989) 1691).

Lists run over the modes; each entry is an array, or a CasADi vector, over the slices.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np


class Slices(NamedTuple):
    """The slices at one instant; every field is a list over modes of arrays over slices."""

    relaxation_times: Sequence[Any]
    """[s]"""
    stiffnesses: Sequence[Any]
    """k = G J/(thickness of one slice) [N*m/rad]."""
    growth: Sequence[Any]
    """k'/k [1/s]: positive where it freezes, negative where it melts."""


class Support(NamedTuple):
    """Surroundings of the layer: springs beside it, and the structure in series with it [N*m/rad]."""

    spring_stiffness: Any
    structure_stiffness: Any


def relief(torques: Sequence[Any], slices: Slices) -> Any:
    """Return the rate at which each slice loses torque at constant angle [N*m/s], sum (1/tau + max(-k'/k, 0)) m."""
    return sum(
        (1.0 / time + np.fmax(-growth, 0.0)) * torque
        for time, growth, torque in zip(slices.relaxation_times, slices.growth, torques, strict=True)
    )


def compliance(slices: Slices, support: Support) -> Any:
    """Return the instant compliance of layer and structure in series [rad/(N*m)], 1/S + sum over slices 1/(sum k)."""
    return 1.0 / support.structure_stiffness + np.sum(1.0 / sum(slices.stiffnesses), axis=0)


def loaded_rates(torques: Sequence[Any], load_rate: Any, slices: Slices, support: Support) -> tuple[Any, list[Any]]:
    """Return the rate of the link's angle [rad/s] and of every mode's torque [N*m/s] under a load on the link, without
    inertia.

    The load L = K_s theta + M; M (1/S) = theta - sum delta. Each slice: M' = (sum k) delta' - relief. Eliminated:
    theta' (1 + K_s C) = C L' + sum over slices relief/(sum k), with C the `compliance`.
    """
    lost = relief(torques, slices)
    totals = sum(slices.stiffnesses)
    yielding = np.sum(lost / totals, axis=0)
    soft = compliance(slices, support)
    speed = (soft * load_rate + yielding) / (1.0 + support.spring_stiffness * soft)
    torque_rate = load_rate - support.spring_stiffness * speed
    turning = (torque_rate + lost) / totals
    changes = [
        k * turning - (1.0 / time + np.fmax(-growth, 0.0)) * torque
        for time, k, growth, torque in zip(*slices, torques, strict=True)
    ]
    return speed, changes


def loaded_start(load: Any, slices: Slices, support: Support) -> tuple[Any, list[Any]]:
    """Return the angle of the link [rad] and torque of every mode [N*m] right after a load is put on a layer free of
    stress."""
    soft = compliance(slices, support)
    angle = load * soft / (1.0 + support.spring_stiffness * soft)
    shared = (load - support.spring_stiffness * angle) / sum(slices.stiffnesses)
    return angle, [k * shared for k in slices.stiffnesses]


def stored_energy(angle: Any, torques: Sequence[Any], slices: Slices, support: Support) -> Any:
    """Return the elastic energy of springs, structure and every mode of every slice [J]: stiffness^-1 torque^2/2
    each."""
    modes = sum(torque**2 / k for torque, k in zip(torques, slices.stiffnesses, strict=True))
    carried = sum(torques)[0]
    return 0.5 * (
        support.spring_stiffness * angle**2 + carried**2 / support.structure_stiffness + np.sum(modes, axis=0)
    )
