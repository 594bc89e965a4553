"""A freezing time is an interval while the record's kinetics are assumed, and none once a user's own are set."""

from __future__ import annotations

from dataclasses import replace

import pytest

from tvimdesign.simulation.working_cycle.resolved_module import ResolvedModule, resolve_study
from tvimdesign.solve.uncertainty.design_uncertainty import UncertaintyModel
from tvimdesign.solve.uncertainty.unmeasured import unmeasured_inputs
from tvimdesign.study import read_study_text

KINETICS = {"pcl_crystallization_half_time", "pcl_nucleation_constant", "pcl_avrami_exponent"}
TEXT = """mode: shear
module: {cold_side: sink, cooling_current: 1.5 A, current: 2 A, response_criterion: softening, pcl_thickness: 0.6 mm}
solver: {cells: 8}
"""


@pytest.fixture(scope="module")
def module() -> ResolvedModule:
    return resolve_study(read_study_text(TEXT, "a test"))


def test_half_time_and_slope_of_freezing_move_without_their_dependents(
    module: ResolvedModule,
) -> None:
    names = {one.name for one in unmeasured_inputs(module)}
    assert names >= KINETICS
    assert "pcl_zero_shear_viscosity" in names
    # With K_g these would be counted twice: only the pair of K_g and T_m0 is known.
    assert not names & {"pcl_equilibrium_melting_temperature", "pcl_glass_transition", "pcl_transport_energy"}


@pytest.mark.gate
def test_freezing_time_is_an_interval_until_a_user_fits_his_own(module: ResolvedModule) -> None:
    interval = UncertaintyModel(module, ["frozen_time"]).at(module, 4).intervals["frozen_time"]
    swings = {swing.moved.name: swing for swing in interval.swings}
    assert interval.low < interval.nominal < interval.high
    assert KINETICS - {"pcl_avrami_exponent"} <= swings.keys()
    slow = swings["pcl_crystallization_half_time"]
    assert 0.0 < slow.at_low < slow.at_high  # a longer half-time freezes later
    steep = swings["pcl_nucleation_constant"]
    assert 0.0 < steep.at_high < steep.at_low  # a steeper slope below the reference freezes sooner
    own = replace(module, values={**module.values, "pcl_crystallization_half_time": 60.0})
    assert "pcl_crystallization_half_time" not in {one.name for one in unmeasured_inputs(own)}
