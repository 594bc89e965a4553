"""The leg of a spring on its pin, against the line constructed with vectors, and against energy."""

import numpy as np
import pytest
import yaml
from hypothesis import assume, given
from hypothesis import strategies as st
from scipy.optimize import brentq
from support import ROOT

from tvimdesign.physics import spring
from tvimdesign.physics.spring import DrawnSpring, bend_stress_factor, bending_length, coil_stress_factor

HANDS = (1.0, -1.0)
lengths = {
    "pin": st.floats(10e-3, 45e-3),
    "placement": st.floats(50e-3, 80e-3),
    "azimuth": st.floats(-0.5, 0.5),
    "share": st.floats(0.0, 0.9),
    "hand": st.sampled_from(HANDS),
}


def constructed_direction(pin: float, placement: float, azimuth: float, offset: float, hand: float) -> float:
    """Angle of the line that passes the coil centre at the distance `offset` and runs through the pin.

    A right-hand coil (+1) is run through counterclockwise towards its leg, so the leg stands to the right of the
    direction in which it points, as a tangent of the coil does.
    """
    to_pin = np.array([pin * np.cos(azimuth) - placement, pin * np.sin(azimuth)])

    def beside(angle: float) -> float:
        right = np.array([np.sin(angle), -np.cos(angle)])
        return float(hand * right @ to_pin - offset)

    towards = np.arctan2(to_pin[1], to_pin[0]) % (2.0 * np.pi)
    return float(brentq(beside, towards - 0.5 * np.pi, towards + 0.5 * np.pi, xtol=1e-15, rtol=1e-14))


@given(**lengths)
def test_direction_is_that_of_vectors_and_its_slopes_are_derivatives(pin, placement, azimuth, share, hand):
    offset, step = share * (placement - pin), 1e-30
    expected = constructed_direction(pin, placement, azimuth, offset, hand)
    assert spring.leg_direction(pin, placement, azimuth, offset, hand) == pytest.approx(expected, abs=1e-9)
    # The complex step cannot pass atan2; a five-point stencil is good to 1e-9 here.
    slope = five_points(lambda f: spring.leg_direction(pin, placement, f, offset, hand), azimuth)
    assert spring.leg_ratio(pin, placement, azimuth, offset, hand) == pytest.approx(slope, rel=1e-6, abs=1e-7)
    slope = spring.leg_ratio(pin, placement, azimuth + 1j * step, offset, hand).imag / step
    assert spring.leg_curvature(pin, placement, azimuth, offset, hand) == pytest.approx(slope, rel=1e-9, abs=1e-9)


@given(**lengths)
def test_the_left_hand_spring_is_the_mirror_image(pin, placement, azimuth, share, hand):
    offset = share * (placement - pin)
    left = spring.leg_direction(pin, placement, azimuth, offset, -hand)
    right = spring.leg_direction(pin, placement, -azimuth, offset, hand)
    assert left + right == pytest.approx(2.0 * np.pi, rel=1e-12)


@pytest.mark.parametrize(("pin", "expected"), [(28.5e-3, 5.61), (38e-3, 22.4)])
def test_four_springs_of_the_paper_make_its_output_stiffness(pin, expected):
    # Exley et al.: K_s = N k (dalpha/dtheta)^2 with N = 4, k = 1.4023 N*m/rad; springs at 57 mm, radial pins.
    ratio = spring.leg_ratio(pin, 57e-3, 0.0, 0.0)
    curvature = spring.leg_curvature(pin, 57e-3, 0.0, 0.0)
    assert spring.output_stiffness(4, 1.4023, 0.15, ratio, curvature) == pytest.approx(expected, rel=5e-3)


@given(pin=lengths["pin"], placement=lengths["placement"], share=lengths["share"], preload=st.floats(0.0, 1.0))
def test_output_stiffness_is_the_curvature_of_the_springs_energy(pin, placement, share, preload):
    # Two right- and two left-hand springs; each stores k (a_pre + w)^2/2, w from the line constructed with vectors.
    # A right-hand coil winds up where its leg turns counterclockwise, a left-hand one clockwise.
    offset, rate = share * (placement - pin), 1.4
    assume(placement - pin > 8e-3)
    free = {hand: constructed_direction(pin, placement, 0.0, offset, hand) for hand in HANDS}

    def energy(angle: float) -> float:
        windings = [hand * (constructed_direction(pin, placement, angle, offset, hand) - free[hand]) for hand in HANDS]
        return sum(2.0 * 0.5 * rate * (preload + winding) ** 2 for winding in windings)

    step = 0.02 * (1.0 - share) * min(1.0, (placement - pin) / pin)
    weights = zip((-3, -2, -1, 0, 1, 2, 3), (2, -27, 270, -490, 270, -27, 2), strict=True)
    expected = sum(weight * energy(i * step) for i, weight in weights) / (180.0 * step**2)
    # The device's choice of signs: a right-hand spring winds where the rotor turns clockwise.
    ratio = -spring.leg_ratio(pin, placement, 0.0, offset)
    curvature = spring.leg_curvature(pin, placement, 0.0, offset)
    stiffness = spring.output_stiffness(4, rate, preload, ratio, curvature)
    scale = 4.0 * rate * (ratio**2 + preload * abs(curvature))
    assert stiffness == pytest.approx(expected, abs=1e-4 * scale)


def test_torque_of_one_spring_is_that_of_its_force_on_the_pin():
    # Statics: the spring's moment M is a force M/L across the leg, L = sqrt(s^2 - e^2) from the coil to the pin.
    pin, placement, offset, azimuth, moment = 28.5e-3, 57e-3, 15.4e-3, 0.08, 0.3
    direction = constructed_direction(pin, placement, azimuth, offset, 1.0)
    position = pin * np.array([np.cos(azimuth), np.sin(azimuth)])
    arm = np.sqrt(np.sum((position - [placement, 0.0]) ** 2) - offset**2)
    # A wound right-hand spring pushes its leg clockwise, so the pin to the leg's right.
    force = moment / arm * np.array([np.sin(direction), -np.cos(direction)])
    torque = position[0] * force[1] - position[1] * force[0]
    # Energy: the springs' torque on the rotor is -M dw/dphi, w the leg's direction.
    expected = -moment * spring.leg_ratio(pin, placement, azimuth, offset)
    assert torque == pytest.approx(expected, rel=1e-9)


def five_points(function, at: float, step: float = 1e-3) -> float:
    return (8.0 * (function(at + step) - function(at - step)) - function(at + 2 * step) + function(at - 2 * step)) / (
        12.0 * step
    )


FE = yaml.safe_load((ROOT / "validation/fe_spring/results.yaml").read_text())
POISSON = FE["poissons_ratio"]
SPRINGS = FE["springs"]


def drawn(case: dict[str, float]) -> DrawnSpring:
    wire, coil, pitch, arm = (1e-3 * case[name] for name in ("wire_diameter", "coil_diameter", "pitch", "arm"))
    return DrawnSpring(wire, coil, 2.0 * np.pi * case["turns"], pitch, arm, (case["bend_ratio"] + 0.5) * wire)


@pytest.mark.parametrize("name", SPRINGS)
def test_the_rate_is_that_of_fe(name):
    case, shape = SPRINGS[name], drawn(SPRINGS[name])
    coils = bending_length(shape, POISSON) / (np.pi * shape.coil_diameter)
    rate = spring.rate(case["modulus"] * 1e9, shape.wire_diameter, shape.coil_diameter, coils)
    assert rate == pytest.approx(case["rate"], rel=0.01)
    handbook = spring.active_coils(case["turns"], shape.coil_diameter, shape.arm)
    without = spring.rate(case["modulus"] * 1e9, shape.wire_diameter, shape.coil_diameter, handbook)
    assert without > 1.1 * case["rate"]  # what stood here before was 11 to 60 % too stiff


@pytest.mark.parametrize("name", SPRINGS)
def test_the_highest_stress_is_that_of_fe(name):
    case, shape = SPRINGS[name], drawn(SPRINGS[name])
    straight = spring.bending_stress(1.0, shape.wire_diameter, 1.0) * 1e-6
    factor = spring.inner_fibre_factor(shape.coil_diameter / shape.wire_diameter)
    fibre = straight * factor * (1.0 + 0.5 * shape.coil_diameter / shape.arm)
    assert fibre == pytest.approx(case["fibre"], rel=0.03)
    if "coil" in case:
        assert straight * coil_stress_factor(shape, factor) == pytest.approx(case["coil"], rel=0.05)
    if case["bend_ratio"] >= 1.0:  # the least that the table's input allows; tighter ones are within 22 %
        assert straight * bend_stress_factor(shape) == pytest.approx(case["bend"], rel=0.09)


def along_the_wire(shape: DrawnSpring, poisson: float) -> float:
    """Wire length that bends as far, by the moment of a unit force on every piece of the centre line in space."""
    radius, climb = 0.5 * shape.coil_diameter, shape.pitch / (2.0 * np.pi)
    rise = shape.pitch / (np.pi * shape.coil_diameter)
    back = np.linspace(0.0, shape.wound, 20001)
    coil = np.stack([-radius * np.sin(back), radius * np.cos(back), -climb * back], axis=1)
    start, toward = coil[-1], coil[-1] - coil[-2]
    toward = np.array([toward[0], toward[1], 0.0]) / np.hypot(toward[0], toward[1])
    down, turn = np.array([0.0, 0.0, -1.0]), np.linspace(0.0, 0.5 * np.pi, 501)[:, None]
    bend = start + shape.bend_radius * (np.sin(turn) * toward + (1.0 - np.cos(turn)) * down)
    pin = np.array([shape.arm, radius, rise * shape.arm])
    wire = np.concatenate([[pin], coil, bend])
    piece, middle = np.diff(wire, axis=0), 0.5 * (wire[1:] + wire[:-1])
    length = np.linalg.norm(piece, axis=1)
    keep = length > 0.0
    piece, middle, length = piece[keep], middle[keep], length[keep]
    moment = np.cross(pin - middle, np.array([0.0, 1.0, 0.0]))
    twist = np.sum(moment * piece, axis=1) / length
    bending = np.sum(moment**2, axis=1) - twist**2
    return float(np.sum((bending + (1.0 + poisson) * twist**2) * length) / shape.arm**2)


@pytest.mark.parametrize("name", SPRINGS)
def test_the_closed_form_is_the_energy_along_the_wire(name):
    # What the closed form leaves out: the slope of the wire, and the bend's own way.
    shape = drawn(SPRINGS[name])
    assert bending_length(shape, POISSON) == pytest.approx(along_the_wire(shape, POISSON), rel=0.02)
