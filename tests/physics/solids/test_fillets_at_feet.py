"""Fillets at feet, and a vane under its block."""

import csv

import numpy as np
import pytest
from scipy.integrate import quad, solve_bvp
from support import ROOT

from tvimdesign.physics.solids import fasteners, structure, vane
from tvimdesign.physics.solids.fasteners import peg_bearing_force as bearing_force
from tvimdesign.physics.solids.fasteners import peg_shear_force as shear_force
from tvimdesign.physics.solids.shapes import radial_strip

MM = 1e-3
UNEVEN = 1.03
"""The model's foot is that much higher, as arcs do not drive it alike all around."""


@pytest.mark.parametrize(("radius", "fillet"), [(6.0, 1.5), (8.0, 1.5), (8.0, 2.0), (10.0, 2.0), (12.0, 1.5)])
def test_the_mean_in_torsion_is_a_little_below_the_peak_of_petersons_chart(radius, fillet):
    """Kts = 0.863 (q/d)^-0.239 for a shoulder of twice the diameter; the model on a plate as thin as rotors have."""
    none = structure.Bores(0.0, 0.0, 1.0)
    rise = structure.foot_rise_on_plate(radius * MM, radius * MM, 3.0 * MM, none, fillet=fillet * MM)
    assert 0.88 < rise / UNEVEN / (0.863 * (0.5 * fillet / radius) ** -0.239) < 1.0


def test_a_small_fillet_counts_as_a_sharp_foot_and_a_larger_one_as_less():
    of = [structure.filleted_foot(fillet * MM) for fillet in (0.0, 0.5, 1.0, 1.5, 2.0)]
    assert of[0] == 1.0
    assert of[1] > 0.999
    assert of[1] > of[2] > of[3] > of[4] > 0.8


@pytest.mark.parametrize(("share", "chart"), [(0.05, 2.38), (0.1, 1.89), (0.2, 1.50), (0.3, 1.31)])
def test_the_bent_pin_has_the_factor_of_petersons_chart(share, chart):
    """Read off Peterson's Stress Concentration Factors, chart 3.11, D/d = 3 to 6."""
    assert structure.bent_at_fillet(4.0 * MM, share * 4.0 * MM) == pytest.approx(chart, rel=0.05)


with (ROOT / "validation/fe_structure/fillets.csv").open(newline="") as file:
    TURNED = [{name: float(cell) for name, cell in row.items()} for row in csv.DictReader(file)]


each = pytest.mark.parametrize(
    "row", TURNED, ids=lambda row: "-".join(f"{row[name]:g}" for name in ("radius", "plate", "fillet"))
)


@each
def test_a_fillet_changes_core_and_plate_as_in_fe(row):
    none, modulus = structure.Bores(0.0, 0.0, 1.0), 1e9
    radius, plate, fillet = (row[name] * MM for name in ("radius", "plate", "fillet"))
    per_length = 1.0 / structure.shaft_stiffness(modulus, radius, 1.0)

    def gives(q: float) -> tuple[float, float]:
        shorter = structure.shorter_by_fillet(radius, plate, q)
        core = structure.bored_shaft_stiffness(modulus, radius, 1.5 * radius, none, none, shorter)
        return 1.0 / core, 1.0 / structure.plate_stiffness(modulus, plate, radius, 4.0 * radius, 0.0, q)

    core, around = ((now - then) / per_length for now, then in zip(gives(fillet), gives(0.0), strict=True))
    assert -core == pytest.approx(row["bar_shorter"] * fillet, abs=0.11 * MM)
    assert around == pytest.approx(row["plate_longer"] * fillet, abs=0.025 * MM)


@each
def test_a_fillet_lowers_the_stress_at_the_foot_as_finite_elements_say(row):
    assert structure.filleted_foot(row["fillet"] * MM) == pytest.approx(row["foot"], abs=0.042)


# Makers of screws print the tables of VDI 2230 (Mastik, catalogue, page 685: fine threads, edition of 2001): most
# force of a screw of class 8.8 that uses 90 % of its yield strength, 640 MPa up to M16, and the torque for it.
TABLE = [
    # diameter, pitch [mm], friction, force [kN], torque [N*m], mean diameter of a hexagon head's face and its hole [mm]
    # (ISO 4014, ISO 273)
    (8.0, 1.0, 0.10, 20.7, 22.8, 10.3), (8.0, 1.0, 0.12, 20.2, 26.1, 10.3), (8.0, 1.0, 0.14, 19.7, 29.2, 10.3),
    (10.0, 1.25, 0.12, 31.6, 51.0, 12.8), (12.0, 1.25, 0.12, 48.0, 90.0, 15.05), (16.0, 1.5, 0.12, 87.6, 218.0, 20.0),
]  # fmt: skip


@pytest.mark.parametrize(("diameter", "pitch", "friction", "force", "torque", "head"), TABLE)
def test_the_force_that_uses_nine_tenths_of_the_yield(diameter, pitch, friction, force, torque, head):
    d, p, F = 1e-3 * diameter, 1e-3 * pitch, 1e3 * force
    twist = fasteners.twist_stress(fasteners.thread_torque(F, d, p, friction), d, p)
    # The tables take the section as yielding all over: its torque is 4/3 of the elastic one.
    tension = F / fasteners.stress_area(d, p)
    assert np.sqrt(tension**2 + 3.0 * (0.75 * twist) ** 2) == pytest.approx(0.9 * 640e6, rel=0.01)
    whole = fasteners.thread_torque(F, d, p, friction) + 0.5e-3 * head * friction * F
    assert whole == pytest.approx(torque, rel=0.02)
    assert fasteners.thread_friction(whole / (F * d), d, p, 1e-3 * head) == pytest.approx(friction, rel=1e-9)


@pytest.mark.parametrize(("diameter", "pitch", "area"), [(3.0, 0.5, 5.03), (4.0, 0.7, 8.78), (5.0, 0.8, 14.2)])
def test_stress_area_of_iso_898(diameter, pitch, area):
    assert fasteners.stress_area(1e-3 * diameter, 1e-3 * pitch) == pytest.approx(1e-6 * area, rel=3e-3)


def test_pegs_bear_what_the_textbook_says():
    # Area 314.16 mm^2, 100 MPa: 31.4 kN; on 15 mm of plate at 240 MPa: 72 kN.
    assert shear_force(100e6, 20e-3) == pytest.approx(31.416e3, rel=1e-4)
    assert bearing_force(240e6, 20e-3, 15e-3) == pytest.approx(72e3)
    # sigma/sqrt(3) pi d^2/4 = sigma d h at h = pi d/(4 sqrt(3)) = 0.45345 d.
    depth = 0.45345 * 3e-3
    assert bearing_force(16e6, 3e-3, depth) == pytest.approx(shear_force(16e6 / np.sqrt(3.0), 3e-3), rel=1e-4)


YOUNGS, SHEAR, WIDTH, THICKNESS, HEIGHT = 2.1e9, 0.76e9, 11e-3, 4e-3, 12e-3


@pytest.mark.parametrize(("height", "free"), [(4e-3, 0.0), (12e-3, 0.0), (40e-3, 0.0), (5e-3, 1e-3), (2e-3, 6e-3)])
def test_mean_deflection_is_that_of_a_beam_with_shear(height, free):
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
    stiffness = vane.stiffness(YOUNGS, SHEAR, WIDTH, THICKNESS, height, free)
    assert stiffness == pytest.approx(load * height / mean, rel=1e-5 if free == 0.0 else 1e-3)


@pytest.mark.parametrize("thickness", [0.5e-3, 1.5e-3, 6e-3])
def test_a_plate_let_into_a_sector_covers_what_points_count(thickness):
    inner, outer = 13e-3, 24e-3
    x, y = np.meshgrid((np.arange(3000) + 0.5) * outer / 3000, (np.arange(600) + 0.5) * thickness / 600, indexing="ij")
    r = np.hypot(x, y)
    counted = np.mean((r > inner) & (r < outer)) * outer * thickness
    assert radial_strip(thickness, inner, outer) == pytest.approx(counted, rel=1e-3)


def test_a_root_s_moment_turns_the_plate_as_a_beam():
    # Slope and no deflection at the middle of each vane, the ends of the beam joined: slope-deflection equations with
    # rigid ends e = x L, 4 E I/L (1 + 3 x + 3 x^2) and 2 E I/L (1 + 6 x + 6 x^2).
    count, radius, height, thickness = 6, 18.5e-3, 4e-3, 4e-3
    inertia, span = WIDTH * height**3 / 12.0, 2.0 * np.pi * radius / count - thickness
    x = 0.5 * thickness / span
    near, far = 1.0 + 3.0 * x + 3.0 * x**2, 1.0 + 6.0 * x + 6.0 * x**2
    beam = (
        2.0
        * YOUNGS
        * inertia
        / span
        * (4.0 * near * np.eye(count) + far * (np.roll(np.eye(count), 1, 0) + np.roll(np.eye(count), -1, 0)))
    )
    slope = np.linalg.solve(beam, np.ones(count))[0]
    footing = vane.Footing(height, 0.0, 0.0, 0.0, bend=2.0, strip=vane.strip_beside(radius, count, thickness))
    rooted = vane.on_footing((YOUNGS, SHEAR), (WIDTH, thickness), between(1e-9), footing)
    assert rooted.leaning == pytest.approx(slope * (0.4e-3 + 0.5 * HEIGHT) ** 2, rel=1e-9)
    assert rooted.aside == 0.0


def test_a_rim_beyond_the_vane_bends_with_its_strips():
    # As wide again as the vane, half the turn; pushed aside, the rim is no help.
    def on(rim: float) -> vane.Vane:
        footing = vane.Footing(4e-3, 0.0, 0.0, 1.0, bend=2.0, strip=8e-3, rim=rim)
        return vane.on_footing((YOUNGS, SHEAR), (WIDTH, THICKNESS), between(1e-9), footing)

    assert on(WIDTH).leaning == pytest.approx(0.5 * on(0.0).leaning, rel=1e-12)
    assert on(WIDTH).aside == on(0.0).aside


def test_a_vane_and_its_root_give_as_often_as_the_footing_says():
    def on(bent: float, sheared: float, give: float, root: float) -> vane.Vane:
        footing = vane.Footing(4e-3, bent, sheared, give, root)
        return vane.on_footing((YOUNGS, SHEAR), (WIDTH, THICKNESS), between(1e-9), footing)

    cantilever = on(1.0, 1.0, 0.0, 0.0)
    stiff = vane.stiffness(YOUNGS, SHEAR, WIDTH, THICKNESS, HEIGHT, 0.4e-3)
    assert cantilever.leaning + cantilever.aside == pytest.approx(1.0 / stiff, rel=1e-12)
    other = on(2.0, 3.0, 1.5, 0.5)
    arm = 0.4e-3 + 0.5 * HEIGHT
    turned = 0.5 * arm**2 / (YOUNGS * WIDTH * 4e-3**2)
    assert other.leaning == pytest.approx(2.0 * cantilever.leaning + turned, rel=1e-12)
    assert other.aside == pytest.approx(3.0 * cantilever.aside + 1.5 / (YOUNGS * WIDTH), rel=1e-12)


def between(modulus: float) -> vane.BlockBetween:
    return vane.BlockBetween((modulus, modulus), (4e-3, 1e-3, 0.5e-3), (WIDTH, HEIGHT), 0.4e-3, 0.1 * modulus)


def test_two_vanes_under_a_block_stand_as_beam_and_springs_do():
    # Angles of both vanes, way and slope of the block's end: Timoshenko's beam element, and the pad's two springs.
    first, other, block = vane.Vane(3e-7, 1e-8), vane.Vane(8e-7, 2e-8), between(140e6)
    arm, depth, beyond, bending = 0.4e-3 + 0.5 * HEIGHT, 4e-3, 1.5e-3, 3.0 * 140e6 * WIDTH * HEIGHT**3 / 12.0
    flat = 12.0 * bending / (5.0 / 6.0 * 140e6 * WIDTH * HEIGHT * depth**2)
    element = bending / depth**3 / (1.0 + flat) * np.array([
        [(4.0 + flat) * depth**2, -6.0 * depth, (2.0 - flat) * depth**2],
        [-6.0 * depth, 12.0, -6.0 * depth],
        [(2.0 - flat) * depth**2, -6.0 * depth, (4.0 + flat) * depth**2],
    ])  # fmt: skip
    slip, twist = np.array([0.0, beyond, 1.0, 0.0]), np.array([0.0, -1.0, 0.0, 1.0])
    across, turned = vane.SHEARED * 140e6 * WIDTH * HEIGHT / 1e-3, vane.TILTED * 14e6 * HEIGHT**2 / 12.0
    resists = across * np.outer(slip, slip) + turned * np.outer(twist, twist)
    resists[np.ix_([0, 2, 3], [0, 2, 3])] += element
    vanes = np.diag([arm**2 / first.leaning, arm**2 / other.leaning, 0.0, 0.0])
    stands = np.linalg.solve(resists + vanes, [arm, arm, 0.0, 0.0])
    shares = vane.compliances(first, other, block)
    assert shares.vane == pytest.approx(arm**2 / first.leaning * stands[0] ** 2 + first.aside, rel=1e-9)
    assert shares.other == pytest.approx(arm**2 / other.leaning * stands[1] ** 2 + other.aside, rel=1e-9)
    assert shares.block == pytest.approx(stands @ resists @ stands, rel=1e-9)
    assert sum(shares) == pytest.approx(arm * (stands[0] + stands[1]) + first.aside + other.aside, rel=1e-9)


def test_soft_blocks_leave_vanes_alone_and_stiff_ones_hold_them():
    first, other = vane.Vane(3e-7, 1e-8), vane.Vane(8e-7, 2e-8)
    free = vane.compliances(first, other, between(1e-3))
    assert free.vane == pytest.approx(first.leaning + first.aside, rel=1e-9)
    assert free.other == pytest.approx(other.leaning + other.aside, rel=1e-9)
    assert free.block < 1e-9 * free.vane
    held = vane.compliances(first, other, between(1e15))
    assert held == pytest.approx((first.aside, other.aside, 0.0), abs=1e-12)


def test_a_pull_along_the_axis_leans_both_vanes():
    # By hand: angles of both vanes on springs a^2/A and a cantilever of 3 E I/d^3, the way of its end found by energy.
    first, other, block = vane.Vane(3e-7, 1e-8), vane.Vane(8e-7, 2e-8), between(140e6)
    arm, thick = 0.4e-3 + 0.5 * HEIGHT, (3e-3, 8e-3)
    levers = np.array([4e-3 + 1.5e-3, 1.5e-3 + 4e-3, 1.0])
    cantilever = 3.0 * 3.0 * 140e6 * WIDTH * HEIGHT**3 / 12.0 / 4e-3**3
    springs = np.diag([arm**2 / first.leaning, arm**2 / other.leaning, cantilever])
    way = levers @ np.linalg.solve(springs, levers)
    assert vane.along_axis(first, other, block, thick) == pytest.approx(way, rel=1e-9)
