"""A point in the melting range that says what soft or stiff means leaves the times of the cycle open too."""

import numpy as np
import pytest
from stiff_when_warm import STIFF_WHEN_WARM

from tvimdesign.catalog import Catalog
from tvimdesign.device.core.impedance.joint_impedance import melt_modes
from tvimdesign.solve.result import StudyResult, answer
from tvimdesign.study import read_study_text

KELVIN = 273.15
POINTS = "operating_points: {{cold: {{temperature: {cold} degC}}, hot: {{temperature: {hot} degC}}}}\n"


UNITS = ("1/K", "", "")
STIFF = ", ".join(f"{name}: {value} {unit}" for (name, value), unit in zip(STIFF_WHEN_WARM.items(), UNITS, strict=True))


def answered(module: str, cold: float = 30.0, hot: float = 100.0) -> StudyResult:
    text = f"mode: shear\nmodule: {{{module}, {STIFF}}}\n" + POINTS.format(cold=cold, hot=hot)
    return answer(read_study_text(text, "a test"))


def liquid_impedance(found: StudyResult, celsius: float) -> complex:
    """K* of the joint with a layer that is all melt, at 1 Hz, from the record's spectrum in complex numbers."""
    value = found.design.value
    modes = melt_modes(Catalog().record("polymers", found.design.choices["pcl_grade"]))
    kelvin, reference = celsius + KELVIN, value("pcl_melt_reference")
    shift = np.exp(value("pcl_flow_activation_energy") / 8.314462618 * (1.0 / kelvin - 1.0 / reference))
    omega = 2j * np.pi
    modulus = sum(plateau * omega * shift * time / (1.0 + omega * shift * time) for time, plateau in modes)
    layer = modulus * value("layer_polar_moment") / value("pcl_thickness")
    loss_factor = value("structure_loss_factor") + value("clamped_loss_factor")
    structure = value("structure_stiffness") * complex(1.0, loss_factor)
    return complex(value("spring_stiffness") + 1.0 / (1.0 / layer + 1.0 / structure))


@pytest.mark.slow
def test_softening_to_a_point_in_the_melting_range_takes_an_interval() -> None:
    found = answered("current: 1.5 A", hot=60.0)
    low, high = found.intervals["softening_time"]
    target = abs(liquid_impedance(found, 60.0))
    stated = answered(f"current: 1.5 A, impedance_targets: stated, soft_impedance: {target:.9f} N.m/rad")
    assert high == pytest.approx(stated.design.value("softening_time"), rel=1e-3)
    assert low < 0.5 * high
    assert "softening_time" not in stated.intervals


@pytest.mark.gate
def test_stiffening_to_a_point_in_the_melting_range_takes_an_interval() -> None:
    found = answered("current: 1.5 A", cold=60.0)
    low, high = found.intervals["stiffening_time"]
    assert 0.0 < low < found.design.value("stiffening_time") < high
    assert found.intervals["cycle_time"] == pytest.approx(
        [found.design.value("response_time") + t for t in (low, high)], rel=1e-4
    )


@pytest.mark.gate
def test_a_switch_that_never_ends_has_no_advice_on_what_never_began() -> None:
    found = answered("current: 0.3 A", hot=60.0)
    assert np.isinf(found.design.value("response_time"))
    assert not [check.text for check in found.warnings if not np.isfinite(check.value)]


def test_the_temperature_sweep_is_a_band_in_the_melting_range_only() -> None:
    found = answered("current: 1.5 A")
    sweep = {name: np.array(column) for name, column in found.sweep.items()}
    inside = (sweep["temperature"] >= 45.0) & (sweep["temperature"] <= 70.0)
    for name in ("pcl_stiffness", "joint_stiffness", "joint_damping", "solid_fraction"):
        low, middle, high = sweep[f"{name}_low"], sweep[name], sweep[f"{name}_high"]
        assert np.all(low <= middle)
        assert np.all(middle <= high)
        assert np.all((low < high) == inside)
    at_sixty = int(np.argmin(np.abs(sweep["temperature"] - 60.0)))
    assert sweep["joint_stiffness_low"][at_sixty] == pytest.approx(liquid_impedance(found, 60.0).real, rel=1e-6)


@pytest.mark.gate
def test_a_limit_that_only_some_histories_satisfy_is_undecided() -> None:
    points = "operating_points: {warm: {temperature: 60 degC}}\n"
    require = "require: {joint_stiffness@warm: '>= 100 N.m/rad', joint_stiffness@hot: '>= 1 N.m/rad'}\n"
    study = read_study_text(f"mode: shear\nmodule: {{{STIFF}}}\n{points}{require}", "a test")
    found = answer(study)
    assert [check.output for check in found.undecided] == ["joint_stiffness@warm"]
    low, high = found.design.intervals["joint_stiffness@warm"]
    assert low == pytest.approx(liquid_impedance(found, 60.0).real, rel=1e-6)
    assert found.undecided[0].worst == pytest.approx(low / 100.0 - 1.0, rel=1e-9)
    assert low < 100.0 < high
