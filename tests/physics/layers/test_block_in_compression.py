"""A squeezed block: stiffness against finite elements, rubber and plain compression; what one mode forgets."""

import csv
from typing import Any

import bonded_block
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from support import ROOT

from tvimdesign.physics.layers import block, layer

Modes = list[tuple[float, float]]
SPECTRA = st.lists(
    st.tuples(st.floats(-5.0, 10.0), st.floats(-2.0, 6.0)),
    min_size=1,
    max_size=6,
    unique_by=lambda pair: round(pair[0], 1),
).map(lambda pairs: [(10.0**time, 10.0**stiffness) for time, stiffness in pairs])


def apparent_modulus(shear: Any, bulk: Any, shape: Any) -> Any:
    """Return what the rows have of a block: its shear modes, and in series with them its change of volume."""
    return 1.0 / (1.0 / (3.0 * shear * block.shape_stiffening(shape)) + 1.0 / block.volumetric_modulus(bulk, shape))


def test_shape_factor_is_one_loaded_face_over_the_free_sides():
    # 200 mm^2 of a 20 mm x 10 mm face over 6 mm x 60 mm of sides.
    assert block.shape_factor(20e-3, 10e-3, 6e-3) == pytest.approx(200.0 / 360.0)
    assert block.shape_factor(1.0, 1.0, 1.0) == pytest.approx(0.25)
    assert block.shape_factor(0.01, 0.01, 0.01) == pytest.approx(0.25, rel=1e-12)
    assert block.shape_stiffening(0.25) == pytest.approx(1.125, rel=1e-12)


@pytest.mark.parametrize("poissons_ratio", [0.42, 0.45, 0.48])
def test_slender_block_has_youngs_modulus(poissons_ratio):
    shear = 1.0 / (2.0 * (1.0 + poissons_ratio))
    bulk = block.bulk_modulus(1.0, poissons_ratio)
    assert apparent_modulus(shear, bulk, 0.0) == pytest.approx(1.0, rel=1e-12)


@pytest.mark.parametrize("shape", [3.0, 10.0, 40.0])
def test_flat_block_of_rubber_has_gent_and_lindleys_modulus(shape):
    # Natural rubber: E = 1.5 MPa, bulk modulus 1.2 GPa; 1/E_app = 1/(E (1 + 2 S^2)) + 1/K.
    youngs, bulk = 1.5e6, 1.2e9
    expected = 1.0 / (1.0 / (youngs * (1.0 + 2.0 * shape**2)) + 1.0 / bulk)
    assert apparent_modulus(youngs / 3.0, bulk, shape) == pytest.approx(expected, rel=5e-3)


def test_finite_elements_give_plain_compression_without_poissons_ratio():
    assert bonded_block.apparent_modulus(20.0, 10.0, 6.0, 0.0, (4, 3, 3)) == pytest.approx(1.0, rel=1e-9)


@pytest.mark.parametrize("poissons_ratio", [0.45, 0.4995])
@pytest.mark.parametrize("sides", [(10, 10, 20), (20, 10, 6), (20, 20, 5), (40, 10, 4), (20, 10, 2)])
def test_block_is_within_thirteen_percent_below_finite_elements(sides, poissons_ratio):
    width, height, depth = sides
    elements = bonded_block.apparent_modulus(width, height, depth, poissons_ratio, (10, 10, 7))
    modulus = apparent_modulus(
        1.0 / (2.0 * (1.0 + poissons_ratio)),
        block.bulk_modulus(1.0, poissons_ratio),
        block.shape_factor(width, height, depth),
    )
    assert 0.87 < modulus / elements < 1.01


def test_stiffness_is_force_times_arm_over_angle():
    # Four blocks of 200 mm^2, 6 mm deep, at 30 mm: 0.01 rad moves a face 0.3 mm, 5 % of the depth.
    angle, modulus = 0.01, 2e6
    assert block.strain(30e-3, angle, 6e-3) == pytest.approx(0.05)
    torque = 4 * (modulus * 0.05 * 200e-6) * 30e-3
    assert block.stiffness(modulus, 4, 200e-6, 30e-3, 6e-3) * angle == pytest.approx(torque)
    assert block.stress(torque, 4, 200e-6, 30e-3) == pytest.approx(modulus * 0.05)
    assert block.torque_at_stress(modulus * 0.05, 4, 200e-6, 30e-3) == pytest.approx(torque)
    # 2 blocks of 1 cm2 and 400 MPa at 20 mm, 5 mm deep: 1 mrad is 20 um or 0.4 %, 160 N on each, 6.4 N*m together.
    assert block.stiffness(400e6, 2, 1e-4, 20e-3, 5e-3) * 1e-3 == pytest.approx(6.4, rel=1e-12)
    assert block.strain(20e-3, 1e-3, 5e-3) == pytest.approx(4e-3, rel=1e-12)
    assert block.torque_at_stress(1.6e6, 2, 1e-4, 20e-3) == pytest.approx(6.4, rel=1e-12)


def test_one_mode_forgets_with_its_exponential():
    assert block.relaxation_loss(3.0, [(2.0, 70.0)]) == pytest.approx(1.0 - np.exp(-1.5))


@given(SPECTRA, st.floats(-4.0, 6.0), st.floats(0.05, 3.0))
def test_longer_hold_never_loses_less(modes, hold, more):
    shorter, longer = 10.0**hold, 10.0 ** (hold + more)
    assert 0.0 <= block.relaxation_loss(shorter, modes) <= block.relaxation_loss(longer, modes) + 1e-12 <= 1.0 + 1e-11


def test_a_block_squeezed_to_half_needs_twice_its_plan():
    # From 6 to 8 mm: 64 - 36 = 28 mm2 of squared radius become 56, and 36 + 56 = 92.
    assert block.squeezed_outer_radius(6e-3, 8e-3, 0.2, 0.1) == pytest.approx(np.sqrt(92e-6), rel=1e-12)
    assert block.squeezed_outer_radius(6e-3, 8e-3, 0.2, 0.0) == pytest.approx(8e-3, rel=1e-12)


@pytest.mark.parametrize("molten", [1, 3, 9])
def test_a_molten_film_is_as_stiff_as_a_block_of_its_depth(molten):
    storage, loss = np.full(12, 1e12), np.zeros(12)
    storage[:molten], loss[:molten] = 2e4, 3e4
    width, height, depth = 11e-3, 12e-3, 4e-3
    series = complex(*layer.series_modulus(storage, loss))
    share = block.soft_share(storage, loss)
    assert share == pytest.approx(molten / 12.0, rel=1e-6)
    shape = block.shape_factor(width, height, depth) / share
    stiffness = block.stiffness(3.0 * series * block.shape_stiffening(shape), 6, width * height, 18.5e-3, depth)
    # By hand: 3 G (1 + 2 S^2) A r^2 over the film's own thickness, S = w h/(2 t (w + h)).
    thick = depth * molten / 12.0
    own = width * height / (2.0 * thick * (width + height))
    alone = 6 * 3.0 * complex(2e4, 3e4) * (1.0 + 2.0 * own**2) * width * height * 18.5e-3**2 / thick
    assert stiffness == pytest.approx(alone, rel=1e-5)


def test_the_soft_share_hangs_on_moduli_not_on_their_order():
    storage = np.geomspace(1e4, 1e8, 12)
    assert block.soft_share(storage, 0.1 * storage) == pytest.approx(
        block.soft_share(storage[::-1], 0.1 * storage[::-1])
    )
    # |G| is 5 in every slice: 3-4-5 either way round, and 0-5.
    storage, loss = np.array([3.0, 4.0, 0.0, 5.0]), np.array([4.0, 3.0, 5.0, 0.0])
    assert block.soft_share(storage, loss) == pytest.approx(1.0, rel=1e-12)


RIGID = 1e15
with (ROOT / "validation/fe_structure/pads.csv").open(newline="") as file:
    PADS = [{name: float(cell) for name, cell in row.items()} for row in csv.DictReader(file)]


@pytest.mark.parametrize(("width", "height"), [(20.0, 20.0), (20.0, 40.0)])
def test_a_thin_pad_is_as_stiff_as_the_pressure_in_it_makes_it(width, height):
    # Of incompressible rubber pressed by e, bonded on both faces: grad^2 p = -12 G e/t^3 with p 0 at the edges, like
    # Prandtl's membrane, so F = 3 G e J/t^3 with Saint-Venant's series for the torsion constant J of a rectangle.
    a, b = height, width
    odd = np.arange(1, 60, 2)
    torsion = a * b**3 / 3.0 * (1.0 - 192.0 * b / (np.pi**5 * a) * np.sum(np.tanh(odd * np.pi * a / (2 * b)) / odd**5))
    thin = 0.1
    stiffness = block.pad_stiffness((1.0, RIGID), (width, height), thin, (0.0, 0.0))
    # Gent and Lindley's shape factor is a few percent to 12 % below the series for rectangles.
    assert 0.87 < stiffness / (3.0 * torsion / thin**3) < 1.01


def test_a_tall_pad_is_a_bar_and_a_slot_of_no_width_costs_nothing():
    youngs = 9.0 * 5.0 * 1.0 / (3.0 * 5.0 + 1.0)
    stiffness = block.pad_stiffness((1.0, 5.0), (1.0, 2.0), 100.0, (0.0, 0.0))
    assert stiffness == pytest.approx(youngs * 2.0 / 100.0, rel=1e-3)
    widths = np.linspace(0.0, 4.0, 400)
    stiffness = np.array([block.pad_stiffness((1.0, 1e3), (8.0, 10.0), 1.6, (w, 8.0)) for w in widths])
    assert stiffness[0] == pytest.approx(block.pad_stiffness((1.0, 1e3), (8.0, 10.0), 1.6, (0.0, 0.0)), rel=1e-12)
    assert np.all(np.diff(stiffness) <= 1e-9)


@pytest.mark.parametrize(
    "pad", PADS, ids=lambda pad: f"{pad['width']:g} x {pad['height']:g}, slot {pad['slot_width']:g}"
)
def test_a_pad_over_a_slot_gives_as_in_fe(pad):
    sides, slot = (pad["width"], pad["height"]), (pad["slot_width"], pad["slot_height"])
    moduli = 1.0, 2.0 * (1.0 + pad["poissons_ratio"]) / (3.0 * (1.0 - 2.0 * pad["poissons_ratio"]))
    stiffness = block.pad_stiffness(moduli, sides, pad["thickness"], slot)
    plain = 3.0 * sides[0] * sides[1] / pad["thickness"]
    assert stiffness / plain == pytest.approx(pad["over_three_g"], rel=0.13 if slot[0] == 0.0 else 0.09)
