"""A block's force that leans out of a vane: against vectors, quadrature, a search for the least energy, and FE."""

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.optimize import minimize_scalar

from tvimdesign.physics.solids import vane, wedge

YOUNGS, SHEAR, WIDTH, THICKNESS, HEIGHT, RADIUS = 2.11e9, 0.77e9, 4.8e-3, 3.6e-3, 6.3e-3, 13.1e-3
PLATE = wedge.PlateAround(3e-3, 6.6e-3, RADIUS, 3.0)


def block(pad: float, wedge_modulus: float = 140e6) -> vane.BlockBetween:
    return vane.BlockBetween((wedge_modulus, pad), (7.8e-3, 1.6e-3, 0.0), (WIDTH, HEIGHT), 0.4e-3)


def sideways(between: vane.BlockBetween, spread: float = 1.0) -> wedge.Sideways:
    return wedge.sideways((YOUNGS, SHEAR), (WIDTH, THICKNESS), between, spread, PLATE)


@pytest.mark.parametrize("ratio", [1.0, 1.2, 1.5, 3.0, 10.0])
def test_a_rectangular_bar_twists_as_saint_venant_s_series_says(ratio: float) -> None:
    # Timoshenko and Goodier, art. 109: J = a b^3/3 (1 - 192 b/(pi^5 a) sum tanh(k pi a/(2 b))/k^5), k odd.
    k = np.arange(1, 60, 2)
    series = ratio / 3.0 * (1.0 - 192.0 / np.pi**5 / ratio * np.sum(np.tanh(0.5 * k * np.pi * ratio) / k**5))
    assert wedge.torsion_constant(ratio, 1.0) == pytest.approx(series, rel=5e-3)
    assert wedge.torsion_constant(1.0, ratio) == wedge.torsion_constant(ratio, 1.0)


def test_plates_and_vanes_bend_as_strips_do() -> None:
    # No vane of its own: the work of the moments on the slopes that 12 m/(E h^3) adds up to from the core outwards.
    between, arm = block(1e6), 0.4e-3 + 0.5 * HEIGHT
    slope = quad(lambda r: 12.0 * 3.0 * arm / (2.0 * np.pi * r) / (YOUNGS * 3e-3**3), 6.6e-3, RADIUS)[0]
    assert sideways(between, 0.0).along == pytest.approx(arm * slope, rel=1e-9)
    between = block(1e6)
    bent = sideways(between, 1.0).along - sideways(between, 0.0).along
    stiff = vane.stiffness(YOUNGS, SHEAR, THICKNESS, WIDTH, HEIGHT, 0.4e-3)
    assert bent == pytest.approx(1.0 / stiff, rel=1e-9)


@pytest.mark.parametrize("pad", [1e5, 1e6, 1e8, 1e12])
def test_a_force_leans_out_where_its_energy_is_least(pad: float) -> None:
    between = block(pad)
    side, half, span = sideways(between), 0.5 * THICKNESS / RADIUS, 7.8e-3 / RADIUS

    def energy(x: float) -> float:
        sheared = 7.8e-3 / 140e6 * (x - half - 0.5 * span) ** 2 + 1.6e-3 / pad * (x - half - span) ** 2
        return float(sheared / (WIDTH * HEIGHT) + side.along * x**2)

    least = minimize_scalar(energy, bounds=(0.0, 1.0), method="bounded", options={"xatol": 1e-9}).x
    assert wedge.lean_out(between, side, THICKNESS, RADIUS) == pytest.approx(least, abs=1e-6)


def test_what_is_softest_has_the_force_across_itself() -> None:
    half, span = 0.5 * THICKNESS / RADIUS, 7.8e-3 / RADIUS

    def leans(between: vane.BlockBetween, along: float) -> float:
        return float(wedge.lean_out(between, wedge.Sideways(along, 0.0), THICKNESS, RADIUS))

    assert leans(block(1.0), 1e-7) == pytest.approx(half + span, rel=1e-6)  # a soft pad
    assert leans(block(1e15), 1e-15) == pytest.approx(half + 0.5 * span, rel=1e-6)  # a soft block
    assert leans(block(1e15), 1.0) == pytest.approx(0.0, abs=1e-3)  # a vane that is free to give along


@pytest.mark.parametrize("angle", [0.1, 0.7])
def test_the_parts_of_a_force_do_their_own_work(angle: float) -> None:
    # Vane's middle on the x axis. The force stands across the radius at the angle, a radius from the axis.
    at = RADIUS * np.array([np.cos(angle), np.sin(angle)])
    force = np.array([-np.sin(angle), np.cos(angle)])
    beside = at - np.array([RADIUS, 0.0])
    moment = beside[0] * force[1] - beside[1] * force[0]
    assert at[0] * force[1] - at[1] * force[0] == pytest.approx(RADIUS)
    across, side = 3e-7, wedge.Sideways(2e-7, 5e-2)
    work = across * force[1] ** 2 + side.along * force[0] ** 2 + side.twisted * moment**2
    assert wedge.compliance(across, side, angle, RADIUS) == pytest.approx(work, rel=1e-12)


def test_a_cupped_plate_stresses_the_core_s_foot_besides() -> None:
    # One newton metre: 6 m/h^2 of a plate, m the three moments on the core's circle; the core's own by Mises.
    angle, arm, core = 0.7, 3.6e-3, 6.6e-3
    moments = 3.0 * arm * np.sin(angle) / (3.0 * RADIUS)
    bending = 6.0 * moments / (2.0 * np.pi * core) / 3e-3**2
    plain = np.sqrt(3.0) * 2.0 / (np.pi * core**3)
    assert wedge.foot_bending(angle, arm, core, PLATE) == pytest.approx(bending / plain, rel=1e-12)


def test_vanes_yield_where_mises_says_in_bending_or_shear() -> None:
    strength, arm = 31e6, 80e-3
    # Stress at the surface of a cantilever: F a (t/2)/I.
    bending = strength * (WIDTH * THICKNESS**3 / 12.0) / (arm * 0.5 * THICKNESS)
    assert wedge.force_at_yield(strength, (WIDTH, THICKNESS), arm) == pytest.approx(bending, rel=1e-3)
    stub = strength / np.sqrt(3.0) * WIDTH * THICKNESS
    assert wedge.force_at_yield(strength, (WIDTH, THICKNESS), 1e-6) == pytest.approx(stub, rel=1e-5)
    force = wedge.force_at_yield(31e6, (WIDTH, THICKNESS), 6e-3)
    bending, shear = 6.0 * force * 6e-3 / (WIDTH * THICKNESS**2), force / (WIDTH * THICKNESS)
    stress = np.array([[bending, shear, 0.0], [shear, 0.0, 0.0], [0.0, 0.0, 0.0]])
    deviator = stress - np.trace(stress) / 3.0 * np.eye(3)
    assert np.sqrt(1.5 * np.sum(deviator**2)) == pytest.approx(31e6, rel=1e-9)


@pytest.mark.parametrize(("ratio", "factor"), [(1.0, 0.208), (1.5, 0.231), (2.0, 0.246), (3.0, 0.267), (10.0, 0.313)])
def test_a_twisted_bar_is_stressed_as_timoshenko_s_table_says(ratio: float, factor: float) -> None:
    # Strength of Materials, part II, 3rd ed., ch. 8: tau = M/(alpha b c^2), c the shorter side.
    assert 1.0 / wedge.stress_of_twist(ratio, 1.0) == pytest.approx(factor * ratio, rel=5e-3)
    assert wedge.stress_of_twist(1.0, ratio) == wedge.stress_of_twist(ratio, 1.0)


def test_a_force_that_leans_out_bends_both_ways_and_twists() -> None:
    # FE of the force on a rotor's vane of `wrist_compression`: 0.76 across, 0.63 along, 3.1 mm of moment.
    arm, angle = 3.57e-3, np.radians(39.6)
    force = wedge.force_at_yield(31e6, (WIDTH, THICKNESS), arm, angle, RADIUS)
    across, along, moment = 0.77 * force, 0.637 * force, 3.0e-3 * force
    bent = across * arm * 6.0 / (WIDTH * THICKNESS**2) + along * arm * 6.0 / (THICKNESS * WIDTH**2)
    sheared = force / (WIDTH * THICKNESS) + moment / (0.225 * WIDTH * THICKNESS**2)
    assert np.hypot(bent, np.sqrt(3.0) * sheared) == pytest.approx(31e6, rel=0.02)
