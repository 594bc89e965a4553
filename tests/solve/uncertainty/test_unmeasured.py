"""Inputs that are assumed or measured: their ranges before and after, and a freezing time's interval."""

from dataclasses import replace
from pathlib import Path

import pytest
from support import study_path

from tvimdesign.catalog import Catalog
from tvimdesign.simulation.working_cycle.resolved_module import ResolvedModule, resolve_study
from tvimdesign.solve.uncertainty.design_uncertainty import UncertaintyModel
from tvimdesign.solve.uncertainty.uncertain_inputs import before_measuring, unmeasured_inputs
from tvimdesign.study import read_study, read_study_text

RECORD = """title: "bench module"
based_on: handbook
values:
  rotor_contact: {value: 4000, unit: "W/m^2/K", low: 3000, high: 5000, status: measured, source: "a log"}
"""


@pytest.fixture
def module(tmp_path: Path) -> ResolvedModule:
    folder = tmp_path / "records" / "heat_paths"
    folder.mkdir(parents=True)
    (folder / "bench.yaml").write_text(RECORD)
    study = study_path("paper_reconstructed").read_text()
    path = tmp_path / "mine.yaml"
    path.write_text(study.replace("\nmodule:", "\ncatalog: records\nmodule:\n  heat_paths: bench", 1))
    return resolve_study(read_study(path))


def test_a_measured_input_knows_its_range_before_and_others_have_none(module: ResolvedModule) -> None:
    inputs = {one.name: one for one in unmeasured_inputs(module)}
    handbook = Catalog().record("heat_paths", "handbook").entry("rotor_contact")
    measured = inputs["rotor_contact"]
    assert (measured.low, measured.high, measured.status) == (3000.0, 5000.0, "measured")
    assert measured.before == (handbook.low, handbook.high)
    assert [name for name, one in inputs.items() if one.before is not None] == ["rotor_contact"]
    (before,) = [one for one in before_measuring(list(inputs.values())) if one.name == "rotor_contact"]
    assert (before.low, before.high) == (handbook.low, handbook.high)
    module = resolve_study(read_study(study_path("paper_reconstructed")))
    assert all(one.before is None for one in unmeasured_inputs(module))


@pytest.mark.slow
def test_the_interval_was_wider_before(module: ResolvedModule) -> None:
    found = UncertaintyModel(module, ["softening_time"]).at(module, 1 << 5, 1 << 7)
    low, high = found.before["softening_time"]
    now = found.intervals["softening_time"]
    assert now.high - now.low < high - low


KINETICS = {"pcl_crystallization_half_time", "pcl_nucleation_constant", "pcl_avrami_exponent"}
TEXT = """mode: shear
module: {cold_side: sink, cooling_current: 1.5 A, current: 2 A, response_criterion: softening, pcl_thickness: 0.6 mm}
solver: {cells: 8}
"""


@pytest.fixture(scope="module")
def freezing_module() -> ResolvedModule:
    return resolve_study(read_study_text(TEXT, "a test"))


def test_half_time_and_slope_of_freezing_move_without_their_dependents(freezing_module: ResolvedModule) -> None:
    names = {one.name for one in unmeasured_inputs(freezing_module)}
    assert names >= KINETICS
    assert "pcl_zero_shear_viscosity" in names
    # With K_g these would be counted twice: only the pair of K_g and T_m0 is known.
    assert not names & {"pcl_equilibrium_melting_temperature", "pcl_glass_transition", "pcl_transport_energy"}


@pytest.mark.gate
def test_freezing_time_is_an_interval_until_a_user_fits_his_own(freezing_module: ResolvedModule) -> None:
    interval = UncertaintyModel(freezing_module, ["frozen_time"]).at(freezing_module, 4).intervals["frozen_time"]
    swings = {swing.moved.name: swing for swing in interval.swings}
    assert interval.low < interval.nominal < interval.high
    assert KINETICS - {"pcl_avrami_exponent"} <= swings.keys()
    slow = swings["pcl_crystallization_half_time"]
    assert 0.0 < slow.at_low < slow.at_high  # a longer half-time freezes later
    steep = swings["pcl_nucleation_constant"]
    assert 0.0 < steep.at_high < steep.at_low  # a steeper slope below the reference freezes sooner
    own = replace(freezing_module, values={**freezing_module.values, "pcl_crystallization_half_time": 60.0})
    assert "pcl_crystallization_half_time" not in {one.name for one in unmeasured_inputs(own)}


@pytest.mark.gate
def test_memory_of_the_melt_is_in_the_intervals_unless_named_off() -> None:
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
