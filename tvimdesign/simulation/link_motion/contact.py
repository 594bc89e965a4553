"""The link's motion between two blocks that only push: held, released or swung, and what of it has no contact."""

from __future__ import annotations

import numpy as np

from tvimdesign.physics.motions import one_sided
from tvimdesign.physics.motions.motion import Joint
from tvimdesign.physics.motions.one_sided import Blocks, Touching
from tvimdesign.simulation.link_motion import link
from tvimdesign.simulation.link_motion.contact_simulation import Course, OneSided
from tvimdesign.simulation.link_motion.linear_system import doubling
from tvimdesign.simulation.link_motion.link import Array


def held(joint: Joint, blocks: Blocks, angle: float, seconds: float, precompression: float = 0.0) -> Array:
    """Internal angles [rad] of blocks squeezed by `precompression`, then turned at once to an angle and held there."""
    course = _prescribed(joint, blocks, 0.0)
    course.start(angle, 0.0, squeezed(blocks, precompression))
    if seconds > 0.0:
        quickest = min(time for side in blocks for time, _ in side)
        for step, count in doubling(quickest / link.SAMPLES_A_PERIOD, seconds):
            for _ in range(count):
                course.across(step)
    return course.states()[2:, -1]


def released(joint: Joint, blocks: Blocks, angle: float, internal: Array, turns: float = np.inf) -> OneSided:
    """Let go of a link at rest, and follow it until its energy is as good as gone, or for an hour.

    With `turns` not much longer than until it has turned round so often.
    """

    def rates(theta: Array, speed: Array, inner: list[Array], touching: Touching) -> list[Array]:
        return one_sided.rates(theta, speed, inner, touching, joint, blocks)

    course = Course(joint, blocks, rates)
    course.start(angle, 0.0, internal)
    enough = link.DEAD**2 * course.energy()
    first = 2.0 * np.pi / link.SAMPLES_A_PERIOD * np.sqrt(joint.inertia / _stiffest(joint, blocks))
    while not _over(course, enough, turns):
        _while_the_same_touch(course, first, enough, turns)
    return course.found()


def swung(
    joint: Joint,
    blocks: Blocks,
    amplitude: float,
    frequency: float,
    periods: int,
    samples: int,
    precompression: float = 0.0,
) -> OneSided:
    """Turn a link to and fro as a sine [rad, Hz] from rest between blocks just squeezed by `precompression`."""
    omega = 2.0 * np.pi * frequency
    course = _prescribed(joint, blocks, omega)
    course.start(0.0, amplitude * omega, squeezed(blocks, precompression))
    for _ in range(periods * samples):
        course.across(1.0 / frequency / samples)
    return course.found()


def squeezed(blocks: Blocks, angle: float) -> Array:
    """Internal angles [rad] of blocks that were free of strain and have just been squeezed by an angle each."""
    return np.full(len(blocks.first) + len(blocks.second), -angle)


def _prescribed(joint: Joint, blocks: Blocks, omega: float) -> Course:
    """A course on which the link turns as a sine, or stands still."""

    def rates(theta: Array, speed: Array, inner: list[Array], touching: Touching) -> list[Array]:
        return [speed, -(omega**2) * theta, *one_sided.internal_rates(theta, inner, touching, joint, blocks)]

    return Course(joint, blocks, rates)


def _stiffest(joint: Joint, blocks: Blocks) -> float:
    """Stiffness with both blocks touching before any mode relaxes [N*m/rad]."""
    alone = joint._replace(spring_stiffness=0.0)
    return float(joint.spring_stiffness + sum(link.stiffest(alone, side) for side in blocks))


def _while_the_same_touch(course: Course, first: float, enough: float, turns: float) -> None:
    """Follow a link with steps that grow until a block is left or met, or the motion is over."""
    events = len(course.events)
    for step, count in link.growing(first, course.regime.values):
        for _ in range(count):
            course.across(step)
            if len(course.events) > events:
                return
        if _over(course, enough, turns):
            return


def _over(course: Course, enough: float, turns: float) -> bool:
    """Whether nothing is left to be seen, too long was looked at it, or it has turned round often enough."""
    if np.isfinite(turns) and course.turns() >= turns:
        return True
    return course.energy() <= enough or course.time >= link.LONGEST or len(course.columns) >= link.MOST_SAMPLES
