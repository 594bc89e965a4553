"""A link held by a constant load, on springs beside a polymer behind a structure: where it goes, and what stays.

At once the load T turns a link at rest, its polymer free of stress; then the polymer creeps as the structure S and the
springs K_s let it. For Laplace transforms the polymer is Q(s) = sum k s/(s + 1/tau) [N*m/rad], so that the link has
theta(s) = T/(s (K_s + S Q/(S + Q))) and the polymer the share S/(S + Q) of that. The link's inertia is left out.
Source: Ferry, Viscoelastic Properties of Polymers, 3rd ed., ch. 1 and 3; Christensen, Theory of Viscoelasticity, 2nd
ed., ch. 2 (the correspondence principle, by which the elastic answer holds for transforms).
"""

from __future__ import annotations

from typing import Any

from tvimdesign.physics import laplace
from tvimdesign.physics.motion import Modes


def loaded_angle(torque: Any, time: Any, springs: Any, structure: Any, modes: Modes) -> Any:
    """Angle of the link [rad] a time [s] after a torque [N*m] came on; springs and structure in N*m/rad."""
    return laplace.inverse(lambda rate: torque * _compliance(rate, springs, structure, modes) / rate, time)


def first_angle(torque: Any, springs: Any, structure: Any, modes: Modes) -> Any:
    """Angle of the link [rad] when the torque has just come on, T/(K_s + S K/(S + K)), K = sum k."""
    return torque / (springs + _branch(sum(stiffness for _, stiffness in modes), structure))


def set_angle(torque: Any, time: Any, springs: Any, structure: Any, modes: Modes) -> Any:
    """Angle at which the polymer is free of stress [rad] a time [s] after the torque came on, sum k q/sum k.

    Of the polymer's angle phi(s) that is the share 1 - Q/sum k, that is sum k/(1 + s tau)/sum k: what its dashpots
    have moved.
    """
    whole = sum(stiffness for _, stiffness in modes)

    def transform(rate: Any) -> Any:
        moved = sum(stiffness / (1.0 + rate * tau) for tau, stiffness in modes) / whole
        taken = structure / (structure + _operational(rate, modes))
        return torque * _compliance(rate, springs, structure, modes) / rate * taken * moved

    return laplace.inverse(transform, time)


def impedance_loss(angle: Any, gap: Any, springs: Any, structure: Any, modes: Modes) -> Any:
    """Share [1] of the torque of a quick turn from rest to an angle [rad] that is lost to a gap on its way [rad].

    Without the gap the turn takes (K_s + B) theta, behind it K_s theta + B (theta - g): lost is B g/((K_s + B) theta),
    with B = S K/(S + K) of structure and polymer before anything relaxes, K = sum k (textbook).
    """
    branch = _branch(sum(stiffness for _, stiffness in modes), structure)
    return branch * gap / ((springs + branch) * angle)


def _operational(rate: Any, modes: Modes) -> Any:
    """Q(s) [N*m/rad]."""
    return sum(stiffness * rate * tau / (1.0 + rate * tau) for tau, stiffness in modes)


def _branch(stiffness: Any, structure: Any) -> Any:
    """Polymer and structure in series [N*m/rad]."""
    return structure * stiffness / (structure + stiffness)


def _compliance(rate: Any, springs: Any, structure: Any, modes: Modes) -> Any:
    """Of the joint [rad/(N*m)] for transforms."""
    return 1.0 / (springs + _branch(_operational(rate, modes), structure))
