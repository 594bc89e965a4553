"""The spread in the nonlinear program, and its trust region."""

from __future__ import annotations

import math
import subprocess
import sys
from contextlib import nullcontext
from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest
from scipy import stats
from scipy.stats import qmc
from support import study_path

from tvimdesign.base.deadline import NEVER
from tvimdesign.simulation.working_cycle.cycle import CycleEngine, Supplied
from tvimdesign.simulation.working_cycle.device_functions import DeviceFunctions, resolve_study
from tvimdesign.solve.nlp import spread, trust_region
from tvimdesign.solve.nlp.decision_vector import ExtendedProblem
from tvimdesign.solve.nlp.problem_parts import Curvatures, CycleModel, Point
from tvimdesign.solve.nlp.solver_run import NO_DESIGN
from tvimdesign.solve.nlp.spread import Contributor, moments, sobol_points
from tvimdesign.solve.optimizer.optimizer import Optimizer
from tvimdesign.solve.uncertainty.uncertain_inputs import UnmeasuredInput, draw
from tvimdesign.study import read_study_text
from tvimdesign.study.reader import read_study

PARTS = [Contributor("a", 1.0, 0.3), Contributor("b", 2.0, 0.3, "uniform"), Contributor("c", -1.0, 0.2, sigma=2.0)]
SLOPES = np.array([[2.0, -3.0, 1.0], [0.0, 0.0, 5.0]])


def _linear(columns: np.ndarray) -> np.ndarray:
    return SLOPES @ columns


def _drawn(function: spread.Columns, parts: list[Contributor], samples: int, seed: int) -> spread.MonteCarlo:
    return spread.moments_of(spread.drawn_values(function, parts, samples, seed))


def test_of_a_linear_function_all_three_agree_with_algebra():
    deviations = [0.1, 0.3 / math.sqrt(3.0), 0.1]
    expected = [math.hypot(2.0 * deviations[0], 3.0 * deviations[1], deviations[2]), 5.0 * deviations[2]]
    deviation, shares = spread.shares(PARTS, SLOPES)
    assert deviation == pytest.approx(expected, rel=1e-12)
    assert np.sum(shares, axis=1) == pytest.approx(1.0)
    drawn = _drawn(_linear, PARTS, 1 << 16, seed=1)
    assert drawn.mean == pytest.approx([-5.0, -5.0], abs=1e-4)
    assert drawn.deviation == pytest.approx(expected, rel=1e-3)
    worst = spread.worst_case(_linear, PARTS, SLOPES)
    assert worst.low == pytest.approx([-5.0 - 0.6 - 0.9 - 0.2, -6.0])
    assert worst.high == pytest.approx([-5.0 + 0.6 + 0.9 + 0.2, -4.0])
    assert worst.by_sign.all()
    assert worst.corners == 8


def test_a_normal_part_has_the_quantiles_and_yield_of_its_distribution():
    drawn = _drawn(lambda x: x, PARTS[:1], 1 << 16, seed=1)
    assert drawn.low[0] == pytest.approx(1.0 - 3.0 * 0.1, abs=2e-3)
    assert drawn.high[0] == pytest.approx(1.0 + 3.0 * 0.1, abs=2e-3)
    drawn = _drawn(lambda x: x, PARTS[:1], 1 << 16, seed=2)
    share = spread.share_kept(drawn.values[0] <= 1.1)  # one standard deviation above the mean
    assert share.share == pytest.approx(0.841345, abs=1e-4)
    assert share.low < 0.841345 < share.high
    assert spread.capability(1.0, 0.1, 1.3, "<=") == pytest.approx(1.0)
    assert spread.capability(1.0, 0.1, 1.3, ">=") == pytest.approx(-1.0)


def test_the_worst_case_bounds_every_module_within_tolerance():
    parts = [Contributor(name, 1.0, 0.4, "uniform") for name in "abc"]

    def bent(x: np.ndarray) -> np.ndarray:
        return np.array([x[0] * x[1] / x[2], np.exp(x[0]) - x[1] * x[2]])

    slopes = np.array([[1.0, 1.0, -1.0], [math.e, -1.0, -1.0]])
    worst = spread.worst_case(bent, parts, slopes)
    drawn = _drawn(bent, parts, 1 << 12, seed=3)
    assert np.all(drawn.values.min(axis=1) >= worst.low)
    assert np.all(drawn.values.max(axis=1) <= worst.high)


def test_a_corner_that_the_derivative_does_not_point_to_is_found():
    parts = [Contributor("a", 0.1, 1.0, "uniform")]
    worst = spread.worst_case(lambda x: x**2, parts, np.array([[-1.0]]))  # a slope of the wrong sign
    assert worst.high[0] == pytest.approx(1.1**2)
    assert not worst.by_sign[0]


def test_sobol_indices_of_ishigamis_function_are_the_published_ones():
    # Ishigami and Homma 1990 with a = 7, b = 0.1; indices from the closed form, as in Saltelli et al. 2008, table 4.2.
    parts = [Contributor(name, 0.0, math.pi, "uniform") for name in "abc"]

    def ishigami(x: np.ndarray) -> np.ndarray:
        return (np.sin(x[0]) + 7.0 * np.sin(x[1]) ** 2 + 0.1 * x[2] ** 4 * np.sin(x[0]))[None]

    first, total = spread.sobol_indices(ishigami, parts, 1 << 12, 1, 0.0)
    assert first[0] == pytest.approx([0.3139, 0.4424, 0.0], abs=5e-3)
    assert total[0] == pytest.approx([0.5576, 0.4424, 0.2437], abs=5e-3)


@pytest.mark.parametrize(("good", "count"), [(0, 50), (37, 50), (50, 50), (999, 1000)])
def test_the_interval_of_a_yield_is_wilsons(good, count):
    share = spread.share_kept(np.arange(count) < good)
    expected = stats.binomtest(good, count).proportion_ci(method="wilson")
    assert (share.low, share.high) == pytest.approx((expected.low, expected.high), abs=1e-6)


def test_what_never_happens_is_counted_and_left_out_of_the_mean():
    parts = [Contributor("a", 0.0, 1.0, "uniform")]
    drawn = _drawn(lambda x: np.where(x > 0.5, np.inf, x), parts, 1 << 12, seed=1)
    assert drawn.never[0] == pytest.approx(0.25, abs=1e-3)
    assert drawn.mean[0] == pytest.approx(-0.25, abs=1e-3)
    assert spread.share_kept(drawn.values[0] <= 9.0).share == pytest.approx(0.75, abs=1e-3)


def test_draws_stay_within_limits_and_samples_are_a_power_of_two():
    part = Contributor("a", 0.1, 0.3, lower=0.0)
    assert part.ends == (0.0, pytest.approx(0.4))
    assert part.ppf(np.array([1e-6, 0.5])) == pytest.approx([0.0, 0.1])
    assert [spread.power_of_two(n) for n in (256, 257, 100_000)] == [256, 512, 131_072]


def test_the_last_of_several_chunks_has_what_is_left(monkeypatch):
    whole = _drawn(_linear, PARTS, 8, seed=1).values
    monkeypatch.setattr(spread, "CHUNK", 8)
    chunks: list[int] = []

    def counted(columns: np.ndarray) -> np.ndarray:
        chunks.append(columns.shape[1])
        return _linear(columns)

    drawn = _drawn(counted, PARTS, 20, seed=1)
    assert chunks == [8, 8, 4]
    assert drawn.values.shape == (2, 20)
    assert np.array_equal(drawn.values[:, :8], whole)


@pytest.mark.parametrize(("inputs", "count", "seed"), [(1, 8, 1), (7, 64, 3), (40, 512, 11)])
def test_ranges_are_drawn_as_scipys_latin_hypercube(inputs, count, seed):
    shares = [UnmeasuredInput(f"share_{i}", 0.5, 0.0, 1.0, "assumed") for i in range(inputs)]
    expected = qmc.LatinHypercube(inputs, rng=np.random.default_rng(seed)).random(count).T
    assert np.array_equal(draw(shares, count, seed), expected)


def test_kept_points_are_scipys_and_scipy_is_not_loaded_for_them(tmp_path, monkeypatch):
    monkeypatch.setenv("TVIMDESIGN_CACHE", str(tmp_path))
    expected = qmc.Sobol(5, rng=np.random.default_rng(2)).random(64)
    assert np.array_equal(sobol_points(5, 64, 2), expected)
    again = (
        "import sys\nfrom tvimdesign.solve.nlp.spread import sobol_points\n"
        "points = sobol_points(5, 64, 2)\nassert 'scipy.stats' not in sys.modules\nprint(points.tobytes().hex())"
    )
    printed = subprocess.run([sys.executable, "-c", again], capture_output=True, text=True, check=True).stdout
    assert bytes.fromhex(printed.strip()) == expected.tobytes()


WIRE = 2e-3  # m


def _moments(tolerance: str) -> tuple[float, float, float]:
    """Value of the springs' rate, which goes with the fourth power of the wire; shift of its mean; its deviation."""
    text = f"mode: shear\nmodule: {{wire_diameter: 2 mm, leg_model: ignored}}\ntolerances: {{{tolerance}}}\n"
    module = resolve_study(read_study_text(text, "a test"))
    model = DeviceFunctions(module.table, module.values, module.points, 2)
    function = moments(model, module.study.tolerances, ["spring_rate"], [1.0])
    shift, deviation = (float(np.asarray(part).ravel()[0]) for part in function(model.start))
    return float(module.quantity("spring_rate")), shift, deviation


@pytest.mark.parametrize(
    ("tolerance", "sigma"),
    [
        ("{plus_minus: 0.03 mm, sigma: 2}", 0.015e-3),
        ("{plus_minus: 0.03 mm, distribution: uniform}", 0.03e-3 / math.sqrt(3.0)),
        ("1.5 %", 0.01e-3),
        ("{plus_minus: 0.03 mm, adjustable: true, adjusted_to: 0.006 mm}", 0.002e-3),
    ],
)
def test_a_fourth_power_has_the_moments_of_one(tolerance, sigma):
    """Of k = c d^4, to second order: deviation 4 k sigma/d, shift of the mean 6 k (sigma/d)^2."""
    rate, shift, deviation = _moments(f"wire_diameter: {tolerance}")
    assert deviation == pytest.approx(4.0 * rate * sigma / WIRE, rel=1e-9)
    assert shift == pytest.approx(6.0 * rate * (sigma / WIRE) ** 2, rel=1e-9)
    # Variances add; the rate is proportional to Young's modulus, 3 % at three sigma are a hundredth of it.
    rate, _, deviation = _moments("wire_diameter: {plus_minus: 0.03 mm}, spring_youngs_modulus: 3 %")
    assert deviation == pytest.approx(rate * math.hypot(4.0 * 0.01e-3 / WIRE, 0.01), rel=1e-9)


def test_curvatures_of_a_quadratic_are_exact_after_some_steps():
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
@pytest.mark.parametrize("study", ["wrist_joint", "elbow_machined"])
def test_models_lead_to_the_optimum_of_the_cycle_in_fewer_cycles(study, monkeypatch):
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


def test_a_model_that_is_sure_of_no_design_ends_a_run_sooner(monkeypatch):
    study = read_study(study_path("wrist_joint"))
    limits = [
        limit.model_copy(update={"limit": 0.5 * limit.limit})
        if limit.output in ("envelope_diameter", "response_time") else limit for limit in study.require
    ]  # fmt: skip
    sure = Optimizer(study.model_copy(update={"require": limits})).solve()
    monkeypatch.setattr(trust_region, "CERTAIN", 0.0)
    unsure = Optimizer(study.model_copy(update={"require": limits})).solve()
    assert sure.start.status == unsure.start.status == NO_DESIGN
    assert sure.start.iterations < unsure.start.iterations


@pytest.mark.parametrize(("worth", "steps"), [(1e-4, 1), (1e-2, trust_region.MOST_CYCLES)])
def test_a_search_for_more_of_a_further_unknown_ends_where_it_creeps(worth, steps):
    """Maximise a share whose model gains `worth` a step, and never ends by its slope."""

    def point(x: np.ndarray) -> Any:
        return SimpleNamespace(
            objective=-worth * round(float(x[1]) * 1e3), rows=np.zeros(1), gradient=np.array([0.0, -1.0]),
            jacobian=np.zeros((1, 2)), cycle=np.ones(1), of_cycle=np.zeros((1, 1)),
        )  # fmt: skip

    problem = SimpleNamespace(
        model=SimpleNamespace(switch_names=("time",)), unknown_count=1, events=["time"],
        modelled=lambda _: nullcontext(),
    )  # fmt: skip
    ends = {"lbx": np.zeros(2), "ubx": np.ones(2), "lbg": np.full(1, -np.inf), "ubg": np.zeros(1)}

    class Creeping:
        share, feasible = 0.0, False

        def __call__(self, *_: Any, **__: Any) -> dict[str, Any]:
            self.share += 1e-3
            return {"x": np.array([0.5, self.share]), "lam_g": np.zeros(1), "lam_x": np.zeros(2)}

        def stats(self) -> dict[str, Any]:
            return {"success": True, "return_status": "Solve_Succeeded"}

    solver = Creeping()
    programme = cast(ExtendedProblem, SimpleNamespace(problem=problem, at=point))
    region = trust_region.TrustRegion(programme, cast(Any, solver), NEVER, ends)
    region.solve(np.array([0.5, 0.0]), near=True)
    assert region.iterations == steps


@pytest.mark.parametrize(
    ("objective", "breach", "taken"),
    [(0.9, 0.2, True), (1.1, 0.1, False), (5.0, 0.05, False), (1.5, 0.05, True), (2.0, 0.0, True), (2.1, 0.0, False)],
)
def test_a_step_is_taken_if_it_beats_each_point_in_one_way(objective, breach, *, taken):
    # Fletcher, Leyffer, Math. Program. 91, 2002: a filter of pairs of objective and breach.
    model = SimpleNamespace(switch_names=())
    problem = SimpleNamespace(model=model, unknown_count=1)
    programme = cast(ExtendedProblem, SimpleNamespace(problem=problem))
    ends = {"lbg": np.array([-np.inf]), "ubg": np.zeros(1)}
    region = trust_region.TrustRegion(programme, cast(Any, None), NEVER, ends)
    region._filter = [(1.0, 0.1), (2.0, 0.0)]
    assert region._better(cast(Point, SimpleNamespace(objective=objective, rows=np.array([breach])))) is taken
