"""Stiff and frozen joints: a stiffness at a frequency need not be frozen, and the advice tells the two apart."""

import numpy as np
import pytest

from tvimdesign.base.errors import InputError
from tvimdesign.solve.result import StudyResult, answer
from tvimdesign.study import read_study_text

# Half a millimetre with a strong sink: at 30 degC and 1 Hz the supercooled melt alone is within twice a soft target.
QUICK = "cold_side: sink, pcl_thickness: 0.6 mm, cooling_current: 1.5 A, stiffening_band: 4"


def answered(module: str, points: str = "") -> StudyResult:
    study = read_study_text(f"mode: shear\nmodule: {{{module}}}\n{points}", "a test")
    return answer(study)


def warned(found: StudyResult) -> set[str]:
    return {check.output for check in found.warnings}


def test_a_melt_that_never_freezes_can_count_as_stiff_and_the_run_says_so() -> None:
    found = answered(f"{QUICK}, pcl_crystallization_half_time: 100000 s")
    assert np.isfinite(found.design.value("stiffening_time"))
    assert np.isinf(found.design.value("frozen_time"))
    assert "stiffening_over_freezing" in warned(found)


def test_a_joint_that_waits_until_it_is_frozen_gets_no_such_advice() -> None:
    found = answered("stiffening_band: 1.02")
    assert found.design.value("stiffening_time") > found.design.value("frozen_time")
    assert "stiffening_over_freezing" not in warned(found)


def test_the_last_slice_of_a_layer_is_half_frozen_at_the_frozen_time() -> None:
    # On the melting curve, from 65 to 50 degC, the middle of the window is half frozen. The least frozen slice, taken
    # smoothly, may be 0.03 short of that.
    found = answered("phase_model: equilibrium, stiffening_band: 1.01")
    stiffening = found.histories["stiffening"]
    warmest = np.max([stiffening[name] for name in stiffening if name.startswith("cell_")], axis=0)
    then = np.interp(found.design.value("frozen_time"), stiffening["time"], warmest)
    assert 57.5 <= then <= 57.5 + 0.03 * 15.0


def test_a_cold_point_hotter_than_the_hot_one_makes_the_thresholds_overlap() -> None:
    points = "operating_points: {cold: {temperature: 110 degC}, hot: {temperature: 100 degC}}\n"
    assert "thresholds_apart" in warned(answered("current: 1.5 A", points))
    assert "thresholds_apart" not in warned(answered("current: 1.5 A"))


def test_the_way_back_ends_by_the_criterion_that_was_chosen() -> None:
    frozen = answered("stiffening_criterion: frozen").design
    assert frozen.value("return_time") == pytest.approx(frozen.value("frozen_time"), rel=1e-6)
    stiff = answered("current: 1.5 A").design
    assert stiff.value("return_time") == pytest.approx(stiff.value("stiffening_time"), rel=1e-6)
    assert stiff.value("return_time") < 0.95 * frozen.value("return_time")
    # What is waited for longer costs more.
    assert stiff.value("stiffening_energy") < frozen.value("stiffening_energy")
    assert frozen.value("cycle_time") == pytest.approx(frozen.value("response_time") + frozen.value("return_time"))


@pytest.mark.parametrize("setting", ["sink_area: 100 cm^2", "soft_impedance: 5 N.m/rad"])
def test_what_a_study_sets_to_no_effect_is_refused(setting: str) -> None:
    with pytest.raises(InputError, match=r"no effect, as (cold_side is open|impedance_targets is operating_points)"):
        answered(setting)
