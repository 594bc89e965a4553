"""The vane as a cantilever integrated along its height, and the plate let into a sector by counting."""

import numpy as np
import pytest
from scipy.integrate import quad, solve_bvp
from scipy.optimize import minimize

from tvimdesign.physics.solids import vane
from tvimdesign.physics.solids.shapes import radial_strip

YOUNGS, SHEAR, WIDTH, THICKNESS, HEIGHT = 2.1e9, 0.76e9, 11e-3, 4e-3, 12e-3


@pytest.mark.parametrize(("height", "free"), [(4e-3, 0.0), (12e-3, 0.0), (40e-3, 0.0), (5e-3, 1e-3), (2e-3, 6e-3)])
def test_mean_deflection_is_that_of_a_beam_with_shear(height: float, free: float) -> None:
    load = 1000.0  # N/m, even, beyond what is free at the root
    inertia, area = WIDTH * THICKNESS**3 / 12.0, WIDTH * THICKNESS

    def slopes(x: np.ndarray, y: np.ndarray) -> np.ndarray:
        turn, moment, force = y[1], y[2], y[3]
        deflection = turn + force / (5.0 / 6.0 * SHEAR * area)
        return np.vstack([deflection, moment / (YOUNGS * inertia), -force, -load * (x > free)])

    def ends(root: np.ndarray, tip: np.ndarray) -> np.ndarray:
        return np.array([root[0], root[1], tip[2], tip[3]])

    grid = np.union1d(np.linspace(0.0, free, 101), np.linspace(free, free + height, 201))
    solved = solve_bvp(slopes, ends, grid, np.zeros((4, grid.size)), tol=1e-8)
    mean = quad(lambda x: solved.sol(x)[0], free, free + height)[0] / height
    found = vane.stiffness(YOUNGS, SHEAR, WIDTH, THICKNESS, height, free)
    assert found == pytest.approx(load * height / mean, rel=1e-5 if free == 0.0 else 1e-3)


@pytest.mark.parametrize("thickness", [0.5e-3, 1.5e-3, 6e-3])
def test_a_plate_let_into_a_sector_covers_what_points_count(thickness: float) -> None:
    inner, outer = 13e-3, 24e-3
    x, y = np.meshgrid((np.arange(3000) + 0.5) * outer / 3000, (np.arange(600) + 0.5) * thickness / 600, indexing="ij")
    r = np.hypot(x, y)
    counted = np.mean((r > inner) & (r < outer)) * outer * thickness
    assert radial_strip(thickness, inner, outer) == pytest.approx(counted, rel=1e-3)


def test_a_root_s_moment_turns_the_plate_as_a_beam() -> None:
    # Slope and no deflection at each vane, the ends of the beam joined: slope-deflection equations, 2 E I/L (2 a + b).
    count, radius, height, thickness = 6, 18.5e-3, 4e-3, 4e-3
    inertia, span = WIDTH * height**3 / 12.0, 2.0 * np.pi * radius / count - thickness
    beam = (
        2.0
        * YOUNGS
        * inertia
        / span
        * (4.0 * np.eye(count) + np.roll(np.eye(count), 1, 0) + np.roll(np.eye(count), -1, 0))
    )
    slope = np.linalg.solve(beam, np.ones(count))[0]
    footing = vane.Footing(height, vane.strip_beside(radius, count, thickness), 0.0, 0.0, 2.0)
    found = vane.on_footing((YOUNGS, SHEAR), (WIDTH, thickness), between(1e-9), footing)
    assert found.leaning == pytest.approx(slope * (0.4e-3 + 0.5 * HEIGHT) ** 2, rel=1e-9)
    assert found.aside == 0.0


def test_a_rim_beyond_the_vane_bends_with_its_strips() -> None:
    # As wide again as the vane, half the turn; pushed aside, the rim is no help.
    def on(rim: float) -> vane.Vane:
        footing = vane.Footing(4e-3, 8e-3, 0.0, 1.0, 2.0, rim)
        return vane.on_footing((YOUNGS, SHEAR), (WIDTH, THICKNESS), between(1e-9), footing)

    assert on(WIDTH).leaning == pytest.approx(0.5 * on(0.0).leaning, rel=1e-12)
    assert on(WIDTH).aside == on(0.0).aside


def between(modulus: float) -> vane.BlockBetween:
    return vane.BlockBetween((modulus, modulus), (4e-3, 1e-3, 0.0), (WIDTH, HEIGHT), 0.4e-3)


def test_two_vanes_under_a_block_stand_where_their_energy_and_its_is_least() -> None:
    # Angles of both vanes by a search for the least of strain energy less the work of a force between them. The block
    # goes with the vanes' faces, which lie half a thickness beside the lines that turn.
    one, other, block = vane.Vane(3e-7, 0.0, 4e-3), vane.Vane(8e-7, 0.0, 6e-3), between(140e6)
    arm, width, height, depth = 0.4e-3 + 0.5 * HEIGHT, WIDTH, HEIGHT, 5e-3

    def energy(angles: np.ndarray) -> float:
        first, second = 1e-3 * angles
        up = np.array([0.5 * one.thickness * first, -0.5 * other.thickness * second])  # along the faces
        shear = 0.5 * (first + second) + (up[0] - up[1]) / depth
        levels, weights = np.polynomial.legendre.leggauss(4)
        squeeze = 0.5 * height * levels * (first - second) / depth
        stored = 0.5 * vane.SHEARED * 140e6 * width * height * depth * shear**2
        stored += 0.5 * vane.TILTED * 3.0 * 140e6 * width * depth * 0.5 * height * np.sum(weights * squeeze**2)
        stored += 0.5 * arm**2 * (first**2 / one.leaning + second**2 / other.leaning)
        return float(1e3 * (stored - 10.0 * arm * (first + second)))

    found = minimize(energy, np.zeros(2), method="Nelder-Mead", options={"xatol": 1e-9, "fatol": 1e-15}).x * 1e-3
    assert vane.compliance(one, other, block) == pytest.approx(found[0] * arm / 10.0, rel=1e-5)
    assert vane.compliance(other, one, block) == pytest.approx(found[1] * arm / 10.0, rel=1e-5)


def test_soft_blocks_leave_vanes_alone_and_stiff_ones_hold_them() -> None:
    one, other = vane.Vane(3e-7, 1e-8, 4e-3), vane.Vane(8e-7, 0.0, 6e-3)
    assert vane.compliance(one, other, between(1e-3)) == pytest.approx(one.leaning + one.aside, rel=1e-9)
    soft = vane.BlockBetween((140e6, 1e-3), (4e-3, 1e-3, 0.0), (WIDTH, HEIGHT), 0.4e-3)
    assert vane.compliance(one, other, soft) == pytest.approx(one.leaning + one.aside, rel=1e-9)
    one, other = vane.Vane(3e-7, 0.0, 4e-3), vane.Vane(1e-15, 0.0, 6e-3)
    assert vane.compliance(one, other, between(1e15)) < 1e-3 * one.leaning
