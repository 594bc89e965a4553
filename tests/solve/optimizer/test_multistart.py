"""Starts of a search, and optima beside one another."""

import itertools
from collections.abc import Callable
from functools import partial
from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest
from scipy.stats import qmc
from support import sample_text, study_path

from tvimdesign.base.deadline import Deadline
from tvimdesign.base.errors import SimulationError
from tvimdesign.device import Input
from tvimdesign.solve.nlp.decision_vector import DecisionVector
from tvimdesign.solve.nlp.problem_parts import Free
from tvimdesign.solve.nlp.solution import Start
from tvimdesign.solve.nlp.solver_run import Run
from tvimdesign.solve.optimizer import refinements
from tvimdesign.solve.optimizer.multistart import FEW, MAX_DRAWS, Multistart, unit_points
from tvimdesign.solve.optimizer.optimizer import Optimizer
from tvimdesign.solve.optimizer.refinements import NeighboringOptima
from tvimdesign.study import Range, SolverOptions, Study, read_study, read_study_text

LOWER, UPPER, SEED = 1.0, 100.0, 3


def searches(
    starts: int,
    own: float = 2.0,
    takes: Callable[[float], float] = lambda size: size,
    mass: Callable[[float], float] = lambda size: size,
) -> tuple[Multistart, list[str]]:
    """Return starts for a number from 1 to 100 that is `own` in the study, and the progress messages."""
    messages: list[str] = []
    table = SimpleNamespace(outputs=(), behind_supplied={"time"})
    model: Any = SimpleNamespace(
        start=np.array([own, 7.0]), index={"size": 0, "other": 1}, table=table, switch_names=["time"]
    )
    model.values = lambda inputs, _: {"mass": mass(inputs[0]), "time": np.nan}

    def simulated(inputs: np.ndarray) -> dict[str, float]:
        return {"time": takes(float(inputs[0]))}

    free = (Free("size", LOWER, UPPER, 2.0),)
    problem = SimpleNamespace(free=free, events=("time",), simulated=simulated, phases=())
    options = SolverOptions(starts=starts, seed=SEED)
    return Multistart(cast(Any, problem), model, options, messages.append), messages


def sizes(search: Multistart) -> list[float]:
    points = list(search.points())
    assert all(point[1] == 7.0 for point in points)  # what is not free stays as the study has it
    return [float(point[0]) for point in points]


def drawn(count: int) -> np.ndarray:
    """Points evenly drawn in the logarithm, number for number."""
    shares = np.random.default_rng(SEED).random((count, 1))[:, 0]
    return np.asarray(LOWER * (UPPER / LOWER) ** shares)


@pytest.mark.parametrize("starts", [1, 4])
def test_the_study_s_start_comes_first_and_others_are_log_even(starts):
    search, messages = searches(starts)
    assert sizes(search) == pytest.approx([2.0, *drawn(starts - 1)])
    assert search.passed_over == {"switch never ends": 0, "no such module": 0}
    assert messages == []


def test_points_whose_switch_never_ends_are_skipped_and_counted():
    search, messages = searches(3, own=2.0, takes=lambda size: np.inf if size < 10.0 else size)
    ends = [size for size in drawn(50) if size >= 10.0][:3]
    tried = 1 + list(drawn(50)).index(ends[-1]) + 1
    assert sizes(search) == pytest.approx(ends)
    assert search.passed_over == {"switch never ends": tried - 3, "no such module": 0}
    assert messages == ["looking for a start: the switch of the study's own never ends, or takes no time"]


def test_points_without_a_module_are_skipped_unsimulated():
    simulated: list[float] = []

    def takes(size: float) -> float:
        simulated.append(size)
        return size

    search, _ = searches(4, takes=takes, mass=lambda size: np.nan if size < 10.0 else size)
    whole = [size for size in drawn(50) if size >= 10.0][:3]
    assert sizes(search) == pytest.approx([2.0, *whole])
    assert search.passed_over == {"switch never ends": 0, "no such module": list(drawn(50)).index(whole[-1]) + 1 - 3}
    assert simulated == pytest.approx([2.0, *whole])  # the study's own once


def test_where_no_point_will_do_the_search_begins_at_the_study_s_own():
    search, _ = searches(2, takes=lambda _: np.inf)
    assert sizes(search) == [2.0, 2.0]
    assert search.passed_over["switch never ends"] == 1 + 2 * MAX_DRAWS
    search, _ = searches(2, mass=lambda _: np.nan)
    assert sizes(search) == [2.0, 2.0]
    assert search.passed_over["no such module"] == MAX_DRAWS


def test_a_point_that_simulates_replaces_a_start_that_does_not():
    def takes(size: float) -> float:
        if size < 10.0:
            raise SimulationError("it cannot be simulated")
        return size if size < 40.0 else np.inf

    search, messages = searches(2, own=2.0, takes=takes)
    first, second = sizes(search)
    assert 10.0 <= first < 40.0
    assert second == pytest.approx(next(size for size in drawn(50) if 10.0 <= size < 40.0))
    assert search.model.start[0] == first
    assert search.cycle["time"] == first
    assert messages == ["looking for a start: the study's own cannot be simulated"]


def test_where_no_point_can_be_simulated_the_error_says_what_to_do():
    def takes(_: float) -> float:
        raise SimulationError("it cannot be simulated")

    with pytest.raises(SimulationError, match=r"it cannot be simulated; neither can 100 points .* set `module` to"):
        searches(2, takes=takes)


def _points(starts: int, size: int, seed: int, count: int) -> np.ndarray:
    return np.array(list(itertools.islice(unit_points(starts, size, seed), count)))


def test_a_seed_gives_its_points_evenly_spread_if_many():
    for starts in (3, 64):
        assert np.array_equal(_points(starts, 4, 1, 50), _points(starts, 4, 1, 50))
        assert not np.allclose(_points(starts, 4, 1, 50), _points(starts, 4, 2, 50))
    # numpy's generator, number for number.
    assert np.array_equal(_points(FEW, 3, 7, 10), np.random.default_rng(7).random((10, 3)))
    # A Sobol sequence of 2^k points has one in each of 2^k slices; random points leave a third of them empty.
    points = _points(64, 12, 1, 64)
    for column in points.T:
        assert len(set((column * 64).astype(int))) == 64
    assert qmc.discrepancy(points) < 0.5 * qmc.discrepancy(np.random.default_rng(1).random((64, 12)))


STUDY = sample_text("started_often")


def test_no_search_begins_with_a_core_wider_than_the_layer_s_inner_edge():
    """Nor with a wall inside the rotor's rim: heat would flow from cold to hot there."""
    optimizer = Optimizer(read_study_text(STUDY, "test"))
    place = optimizer.model.index
    begins = list(optimizer.multistart.points())
    assert len(begins) == 8
    for begin in begins:
        values = optimizer.model.values(begin, optimizer.multistart.cycle)
        assert begin[place["core_radius"]] < begin[place["pcl_inner_radius"]]
        assert values["rotor_radius"] < values["housing_inner_radius"]
    assert optimizer.multistart.passed_over["no such module"] > 0


def test_starts_of_a_module_with_links_that_correct_others_differ():
    # A link that corrects another is below zero at the study's start, too: no reason to pass over a point.
    study = read_study(study_path("wrist_compression"))
    study = study.model_copy(update={"solver": study.solver.model_copy(update={"starts": 3})})
    multistart = Optimizer(study).multistart
    begins = list(multistart.points())
    assert not multistart.heats(begins[0])
    assert len({begin.tobytes() for begin in begins}) == 3
    assert all(multistart.trial(begin) is not None for begin in begins)


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
def test_a_start_is_led_to_what_is_as_good_as_the_best_of_all_turns():
    # A start with more coils ends in an optimum with a better one a turn beside it, which the solver does not leave.
    study = read_study(study_path("ankle"))
    optimizer = Optimizer(study)
    run = _run_from(optimizer, coil_count=5.3)
    improved, *_ = NeighboringOptima(optimizer).improve([run])
    alone = [_kept_within(study, optimizer, turn, turn + 1.0) for turn in (3.0, 4.0, 5.0)]
    assert improved.start.objective <= (1.0 + 1e-4) * min(alone)
    assert improved.start.objective < (1.0 - 1e-3) * run.start.objective
    assert improved.start.by_neighbor
    assert improved.start.begin == run.start.begin
    assert improved.start.iterations > run.start.iterations


@pytest.mark.gate
def test_the_best_turn_is_not_left(optimizer):
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


def test_no_neighbor_is_tried_twice(monkeypatch):
    # One start ends in the fifth turn and is led to the third; another in the sixth is led to the fifth, and on.
    monkeypatch.setattr(refinements, "SHAKES", 0)
    tried: list[float] = []
    led = NeighboringOptima(_of_coils(1.0, tried)).improve([_ended_at(5.5), _ended_at(6.5)])
    assert [run.start.objective for run in led] == [1.0, 1.0]
    assert all(run.start.by_neighbor for run in led)
    assert tried == pytest.approx([4.5, 3.5, 2.5, 5.5])


def test_searches_begin_a_little_beside_the_best_optimum_too(monkeypatch):
    """Within a tenth of the range, 0.9 of a coil; each from the best so far, and what is no better leaves no trace."""
    monkeypatch.setattr(refinements, "SHAKES", 12)
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
    assert all(abs(size - 3.5) <= 0.9 for size in tried)


@pytest.mark.gate
def test_two_starts_that_each_found_one_half_find_the_whole(study):
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
    *unchanged, crossed = NeighboringOptima(optimizer).improve(halves)
    assert unchanged == halves
    assert crossed.start.crossed
    assert crossed.start.objective < (1.0 + 1e-4) * whole.start.objective
