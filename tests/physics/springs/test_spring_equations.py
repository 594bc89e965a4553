"""Torsion springs against handbook examples and against the mechanics the equations come from."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.optimize import brentq
from support import cases_of

from tvimdesign.catalog import Catalog
from tvimdesign.physics import spring

INCH = 0.0254
POUND_FORCE_INCH = 0.1129848290276167  # N*m
KPSI = 6.894757293168e6
TURN = 2.0 * np.pi
HALF_PERCENT = 5e-3

# Shigley, 10th ed., example 10-8: music wire .072 in, outer diameter 19/32 in, 4.25 body coils, two legs of 1 in.
WIRE = 0.072 * INCH
COIL = (19.0 / 32.0 - 0.072) * INCH


def test_a_spring_is_that_of_shigleys_example_10_8():
    assert spring.active_coils(4.25, COIL, 2.0 * INCH) == pytest.approx(4.6567, rel=1e-4)
    rate = spring.rate(28_500 * KPSI, WIRE, COIL, spring.active_coils(4.25, COIL, 2.0 * INCH), "smi")
    assert rate * TURN / POUND_FORCE_INCH == pytest.approx(29.2, rel=HALF_PERCENT)
    assert spring.inner_fibre_factor(spring.spring_index(WIRE, COIL)) == pytest.approx(1.1146, rel=1e-4)
    assert spring.loaded_coil_diameter(COIL, 4.25, 0.236 * TURN) / INCH == pytest.approx(0.4943, rel=1e-3)
    # The example winds the body by .236 turn because .78 S_ut allows it, S_ut = 201 kpsi/.072^.145 (d in inch).
    torque = 0.236 * TURN * spring.rate(28_500 * KPSI, WIRE, COIL, 4.25, "smi")
    stress = spring.bending_stress(torque, WIRE, spring.inner_fibre_factor(COIL / WIRE))
    assert stress == pytest.approx(0.78 * 201 * KPSI / 0.072**0.145, rel=HALF_PERCENT)


@pytest.mark.parametrize(
    ("modulus", "wire", "coil", "count", "model", "expected"),
    [
        (207e9, 2e-3, 20e-3, 5.0, "smi", 3.06667 / TURN),  # 3066.67 N*mm a turn, the SMI formula worked by hand
        (203.4e9, 2e-3, 20e-3, 5.0, "bending", 0.5085),
        (203.4e9, 2e-3, 20e-3, 5.0, "smi", 0.47959),
        # Exley et al., table I. The 12.5 printed there is 12.41 in*lbf/rad, not N*m/rad.
        (210e9, 2.413e-3, 24.4094e-3, 3.25, "bending", 1.4023),
        (210e9, 2.413e-3, 24.4094e-3, 3.25, "bending", 12.41 * POUND_FORCE_INCH),
    ],
)
def test_rate_agrees_with_published_springs(modulus, wire, coil, count, model, expected):
    assert spring.rate(modulus, wire, coil, count, model) == pytest.approx(expected, rel=HALF_PERCENT)


def test_rate_and_stress_are_those_of_the_straightened_wire():
    # Castigliano: a wire of the length pi D n turns by M L/(E I) under a constant moment, I = pi d^4/64.
    wire, coil, count, modulus = 1.7e-3, 15e-3, 6.2, 200e9
    straight = modulus * np.pi * wire**4 / 64.0 / (np.pi * coil * count)
    assert spring.rate(modulus, wire, coil, count) == pytest.approx(straight, rel=1e-12)
    # Cantilever with a load at its end: the slope's work is M^2 L/(6 E I), that of a coil M^2 (pi D)/(2 E I).
    assert spring.active_coils(5.0, 20e-3, 3.0 * np.pi * 20e-3) == pytest.approx(6.0, rel=1e-12)
    # 10 N*m on a round bar of 10 mm: W = pi d^3/32 = 98.17 mm^3, 101.86 MPa.
    assert spring.bending_stress(10.0, 10e-3, 1.0) == pytest.approx(101.86e6, rel=1e-4)


@given(
    rate=st.floats(0.05, 20.0),
    wire=st.floats(0.5e-3, 8e-3),
    index=st.floats(4.0, 20.0),
    modulus=st.floats(180e9, 215e9),
)
def test_mass_follows_from_rate_and_wire_whatever_the_coil_diameter(rate, wire, index, modulus):
    # The wire's length E I/k holds no D: m = rho pi^2 E d^6/(256 k).
    coil = index * wire
    count = spring.rate(modulus, wire, coil, 1.0) / rate
    assert spring.rate(modulus, wire, coil, count) == pytest.approx(rate, rel=1e-12)
    mass = 7850.0 * np.pi * coil * count * 0.25 * np.pi * wire**2
    assert mass == pytest.approx(7850.0 * np.pi**2 * modulus * wire**6 / (256.0 * rate), rel=1e-9)


@pytest.mark.parametrize("index", [4.0, 6.0, 8.0, 10.0, 12.0, 20.0])
def test_stress_factors_are_those_of_a_curved_bar(index):
    # Winkler-Bach, lengths in wire diameters: r_n = r^2/(2 (R - sqrt(R^2 - r^2))), sigma_i = M c_i/(A e r_i).
    mean, radius = 0.5 * index, 0.5
    neutral = radius**2 / (2.0 * (mean - np.sqrt(mean**2 - radius**2)))
    inner = mean - radius
    stress = (neutral - inner) / (np.pi * radius**2 * (mean - neutral) * inner)
    exact = stress / (32.0 / np.pi)
    assert spring.inner_fibre_factor(index) == pytest.approx(exact, rel=5e-4)
    assert spring.inner_fibre_factor_en(index) == pytest.approx(exact, rel=0.02)


@cases_of("spring_equations", "handbook_wires")
def test_wire_strength_agrees_with_the_handbook(record, inches, kpsi, exponent):
    rows = Catalog().record("spring_materials", record).table("strength")
    strength = spring.tensile_strength(inches * INCH, [(row["coefficient"], row["exponent"]) for row in rows])
    assert strength == pytest.approx(kpsi * KPSI / inches**exponent, rel=8e-3)


@given(tensile=st.floats(1e9, 2.5e9), ratio=st.floats(0.3, 0.6))
def test_endurance_limit_lies_on_the_gerber_line(tensile, ratio):
    # S_r is a stress from zero: amplitude and mean are both S_r/2, and the part just fails.
    half = 0.5 * ratio * tensile
    endurance = spring.endurance_strength(tensile, ratio)
    assert half / endurance + (half / tensile) ** 2 == pytest.approx(1.0, rel=1e-12)


@given(
    amplitude=st.floats(1e6, 1e9), mean=st.floats(0.0, 1e9), endurance=st.floats(2e8, 8e8), tensile=st.floats(1e9, 3e9)
)
def test_gerber_safety_solves_gerbers_equation(amplitude, mean, endurance, tensile):
    def beyond(factor: float) -> float:
        return factor * amplitude / endurance + (factor * mean / tensile) ** 2 - 1.0

    root = brentq(beyond, 0.0, 2.0 * endurance / amplitude, xtol=1e-15, rtol=1e-14)
    assert spring.gerber_safety(amplitude, mean, endurance, tensile) == pytest.approx(root, rel=1e-9)


def test_a_spring_wound_up_keeps_its_wire_and_grows_by_it():
    # pi D n is the length of the wire; a turn of winding adds a turn of coil.
    coil, count, angle = 24e-3, 3.25, 1.2
    wound = spring.loaded_coil_diameter(coil, count, angle)
    assert wound * (count + angle / TURN) == pytest.approx(coil * count, rel=1e-12)
    # Shigley, section 10-12: d (n_b + 1 + theta).
    assert spring.body_length(2e-3, 4.25, 0.0) == pytest.approx(10.5e-3, rel=1e-12)
    assert spring.body_length(2e-3, 4.25, TURN) == pytest.approx(12.5e-3, rel=1e-12)
    assert spring.body_length(2e-3, 4.25, TURN, coil_gap=0.1e-3) == pytest.approx(13.025e-3, rel=1e-12)


@pytest.mark.parametrize(("grade_factor", "millimetres"), [(0.63, 0.3309), (1.6, 0.8404)])
def test_diameter_of_the_papers_spring_varies_as_din_2194_says(grade_factor, millimetres):
    tolerance = spring.diameter_tolerance(2.413e-3, 24.4094e-3, grade_factor)
    assert tolerance == pytest.approx(millimetres * 1e-3, rel=HALF_PERCENT)


@pytest.mark.parametrize("wire", [1e-3, 1.5e-3, 2e-3])
def test_a_coil_is_wound_on_the_mandrel_of_a_published_chart(wire):
    # Chart of D_w/D over the index for music wire, read as a straight line: metalworkingfun.com, thread 1441, post 50.
    strength = 2211e6 / (1e3 * wire) ** 0.145  # ASTM A228
    for index in (5.0, 8.0, 11.0, 15.0):
        wound = spring.wound_coil_diameter(index * wire, wire, strength, 203.4e9)
        assert wound / (index * wire) == pytest.approx(0.980364 - 0.012436 * index, rel=0.02)


def test_a_wound_coil_springs_back_as_a_section_that_yields_in_slices():
    # An ideally plastic round wire bent on the mandrel and let go, its moment summed over slices of its section.
    wire, wound, stress, modulus = 2e-3, 12e-3, 1.9e9, 203e9
    height = (np.arange(200_000) + 0.5) / 200_000 * 0.5 * wire
    width = 2.0 * np.sqrt((0.5 * wire) ** 2 - height**2)
    borne = np.minimum(modulus * height * 2.0 / wound, stress)
    moment = 2.0 * np.sum(borne * height * width) * height[0] * 2.0
    free = 2.0 / (2.0 / wound - moment / (modulus * np.pi * wire**4 / 64.0))
    assert spring.wound_coil_diameter(free, wire, stress, modulus) == pytest.approx(wound, rel=2e-3)


SIZES = (21e-3, 25e-3, 0.2e-3, 3)
YOUNGS = 206e9


def test_a_wave_spring_is_beams_and_its_factor_is_the_makers():
    inner, outer, thickness, waves = SIZES
    wave, force, section = np.pi * 0.5 * (inner + outer) / waves, 5.0, 0.5 * (outer - inner) * thickness**2 / 6.0
    # Clamped, loaded in the middle: F L/8 (Shigley, table A-9, 14), each wave bears its share of the force.
    assert spring.wave_spring_stress(force, *SIZES) == pytest.approx(force / waves * wave / 8.0 / section)
    inner, outer, thickness, waves = SIZES
    wave, moment = np.pi * 0.5 * (inner + outer) / waves, 0.5 * (outer - inner) * thickness**3 / 12.0
    free, clamped = (waves * factor * YOUNGS * moment / wave**3 for factor in (48.0, 192.0))
    rate = spring.wave_spring_rate(YOUNGS, *SIZES)
    assert free < rate < clamped
    assert rate == pytest.approx(2.0 * free * outer / inner)
    # Rotor Clip and others: K = 3.88 for 2.0 to 4.0 waves a turn.
    assert pytest.approx(3.88, abs=0.005) == spring.WAVE_FACTOR
    printed = spring.wave_spring_rate(YOUNGS, *SIZES, factor=3.88)
    assert spring.wave_spring_rate(YOUNGS, *SIZES) == pytest.approx(printed, rel=0.002)
    # B = F K Dm^3/(E SW T^3 Z^4) ID/OD, in millimetres and newtons by hand: 1 mm takes 6.73 N.
    assert printed * 1e-3 == pytest.approx(206e3 * 2.0 * 0.008 * 81.0 / (3.88 * 23.0**3) * 25.0 / 21.0, rel=1e-9)
