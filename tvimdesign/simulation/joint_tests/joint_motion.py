"""A motion of the joint with the contact its PCL has: a layer that is bonded, or blocks that only push."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from tvimdesign.physics.motions import one_sided
from tvimdesign.physics.motions.one_sided import Blocks
from tvimdesign.simulation.joint_tests.case import Case
from tvimdesign.simulation.link_motion import contact, dry_friction, link
from tvimdesign.simulation.link_motion.contact_simulation import OneSided
from tvimdesign.simulation.link_motion.linear_system import Stretch
from tvimdesign.simulation.link_motion.link import Array, Motion
from tvimdesign.simulation.trial import Column, CurveTable


def blocks_of(case: Case) -> Blocks:
    """The blocks on either side, which are alike."""
    return Blocks(case.modes, case.modes)


def held(case: Case, angle: float, seconds: float) -> Array:
    """Internal angles [rad] of a PCL that was free of strain, turned at once to an angle and held there."""
    if case.one_sided:
        return contact.held(case.joint, blocks_of(case), angle, seconds)
    return link.held(case.joint, case.modes, angle, seconds)


def gap(case: Case, internal: Array) -> float:
    """Angle over which nothing touches [rad]; a bonded layer has none."""
    return float(one_sided.gap(list(internal), blocks_of(case))) if case.one_sided else 0.0


def released(case: Case, angle: float, internal: Array, turns: float = np.inf) -> OneSided:
    """Let go of a link at rest against its friction; with `turns` only until it has turned round so often."""
    if case.friction > 0.0:
        plant = dry_friction.Plant(case.joint, case.modes, case.one_sided)
        return dry_friction.released(plant, case.friction, angle, internal, turns)
    if case.one_sided:
        return contact.released(case.joint, blocks_of(case), angle, internal, turns)
    return _bonded(link.released(case.joint, case.modes, angle, internal))


def swung(case: Case, amplitude: float, frequency: float, periods: int, samples: int) -> OneSided:
    """Turn a link to and fro as a sine [rad, Hz] from rest, its PCL free of strain at first."""
    if case.one_sided:
        return contact.swung(case.joint, blocks_of(case), amplitude, frequency, periods, samples)
    return _bonded(link.swung(case.joint, case.modes, amplitude, frequency, periods, samples))


def turned(case: Case, angle: float, rise: float, after: Sequence[Stretch]) -> OneSided:
    """Turn a link steadily to a positive angle and hold it there: blocks ahead are pressed throughout, none behind."""
    moved = link.turned(case.joint, case.modes, angle, rise, after)
    return _alone(moved) if case.one_sided else _bonded(moved)


def contact_columns(case: Case, found: OneSided) -> tuple[Column, ...]:
    """Which blocks touch at each sample; nothing where none can part."""
    if not case.one_sided:
        return ()
    ahead, behind = found.touching.astype(float)
    return Column("ahead_touches", "1", ahead), Column("behind_touches", "1", behind)


def event_sheets(name: str, found: OneSided) -> tuple[CurveTable, ...]:
    """The moments at which a block was left or met, as a sheet of its own; none where none was."""
    if not found.events:
        return ()
    rows = np.array([[event.time, float(event.side == 0), float(event.touching)] for event in found.events]).T
    names = (("time", "s"), ("block_ahead", "1"), ("touches_from_here", "1"))
    columns = (Column(title, unit, values) for (title, unit), values in zip(names, rows, strict=True))
    return (CurveTable(f"{name}_events", tuple(columns)),)


def _bonded(moved: Motion) -> OneSided:
    return OneSided(moved, np.ones((2, len(moved.times)), dtype=bool), ())


def _alone(moved: Motion) -> OneSided:
    touching = np.ones((2, len(moved.times)), dtype=bool)
    touching[1] = False
    return OneSided(moved, touching, ())
