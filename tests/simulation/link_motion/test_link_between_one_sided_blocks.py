"""The link between blocks that only push: by hand, against Radau with events and the two-sided link, and passive."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray
from scipy.integrate import solve_ivp

from tvimdesign.physics.motions import motion, one_sided
from tvimdesign.physics.motions.one_sided import Blocks
from tvimdesign.simulation.link_motion import link
from tvimdesign.simulation.link_motion.course import Plant
from tvimdesign.simulation.link_motion.sampled_motion import DEAD, SAMPLES_A_PERIOD, OneSided

Array = NDArray[np.float64]
INERTIA, SPRINGS = 4.156e-4, 5.61  # the paper's table I
JOINT = motion.Joint(INERTIA, SPRINGS, 919.0)
SWING = np.sqrt(SPRINGS / INERTIA)
MELT = [(2.07e-2, 82.0), (6.5e-3, 104.0), (2.07e-3, 131.0), (6.5e-4, 165.0), (2.07e-4, 207.0), (6.5e-5, 261.0)]
SOLID = [(1e10, 2.1e5), (10.0, 1.8e4), (1.0, 1.7e4), (0.1, 1.9e4), (0.01, 1.9e4), (0.001, 2.6e4)]
HALF = [(300.0, 56.0), (0.4, 180.0), (0.05, 200.0), (8e-3, 240.0), (1.5e-3, 270.0), (2e-4, 350.0)]
PAIRS = {
    "melt": Blocks(MELT, MELT),
    "half frozen": Blocks(HALF, HALF),
    "solid": Blocks(SOLID, SOLID),
    "one side cold": Blocks(SOLID, MELT),
}
NAMED = pytest.mark.parametrize("pair", PAIRS)


def radau(blocks: Blocks, angle: float, hold: float, times: Array) -> tuple[Array, list[float]]:
    """Angle at times after a release, and the events; unknowns are faces and the torques of the modes.

    T' = k phi' - T/tau; behind the structure S (theta - phi) = sum T, free of the link sum T = 0.
    """
    sides = [np.array(side).T for side in blocks]
    counts = [len(side[0]) for side in sides]
    structure = JOINT.structure_stiffness

    def parts(y: Array) -> list[tuple[float, Array]]:
        first = y[3 : 3 + counts[0]]
        return [(y[2], first), (y[3 + counts[0]], y[4 + counts[0] :])]

    def rates(_: float, y: Array, touching: list[bool]) -> Array:
        torque, rows = -SPRINGS * y[0], []
        for sign, (tau, k), touches, (_, torques) in zip((1.0, -1.0), sides, touching, parts(y), strict=True):
            pushing = structure if touches else 0.0
            turning = (pushing * sign * y[1] + np.sum(torques / tau)) / (pushing + np.sum(k))
            torque -= sign * np.sum(torques) if touches else 0.0
            rows += [turning, *(k * turning - torques / tau)]
        return np.array([y[1], torque / INERTIA, *rows])

    start = [angle, 0.0]
    for side, (tau, k) in enumerate(sides):
        torques, face = np.zeros(counts[side]), 0.0
        if side == 0:
            at_once = k * structure * angle / (structure + np.sum(k))

            def still(_: float, y: Array, tau: Array = tau, k: Array = k) -> Array:
                return np.asarray(k * np.sum(y / tau) / (structure + np.sum(k)) - y / tau)

            torques = solve_ivp(still, (0.0, hold), at_once, method="Radau", rtol=1e-11, atol=1e-13).y[:, -1]
            face = angle - np.sum(torques) / structure
        start += [face, *torques]

    def passing(side: int) -> object:
        def distance(_: float, y: Array, __: list[bool]) -> float:
            return float((y[0] if side == 0 else -y[0]) - parts(y)[side][0])

        distance.terminal = True
        return distance

    ahead, behind = passing(0), passing(1)
    # A block that has relaxed to rounding is not touched from the start.
    now, state, touching = 0.0, np.array(start), [bool(np.sum(start[3 : 3 + counts[0]]) > 1e-9), False]
    angles, events = np.empty(len(times)), []
    while now < times[-1]:
        # The event that has just been is left out until the link has gone on a little.
        for watched, end in (((), now + 1e-9), ((ahead, behind), times[-1])):
            part = solve_ivp(
                rates, (now, end), state, method="Radau", events=watched, dense_output=True, args=(touching,),
                rtol=1e-10, atol=1e-13,
            )  # fmt: skip
            inside = (times >= now) & (times <= part.t[-1])
            if np.any(inside):
                angles[inside] = part.sol(times[inside])[0]
            now, state = float(part.t[-1]), part.y[:, -1]
            if now >= times[-1]:
                break
        if part.status == 1:
            if now > 1e-6:
                events.append(now)
            side = 0 if len(part.t_events[0]) else 1
            touching[side] = not touching[side]
    return angles, events


@pytest.mark.gate
@NAMED
@pytest.mark.parametrize("hold", [0.02, pytest.param(10.0, marks=pytest.mark.slow)])
def test_release_and_its_events_are_those_of_radau(pair, hold):
    blocks = PAIRS[pair]
    moved = link.released(Plant(JOINT, blocks), 0.1, link.held(Plant(JOINT, blocks), 0.1, hold))
    last = min(moved.events[5].time, 0.05) if len(moved.events) > 5 else 0.05
    early = moved.motion.times <= last
    angle, events = radau(blocks, 0.1, hold, moved.motion.times[early])
    assert moved.motion.angle[early] == pytest.approx(angle, abs=2e-7)
    # A relaxed block is left at once: whether that is an event is a matter of rounding.
    ours = [event.time for event in moved.events if 1e-6 < event.time < 0.99 * last]
    assert ours
    assert ours == pytest.approx(events[: len(ours)], rel=1e-5, abs=1e-8)


def test_relaxed_link_meets_the_other_block_when_its_cosine_says():
    # The block ahead stands back out of reach; the one behind stands 0.02 rad behind rest.
    blocks = Blocks([(1e10, 300.0)], [(1e10, 300.0)])
    moved = link.released(Plant(JOINT, blocks), 0.05, np.array([0.06, 0.02]))
    first = moved.events[0]
    assert (first.side, first.touching) == (1, True)
    assert not np.any(moved.touching[:, 0])
    assert first.time == pytest.approx(np.arccos(-0.4) / SWING, rel=1e-9)
    flight = moved.motion.times <= first.time
    assert moved.motion.angle[flight] == pytest.approx(0.05 * np.cos(SWING * moved.motion.times[flight]), abs=1e-12)
    assert moved.lost_share(0.0, first.time) == pytest.approx(1.0)
    # Elastic on the far side: it comes back as fast, and leaves after half a period of the stiffer swing.
    leaving = next(event for event in moved.events if event.side == 1 and not event.touching)
    stiff = SPRINGS + 300.0 * 919.0 / 1219.0
    offset = -0.02 * (stiff - SPRINGS) / stiff
    speed = 0.05 * SWING * np.sqrt(1.0 - 0.16)
    phase = np.arctan2(speed / np.sqrt(stiff / INERTIA), 0.02 + offset)
    assert leaving.time - first.time == pytest.approx(2.0 * phase / np.sqrt(stiff / INERTIA), rel=1e-8)


@NAMED
def test_no_block_ever_pulls(pair):
    blocks = PAIRS[pair]
    moved = link.released(Plant(JOINT, blocks), 0.1, link.held(Plant(JOINT, blocks), 0.1, 10.0))
    pulls = one_sided.pulls(moved.motion.angle, list(moved.motion.internal), blocks)
    for side, touching in zip(pulls, moved.touching, strict=True):
        scale = 1e-12 * np.max(np.abs(side))
        assert np.all(side[touching] >= -scale)
        assert np.all(side[~touching] <= scale)


@NAMED
def test_squeezed_blocks_that_keep_contact_are_the_two_sided_link(pair):
    blocks = PAIRS[pair]
    if blocks.first != blocks.second:
        blocks = Blocks(blocks.first, [(tau, k) for tau, k in blocks.first])
    doubled = JOINT._replace(structure_stiffness=2.0 * JOINT.structure_stiffness)
    modes = [(tau, 2.0 * k) for tau, k in blocks.first]
    moved = link.released(Plant(JOINT, blocks), 0.01, link.held(Plant(JOINT, blocks), 0.01, 1e-4, precompression=10.0))
    layer = Plant(doubled, modes)
    linear = link.released(layer, 0.01, link.held(layer, 0.01, 1e-4)).motion
    first = moved.events[0].time if moved.events else np.inf
    both = min(first, moved.motion.times[-1], linear.times[-1])
    early, wanted = moved.motion.times < both, linear.times < both
    assert np.sum(early) > 20
    assert moved.motion.times[early] == pytest.approx(linear.times[wanted], rel=1e-9)
    assert moved.motion.angle[early] == pytest.approx(linear.angle[wanted], abs=1e-11)
    assert moved.motion.torque[early] == pytest.approx(linear.torque[wanted], abs=1e-8 * abs(linear.torque[0]))
    assert moved.lost_share(0.0, both) == 0.0


@pytest.mark.slow
@NAMED
@pytest.mark.parametrize("precompression", [0.0, 0.02, 0.3])
def test_gap_after_a_hold_is_what_relaxed_less_the_precompression(pair, precompression):
    # By hand: the block ahead stands back (0.1 + p) loss - p, the one behind max(p - 0.1, 0) loss - p.
    modes = PAIRS[pair].first
    rigid = JOINT._replace(structure_stiffness=1e14)
    inner = link.held(Plant(rigid, Blocks(modes, modes)), 0.1, 2.0, precompression)
    loss = sum(k * -np.expm1(-2.0 / tau) for tau, k in modes) / sum(k for _, k in modes)
    expected = (0.1 + precompression + max(precompression - 0.1, 0.0)) * loss - 2.0 * precompression
    assert one_sided.gap(inner, Blocks(modes, modes)) == pytest.approx(max(expected, 0.0), rel=1e-6, abs=1e-9)


def test_elastic_blocks_never_lose_a_link_that_is_swung():
    blocks = Blocks([(1e16, 300.0)], [(1e16, 100.0)])
    moved = link.swung(Plant(JOINT, blocks), 0.1, 3.0, 3, 96)
    assert moved.lost_share(0.0, 1.0) == 0.0
    angle = 0.1 * np.sin(6.0 * np.pi * moved.motion.times)
    assert moved.motion.angle == pytest.approx(angle, abs=1e-10)
    stiffness = np.where(angle > 0.0, 300.0 * 919.0 / 1219.0, 100.0 * 919.0 / 1019.0)
    assert moved.motion.torque == pytest.approx(-(SPRINGS + stiffness) * angle, abs=1e-8)
    # Once every half period one block is left and the other met; a sine's zeros are those moments.
    inside = [event.time for event in moved.events if event.time < 0.99]
    assert inside == pytest.approx(np.repeat(np.arange(1, 6) / 6.0, 2), abs=1e-9)


def test_blocks_grazed_or_left_between_two_samples_are_found():
    # Faces 0.0999 rad away on either side, ten samples a period: the crests of 0.1 rad lie between samples.
    blocks = Blocks([(1e16, 300.0)], [(1e16, 300.0)])
    moved = link.swung(Plant(JOINT, blocks), 0.1, 1.0, 1, 10, precompression=-0.0999)
    reach = np.arccos(0.999) / (2.0 * np.pi)
    expected = [0.25 - reach, 0.25 + reach, 0.75 - reach, 0.75 + reach]
    assert [event.time for event in moved.events] == pytest.approx(expected, rel=1e-9)
    assert [(event.side, event.touching) for event in moved.events] == [(0, True), (0, False), (1, True), (1, False)]
    assert moved.lost_share(0.0, 1.0) == pytest.approx(1.0 - 4.0 * reach, rel=1e-9)
    # Blocks squeezed by as much as the swing but for its crest: the one behind is left there alone.
    blocks = Blocks([(1e16, 300.0)], [(1e16, 300.0)])
    moved = link.swung(Plant(JOINT, blocks), 0.1, 1.0, 1, 10, precompression=0.0999)
    reach = np.arccos(0.999) / (2.0 * np.pi)
    expected = [0.25 - reach, 0.25 + reach, 0.75 - reach, 0.75 + reach]
    assert [event.time for event in moved.events] == pytest.approx(expected, rel=1e-9)
    assert [(event.side, event.touching) for event in moved.events] == [(1, False), (1, True), (0, False), (0, True)]
    assert moved.lost_share(0.0, 1.0) == 0.0


def test_releases_last_one_swing_or_until_their_energy_is_gone():
    blocks = Blocks([(1e16, 300.0)], [(1e16, 300.0)])
    moved = link.released(Plant(JOINT, blocks), 0.1, np.array([0.2, 0.2]))
    assert moved.events == ()
    step = np.max(np.diff(moved.motion.times))
    assert moved.first_swing() == pytest.approx(2.0 * np.pi / SWING, abs=1.01 * step)
    assert moved.lost_share(0.0, moved.first_swing()) == 1.0
    moved = link.released(Plant(JOINT, PAIRS["melt"]), 0.1, link.squeezed(Plant(JOINT, PAIRS["melt"]), 0.5))
    share = moved.motion.energy / moved.motion.energy[0]
    assert share[-1] <= DEAD**2 < share[-2 * SAMPLES_A_PERIOD]


def test_fluid_blocks_are_pushed_aside_once_and_not_touched_again():
    # A fluid that relaxes at once stays where the first swing has pushed it.
    blocks = Blocks([(1e-7, 300.0)], [(1e-7, 300.0)])
    moved = link.swung(Plant(JOINT, blocks), 0.1, 1.0, 4, 48)
    assert moved.lost_share(1.0, 4.0) > 0.98
    # In the first period it touches from rest to the crest, and from rest to the trough.
    assert moved.lost_share(0.0, 1.0) == pytest.approx(0.5, abs=0.01)


modes = st.lists(
    st.tuples(st.floats(-5.0, 10.0), st.floats(-3.0, 5.5)).map(lambda pair: (10.0 ** pair[0], 10.0 ** pair[1])),
    min_size=1,
    max_size=4,
)


@settings(max_examples=40, deadline=None)
@given(modes, modes, st.floats(1.0, 5.0), st.floats(-4.0, 4.0), st.sampled_from([0.0, 0.01, 0.3]))
@pytest.mark.slow
def test_energy_never_rises_once_the_link_is_let_go(first, second, structure, hold, squeeze):
    joint = motion.Joint(INERTIA, SPRINGS, 10.0**structure)
    blocks = Blocks(first, second)
    moved = link.released(Plant(joint, blocks), 0.1, link.held(Plant(joint, blocks), 0.1, 10.0**hold, squeeze))
    assert np.max(np.diff(moved.motion.energy)) <= 1e-9 * moved.motion.energy[0]
    assert np.all(moved.motion.energy >= 0.0)
    assert np.all(np.diff(moved.motion.times) >= 0.0)


@pytest.mark.parametrize("end", [10.25, 10.255])
def test_a_curve_that_ends_as_the_link_passes_its_rest_is_unsettled(end):
    def swinging(decay: float) -> OneSided:
        times = np.linspace(0.0, end, 4001)
        angle = 0.1 * np.exp(-decay * times) * np.cos(2.0 * np.pi * times)
        none = np.zeros((0, times.size))
        moved = link.Motion(times, angle, np.gradient(angle, times), none, none, none, ())
        return OneSided(moved, np.ones((2, times.size), dtype=bool), ())

    # Its last sample is within 5 % of the start, but it swings by 99 % of the start to either side.
    endless = swinging(1e-3)
    assert abs(endless.motion.angle[-1]) < 0.05 * endless.motion.angle[0]
    assert endless.settling_time(0.05) == np.inf
    # It turns atan(1/2 pi)/2 pi = 0.025 s before every half second: at 2.975 s it is 5.04 % of the start off, at the
    # next turn 3.06 %.
    settled = swinging(1.0).settling_time(0.05)
    assert 2.975 < settled < 3.0
    assert np.exp(-settled) * abs(np.cos(2.0 * np.pi * settled)) == pytest.approx(0.05, rel=1e-3)
