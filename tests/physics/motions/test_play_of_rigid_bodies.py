"""Play of rigid bodies, and a link with a Maxwell layer."""

from collections.abc import Callable

import numpy as np
import pytest
import textbook
from hypothesis import given
from hypothesis import strategies as st
from scipy.integrate import quad
from scipy.optimize import brentq, minimize

from tvimdesign.physics.motions import contacts, motion, one_sided
from tvimdesign.physics.motions.one_sided import Blocks, Touching
from tvimdesign.physics.solids import fasteners
from tvimdesign.physics.spring import leg_ratio, pin_slip

# The optimum of paper_shear.yaml as it was read and measured from outside: a coil of 8 mm of wire of 1.81 mm.
TANG, LENGTH, LEVER, POST, LEVELS, ARM = 0.25e-3, 3.5e-3, 4.392e-3, 0.3515e-3, (1.81e-3, 7.5e-3), 14.23e-3


def largest_turn(arm: float, leaning: bool) -> float:
    """Return how far a force at the leg's end turns a rigid spring, over all places that tang and post allow."""

    def clear(moved: np.ndarray) -> np.ndarray:
        aside, ahead, turn, lean_x, lean_y = moved * 1e-3

        def at(z: float, x: float) -> np.ndarray:
            return np.array([aside + lean_y * z, ahead - lean_x * z + turn * x])

        tang = [TANG**2 - np.sum(at(z, LEVER) ** 2) for z in (0.0, -LENGTH)]
        post = [POST**2 - np.sum(at(z, 0.0) ** 2) for z in LEVELS]
        return np.array([*tang, *post]) * 1e6

    def given_way(moved: np.ndarray) -> float:
        _, ahead, turn, lean_x, _ = moved * 1e-3
        return -1e3 * (turn + (ahead - lean_x * LEVELS[1]) / arm)

    bounds = [(-2, 2), (-2, 2), (-500, 500), *([(-500, 500)] * 2 if leaning else [(0, 0)] * 2)]
    draw = np.random.default_rng(1).uniform(-1.0, 1.0, (12, 5)) * [0.1, 0.1, 50.0, 20.0, 20.0]
    optima = [
        minimize(given_way, start * (1.0 if leaning else [1, 1, 1, 0, 0]), method="SLSQP", bounds=bounds,
                 constraints={"type": "ineq", "fun": clear}, options={"maxiter": 400, "ftol": 1e-12})
        for start in draw
    ]  # fmt: skip
    return max(-1e-3 * optimum.fun for optimum in optima if np.all(clear(optimum.x) > -1e-6))


def test_loose_springs_turn_as_far_as_rigid_ones_can():
    bound = float(contacts.spring_play(TANG, LENGTH, LEVER, POST, LEVELS, ARM))
    turn = largest_turn(ARM, leaning=True)
    assert turn <= bound * (1.0 + 1e-6)
    assert turn == pytest.approx(bound, rel=0.02)  # the bound is nearly reached
    # The reading from outside had 13 degrees with the lean; this one is a bound of its own geometry.
    assert np.degrees(bound) == pytest.approx(13.0, rel=0.1)
    upright = float(contacts.spring_play(TANG, 1e9, LEVER, POST, LEVELS, 1e9))
    assert upright == pytest.approx(largest_turn(1e9, leaning=False), rel=1e-4)
    assert np.degrees(upright) == pytest.approx(7.9, rel=0.01)  # read from outside
    # The tang alone: 57 mrad of 0.25 mm at 4.4 mm.
    assert float(contacts.spring_play(0.25e-3, 1e9, 4.4e-3, 0.0, LEVELS, 1e9)) == pytest.approx(57e-3, rel=5e-3)


def slid(p: float, r: float, offset: float, diameter: float) -> float:
    """Slip on a pin for each radian, of points of pin and leg that touched: the rotor turned, the leg's line found."""
    step = 1e-6

    def line(rotor: float) -> float:
        # Direction of a line at `offset` from the coil's axis (r, 0) through the pin's middle.
        pin = p * np.array([np.cos(rotor), np.sin(rotor)]) - [r, 0.0]
        return float(brentq(lambda a: pin @ [-np.sin(a), np.cos(a)] - offset, 0.6 * np.pi, 1.4 * np.pi, xtol=1e-15))

    start, end = line(0.0), line(step)
    normal = np.array([-np.sin(start), np.cos(start)])
    touch = np.array([p, 0.0]) - 0.5 * diameter * normal

    def spun(point: np.ndarray, about: np.ndarray, angle: float) -> np.ndarray:
        c, s = np.cos(angle), np.sin(angle)
        return about + np.array([[c, -s], [s, c]]) @ (point - about)

    coil = np.array([r, 0.0])
    apart = spun(touch, np.zeros(2), step) - spun(touch, coil, end - start)
    return abs(float(apart @ [np.cos(start), np.sin(start)])) / step


@pytest.mark.parametrize("ratio", [0.4, 0.5, 0.65])
def test_a_leg_slides_on_its_pin_as_two_turning_bodies(ratio):
    r, offset, diameter = 57e-3, 15.4e-3, 4e-3
    p = ratio * r
    slip = float(pin_slip(p, r, offset, diameter))
    assert slip == pytest.approx(slid(p, r, offset, diameter), rel=1e-4)
    # And as the distances of the line of sliding from rotor axis and coil axis: h_O - g h_C.
    direction = np.arcsin(offset / (r - p))
    from_rotor = p * np.sin(direction) + 0.5 * diameter
    from_coil = offset - 0.5 * diameter
    ratio_of_leg = float(leg_ratio(p, r, 0.0, offset))
    assert slip == pytest.approx(from_rotor + ratio_of_leg * from_coil, rel=1e-12)


def test_friction_of_screws_rings_and_pegs_and_a_loose_shaft():
    # Four M3 on 4.9 mm: 1.5 N.m in plastic, 4 in aluminium, by a reading from outside.
    for stress, torque in ((55e6, 1.5), (150e6, 4.0)):
        assert contacts.bolted_torque(0.2, contacts.tightened_force(stress, 3e-3), 4, 4.9e-3) == pytest.approx(
            torque, rel=0.05
        )
    assert float(contacts.joint_play(0.5 * (3.4e-3 - 3e-3), 4.9e-3)) == pytest.approx(41e-3, rel=0.01)
    assert contacts.sliding_torque(0.25, 8.0, 4e-3) == pytest.approx(8e-3, rel=1e-12)
    # SKF: M = 0.5 mu P d. 100 N on a bore of 15 mm with 0.0015: 1.125 N*mm.
    assert contacts.journal_torque(0.0015, 100.0, 15e-3) == pytest.approx(1.125e-3, rel=1e-12)
    # A line through the opposite ends of two plays of 0.1 mm, 5 mm apart, continued by 10 mm.
    line = np.polyfit([0.0, -5.0], [0.1, -0.1], 1)
    assert contacts.overhung_shift(0.1e-3, 5e-3, 10e-3, np.inf) == pytest.approx(
        1e-3 * np.polyval(line, 10.0), rel=1e-12
    )
    assert contacts.overhung_shift(0.1e-3, 5e-3, 10e-3, 0.01) == pytest.approx(0.2e-3, rel=1e-12)
    friction, force, inner, outer = 0.3, 250.0, 2e-3, 9e-3
    pressure = force / (3.141592653589793 * (outer**2 - inner**2))
    thin = quad(lambda r: friction * pressure * 2.0 * 3.141592653589793 * r * r, inner, outer)[0]
    assert contacts.disc_torque(friction, force, inner, outer) == pytest.approx(thin, rel=1e-9)
    assert contacts.disc_torque(0.3, 250.0, 8.999e-3, 9.001e-3) == pytest.approx(0.3 * 250.0 * 9e-3, rel=1e-6)
    angles = np.linspace(0.0, 2.0 * np.pi, 1000, endpoint=False)
    pieces = 24e6 * (0.9e-3 * 3.5e-3 * 2.0 * np.pi / angles.size) * 0.9e-3 * np.ones_like(angles)
    assert fasteners.peg_twist_torque(24e6, 1.8e-3, 3.5e-3) == pytest.approx(np.sum(pieces), rel=1e-12)


def test_a_stiff_peg_presses_hardest_at_the_mouth_of_its_hole():
    # A row of equal springs along the peg, solved for its shift and tilt; pressure is what each spring bears.
    force, height, diameter, depth, count = 22.6, 1.6e-3, 3e-3, 6.8e-3, 4000
    z = (np.arange(count) + 0.5) * depth / count
    sums = np.array([[count, -np.sum(z)], [-np.sum(z), np.sum(z**2)]])
    shift, tilt = np.linalg.solve(sums, np.array([force, force * height]))
    at_mouth = shift / (diameter * depth / count)
    assert fasteners.peg_rocking_force(at_mouth, diameter, height, depth) == pytest.approx(force, rel=1e-3)
    assert fasteners.peg_rocking_force(at_mouth, diameter, height, -depth) < 0.0
    assert tilt > 0.0


def test_damping_loses_in_a_cycle_what_constant_friction_does():
    omega, amplitude, torque = 2.0 * np.pi, 0.104, 0.05
    damping = contacts.equivalent_damping(torque, omega, amplitude)
    viscous, _ = quad(lambda t: damping * (omega * amplitude * np.cos(omega * t)) ** 2, 0.0, 1.0)
    assert viscous == pytest.approx(torque * 4.0 * amplitude, rel=1e-9)  # there, back, and both again
    constant = contacts.equivalent_damping(0.2 * 7.0 * 0.1, 2.0, 0.1)
    assert contacts.loaded_damping(0.2, 7.0, 0.0, 2.0) == pytest.approx(0.5 * constant, rel=1e-12)
    assert contacts.loaded_damping(0.2, 0.0, 7.0, 2.0) == pytest.approx(0.25 * np.pi * constant, rel=1e-12)


@pytest.mark.parametrize("degrees", [0.0, 20.0, 60.0, 90.0])
def test_friction_that_grows_with_the_load_over_a_cycle(degrees):
    # K* of 7 N m/rad at that phase, friction a fifth of the load, 3 Hz, 0.1 rad: W by quadrature, b = W/(pi w a^2).
    delta, omega, reach, share, size = np.radians(degrees), 6.0 * np.pi, 0.1, 0.2, 7.0
    phase = np.linspace(0.0, 2.0 * np.pi, 200_001)
    torque = share * size * reach * np.abs(np.sin(phase + delta))
    energy = np.trapezoid(torque * np.abs(reach * np.cos(phase)), phase)
    damping = contacts.loaded_damping(share, size * np.cos(delta), size * np.sin(delta), omega)
    assert damping == pytest.approx(energy / (np.pi * omega * reach**2), rel=1e-8)


@pytest.mark.parametrize(("diameter", "pitch"), [(2.0, 0.4), (3.0, 0.5), (4.0, 0.7), (5.0, 0.8)])
def test_a_nut_factor_of_a_fifth_is_a_friction_of_fifteen_hundredths(diameter, pitch):
    # Shigley, 10th ed., eq. 8-26: thread of 60 degrees on its pitch diameter, and a head that bears at 1.25 d.
    friction, flank = 0.15, 1.0 / np.cos(np.radians(30.0))
    at = diameter - 0.6495 * pitch  # ISO 724
    slope = pitch / (np.pi * at)
    thread = 0.5 * at * (slope + friction * flank) / (1.0 - friction * slope * flank)
    by_parts = thread + 0.625 * friction * diameter  # mm, of one newton
    assert contacts.tightening_torque(1.0, 1e-3 * diameter, 0.2) == pytest.approx(1e-3 * by_parts, rel=0.03)


def test_a_wire_wears_a_groove_across_its_pin():
    # Archard: 1e-7 mm3/(N m), 20 N over 2 km wear off 0.004 mm3.
    volume = contacts.worn_volume(1e-7 * 1e-9, 20.0, 2000.0)
    assert volume == pytest.approx(0.004e-9)
    wire, pin = 0.5e-3, 1.5e-3
    depth = contacts.crossed_groove_depth(volume, wire, pin)
    # What a round wire and a round pin that it crosses so deep have in common, counted across both.
    x, y = (np.linspace(-reach, reach, 1001) for reach in (0.22e-3, 0.4e-3))
    sunk = [radius - np.sqrt(radius**2 - along**2) for radius, along in ((wire, x), (pin, y))]
    common = np.maximum(depth - sunk[0][:, None] - sunk[1][None, :], 0.0)
    assert common.sum() * (x[1] - x[0]) * (y[1] - y[0]) == pytest.approx(volume, rel=0.03)


JOINT = motion.Joint(4.156e-4, 5.61, 919.0)
MODES = [(2e-2, 150.0), (1e-3, 300.0), (1e10, 40.0)]
angles = st.floats(-1.0, 1.0)
states = st.lists(angles, min_size=3, max_size=3)


def test_modes_and_springs_of_a_layer_by_hand():
    # 82513.7 Pa * 1.797e-6 m^4/1 mm = 148.28 N*m/rad, the melt's longest mode in the paper's layer.
    (time, stiffness), *_ = motion.layer_modes([(2.068841e-2, 82513.7)], 1.797e-6, 1e-3)
    assert time == 2.068841e-2
    assert stiffness == pytest.approx(148.277, rel=1e-5)
    # 490 N*m/rad behind 919: 319.6 N*m/rad; the layer takes 919/1409 of the angle.
    assert motion.branch_torque(0.1, [0.0, 0.0, 0.0], JOINT, MODES) == pytest.approx(31.96, rel=1e-3)
    assert motion.layer_angle(0.1, [0.0, 0.0, 0.0], JOINT, MODES) == pytest.approx(0.1 * 919.0 / 1409.0)
    assert motion.module_torque(0.1, [0.1, 0.1, 0.1], JOINT, MODES) == pytest.approx(-0.561)
    modes = [(1.0, 200.0)]
    phi = (919.0 * 0.1 + 200.0 * 0.02) / 1119.0
    by_hand = 0.5 * (4.156e-4 * 3.0**2 + 5.61 * 0.1**2 + 919.0 * (0.1 - phi) ** 2 + 200.0 * (phi - 0.02) ** 2)
    assert motion.stored_energy(0.1, 3.0, [0.02], JOINT, modes) == pytest.approx(by_hand, rel=1e-12)
    speed, acceleration = motion.kelvin_voigt_rates(0.1, 2.0, 0.5, 0.25, 10.0)
    assert (speed, acceleration) == (2.0, pytest.approx(-(0.25 * 2.0 + 10.0 * 0.1) / 0.5))
    assert motion.kelvin_voigt_torque(0.1, 2.0, 0.25, 10.0) == pytest.approx(-1.5)


@given(angles, states)
def test_structure_and_modes_carry_one_torque(angle, internal):
    phi = motion.layer_angle(angle, internal, JOINT, MODES)
    carried = sum(k * (phi - q) for (_, k), q in zip(MODES, internal, strict=True))
    assert motion.branch_torque(angle, internal, JOINT, MODES) == pytest.approx(carried, rel=1e-9, abs=1e-9)


@given(angles, st.floats(-100.0, 100.0), states, st.floats(-5.0, 5.0))
def test_energy_grows_by_the_work_done_less_the_heat_made(angle, speed, internal, torque):
    state = np.array([angle, speed, *internal])
    rate = np.array(motion.rates(angle, speed, internal, torque, JOINT, MODES))
    # Complex step: the derivative along the motion to machine precision.
    moved = state + 1e-30j * rate
    growth = np.imag(motion.stored_energy(moved[0], moved[1], list(moved[2:]), JOINT, MODES)) / 1e-30
    heat = textbook.dissipation(angle, internal, JOINT, MODES)
    assert heat >= 0.0
    scale = abs(torque * speed) + heat + motion.stored_energy(angle, speed, internal, JOINT, MODES)
    assert growth == pytest.approx(torque * speed - heat, abs=1e-9 * scale + 1e-12)


PAIRS: dict[str, tuple[Callable[[float], float], Callable[[float], float]]] = {
    "one": (lambda s: 1.0 / s, lambda _: 1.0),
    "time": (lambda s: 1.0 / s**2, lambda t: t),
    "root": (lambda s: s**-1.5, lambda t: 2.0 * np.sqrt(t / np.pi)),
    "decay": (lambda s: 1.0 / (s + 0.7), lambda t: np.exp(-0.7 * t)),
    "approach": (lambda s: 0.7 / (s * (s + 0.7)), lambda t: 1.0 - np.exp(-0.7 * t)),
}


@pytest.mark.parametrize("name", PAIRS)
@pytest.mark.parametrize("time", [0.03, 0.4, 2.0])
def test_what_fades_or_creeps_comes_back_to_the_stated_accuracy(name, time):
    transform, expected = PAIRS[name]
    (inverse,) = motion.inverse(lambda s: (transform(s),), time)
    assert inverse == pytest.approx(expected(time), rel=4e-4)


def test_the_weights_are_those_that_stehfest_printed():
    # Communications of the ACM 13 (1970) 47: those of ten terms.
    printed = [1 / 12, -385 / 12, 1279, -46871 / 3, 505465 / 6, -473915 / 2, 1127735 / 3, -1020215 / 3, 328125 / 2,
               -65625 / 2]  # fmt: skip
    assert motion.weights(10) == pytest.approx(printed, rel=1e-12)
    assert motion.TERMS == 10


BLOCKS = Blocks([(2e-2, 150.0), (1e-3, 300.0)], [(1e10, 40.0), (0.5, 80.0), (1e-3, 20.0)])
ALL = [Touching(a, b) for a in (0.0, 1.0) for b in (0.0, 1.0)]
blocks_states = st.lists(angles, min_size=5, max_size=5)


def test_face_of_a_block_stands_where_its_modes_balance():
    # Means weighted with the stiffness: 13.5/450 and 20/140.
    internal = [0.01, 0.04, 0.1, 0.2, 0.0]
    first, second = one_sided.divided(internal, BLOCKS)
    assert one_sided.surface_angle(first, BLOCKS.first) == pytest.approx(0.03)
    assert one_sided.surface_angle(second, BLOCKS.second) == pytest.approx(1.0 / 7.0)
    assert one_sided.gap(internal, BLOCKS) == pytest.approx(0.03 + 1.0 / 7.0)
    assert one_sided.gap([-0.2] * 5, BLOCKS) == 0.0


def test_blocks_pull_where_the_link_is_ahead_towards_the_other_side():
    internal = [0.01, 0.04, 0.1, 0.2, 0.0]
    for ahead in (-1e-3, 1e-3):
        assert one_sided.pulls(0.03 + ahead, internal, BLOCKS)[0] == pytest.approx(450.0 * ahead)
        assert one_sided.pulls(-1.0 / 7.0 - ahead, internal, BLOCKS)[1] == pytest.approx(140.0 * ahead)
    # 450 N*m/rad behind 919: 302.1 N*m/rad; 140 behind 919: 121.5 N*m/rad.
    free = [0.0] * 5
    assert one_sided.module_torque(0.1, free, Touching(1.0, 0.0), JOINT, BLOCKS) == pytest.approx(-30.769, rel=1e-4)
    assert one_sided.module_torque(-0.1, free, Touching(0.0, 1.0), JOINT, BLOCKS) == pytest.approx(12.711, rel=1e-4)
    assert one_sided.module_torque(0.1, free, Touching(0.0, 0.0), JOINT, BLOCKS) == pytest.approx(-0.561)


@given(blocks_states)
def test_nothing_jumps_where_a_block_is_left(internal):
    angle = one_sided.surface_angle(internal[:2], BLOCKS.first)
    left, met = (
        [
            *one_sided.rates(angle, 3.0, internal, Touching(touching, 0.0), JOINT, BLOCKS),
            one_sided.stored_energy(angle, 3.0, internal, Touching(touching, 0.0), JOINT, BLOCKS),
        ]
        for touching in (0.0, 1.0)
    )
    assert left == pytest.approx(met, rel=1e-9, abs=1e-9)


@pytest.mark.parametrize("touching", ALL)
@given(angle=angles, speed=st.floats(-100.0, 100.0), internal=blocks_states)
def test_energy_falls_by_the_heat_of_the_dashpots(touching, angle, speed, internal):
    state = np.array([angle, speed, *internal])
    rate = np.array(one_sided.rates(angle, speed, internal, touching, JOINT, BLOCKS))
    moved = state + 1e-30j * rate
    growth = np.imag(one_sided.stored_energy(moved[0], moved[1], list(moved[2:]), touching, JOINT, BLOCKS)) / 1e-30
    heat = sum(k * tau * q**2 for (tau, k), q in zip([*BLOCKS.first, *BLOCKS.second], rate[2:], strict=True))
    scale = heat + one_sided.stored_energy(angle, speed, internal, touching, JOINT, BLOCKS)
    assert growth == pytest.approx(-heat, abs=1e-9 * scale + 1e-12)
