"""Tolerances of dimensions, and unmeasured inputs."""

from collections.abc import Callable
from dataclasses import replace
from functools import cache
from pathlib import Path
from statistics import NormalDist

import numpy as np
import pytest
from support import sample_text, study_path

from tvimdesign.base.errors import InputError
from tvimdesign.catalog import Catalog
from tvimdesign.simulation.working_cycle.device_functions import DeviceFunctions, ResolvedModule, resolve_study
from tvimdesign.solve.nlp.constraints import constraints_of
from tvimdesign.solve.nlp.spread import moments
from tvimdesign.solve.uncertainty.design_uncertainty import UncertaintyModel
from tvimdesign.solve.uncertainty.tolerance import Tolerancing
from tvimdesign.solve.uncertainty.uncertain_inputs import before_measuring, contributors_of, unmeasured_inputs
from tvimdesign.study import read_study, read_study_text

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


def test_the_free_angle_of_the_papers_spring_is_three_times_its_stroke(resolved):
    spread = "tolerances: {preload_angle: {row: free_angle_tolerance, adjusted_to: 1 deg}}"
    module = resolved(f"{spread}\nrequire: {{preload_margin: '>= 0 rad'}}\n")
    angle = next(contributor for contributor in contributors_of(module) if contributor.name == "preload_angle")
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


def test_what_is_adjusted_is_as_wide_as_adjusting_leaves_it(resolved):
    text = "tolerances: {preload_angle: {plus_minus: 5 deg, adjustable: %s, adjusted_to: 2 deg}}\n"
    widths = {("true", None): 2.0, ("false", None): 5.0, ("false", True): 2.0, ("true", False): 5.0}
    for (adjustable, adjusted), expected in widths.items():
        (contributor,) = contributors_of(resolved(text % adjustable), adjusted)
        assert np.degrees(contributor.plus_minus) == pytest.approx(expected)
    assert contributors_of(resolved("tolerances: {preload_angle: {plus_minus: 5 deg, adjustable: true}}\n")) == []


def _differences(module: ResolvedModule, output: str) -> tuple[float, float]:
    """Shift of the mean and standard deviation, by differences of the table's own floats."""
    shift = variance = 0.0
    for contributor in contributors_of(module):
        step = 0.2 * contributor.plus_minus

        def at(value: float, name: str = contributor.name) -> float:
            return float(module.table.evaluate({**module.values, name: value}, [output])[output])

        low, here, high = (at(contributor.nominal + k * step) for k in (-1, 0, 1))
        variance += ((high - low) / (2.0 * step) * contributor.deviation) ** 2
        shift += 0.5 * (high - 2.0 * here + low) / step**2 * contributor.deviation**2
    return shift, float(np.sqrt(variance))


def test_the_moments_are_those_of_differences_of_the_table(resolved):
    module = resolved(f"tolerances:\n{SPRINGS}  pcl_thickness: {{plus_minus: 0.2 mm, distribution: uniform}}\n")
    model = DeviceFunctions(module.table, module.values, module.points, 4)
    function = moments(model, module.study.tolerances, OUTPUTS, [1.0] * len(OUTPUTS))
    shifts, deviations = (np.asarray(part).ravel() for part in function(model.start))
    for output, shift, deviation in zip(OUTPUTS, shifts, deviations, strict=True):
        expected = _differences(module, output)
        assert (shift, deviation) == (pytest.approx(expected[0], rel=0.02), pytest.approx(expected[1], rel=0.01))


def test_one_input_gives_a_yield_that_can_be_worked_out(resolved):
    # Mass is linear in the density of the springs, so the yield is the normal distribution's.
    module = resolved("tolerances: {spring_density: 9 %}\nrequire: {springs_mass: '<= 1 kg'}\n")
    mass = float(module.quantity("springs_mass"))
    text = f"tolerances: {{spring_density: 9 %}}\nrequire: {{springs_mass: '<= {1.03 * mass:.17g} kg'}}\n"
    spread = Tolerancing(resolved(text), _silent).analyse(1 << 14, 1)
    (satisfied,) = [limit for limit in spread.limit_yields if limit.limit.output == "springs_mass"]
    assert satisfied.share.share == pytest.approx(0.841345, abs=5e-4)  # one standard deviation
    assert satisfied.capability == pytest.approx(1.0 / 3.0, rel=1e-3)
    i = spread.outputs.index("springs_mass")
    assert spread.deviation[i] == pytest.approx(0.03 * mass, rel=1e-9)
    assert spread.worst.high[i] == pytest.approx(1.09 * mass, rel=1e-9)
    assert spread.total[i, 0] == pytest.approx(1.0, abs=0.02)


@pytest.mark.gate
def test_the_same_bits_for_any_number_of_workers(resolved):
    module = resolved("tolerances: {current: 1 %, wire_diameter: 0.02 mm}\nrequire: {response_time: '<= 200 s'}\n")
    analysis = Tolerancing(module, _silent)
    alone = analysis.analyse(1 << 11, 7)
    analysis.workers = 2
    shared = analysis.analyse(1 << 11, 7)
    for name in ("shares", "first", "total"):
        assert np.array_equal(getattr(alone, name), getattr(shared, name))
    assert np.array_equal(alone.drawn.values, shared.drawn.values)
    assert alone.together == shared.together


def test_where_nothing_spreads_the_report_says_so(resolved):
    with pytest.raises(InputError, match="nothing spreads; give `tolerances: standard`"):
        Tolerancing(resolved("tolerances: {current: 0 A}\n"), _silent)
    text = "tolerances: {structure_service_temperature: 5 K}\nrequire: {spring_stiffness: '>= 1 N.m/rad'}\n"
    with pytest.raises(InputError, match="depends on structure_service_temperature; give tolerances of other inputs"):
        Tolerancing(resolved(text), _silent)


def _outputs(module: ResolvedModule) -> list[str]:
    """Return the outputs an analysis would ask for, without compiling anything."""
    analysis = object.__new__(Tolerancing)
    analysis.resolved = module
    analysis.limits = constraints_of(module.study, module.table, module.values)
    return analysis._requested()


def test_without_requirements_the_spread_of_the_switch_is_reported(resolved):
    module = resolved("tolerances: {pcl_thickness: 0.05 mm}\n")
    outputs = set(_outputs(module))
    assert {"module_mass", "softening_time", "joint_stiffness@cold"} <= outputs
    # What comes after the switch takes ten times as long; the springs do not hang on the layer's thickness.
    assert not outputs & {"stiffening_time", "frozen_time", "cycle_time", "spring_rate"}
    assert all(module.table.output(name).headline for name in outputs)


RECORD = sample_text("measured_heat_path")


@pytest.fixture
def module(tmp_path: Path) -> ResolvedModule:
    folder = tmp_path / "records" / "heat_paths"
    folder.mkdir(parents=True)
    (folder / "bench.yaml").write_text(RECORD)
    study = study_path("paper_reconstructed").read_text()
    path = tmp_path / "mine.yaml"
    path.write_text(study.replace("\nmodule:", "\ncatalog: records\nmodule:\n  heat_paths: bench", 1))
    return resolve_study(read_study(path))


def test_a_measured_input_knows_its_range_before_and_others_have_none(module):
    inputs = {assumed.name: assumed for assumed in unmeasured_inputs(module)}
    handbook = Catalog().record("heat_paths", "handbook").entry("rotor_contact")
    measured = inputs["rotor_contact"]
    assert (measured.low, measured.high, measured.status) == (3000.0, 5000.0, "measured")
    assert measured.before == (handbook.low, handbook.high)
    assert [name for name, assumed in inputs.items() if assumed.before is not None] == ["rotor_contact"]
    (before,) = [assumed for assumed in before_measuring(list(inputs.values())) if assumed.name == "rotor_contact"]
    assert (before.low, before.high) == (handbook.low, handbook.high)
    module = resolve_study(read_study(study_path("paper_reconstructed")))
    assert all(assumed.before is None for assumed in unmeasured_inputs(module))


@pytest.mark.slow
def test_the_interval_was_wider_before(module):
    uncertainty = UncertaintyModel(module, ["softening_time"]).at(module, 1 << 5, 1 << 7)
    low, high = uncertainty.before["softening_time"]
    now = uncertainty.intervals["softening_time"]
    assert now.high - now.low < high - low


KINETICS = {"pcl_crystallization_half_time", "pcl_nucleation_constant", "pcl_avrami_exponent"}
TEXT = """mode: shear
module: {cold_side: sink, cooling_current: 1.5 A, current: 2 A, response_criterion: softening, pcl_thickness: 0.6 mm}
solver: {cells: 8}
"""


@pytest.fixture(scope="module")
def freezing_module() -> ResolvedModule:
    return resolve_study(read_study_text(TEXT, "a test"))


def test_half_time_and_slope_of_freezing_move_without_their_dependents(freezing_module):
    names = {assumed.name for assumed in unmeasured_inputs(freezing_module)}
    assert names >= KINETICS
    assert "pcl_zero_shear_viscosity" in names
    # With K_g these would be counted twice: only the pair of K_g and T_m0 is known.
    assert not names & {"pcl_equilibrium_melting_temperature", "pcl_glass_transition", "pcl_transport_energy"}


@pytest.mark.gate
def test_freezing_time_is_an_interval_until_a_user_fits_his_own(freezing_module):
    interval = UncertaintyModel(freezing_module, ["frozen_time"]).at(freezing_module, 4).intervals["frozen_time"]
    swings = {swing.moved.name: swing for swing in interval.swings}
    assert interval.low < interval.nominal < interval.high
    assert KINETICS - {"pcl_avrami_exponent"} <= swings.keys()
    slow = swings["pcl_crystallization_half_time"]
    assert 0.0 < slow.at_low < slow.at_high  # a longer half-time freezes later
    steep = swings["pcl_nucleation_constant"]
    assert 0.0 < steep.at_high < steep.at_low  # a steeper slope below the reference freezes sooner
    own = replace(freezing_module, values={**freezing_module.values, "pcl_crystallization_half_time": 60.0})
    assert "pcl_crystallization_half_time" not in {assumed.name for assumed in unmeasured_inputs(own)}


@pytest.mark.gate
def test_memory_of_the_melt_is_in_the_intervals_unless_named_off():
    warm = (
        TEXT.replace("0.6 mm", "4 mm")
        + "operating_points: {cold: {temperature: 30 degC}, hot: {temperature: 70 degC}}\n"
    )
    resolved = resolve_study(read_study_text(warm, "a test"))
    (memory,) = [each for each in unmeasured_inputs(resolved) if each.name == "melt_memory"]
    assert (memory.low, memory.high, memory.logarithmic) == (1.0, 10.0, True)
    intervals = UncertaintyModel(resolved, ["joint_damping@hot", "impedance_range"]).at(resolved, 0).intervals
    for name in ("joint_damping@hot", "impedance_range"):
        swing = {swing.moved.name: swing for swing in intervals[name].swings}["melt_memory"]
        assert swing.size > 0.2 * intervals[name].nominal, name
    assert 1.5 < resolved.quantity("memory_factor@hot") < 2.0
    without = resolve_study(read_study_text(warm.replace("{cold_side", "{melt_memory: 1, cold_side"), "a test"))
    assert without.quantity("memory_factor@hot") == 1.0
    assert without.quantity("joint_damping@hot") < 0.9 * resolved.quantity("joint_damping@hot")
    assert "melt_memory" not in {each.name for each in unmeasured_inputs(without)}
