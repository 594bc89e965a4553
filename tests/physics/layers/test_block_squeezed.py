"""The squeezed block at the ends of its shapes, and against what is known of cubes and of torques."""

import numpy as np
import pytest

from tvimdesign.physics.layers import block


def test_a_cube_has_the_shape_factor_of_one_face_over_four() -> None:
    assert block.shape_factor(0.01, 0.01, 0.01) == pytest.approx(0.25, rel=1e-12)
    assert block.shape_stiffening(0.25) == pytest.approx(1.125, rel=1e-12)


def test_a_slender_block_has_young_s_modulus_and_a_flat_one_its_bulk_modulus() -> None:
    youngs, poisson = 400e6, 0.45
    shear, bulk = youngs / (2.0 * (1.0 + poisson)), block.bulk_modulus(youngs, poisson)

    def apparent(shape: float) -> float:
        shearing = 3.0 * shear * block.shape_stiffening(shape)
        return 1.0 / (1.0 / shearing + 1.0 / block.volumetric_modulus(bulk, shape))

    assert bulk == pytest.approx(1333.3e6, rel=1e-4)
    assert apparent(0.0) == pytest.approx(youngs, rel=1e-12)
    assert apparent(100.0) == pytest.approx(bulk, rel=1e-3)


def test_stiffness_is_force_times_arm_over_angle() -> None:
    # 2 blocks of 1 cm2 and 400 MPa at 20 mm, 5 mm deep: 1 mrad is 20 um or 0.4 %, 160 N on each, 6.4 N*m together.
    assert block.stiffness(400e6, 2, 1e-4, 20e-3, 5e-3) * 1e-3 == pytest.approx(6.4, rel=1e-12)
    assert block.strain(20e-3, 1e-3, 5e-3) == pytest.approx(4e-3, rel=1e-12)
    assert block.torque_at_stress(1.6e6, 2, 1e-4, 20e-3) == pytest.approx(6.4, rel=1e-12)


def test_a_block_squeezed_to_half_its_angle_needs_twice_its_plan_width_in_square_of_radius() -> None:
    # From 6 to 8 mm: 64 - 36 = 28 mm2 of squared radius become 56, and 36 + 56 = 92.
    assert block.squeezed_outer_radius(6e-3, 8e-3, 0.2, 0.1) == pytest.approx(np.sqrt(92e-6), rel=1e-12)
    assert block.squeezed_outer_radius(6e-3, 8e-3, 0.2, 0.0) == pytest.approx(8e-3, rel=1e-12)
