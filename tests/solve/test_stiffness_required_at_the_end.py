"""Stiffness at the end of the switch and of the way back: simulated, required, frozen or left open."""

from functools import cache

import numpy as np
import pytest
from stiff_when_warm import STIFF_WHEN_WARM
from support import cases_of, sample_text

from tvimdesign.base.errors import InputError
from tvimdesign.catalog import Catalog
from tvimdesign.device.core.impedance.joint_impedance import melt_modes
from tvimdesign.solve.nlp.constraints import constraints_of, refuse_impossible
from tvimdesign.solve.result import StudyResult, answer
from tvimdesign.study import read_study_text

ENDS = ("softened_stiffness", "softened_damping", "softened_impedance", "softened_temperature")
STUDY = sample_text("stiffness_at_the_end")


@cache
def _answer(more: str = "", criterion: str = "mean") -> StudyResult:
    study = read_study_text(STUDY.format(criterion=criterion, more=more), "test")
    return answer(study)


@pytest.mark.gate
def test_a_joint_that_ends_the_switch_as_soft_ends_it_at_the_threshold():
    # The threshold is arithmetic of the hot point; the impedance at the end is read off the simulated layer.
    values = _answer(criterion="softening").design.values
    assert values["softened_impedance"] == pytest.approx(values["soft_threshold"], rel=1e-4)
    assert values["spring_stiffness"] < values["softened_stiffness"] < values["softened_impedance"]


@pytest.mark.gate
@pytest.mark.parametrize("name", ENDS)
def test_it_is_the_last_of_the_simulated_history(name):
    result = _answer()
    column, zero = {"softened_temperature": ("far_face", 273.15)}.get(name, (f"joint_{name.partition('_')[2]}", 0.0))
    last = result.histories["softening"][column][-1] + zero
    assert result.design.values[name] == pytest.approx(last, rel=1e-6)


@pytest.mark.slow
def test_simulation_confirms_the_stiffness_required_at_the_end():
    free = _answer().design.values["softened_stiffness"]
    limit = free - 0.25 * (free - 4.0)
    held = _answer(f', softened_stiffness: "<= {limit:.6f} N.m/rad"')
    check = next(check for check in held.checks if check.output == "softened_stiffness")
    assert held.design.status == "optimal"
    assert check.origin == "require"
    # The values of a design are simulated; that the limit is active there says that the equations agree with it.
    assert held.design.values["softened_stiffness"] == pytest.approx(limit, rel=2e-3)
    assert held.design.values["softened_stiffness"] < 0.99 * free
    active = [limit.output for limit in held.solution.held if abs(limit.residual) < 1e-4] if held.solution else []
    assert "softened_stiffness" in active


@pytest.mark.parametrize(
    ("criterion", "reached"), [("far_face", True), pytest.param("softening", False, marks=pytest.mark.gate)]
)
def test_a_hot_point_that_the_layer_never_reaches_is_warned_of(criterion, reached):
    # The thermometer at the far face waits for 100 degC, which is the hot point; the impedance does not.
    result = _answer(criterion=criterion)
    warned = [check for check in result.warnings if check.output == "hot_point_margin"]
    assert bool(warned) is not reached
    assert all("never" in check.origin and "softened_stiffness" in check.origin for check in warned)


HOT = 'require: {joint_stiffness@hot: [">= 2 N.m/rad", "<= 3 N.m/rad"]'


@cases_of("stiffness_required_at_the_end", "unreached")
def test_a_limit_at_an_unreached_hot_point_is_also_put_on_the_end(module, more, outputs):
    study = read_study_text(f"mode: shear\nmodule: {{{module}}}\n{HOT}{more}}}\n", "test")
    limits = [limit for limit in constraints_of(study, study.table, study.module) if limit.origin == "require"]
    assert [limit.output for limit in limits] == outputs
    ends = {limit.sense: limit.limit for limit in limits if limit.output == "softened_stiffness"}
    assert ends == ({} if "softened_stiffness" not in outputs else {">=": 2.0, "<=": 4.0 if more else 3.0})


def test_a_limit_that_means_nothing_where_heating_ends_is_refused():
    text = 'mode: shear\nmodule: {{{}}}\nrequire: {{natural_frequency@hot: ">= 1 Hz"}}\n'
    with pytest.raises(InputError, match=r"natural_frequency@hot: heating may end before .*, or limit joint_impedance"):
        refuse_impossible(read_study_text(text.format("response_criterion: softening"), "test"))
    refuse_impossible(read_study_text(text.format(""), "test"))


# Half a millimetre with a strong sink: at 30 degC and 1 Hz the supercooled melt alone is within twice a soft target.
QUICK = "cold_side: sink, pcl_thickness: 0.6 mm, cooling_current: 1.5 A, stiffening_band: 4"


def answered(module: str, points: str = "") -> StudyResult:
    study = read_study_text(f"mode: shear\nmodule: {{{module}}}\n{points}", "a test")
    return answer(study)


def warned(result: StudyResult) -> set[str]:
    return {check.output for check in result.warnings}


def test_a_cold_point_hotter_than_the_hot_one_and_melts_are_warned_of():
    result = answered(f"{QUICK}, pcl_crystallization_half_time: 100000 s")
    assert np.isfinite(result.design.value("stiffening_time"))
    assert np.isinf(result.design.value("frozen_time"))
    assert "stiffening_over_freezing" in warned(result)
    result = answered("stiffening_band: 1.02")
    assert result.design.value("stiffening_time") > result.design.value("frozen_time")
    assert "stiffening_over_freezing" not in warned(result)
    points = "operating_points: {cold: {temperature: 110 degC}, hot: {temperature: 100 degC}}\n"
    assert "thresholds_apart" in warned(answered("current: 1.5 A", points))
    assert "thresholds_apart" not in warned(answered("current: 1.5 A"))


def test_the_last_slice_of_a_layer_is_half_frozen_at_the_frozen_time():
    # On the melting curve, from 65 to 50 degC, the middle of the window is half frozen. The least frozen slice, taken
    # smoothly, may be 0.03 short of that.
    result = answered("phase_model: equilibrium, stiffening_band: 1.01")
    stiffening = result.histories["stiffening"]
    warmest = np.max([stiffening[name] for name in stiffening if name.startswith("cell_")], axis=0)
    then = np.interp(result.design.value("frozen_time"), stiffening["time"], warmest)
    assert 57.5 <= then <= 57.5 + 0.03 * 15.0


@pytest.mark.gate
def test_the_way_back_ends_by_the_criterion_that_was_chosen():
    frozen = answered("stiffening_criterion: frozen").design
    assert frozen.value("return_time") == pytest.approx(frozen.value("frozen_time"), rel=1e-6)
    stiff = answered("current: 1.5 A").design
    assert stiff.value("return_time") == pytest.approx(stiff.value("stiffening_time"), rel=1e-6)
    assert stiff.value("return_time") < 0.95 * frozen.value("return_time")
    # What is waited for longer costs more.
    assert stiff.value("stiffening_energy") < frozen.value("stiffening_energy")
    assert frozen.value("cycle_time") == pytest.approx(frozen.value("response_time") + frozen.value("return_time"))


KELVIN = 273.15
POINTS = "operating_points: {{cold: {{temperature: {cold} degC}}, hot: {{temperature: {hot} degC}}}}\n"


UNITS = ("1/K", "", "")
STIFF = ", ".join(f"{name}: {value} {unit}" for (name, value), unit in zip(STIFF_WHEN_WARM.items(), UNITS, strict=True))


def answered_between(module: str, cold: float = 30.0, hot: float = 100.0) -> StudyResult:
    text = f"mode: shear\nmodule: {{{module}, {STIFF}}}\n" + POINTS.format(cold=cold, hot=hot)
    return answer(read_study_text(text, "a test"))


def liquid_impedance(result: StudyResult, celsius: float) -> complex:
    """K* of the joint with a layer that is all melt, at 1 Hz, from the record's spectrum in complex numbers."""
    value = result.design.value
    modes = melt_modes(Catalog().record("polymers", result.design.choices["pcl_grade"]))
    kelvin, reference = celsius + KELVIN, value("pcl_melt_reference")
    shift = np.exp(value("pcl_flow_activation_energy") / 8.314462618 * (1.0 / kelvin - 1.0 / reference))
    omega = 2j * np.pi
    modulus = sum(plateau * omega * shift * time / (1.0 + omega * shift * time) for time, plateau in modes)
    layer = modulus * value("layer_polar_moment") / value("pcl_thickness")
    loss_factor = value("structure_loss_factor") + value("clamped_loss_factor")
    structure = value("structure_stiffness") * complex(1.0, loss_factor)
    return complex(value("spring_stiffness") + 1.0 / (1.0 / layer + 1.0 / structure))


@pytest.mark.slow
def test_softening_to_a_point_in_the_melting_range_takes_an_interval():
    result = answered_between("current: 1.5 A", hot=60.0)
    low, high = result.intervals["softening_time"]
    target = abs(liquid_impedance(result, 60.0))
    stated = answered_between(f"current: 1.5 A, impedance_targets: stated, soft_impedance: {target:.9f} N.m/rad")
    assert high == pytest.approx(stated.design.value("softening_time"), rel=1e-3)
    assert low < 0.5 * high
    assert "softening_time" not in stated.intervals


@pytest.mark.gate
def test_stiffening_to_a_point_in_the_melting_range_takes_an_interval():
    result = answered_between("current: 1.5 A", cold=60.0)
    low, high = result.intervals["stiffening_time"]
    assert 0.0 < low < result.design.value("stiffening_time") < high
    assert result.intervals["cycle_time"] == pytest.approx(
        [result.design.value("response_time") + t for t in (low, high)], rel=1e-4
    )


@pytest.mark.gate
def test_a_switch_that_never_ends_has_no_advice_on_what_never_began():
    result = answered_between("current: 0.3 A", hot=60.0)
    assert np.isinf(result.design.value("response_time"))
    assert not [check.text for check in result.warnings if not np.isfinite(check.value)]


def test_the_temperature_sweep_is_a_band_in_the_melting_range_only():
    result = answered_between("current: 1.5 A")
    sweep = {name: np.array(column) for name, column in result.sweep.items()}
    inside = (sweep["temperature"] >= 45.0) & (sweep["temperature"] <= 70.0)
    for name in ("pcl_stiffness", "joint_stiffness", "joint_damping", "solid_fraction"):
        low, middle, high = sweep[f"{name}_low"], sweep[name], sweep[f"{name}_high"]
        assert np.all(low <= middle)
        assert np.all(middle <= high)
        assert np.all((low < high) == inside)
    at_sixty = int(np.argmin(np.abs(sweep["temperature"] - 60.0)))
    assert sweep["joint_stiffness_low"][at_sixty] == pytest.approx(liquid_impedance(result, 60.0).real, rel=1e-6)


@pytest.mark.gate
def test_a_limit_that_only_some_histories_satisfy_is_undecided():
    points = "operating_points: {warm: {temperature: 60 degC}}\n"
    require = "require: {joint_stiffness@warm: '>= 100 N.m/rad', joint_stiffness@hot: '>= 1 N.m/rad'}\n"
    study = read_study_text(f"mode: shear\nmodule: {{{STIFF}}}\n{points}{require}", "a test")
    result = answer(study)
    assert [check.output for check in result.undecided] == ["joint_stiffness@warm"]
    low, high = result.design.intervals["joint_stiffness@warm"]
    assert low == pytest.approx(liquid_impedance(result, 60.0).real, rel=1e-6)
    assert result.undecided[0].worst == pytest.approx(low / 100.0 - 1.0, rel=1e-9)
    assert low < 100.0 < high
