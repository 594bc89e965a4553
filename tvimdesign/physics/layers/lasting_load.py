"""A link held by a constant load, on springs beside a polymer behind a structure: where it goes, and what stays.

At once the load T turns a link at rest, its polymer free of stress; then the polymer creeps as the structure S and the
springs K_s let it. For Laplace transforms the polymer is Q(s) = sum k s/(s + 1/tau) [N*m/rad], so that the link has
theta(s) = T/(s (K_s + S Q/(S + Q))) and the polymer the share S/(S + Q) of that. The link's inertia is left out.
Source: Ferry, Viscoelastic Properties of Polymers, 3rd ed., ch. 1 and 3; Christensen, Theory of Viscoelasticity, 2nd
ed., ch. 2 (the correspondence principle, by which the elastic answer holds for transforms).

A loaded layer while it melts or freezes: slices in series through its thickness, each a changing Maxwell body.

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

from tvimdesign.physics.motions import motion
from tvimdesign.physics.motions.motion import Modes
from tvimdesign.physics.solids.structure import series


class Held(NamedTuple):
    """Angles after a load has been held for a time [rad]."""

    angle: Any
    """Angle of the link."""
    set_angle: Any
    """Angle at which the polymer is free of stress, sum k q/sum k: what its dashpots have moved."""


def held(torque: Any, time: Any, springs: Any, structure: Any, modes: Modes) -> Held:
    """Follow a link for a time [s] after a torque [N*m] came on; springs and structure in N*m/rad.

    What the dashpots have moved is, of the polymer's angle, the share 1 - Q/sum k, that is sum k/(1 + s tau)/sum k.
    """
    whole = sum(stiffness for _, stiffness in modes)

    def transforms(rate: Any) -> tuple[Any, Any]:
        shares = [(tau, stiffness / (1.0 + rate * tau)) for tau, stiffness in modes]
        polymer = rate * sum(tau * share for tau, share in shares)
        taken = structure / (structure + polymer)
        angle = torque / (rate * (springs + taken * polymer))
        return angle, angle * taken * sum(share for _, share in shares) / whole

    given = (torque, time, springs, structure, *(number for mode in modes for number in mode))
    axes = len(np.broadcast_shapes(*(np.shape(number) for number in given)))
    return Held(*motion.inverse(transforms, time, axes))


def first_torque(torque: Any, springs: Any, structure: Any, modes: Modes) -> Any:
    """Return the share of a torque [N*m] that the polymer bears when it has just come on, T B/(K_s + B); B as below."""
    branch = _branch(structure, modes)
    return torque * branch / (springs + branch)


def impedance_loss(angle: Any, gap: Any, springs: Any, structure: Any, modes: Modes) -> Any:
    """Return the share [1] of the torque of a quick turn from rest to an angle [rad] that is lost to a gap on its way
    [rad].

    Without the gap the turn takes (K_s + B) theta, behind it K_s theta + B (theta - g): lost is B g/((K_s + B) theta),
    with B = S K/(S + K) of structure and polymer before anything relaxes, K = sum k (textbook).
    """
    branch = _branch(structure, modes)
    return branch * gap / ((springs + branch) * angle)


def _branch(structure: Any, modes: Modes) -> Any:
    """Return the polymer before anything relaxes and structure in series [N*m/rad]."""
    return series(structure, sum(stiffness for _, stiffness in modes))


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
