"""Structure, dynamics and wedges by closed forms."""

from typing import Any

import numpy as np
import pytest
from scipy import sparse
from scipy.integrate import quad
from scipy.optimize import minimize_scalar
from scipy.sparse.linalg import spsolve

from tvimdesign.physics.motions import motion
from tvimdesign.physics.solids import structure, vane, wedge

INERTIA = 4.156e-4  # kg*m^2, Exley et al., table I (there as kg/mm^2)
STIFFNESS = 5.61  # N*m/rad, four springs of 1.4023


def test_springs_ring_and_rings_bearings_and_ledges_share_by_hand():
    # sqrt(5.61/4.156e-4)/(2 pi) = 116.2/6.2832.
    assert motion.natural_frequency(STIFFNESS, INERTIA) == pytest.approx(18.5, rel=5e-3)
    # 2 sqrt(5.61 * 4.156e-4) = 0.0966 N*m*s/rad.
    assert motion.damping_ratio(0.0966, STIFFNESS, INERTIA) == pytest.approx(1.0, rel=5e-3)
    # A ring of radius r, width dr and thickness h sheared in its plane turns by T dr/(2 pi r^3 h G).
    modulus, thickness, inner, outer = 0.76e9, 4e-3, 10e-3, 33e-3
    compliance, _ = quad(lambda r: 1.0 / (2.0 * np.pi * r**3 * thickness * modulus), inner, outer, epsabs=0.0)
    stiffness = structure.ring_stiffness(modulus, thickness, inner, outer)
    assert stiffness == pytest.approx(1.0 / compliance, rel=1e-9)
    force, height, spread = 120.0, 0.05, 0.02
    far, near = np.linalg.solve([[1.0, 1.0], [0.0, spread]], [-force, -force * (height + spread)])
    assert structure.overhung_load(force, height, spread) == pytest.approx(-near)
    assert far > 0.0  # the farther one pulls the other way
    assert structure.under_ledges_compliance((1.0, 1.0), 1e9, 3.0) == pytest.approx(3.0, rel=1e-6)
    # Compliances of 6 and 4 inside and 2 outside: the inner way bears 2/12, which costs 4 (2/12)^2.
    assert structure.under_ledges_compliance((6.0, 2.0), 4.0, 0.0) == pytest.approx(4.0 / 36.0, rel=1e-12)
    # A small hole of radius r at b in a shaft of radius R: its own polar moment is pi r^2 b^2 of pi R^4/2.
    own = np.pi * 0.1**2 * 5.0**2 / (0.5 * np.pi * 10.0**4)
    assert structure.hole_weakening(0.1, 5.0, 3, 10.0) == pytest.approx(3 * 2.0 * own, rel=1e-12)


def test_shafts_have_the_handbooks_stiffness_and_strength():
    # 6061-T6: E 68.9 GPa, nu 0.33, G 26 GPa (MIL-HDBK-5: 3.8e6 psi = 26.2 GPa).
    assert structure.shear_modulus(68.9e9, 0.33) == pytest.approx(26e9, rel=0.01)
    modulus, radius, length = 0.76e9, 10e-3, 9e-3
    polar, _ = quad(lambda r: 2.0 * np.pi * r**3, 0.0, radius, epsabs=0.0, epsrel=1e-12)
    assert structure.shaft_stiffness(modulus, radius, length) == pytest.approx(modulus * polar / length, rel=1e-9)
    # Stress rises with the radius: tau r/R on the rings 2 pi r dr, each on the arm r.
    shear_yield, radius = 30e6, 8e-3
    torque, _ = quad(lambda r: shear_yield * r / radius * 2.0 * np.pi * r**2, 0.0, radius, epsabs=0.0)
    assert structure.shaft_torque(shear_yield, radius) == pytest.approx(torque, rel=1e-9)
    # Mises: sqrt(3/2 s:s) of the deviator, here of shear alone in two planes of the tensor.
    shear = structure.shear_yield(47.5e6)
    tensor = np.array([[0.0, shear, 0.0], [shear, 0.0, 0.0], [0.0, 0.0, 0.0]])
    assert np.sqrt(1.5 * np.sum(tensor**2)) == pytest.approx(47.5e6, rel=1e-12)


def test_a_foot_moves_as_timoshenkos_beam_built_in_below_a_thick_floor():
    # Steel pin of 10 mm, 300 mm long, both ends built in: 12 E I/h^3 = 4.494e4 N/m; the shear adds under 1 %.
    stiffness = structure.foot_stiffness(206e9, 79e9, 5e-3, 0.0, 300e-3)
    assert stiffness == pytest.approx(12.0 * 206e9 * 4.9087e-10 / 27e-3, rel=0.01)
    # A cantilever bends four times as far as a beam whose ends keep their directions: h^3/(3 E I) for h^3/(12 E I).
    assert structure.foot_tilt(3.5e-3, 1.7e-3, 60.0, 1.0) == pytest.approx(1.0, abs=1e-3)
    assert structure.foot_tilt(3.5e-3, 1.7e-3, 6e-3, 1e-6) == pytest.approx(4.0, rel=1e-3)


def test_a_spot_at_the_edge_of_a_sheet_moves_as_a_force_on_a_half_plane():
    # Flamant, along the edge: u = 2 F ln(l/r)/(pi E h) but for what does not grow with l. The closed form is 14 %
    # stiffer at nu 0.3, and half as stiff as what a force within a sheet meets, (3 - nu)(1 + nu) F ln(l/r)/(4 pi E h).
    youngs, nu, h, spot, reach = 2.1e9, 0.3, 4e-3, 3.5e-3, 30e-3
    stiffness = structure.spot_stiffness(structure.shear_modulus(youngs, nu), nu, h, spot, reach)
    assert stiffness == pytest.approx(np.pi * youngs * h / (2.0 * np.log(reach / spot)), rel=0.15)
    whole = 4.0 * np.pi * youngs * h / ((3.0 - nu) * (1.0 + nu) * np.log(reach / spot))
    assert stiffness == pytest.approx(0.5 * whole, rel=1e-9)


def test_pushed_bars_and_driven_plates_keep_their_shares():
    # Energy of N = q x from -L/2 to L/2, twice over the moment squared: by quadrature, of three bars at 15 mm.
    length, section, youngs, count, radius = 22e-3, 4e-6, 2.1e9, 3, 15e-3
    push = 1.0 / (count * radius * length)
    x = (np.arange(1000) + 0.5) / 1000 * length - 0.5 * length
    energy = count * np.mean((push * x) ** 2) * length / (youngs * section)
    assert structure.hoop_compliance(youngs, section, length, count, radius) == pytest.approx(energy, rel=1e-4)
    # A block of 10 by 10 mm, 3 mm thick, its shear falling from 1 N/mm^2 to nothing; its strain energy by integral.
    energy, _ = quad(lambda z: 0.5 * (1.0 - z / 3.0) ** 2 * 100.0 / 7.0, 0.0, 3.0)
    assert structure.face_compliance(7.0, 3.0, 100.0) == pytest.approx(2.0 * energy / 100.0**2, rel=1e-9)


def stepped_bar(plate: float, reach: float, fine: int) -> float:
    """Return how much 1/a^2 rises, times a^2, as a torque enters a plate: a core of radius one on it, by differences.

    The angle f follows from div(r^3 grad f) = 0 (Timoshenko and Goodier, torsion of round bars of varying section);
    twice the energy beyond the core's radius is T^2 ((1 + e) - 1/b^2)/(4 pi G h).
    """
    step, tall = 1.0 / fine, plate + 1.0
    radii, levels = np.arange(round(reach * fine) + 1) * step, np.arange(round(tall * fine) + 1) * step
    solid = (radii[:-1, None] < 1.0 - 1e-9) | (levels[None, :-1] < plate - 1e-9)  # cells
    at = np.arange(radii.size * levels.size).reshape(radii.size, levels.size)
    weight = np.where(solid, (0.5 * (radii[:-1] + radii[1:])[:, None]) ** 3, 0.0)
    ends, flows, beyond = [], [], []
    for near, far in (((0, 0), (1, 0)), ((0, 1), (1, 1)), ((0, 0), (0, 1)), ((1, 0), (1, 1))):
        first, second = (at[i : i + radii.size - 1, j : j + levels.size - 1] for i, j in (near, far))
        ends.append(np.stack([first.ravel(), second.ravel()]))
        flows.append(0.5 * weight.ravel())
        beyond.append(np.broadcast_to(radii[:-1, None] > 1.0 - 1e-9, solid.shape).ravel())
    pairs, flow = np.concatenate(ends, 1), np.concatenate(flows)
    whole: Any = sparse.coo_matrix(
        (np.tile(-flow, 2), (pairs.ravel(), pairs[::-1].ravel())), shape=(at.size, at.size)
    ).tocsr()
    whole += sparse.diags(-np.asarray(whole.sum(axis=1)).ravel())
    angle, free = np.zeros(at.size), np.asarray(whole.diagonal() > 0.0)
    angle[at[radii <= 1.0 + 1e-9, -1]] = 1.0
    free[at[:, -1]] = False
    free[at[-1]] = False
    angle[free] = spsolve(whole[free][:, free].tocsc(), -whole[free] @ angle)
    torque = 2.0 * np.pi * float(angle @ (whole @ angle))
    energy = 2.0 * np.pi * float(np.sum((flow * (angle[pairs[0]] - angle[pairs[1]]) ** 2)[np.concatenate(beyond)]))
    return energy / torque**2 * 4.0 * np.pi * plate - 1.0 + reach**-2


@pytest.mark.parametrize("plate", [0.3, 0.4, 0.5, 0.8])
def test_a_torque_enters_a_plate_as_it_does_in_a_stepped_bar(plate):
    coarse, fine = (stepped_bar(plate, 2.0, count) for count in (30, 60))
    entry = 2.0 * fine - coarse
    stiffness = structure.plate_stiffness(1.0, plate, 1.0, 2.0)
    # Where it enters a plate that is half as thick as the core's radius, a tenth of 1/a^2 more; 0.6 (h/a)^2 were 0.15.
    assert stiffness == pytest.approx(4.0 * np.pi * plate / (1.0 + entry - 0.25), rel=0.015)


def test_a_ring_that_a_layer_relieves_evenly_gives_as_its_energy_says():
    inner, outer = 15.0, 27.5

    def left(radius: float) -> float:
        borne, _ = quad(lambda r: r**3, inner, radius)
        whole, _ = quad(lambda r: r**3, inner, outer)
        return 1.0 - borne / whole

    worked, _ = quad(lambda r: left(r) ** 2 / r**3, inner, outer)
    plain, _ = quad(lambda r: r**-3, inner, outer)
    assert structure.evenly_relieved(inner, outer) == pytest.approx(worked / plain, rel=1e-9)


YOUNGS, SHEAR, WIDTH, THICKNESS, HEIGHT, RADIUS = 2.11e9, 0.77e9, 4.8e-3, 3.6e-3, 6.3e-3, 13.1e-3
PLATE = wedge.PlateAround(3e-3, 6.6e-3, RADIUS, 3.0)


def block(pad: float, wedge_modulus: float = 140e6) -> vane.BlockBetween:
    return vane.BlockBetween((wedge_modulus, pad), (7.8e-3, 1.6e-3, 0.0), (WIDTH, HEIGHT), 0.4e-3, pad * 0.1)


def sideways(between: vane.BlockBetween) -> wedge.Sideways:
    return wedge.sideways((YOUNGS, SHEAR), (WIDTH, THICKNESS), between, PLATE)


@pytest.mark.parametrize("ratio", [1.0, 1.2, 1.5, 3.0, 10.0])
def test_a_rectangular_bar_twists_as_saint_venant_s_series_says(ratio):
    # Timoshenko and Goodier, art. 109: J = a b^3/3 (1 - 192 b/(pi^5 a) sum tanh(k pi a/(2 b))/k^5), k odd.
    k = np.arange(1, 60, 2)
    series = ratio / 3.0 * (1.0 - 192.0 / np.pi**5 / ratio * np.sum(np.tanh(0.5 * k * np.pi * ratio) / k**5))
    assert wedge.torsion_constant(ratio, 1.0) == pytest.approx(series, rel=5e-3)
    assert wedge.torsion_constant(1.0, ratio) == wedge.torsion_constant(ratio, 1.0)


def test_plates_and_vanes_bend_as_strips_do():
    # A vane bent along its width, and the work of the moments on the slopes that 12 m/(E h^3) adds up to outwards.
    between, arm = block(1e6), 0.4e-3 + 0.5 * HEIGHT
    slope = quad(lambda r: 12.0 * 3.0 * arm / (2.0 * np.pi * r) / (YOUNGS * 3e-3**3), 6.6e-3, RADIUS)[0]
    stiff = vane.stiffness(YOUNGS, SHEAR, THICKNESS, WIDTH, HEIGHT, 0.4e-3)
    assert sideways(between).along == pytest.approx(arm * slope + 1.0 / stiff, rel=1e-9)


@pytest.mark.parametrize("pad", [1e5, 1e6, 1e8, 1e12])
def test_a_force_leans_out_where_its_energy_is_least(pad):
    between = block(pad)
    side, half, span = sideways(between), 0.5 * THICKNESS / RADIUS, 7.8e-3 / RADIUS

    def energy(x: float) -> float:
        sheared = 7.8e-3 / 140e6 * (x - half - 0.5 * span) ** 2 + 1.6e-3 / pad * (x - half - span) ** 2
        return float(sheared / (WIDTH * HEIGHT) + side.along * x**2)

    least = minimize_scalar(energy, bounds=(0.0, 1.0), method="bounded", options={"xatol": 1e-9}).x
    assert wedge.lean_out(between, side, THICKNESS, RADIUS) == pytest.approx(least, abs=1e-6)


def test_what_is_softest_has_the_force_across_itself():
    half, span = 0.5 * THICKNESS / RADIUS, 7.8e-3 / RADIUS

    def leans(between: vane.BlockBetween, along: float) -> float:
        return float(wedge.lean_out(between, wedge.Sideways(along, 0.0), THICKNESS, RADIUS))

    assert leans(block(1.0), 1e-7) == pytest.approx(half + span, rel=1e-6)  # a soft pad
    assert leans(block(1e15), 1e-15) == pytest.approx(half + 0.5 * span, rel=1e-6)  # a soft block
    assert leans(block(1e15), 1.0) == pytest.approx(0.0, abs=1e-3)  # a vane that is free to give along


@pytest.mark.parametrize("angle", [0.1, 0.7])
def test_the_parts_of_a_force_do_their_own_work(angle):
    # Vane's middle on the x axis. The force stands across the radius at the angle, a radius from the axis.
    at = RADIUS * np.array([np.cos(angle), np.sin(angle)])
    force = np.array([-np.sin(angle), np.cos(angle)])
    beside = at - np.array([RADIUS, 0.0])
    moment = beside[0] * force[1] - beside[1] * force[0]
    assert at[0] * force[1] - at[1] * force[0] == pytest.approx(RADIUS)
    across, side = 3e-7, wedge.Sideways(2e-7, 5e-2)
    work = across * force[1] ** 2 + side.along * force[0] ** 2 + side.twisted * moment**2
    assert wedge.compliance(across, side, angle, RADIUS) == pytest.approx(work, rel=1e-12)


def test_a_cupped_plate_stresses_the_core_s_foot_besides():
    # One newton metre: 6 m/h^2 of a plate, m the three moments on the core's circle; the core's own by Mises.
    angle, arm, core = 0.7, 3.6e-3, 6.6e-3
    moments = 3.0 * arm * np.sin(angle) / (3.0 * RADIUS)
    bending = 6.0 * moments / (2.0 * np.pi * core) / 3e-3**2
    plain = np.sqrt(3.0) * 2.0 / (np.pi * core**3)
    assert wedge.foot_bending(angle, arm, core, PLATE) == pytest.approx(bending / plain, rel=1e-12)


def test_vanes_yield_where_mises_says_in_bending_or_shear():
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
def test_a_twisted_bar_is_stressed_as_timoshenko_s_table_says(ratio, factor):
    # Strength of Materials, part II, 3rd ed., ch. 8: tau = M/(alpha b c^2), c the shorter side.
    assert 1.0 / wedge.stress_of_twist(ratio, 1.0) == pytest.approx(factor * ratio, rel=5e-3)
    assert wedge.stress_of_twist(1.0, ratio) == wedge.stress_of_twist(ratio, 1.0)


def test_a_force_that_leans_out_bends_both_ways_and_twists():
    # FE of the force on a rotor's vane of `wrist_compression`: 0.76 across, 0.63 along, 3.1 mm of moment.
    arm, angle = 3.57e-3, np.radians(39.6)
    force = wedge.force_at_yield(31e6, (WIDTH, THICKNESS), arm, angle, RADIUS)
    across, along, moment = 0.77 * force, 0.637 * force, 3.0e-3 * force
    bent = across * arm * 6.0 / (WIDTH * THICKNESS**2) + along * arm * 6.0 / (THICKNESS * WIDTH**2)
    sheared = force / (WIDTH * THICKNESS) + moment / (0.225 * WIDTH * THICKNESS**2)
    assert np.hypot(bent, np.sqrt(3.0) * sheared) == pytest.approx(31e6, rel=0.02)
