"""The gap that freezing blocks leave beside their vanes."""

from __future__ import annotations

import pytest

from tvimdesign.device import table_for
from tvimdesign.study import given, read_study_text

TABLE = table_for("compression")


def test_a_block_shrinks_from_its_vane_by_a_third_of_its_volume_share() -> None:
    study = read_study_text("mode: compression\nmodule:\n  block_depth: 7 mm\n  axial_preload: wave_21x25\n", "a test")
    rows = ["freezing_gap", "freezing_backlash", "freezing_travel", "stop_play", "axial_play"]
    found = TABLE.evaluate(given(study), rows)
    assert found["freezing_gap"] == pytest.approx(7e-3 * (1.0 - (1070.0 / 1145.0) ** (1.0 / 3.0)), rel=1e-9)
    assert found["freezing_gap"] == pytest.approx(0.156e-3, rel=0.01)
    # A gap on either side of a vane, at 33 mm: 9.5 mrad, a tenth of the stroke.
    assert found["freezing_backlash"] == pytest.approx(2.0 * 0.156e-3 / 33e-3, rel=0.01)
    # Blocks have room above and below: the rotor stands still and its stop touches.
    assert found["freezing_travel"] == found["stop_play"] == found["axial_play"] == 0.0


def test_nothing_holds_a_molten_block_at_its_sides() -> None:
    study = read_study_text("mode: compression\nmodule:\n  block_depth: 4 mm\n", "a test")
    found = TABLE.evaluate(given(study), ["melt_creep", "pcl_viscosity@hot"])
    # Between two vanes 4 mm apart, upright: h^2 rho g/(12 eta), by hand. A thin layer creeps a twentieth of that.
    speed = 4e-3**2 * 1070.0 * 9.80665 / (12.0 * found["pcl_viscosity@hot"])
    assert found["melt_creep"] == pytest.approx(3600.0 * speed, rel=1e-6)
    assert found["melt_creep"] > 10e-3
