"""Local models of the working cycle: their curvature, and the optima they lead to."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest
from support import study_path

from tvimdesign.base.deadline import NEVER
from tvimdesign.simulation.working_cycle.cycle_engine import CycleEngine, Supplied
from tvimdesign.solve.nlp import trust_region
from tvimdesign.solve.nlp.cycle_model import Curvatures, CycleModel
from tvimdesign.solve.nlp.extended_problem import ExtendedProblem
from tvimdesign.solve.nlp.problem_parts import Point
from tvimdesign.solve.optimizer.optimizer import Optimizer
from tvimdesign.study.reader import read_study


def test_curvatures_of_a_quadratic_are_exact_after_some_steps() -> None:
    # Nocedal, Wright, Numerical optimization, 2006, theorem 6.1.
    random = np.random.default_rng(0)
    size = 4
    slope, half = random.normal(size=size), random.normal(size=(size, size))
    hessian, curvatures = half + half.T, Curvatures(1, size)

    def model(x: np.ndarray) -> CycleModel:
        logarithm, slopes = slope @ x + 0.5 * x @ hessian @ x, slope + hessian @ x
        value = np.exp(np.array([logarithm]))
        return CycleModel.of(x, value, value[:, None] * slopes, curvatures.matrices)

    x = np.zeros(size)
    for _ in range(3 * size):  # an unsound step is left out
        to = x + 0.1 * random.normal(size=size)
        curvatures.learn(model(x), model(to))
        x = to
    assert np.allclose(curvatures.matrices[0], hessian, rtol=1e-6, atol=1e-6)
    there = x + 0.3
    values, slopes = model(x)(there)
    exact = model(there)
    assert np.allclose(values, exact.values, rtol=1e-9)
    assert np.allclose(slopes, exact.values[:, None] * exact.slopes, rtol=1e-6)


@pytest.mark.gate
@pytest.mark.parametrize("study", ["wrist_joint", "elbow_printed"])
def test_models_lead_to_the_optimum_of_the_cycle_in_fewer_cycles(study: str, monkeypatch: pytest.MonkeyPatch) -> None:
    runs = [0]
    run = CycleEngine.run

    def counted(self: CycleEngine, *given: Any, **named: Any) -> Supplied:
        runs[0] += 1
        return run(self, *given, **named)

    monkeypatch.setattr(CycleEngine, "run", counted)
    optimizer = Optimizer(read_study(study_path(study)))
    before = runs[0]
    by_models, count = optimizer.solve(), runs[0]
    assert count - before <= by_models.start.iterations + 7  # one a step; others where steps in time are placed
    monkeypatch.setattr(trust_region, "MOST_CYCLES", 0)
    runs[0] = 0
    on_cycle = Optimizer(read_study(study_path(study))).solve()
    assert by_models.start.converged
    assert on_cycle.start.converged
    assert by_models.start.objective <= on_cycle.start.objective * (1.0 + 1e-6)
    assert count < runs[0]


@pytest.mark.parametrize(
    ("objective", "breach", "taken"),
    [(0.9, 0.2, True), (1.1, 0.1, False), (5.0, 0.05, False), (1.5, 0.05, True), (2.0, 0.0, True), (2.1, 0.0, False)],
)
def test_a_step_is_taken_if_it_beats_each_point_in_one_way(objective: float, breach: float, *, taken: bool) -> None:
    # Fletcher, Leyffer, Math. Program. 91, 2002: a filter of pairs of objective and breach.
    model = SimpleNamespace(switch_names=())
    problem = SimpleNamespace(model=model, unknown_count=1)
    programme = cast(ExtendedProblem, SimpleNamespace(problem=problem))
    ends = {"lbg": np.array([-np.inf]), "ubg": np.zeros(1)}
    region = trust_region.TrustRegion(programme, lambda _: cast(Any, None), NEVER, ends)
    region._filter = [(1.0, 0.1), (2.0, 0.0)]
    assert region._better(cast(Point, SimpleNamespace(objective=objective, rows=np.array([breach])))) is taken
