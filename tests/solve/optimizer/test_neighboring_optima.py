"""Steps beside the ends of the starts, compared with searches that stay within one turn each."""

from functools import partial
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from support import study_path

from tvimdesign.base.deadline import Deadline
from tvimdesign.device import Input
from tvimdesign.solve.nlp.decision_vector import DecisionVector
from tvimdesign.solve.nlp.problem_parts import Free
from tvimdesign.solve.nlp.solution import Start
from tvimdesign.solve.nlp.solver_run import Run
from tvimdesign.solve.optimizer import neighboring_optima
from tvimdesign.solve.optimizer.neighboring_optima import NeighboringOptima
from tvimdesign.solve.optimizer.optimizer import Optimizer
from tvimdesign.study import Range, SolverOptions, Study, read_study

WIDE_ARCS = {
    "placement_radius": 33.2e-3, "core_radius": 9.25e-3, "link_thickness": 5.25e-3, "pcl_inner_radius": 13.65e-3,
    "pcl_outer_radius": 24.8e-3, "arc_span": 1.35, "pcl_thickness": 0.6e-3, "current": 1.62,
}  # fmt: skip
SOFT_SPRINGS = {
    "wire_diameter": 1.75e-3, "coil_diameter": 10.7e-3, "coil_count": 3.36, "preload_angle": 0.262,
    "pin_radius_ratio": 0.69,
}  # fmt: skip


@pytest.fixture(scope="module")
def study() -> Study:
    return read_study(study_path("paper_shear"))


@pytest.fixture(scope="module")
def optimizer(study: Study) -> Optimizer:
    return Optimizer(study)


def _run_from(optimizer: Optimizer, **numbers: float) -> Run:
    begin = optimizer.model.start.copy()
    for name, value in numbers.items():
        begin[optimizer.model.index[name]] = value
    run = optimizer.solve(begin=begin)
    assert run.start.converged
    return run


def _kept_within(study: Study, optimizer: Optimizer, lower: float, upper: float) -> float:
    """Return the best objective with the coils within one turn, started in its middle; infinite if there is none."""
    vary = {**study.vary, "coil_count": Range(lower=lower, upper=upper)}
    middle = {**study.module, "coil_count": 0.5 * (lower + upper)}
    other = Optimizer(study.model_copy(update={"vary": vary, "module": middle}), optimizer.reference)
    run = other.solve()
    return run.start.objective if run.start.converged else np.inf


@pytest.mark.slow
def test_a_start_is_led_to_what_is_as_good_as_the_best_of_all_turns() -> None:
    # The study's own start ends in an optimum with better ones beside it, which the solver does not leave.
    study = read_study(study_path("wrist_compression"))
    optimizer = Optimizer(study)
    run = optimizer.solve()
    (improved,) = NeighboringOptima(optimizer).improve([run])
    alone = [_kept_within(study, optimizer, turn, turn + 1.0) for turn in (3.0, 4.0, 5.0)]
    assert improved.start.objective <= (1.0 + 1e-4) * min(alone)
    assert improved.start.objective < (1.0 - 1e-3) * run.start.objective
    assert improved.start.by_neighbor
    assert improved.start.begin == run.start.begin
    assert improved.start.iterations > run.start.iterations


@pytest.mark.gate
def test_the_best_turn_is_not_left(optimizer: Optimizer) -> None:
    run = _run_from(optimizer, **WIDE_ARCS, **SOFT_SPRINGS)
    best, *_ = NeighboringOptima(optimizer).improve([run])
    assert best.start.objective <= run.start.objective
    assert NeighboringOptima(optimizer).improve([best])[0] is best


def _ended_at(turns: float) -> Run:
    """Return an optimum in the middle of a turn, the worse the further from the third; each turn has one."""
    start = Start(1, "Solve_Succeeded", True, 5, 1.0 + abs(turns - 3.5), 0.0, {}, {})
    none = np.zeros(0)
    return Run(start, np.array([turns]), {}, {}, np.array([turns / 5.0]), none, none, none)


def _of_coils(period: float | None, tried: list[float]) -> Any:
    """Return an optimizer of nothing but coils, which notes where it begins; it ends in the middle of that turn."""

    def solve(*_: Any, unknowns: np.ndarray, **_more: Any) -> Run:
        tried.append(5.0 * float(unknowns[0]))
        return _ended_at(np.floor(tried[-1]) + 0.5)

    coils = Input(name="coil_count", unit="1", description="", group="", period=period)
    vector = SimpleNamespace(
        places_of_currents=list, inputs=lambda unknowns: 5.0 * unknowns,
        bounds=lambda _: (np.array([0.0]), np.array([1.8])), problem=SimpleNamespace(free=["coil_count"]),
    )  # fmt: skip
    vector.shaken = partial(DecisionVector.shaken, vector)
    return SimpleNamespace(
        free=[Free("coil_count", 0.0, 9.0, 5.0)], table=SimpleNamespace(by_name={"coil_count": coils}), solve=solve,
        model=SimpleNamespace(index={"coil_count": 0}), vector=vector, deadline=Deadline(), mixtures=(),
        study=SimpleNamespace(solver=SolverOptions()),
    )  # fmt: skip


def test_no_neighbor_is_tried_twice(monkeypatch: pytest.MonkeyPatch) -> None:
    # One start ends in the fifth turn and is led to the third; another in the sixth is led to the fifth, and on.
    monkeypatch.setattr(neighboring_optima, "SHAKES", 0)
    tried: list[float] = []
    led = NeighboringOptima(_of_coils(1.0, tried)).improve([_ended_at(5.5), _ended_at(6.5)])
    assert [run.start.objective for run in led] == [1.0, 1.0]
    assert all(run.start.by_neighbor for run in led)
    assert tried == pytest.approx([4.5, 3.5, 2.5, 5.5])


def test_searches_begin_a_little_beside_the_best_optimum_too(monkeypatch: pytest.MonkeyPatch) -> None:
    """Within a tenth of the range, 0.9 of a coil; each from the best so far, and what is no better leaves no trace."""
    monkeypatch.setattr(neighboring_optima, "SHAKES", 12)
    tried: list[float] = []
    worse, best = _ended_at(6.5), _ended_at(5.5)
    *same, shaken = NeighboringOptima(_of_coils(None, tried)).improve([worse, best])
    assert same == [worse, best]
    assert len(tried) == 12
    assert abs(tried[0] - 5.5) <= 0.9
    assert shaken.start.objective == 1.0
    assert shaken.start.by_neighbor
    tried.clear()
    assert NeighboringOptima(_of_coils(None, tried)).improve([shaken]) == [shaken]
    assert all(abs(one - 3.5) <= 0.9 for one in tried)


def test_two_starts_that_each_found_one_half_find_the_whole(study: Study) -> None:
    # One start was kept from the better springs, the other from the better layer; no turn lies beside either.
    fixed = {name: vary for name, vary in study.vary.items() if name not in {"coil_count", "pin_radius_ratio"}}
    module = {**study.module, "coil_count": 3.36, "pin_radius_ratio": 0.69}
    optimizer = Optimizer(study.model_copy(update={"vary": fixed, "module": module}))
    whole = optimizer.solve()
    halves = [
        optimizer.solve({"wire_diameter": (2.1e-3, 3.2e-3)}),
        optimizer.solve({"pcl_outer_radius": (36e-3, 48e-3)}),
    ]
    assert all(run.start.converged for run in (whole, *halves))
    assert min(half.start.objective for half in halves) > 1.01 * whole.start.objective
    *kept, crossed = NeighboringOptima(optimizer).improve(halves)
    assert kept == halves
    assert crossed.start.crossed
    assert crossed.start.objective < (1.0 + 1e-4) * whole.start.objective
