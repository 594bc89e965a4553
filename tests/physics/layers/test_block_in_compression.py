"""A squeezed block: stiffness against finite elements, rubber and plain compression; what one mode forgets."""

from typing import Any

import bonded_block
import casadi as ca
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tvimdesign.physics.layers import block

Modes = list[tuple[float, float]]
MELT = [(2.07e-2, 82.0), (6.5e-3, 104.0), (2.07e-3, 131.0), (6.5e-4, 165.0), (2.07e-4, 207.0), (6.5e-5, 261.0)]
SOLID = [(1e10, 2.1e5), (10.0, 1.8e4), (1.0, 1.7e4), (0.1, 1.9e4), (0.01, 1.9e4), (0.001, 2.6e4)]
HALF = [(300.0, 5.6e3), (0.4, 1.8e3), (0.05, 2.0e3), (8e-3, 2.4e3), (1.5e-3, 2.7e3), (2e-4, 3.5e3)]
NAMED = pytest.mark.parametrize("modes", [MELT, HALF, SOLID], ids=["melt", "half frozen", "solid"])
SPECTRA = st.lists(
    st.tuples(st.floats(-5.0, 10.0), st.floats(-2.0, 6.0)),
    min_size=1,
    max_size=6,
    unique_by=lambda pair: round(pair[0], 1),
).map(lambda pairs: [(10.0**time, 10.0**stiffness) for time, stiffness in pairs])


def apparent_modulus(shear: Any, bulk: Any, shape: Any) -> Any:
    """What the rows have of a block: its shear modes, and in series with them its change of volume."""
    return 1.0 / (1.0 / (3.0 * shear * block.shape_stiffening(shape)) + 1.0 / block.volumetric_modulus(bulk, shape))


def test_shape_factor_is_one_loaded_face_over_the_free_sides() -> None:
    # 200 mm^2 of a 20 mm x 10 mm face over 6 mm x 60 mm of sides.
    assert block.shape_factor(20e-3, 10e-3, 6e-3) == pytest.approx(200.0 / 360.0)
    assert block.shape_factor(1.0, 1.0, 1.0) == pytest.approx(0.25)


@pytest.mark.parametrize("poissons_ratio", [0.42, 0.45, 0.48])
def test_slender_block_has_youngs_modulus(poissons_ratio: float) -> None:
    shear = 1.0 / (2.0 * (1.0 + poissons_ratio))
    bulk = block.bulk_modulus(1.0, poissons_ratio)
    assert apparent_modulus(shear, bulk, 0.0) == pytest.approx(1.0, rel=1e-12)


@pytest.mark.parametrize("shape", [3.0, 10.0, 40.0])
def test_flat_block_of_rubber_has_gent_and_lindleys_modulus(shape: float) -> None:
    # Natural rubber: E = 1.5 MPa, bulk modulus 1.2 GPa; 1/E_app = 1/(E (1 + 2 S^2)) + 1/K.
    youngs, bulk = 1.5e6, 1.2e9
    expected = 1.0 / (1.0 / (youngs * (1.0 + 2.0 * shape**2)) + 1.0 / bulk)
    assert apparent_modulus(youngs / 3.0, bulk, shape) == pytest.approx(expected, rel=5e-3)


def test_finite_elements_give_plain_compression_without_poissons_ratio() -> None:
    assert bonded_block.apparent_modulus(20.0, 10.0, 6.0, 0.0, (4, 3, 3)) == pytest.approx(1.0, rel=1e-9)


@pytest.mark.parametrize("poissons_ratio", [0.45, 0.4995])
@pytest.mark.parametrize("sides", [(10, 10, 20), (20, 10, 6), (20, 20, 5), (40, 10, 4), (20, 10, 2)])
def test_block_is_within_thirteen_percent_below_finite_elements(
    sides: tuple[float, ...], poissons_ratio: float
) -> None:
    width, height, depth = sides
    elements = bonded_block.apparent_modulus(width, height, depth, poissons_ratio, (10, 10, 7))
    found = apparent_modulus(
        1.0 / (2.0 * (1.0 + poissons_ratio)),
        block.bulk_modulus(1.0, poissons_ratio),
        block.shape_factor(width, height, depth),
    )
    assert 0.87 < found / elements < 1.01


def test_stiffness_is_force_times_arm_over_angle() -> None:
    # Four blocks of 200 mm^2, 6 mm deep, at 30 mm: 0.01 rad moves a face 0.3 mm, 5 % of the depth.
    angle, modulus = 0.01, 2e6
    assert block.strain(30e-3, angle, 6e-3) == pytest.approx(0.05)
    torque = 4 * (modulus * 0.05 * 200e-6) * 30e-3
    assert block.stiffness(modulus, 4, 200e-6, 30e-3, 6e-3) * angle == pytest.approx(torque)
    assert block.stress(torque, 4, 200e-6, 30e-3) == pytest.approx(modulus * 0.05)
    assert block.torque_at_stress(modulus * 0.05, 4, 200e-6, 30e-3) == pytest.approx(torque)


def test_one_mode_forgets_with_its_exponential() -> None:
    assert block.relaxation_loss(3.0, [(2.0, 70.0)]) == pytest.approx(1.0 - np.exp(-1.5))


@given(SPECTRA, st.floats(-4.0, 6.0), st.floats(0.05, 3.0))
def test_longer_hold_never_loses_less(modes: Modes, hold: float, more: float) -> None:
    shorter, longer = 10.0**hold, 10.0 ** (hold + more)
    assert 0.0 <= block.relaxation_loss(shorter, modes) <= block.relaxation_loss(longer, modes) + 1e-12 <= 1.0 + 1e-11


@NAMED
def test_symbols_give_what_floats_give(modes: Modes) -> None:
    names = [ca.SX.sym(name) for name in ("time", "width", "depth", "shear")]

    def rows(time: Any, width: Any, depth: Any, shear: Any) -> list[Any]:
        shape = block.shape_factor(width, 10e-3, depth)
        return [
            block.relaxation_loss(time, modes),
            block.stiffness(apparent_modulus(shear, block.bulk_modulus(411e6, 0.45), shape), 4, 2e-4, 0.03, depth),
        ]

    numbers = (0.02, 20e-3, 6e-3, 1.2e8)
    symbolic = ca.vertcat(*rows(*names))
    found = np.asarray(ca.Function("found", names, [symbolic])(*numbers)).ravel()
    assert found == pytest.approx([float(row) for row in rows(*numbers)], rel=1e-12)
