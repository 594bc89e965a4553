"""Places where the stress at a core's foot is read."""

import foot_surface
import numpy as np
import pytest


def test_stress_is_read_beside_feet_and_along_fillets_at_each_angle() -> None:
    radius, height = foot_surface.places(10.0, 0.0)
    assert radius == pytest.approx(9.98)
    assert (height[0], height[-1]) == pytest.approx((0.025, 0.975))
    along = np.zeros((40, 2))
    along[5:25, 0], along[10:20, 1] = 3.0, 4.0
    assert foot_surface.highest_mean(along) == pytest.approx([3.0, 2.0])


@pytest.mark.parametrize("fillet", [0.1, 0.9, 1.5])
def test_along_a_fillet_it_stays_just_below_the_surface(fillet: float) -> None:
    radius, height = foot_surface.places(10.0, fillet)
    on_fillet = height < fillet
    centre = np.hypot(radius - 10.0 - fillet, height - fillet)
    assert centre[on_fillet] == pytest.approx(fillet + 0.02)
    assert radius[~on_fillet] == pytest.approx(9.98)
    assert height[0] > 0.2 * fillet  # from the middle on, (1 - cos 45 degrees) q
    assert len(radius) == round(20 * (1.0 + fillet))
