"""A link on springs between two blocks that only push, one against positive angles and one against negative ones.

Each block is a generalised Maxwell body behind its own share of the structure, as in `motion`; the first sees the angle
theta, the second -theta, and a block that was squeezed at rest starts with negative internal angles. A block touches
where its pull is positive, sum k_m (theta - q_m) > 0, that is, where the link is ahead of the block's stress-free face
sum k q/sum k. If it does not touch, it is the same body behind a structure of no stiffness: no torque, and its face
recovers. Both are equal where the pull is zero, so nothing jumps when contact is lost or made.
Source: Signorini's conditions of one-sided contact (Kikuchi and Oden, Contact Problems in Elasticity, 1988, ch. 2).
"""

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np

from tvimdesign.physics.motions import motion
from tvimdesign.physics.motions.motion import Joint, Modes


class Blocks(NamedTuple):
    """Modes of the blocks on either side (time [s], stiffness [N*m/rad]); a `Joint`'s structure is that of one side."""

    first: Modes  # Pushes back against positive angles
    second: Modes  # Pushes back against negative angles


class Touching(NamedTuple):
    """Contacts of the blocks with the link: 1 or 0."""

    first: Any
    second: Any


def divided(internal: Sequence[Any], blocks: Blocks) -> tuple[Sequence[Any], Sequence[Any]]:
    """Return the internal angles of the first and of the second block [rad], from those of both in one row."""
    count = len(blocks.first)
    return internal[:count], internal[count:]


def surface_angle(internal: Sequence[Any], modes: Modes) -> Any:
    """Return the angle at which the face of a block stands that nothing touches [rad]: its modes' mean, sum k q/sum
    k."""
    return motion.layer_angle(0.0, internal, Joint(0.0, 0.0, 0.0), modes)


def gap(internal: Sequence[Any], blocks: Blocks) -> Any:
    """Return the angle over which neither block touches [rad]: how far both faces stand back, or 0 where the two
    meet."""
    first, second = divided(internal, blocks)
    return np.fmax(surface_angle(first, blocks.first) + surface_angle(second, blocks.second), 0.0)


def out_of_contact(touching: Touching) -> Any:
    """Return 1 where neither block touches the link, else 0."""
    return 1.0 - np.fmax(touching.first, touching.second)


def pulls(angle: Any, internal: Sequence[Any], blocks: Blocks) -> tuple[Any, Any]:
    """Return the torque each block would push back with behind a rigid structure [N*m]; negative where it does not
    touch."""
    first, second = divided(internal, blocks)
    return motion.layer_pull(angle, first, blocks.first), motion.layer_pull(-angle, second, blocks.second)


def module_torque(angle: Any, internal: Sequence[Any], touching: Touching, joint: Joint, blocks: Blocks) -> Any:
    """Return the torque of springs and touching blocks on the link [N*m]."""
    first, second = divided(internal, blocks)
    ahead, behind = _joints(joint, touching)
    return (
        -joint.spring_stiffness * angle
        - motion.branch_torque(angle, first, ahead, blocks.first)
        + motion.branch_torque(-angle, second, behind, blocks.second)
    )


def internal_rates(angle: Any, internal: Sequence[Any], touching: Touching, joint: Joint, blocks: Blocks) -> list[Any]:
    """Return the rates of all internal angles [rad/s]; a block that does not touch recovers."""
    first, second = divided(internal, blocks)
    ahead, behind = _joints(joint, touching)
    return [
        *motion.internal_rates(angle, first, ahead, blocks.first),
        *motion.internal_rates(-angle, second, behind, blocks.second),
    ]


def rates(
    angle: Any, speed: Any, internal: Sequence[Any], touching: Touching, joint: Joint, blocks: Blocks
) -> list[Any]:
    """Return the rates of angle, speed and internal angles of a link that is left alone."""
    torque = module_torque(angle, internal, touching, joint, blocks)
    return [speed, torque / joint.inertia, *internal_rates(angle, internal, touching, joint, blocks)]


def energy_terms(
    angle: Any, speed: Any, internal: Sequence[Any], touching: Touching, joint: Joint, blocks: Blocks
) -> list[tuple[Any, Any]]:
    """Return what stores energy, as pairs (stiffness or inertia c, deflection or speed d) that hold c d^2/2 each
    [J]."""
    first, second = divided(internal, blocks)
    ahead, behind = _joints(joint, touching)
    return [
        (joint.inertia, speed),
        (joint.spring_stiffness, angle),
        *motion.branch_energy_terms(angle, first, ahead, blocks.first),
        *motion.branch_energy_terms(-angle, second, behind, blocks.second),
    ]


def stored_energy(
    angle: Any, speed: Any, internal: Sequence[Any], touching: Touching, joint: Joint, blocks: Blocks
) -> Any:
    """Return the kinetic and elastic energy [J], sum of c d^2/2; with contact lost or made it does not jump."""
    return 0.5 * sum(c * d**2 for c, d in energy_terms(angle, speed, internal, touching, joint, blocks))


def _joints(joint: Joint, touching: Touching) -> tuple[Joint, Joint]:
    stiffness = joint.structure_stiffness
    return (
        joint._replace(structure_stiffness=touching.first * stiffness),
        joint._replace(structure_stiffness=touching.second * stiffness),
    )
