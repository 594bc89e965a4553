"""A link held by a constant load, on springs beside a polymer behind a structure: where it goes, and what stays.

At once the load T turns a link at rest, its polymer free of stress; then the polymer creeps as the structure S and the
springs K_s let it. For Laplace transforms the polymer is Q(s) = sum k s/(s + 1/tau) [N*m/rad], so that the link has
theta(s) = T/(s (K_s + S Q/(S + Q))) and the polymer the share S/(S + Q) of that. The link's inertia is left out.
Source: Ferry, Viscoelastic Properties of Polymers, 3rd ed., ch. 1 and 3; Christensen, Theory of Viscoelasticity, 2nd
ed., ch. 2 (the correspondence principle, by which the elastic answer holds for transforms).
"""

from typing import Any, NamedTuple

import numpy as np

from tvimdesign.physics.motions import motion
from tvimdesign.physics.motions.motion import Modes
from tvimdesign.physics.solids.structure import series


class Held(NamedTuple):
    """Angles after a load has been held for a time [rad]."""

    angle: Any  # Angle of the link
    set_angle: Any  # Angle at which the polymer is free of stress, sum k q/sum k: what its dashpots have moved


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
