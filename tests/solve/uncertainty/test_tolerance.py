"""The module with its tolerances: moments inside the optimiser, the free angle, yields, and the compiled functions."""

from collections.abc import Callable
from functools import cache
from statistics import NormalDist

import numpy as np
import pytest

from tvimdesign.base.errors import InputError
from tvimdesign.simulation.working_cycle.device_functions import DeviceFunctions
from tvimdesign.simulation.working_cycle.resolved_module import ResolvedModule, resolve_study
from tvimdesign.solve.nlp.constraints import constraints_of
from tvimdesign.solve.nlp.spread import moments
from tvimdesign.solve.uncertainty.tolerance import Tolerancing
from tvimdesign.solve.uncertainty.uncertain_inputs import contributors_of
from tvimdesign.study import read_study_text

SPRINGS = "  wire_diameter: 0.025 mm\n  coil_diameter: {row: coil_diameter_tolerance}\n  spring_youngs_modulus: 1 %\n"
OUTPUTS = ["spring_stiffness", "spring_static_safety", "pcl_stiffness@hot", "module_mass"]


@pytest.fixture(scope="module")
def resolved() -> Callable[[str], ResolvedModule]:
    """Return a shear module with what is written under its mode."""

    @cache
    def make(text: str) -> ResolvedModule:
        return resolve_study(read_study_text(f"mode: shear\n{text}", "a test"))

    return make


def _silent(_: str) -> None:
    pass


def test_the_free_angle_of_the_papers_spring_is_three_times_its_stroke(
    resolved: Callable[[str], ResolvedModule],
) -> None:
    spread = "tolerances: {preload_angle: {row: free_angle_tolerance, adjusted_to: 1 deg}}"
    module = resolved(f"{spread}\nrequire: {{preload_margin: '>= 0 rad'}}\n")
    angle = next(one for one in contributors_of(module) if one.name == "preload_angle")
    assert np.degrees(angle.plus_minus) == pytest.approx(18.7, abs=0.05)  # +-18.7 deg of grade 2 against +-5.96 deg
    preload = Tolerancing(module, _silent).preload(1 << 12, 1)
    assert preload.over_stroke == pytest.approx(3.14, abs=0.01)
    assert preload.adjusted == pytest.approx(np.radians(1.0))
    # A pin 28.5 mm from the middle, a spring at 57 mm, and a leg that passes its axis at (24.41 + 2.413 + 4) / 2 mm:
    # to the stop at 0.104 + 0.02 rad the spring unwinds by 0.1317. The preload of 0.15 less that is what it may be off.
    # The rule that the preload leaves room for springs as sorted is no limit here: it would count the spread twice.
    # One in a thousand is wound so far that it breaks its pin, which is lost beside them.
    pin = 28.5 * np.exp(0.124j)
    turned = np.angle(57.0 - pin) + np.arcsin(15.411 / abs(57.0 - pin)) - np.arcsin(15.411 / 28.5)
    reserve = 0.15 - abs(turned)
    bought, adjusted = (NormalDist(0.0, np.radians(degrees) / 3.0).cdf(reserve) for degrees in (18.7, 1.0))
    assert preload.yield_as_bought.share == pytest.approx(bought, abs=5e-3)
    assert preload.yield_adjusted.share == pytest.approx(adjusted, abs=5e-4)


def test_what_is_adjusted_is_as_wide_as_adjusting_leaves_it(resolved: Callable[[str], ResolvedModule]) -> None:
    text = "tolerances: {preload_angle: {plus_minus: 5 deg, adjustable: %s, adjusted_to: 2 deg}}\n"
    for said, adjusted, expected in (
        ("true", None, 2.0),
        ("false", None, 5.0),
        ("false", True, 2.0),
        ("true", False, 5.0),
    ):
        (one,) = contributors_of(resolved(text % said), adjusted)
        assert np.degrees(one.plus_minus) == pytest.approx(expected)
    assert contributors_of(resolved("tolerances: {preload_angle: {plus_minus: 5 deg, adjustable: true}}\n")) == []


def _differences(module: ResolvedModule, output: str) -> tuple[float, float]:
    """Shift of the mean and standard deviation, by differences of the table's own floats."""
    shift = variance = 0.0
    for one in contributors_of(module):
        step = 0.2 * one.plus_minus

        def at(value: float, name: str = one.name) -> float:
            return float(module.table.evaluate({**module.values, name: value}, [output])[output])

        low, here, high = (at(one.nominal + k * step) for k in (-1, 0, 1))
        variance += ((high - low) / (2.0 * step) * one.deviation) ** 2
        shift += 0.5 * (high - 2.0 * here + low) / step**2 * one.deviation**2
    return shift, float(np.sqrt(variance))


def test_the_moments_are_those_of_differences_of_the_table(resolved: Callable[[str], ResolvedModule]) -> None:
    module = resolved(f"tolerances:\n{SPRINGS}  pcl_thickness: {{plus_minus: 0.2 mm, distribution: uniform}}\n")
    model = DeviceFunctions(module.table, module.values, module.points, 4)
    function = moments(model, module.study.tolerances, OUTPUTS, [1.0] * len(OUTPUTS))
    shifts, deviations = (np.asarray(part).ravel() for part in function(model.start))
    for output, shift, deviation in zip(OUTPUTS, shifts, deviations, strict=True):
        expected = _differences(module, output)
        assert (shift, deviation) == (pytest.approx(expected[0], rel=0.02), pytest.approx(expected[1], rel=0.01))


def test_one_input_gives_a_yield_that_can_be_worked_out(resolved: Callable[[str], ResolvedModule]) -> None:
    # Mass is linear in the density of the springs, so the yield is the normal distribution's.
    module = resolved("tolerances: {spring_density: 9 %}\nrequire: {springs_mass: '<= 1 kg'}\n")
    mass = float(module.quantity("springs_mass"))
    text = f"tolerances: {{spring_density: 9 %}}\nrequire: {{springs_mass: '<= {1.03 * mass:.17g} kg'}}\n"
    found = Tolerancing(resolved(text), _silent).analyse(1 << 14, 1)
    (kept,) = [one for one in found.kept if one.limit.output == "springs_mass"]
    assert kept.share.share == pytest.approx(0.841345, abs=5e-4)  # one standard deviation
    assert kept.capability == pytest.approx(1.0 / 3.0, rel=1e-3)
    i = found.outputs.index("springs_mass")
    assert found.deviation[i] == pytest.approx(0.03 * mass, rel=1e-9)
    assert found.worst.high[i] == pytest.approx(1.09 * mass, rel=1e-9)
    assert found.total[i, 0] == pytest.approx(1.0, abs=0.02)


@pytest.mark.gate
def test_the_same_bits_for_any_number_of_workers(resolved: Callable[[str], ResolvedModule]) -> None:
    module = resolved("tolerances: {current: 1 %, wire_diameter: 0.02 mm}\nrequire: {response_time: '<= 200 s'}\n")
    analysis = Tolerancing(module, _silent)
    alone = analysis.analyse(1 << 11, 7)
    analysis.workers = 2
    shared = analysis.analyse(1 << 11, 7)
    for name in ("shares", "first", "total"):
        assert np.array_equal(getattr(alone, name), getattr(shared, name))
    assert np.array_equal(alone.drawn.values, shared.drawn.values)
    assert alone.together == shared.together


def test_where_nothing_spreads_that_is_said(resolved: Callable[[str], ResolvedModule]) -> None:
    with pytest.raises(InputError, match="nothing spreads; give `tolerances: standard`"):
        Tolerancing(resolved("tolerances: {current: 0 A}\n"), _silent)
    text = "tolerances: {structure_service_temperature: 5 K}\nrequire: {spring_stiffness: '>= 1 N.m/rad'}\n"
    with pytest.raises(InputError, match="depends on structure_service_temperature; give tolerances of other inputs"):
        Tolerancing(resolved(text), _silent)


def _asked(module: ResolvedModule) -> list[str]:
    """Return the outputs an analysis would ask for, without compiling anything."""
    analysis = object.__new__(Tolerancing)
    analysis.resolved = module
    analysis.limits = constraints_of(module.study, module.table, module.values)
    return analysis._requested()


def test_without_requirements_the_spread_of_the_switch_is_reported(resolved: Callable[[str], ResolvedModule]) -> None:
    module = resolved("tolerances: {pcl_thickness: 0.05 mm}\n")
    asked = set(_asked(module))
    assert {"module_mass", "softening_time", "joint_stiffness@cold"} <= asked
    # What comes after the switch takes ten times as long; the springs do not hang on the layer's thickness.
    assert not asked & {"stiffening_time", "frozen_time", "cycle_time", "spring_rate"}
    assert all(module.table.output(name).headline for name in asked)
