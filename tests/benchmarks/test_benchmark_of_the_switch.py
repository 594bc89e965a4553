"""The benchmark compares like with like: every row solves the same equations and finds the same times."""

from __future__ import annotations

import numpy as np
import pytest
import switch

from tvimdesign.simulation.working_cycle.device_functions import DeviceFunctions
from tvimdesign.study import given, read_study


@pytest.fixture(scope="module")
def model() -> DeviceFunctions:
    study = read_study(switch.STUDY)
    table = study.table
    return DeviceFunctions(table, given(study), tuple(study.operating_points), study.solver.cells)


def test_equations_by_hand_and_compiled_are_the_same(model: DeviceFunctions) -> None:
    hand, machine = switch.written_by_hand(model, sparse=True), switch.compiled(model)
    assert hand.start == pytest.approx(machine.start)
    generator = np.random.default_rng(1)
    for _ in range(5):
        state = hand.start * generator.uniform(0.9, 4.0, hand.start.size)
        assert hand.rates(0.0, state) == pytest.approx(machine.rates(0.0, state), rel=1e-9, abs=1e-12)
        gaps = np.asarray(hand.gaps(0.0, state)) / np.array([100.0, 100.0, 100.0, 1.0])
        assert gaps == pytest.approx(machine.gaps(0.0, state), rel=1e-9, abs=1e-12)
        slope = machine.jacobian(0.0, state)
        assert np.all((slope == 0.0) | (hand.sparsity == 1.0))
        shift = 1e-6 * generator.standard_normal(state.size)
        change = machine.rates(0.0, state + shift) - machine.rates(0.0, state - shift)
        assert change == pytest.approx(2.0 * slope @ shift, rel=1e-4, abs=1e-10)


@pytest.mark.gate
def test_all_rows_find_the_same_times(model: DeviceFunctions) -> None:
    machine = switch.compiled(model)
    ours = switch.by_tvimdesign(model)(0.0)
    assert switch.by_scipy(machine, "LSODA")(1e-9) == pytest.approx(ours, rel=1e-4)
    assert switch.by_scipy(machine, "BDF")(1e-7) == pytest.approx(ours, rel=1e-4)
    assert switch.by_scipy(switch.written_by_hand(model, sparse=True), "BDF")(1e-5) == pytest.approx(ours, rel=1e-4)
