"""Optimises a study: IPOPT from several recorded starts, every solution simulated and checked again outside IPOPT."""

from __future__ import annotations

import itertools
import time
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tvimdesign.catalog import Catalog
from tvimdesign.device import Event, Input, Path, Table
from tvimdesign.errors import InfeasibleError, InputError
from tvimdesign.solve.backend import ca
from tvimdesign.solve.limits import Limit, in_words, limits_of
from tvimdesign.solve.model import Model
from tvimdesign.solve.problem import Free, Problem
from tvimdesign.solve.simulate import Simulator, Switch
from tvimdesign.solve.transcription import guess
from tvimdesign.study import Options, Range, Study, given

Array = NDArray[np.float64]
Progress = Callable[[str], None]

ALGEBRAIC_TOLERANCE = 1e-6
"""Share of its scale by which a limit on an algebraic row may be broken: IPOPT's own tolerance with a margin."""
SWITCH_TOLERANCE = 2e-3
"""The same for rows that depend on a switch: collocation and the simulation that checks it differ by up to this."""
SAME_OPTIMUM = 1e-4
MAX_COMBINATIONS = 500

_IPOPT = {
    "print_level": 0,
    "sb": "yes",
    "linear_solver": "mumps",
    "mu_init": 1e-3,
    # The bounds of a study are exact: IPOPT's usual relaxation of 1e-8 stays, and the point is put back inside.
    "honor_original_bounds": "yes",
}
_WARM = {
    "warm_start_init_point": "yes",
    "mu_init": 1e-7,
    "warm_start_bound_push": 1e-6,
    "warm_start_mult_bound_push": 1e-6,
    "warm_start_slack_bound_push": 1e-6,
}


@dataclass(frozen=True)
class Start:
    """One run of the solver: where it began, how it ended. Plain data for the report."""

    number: int
    status: str
    converged: bool
    iterations: int
    objective: float
    seconds: float
    begin: dict[str, float]
    end: dict[str, float]
    choices: dict[str, str | float] = field(default_factory=dict)


@dataclass(frozen=True)
class Held:
    """One limit or bound at the solution: its residual (share of its scale, kept where <= 0) and what it costs.

    `price` is the share of the objective that relaxing it by 1 % of its scale would save, in percent.
    """

    name: str
    text: str
    residual: float
    price: float
    origin: str


@dataclass(frozen=True)
class Solution:
    """The best design found, with the account of how."""

    status: str
    feasible: bool
    model: Model
    inputs: Array
    switch: Switch
    values: dict[str, float]
    objective: float
    starts: tuple[Start, ...]
    held: tuple[Held, ...]
    reference: dict[str, float]
    """Value of each minimised output at the study's start; the objective is the weighted sum of the ratios to it."""
    seconds: dict[str, float]


@dataclass
class _Run:
    """What IPOPT left behind at one start."""

    start: Start
    inputs: Array
    unknowns: Array
    multipliers: Array
    bound_multipliers: Array


class Optimizer:
    """One study with its records chosen: the problem and its solvers, built once."""

    def __init__(self, study: Study, catalog: Catalog, table: Table, progress: Progress = lambda _: None) -> None:
        """Compile the device, simulate the study's start, and build the problem. Raises InfeasibleError, InputError."""
        self.study, self.table, self.progress = study, table, progress
        began = time.perf_counter()
        self.model = Model(table, given(study, catalog, table), tuple(study.operating_points), study.solver.cells)
        self.simulator = Simulator(self.model)
        self.start_switch = self.simulator.run(self.model.start)
        self.start_values = self.model.values(self.model.start, self.start_switch.values)
        self.free = tuple(self._free(name) for name in study.vary if isinstance(table.row(name), Input))
        self.problem = self._problem(limits_of(study, table))
        self.reference = {name: self._reference(name) for name in study.minimize}
        self._solvers: dict[bool, Any] = {}
        self.seconds = {"set_up": time.perf_counter() - began, "solve": 0.0}

    def _free(self, name: str) -> Free:
        vary = self.study.vary[name]
        reference = self.model.start[self.model.index[name]]
        if isinstance(vary, Range):
            lower, upper = vary.lower, vary.upper
        else:
            numbers = [float(value) for value in vary.values]
            lower, upper = min(numbers), max(numbers)
        return Free(name, lower, upper, reference if reference != 0.0 else upper)

    def _problem(self, limits: list[Limit]) -> Problem:
        """The problem without the limits that nothing free can change; those are checked here and now."""
        draft = Problem(self.model, self.free, limits, tuple(self.study.minimize), self.study.solver.elements)
        draft.check()
        constant = draft.constant_limits()
        for limit in constant:
            value = self.start_values[limit.output]
            if not limit.residual(value) <= ALGEBRAIC_TOLERANCE:
                raise InfeasibleError(
                    f"{in_words(limit, self.table)} does not hold, and nothing under `vary` can change it; "
                    f"vary one of: {', '.join(self._variables_behind(limit.output))}"
                )
        if not constant:
            return draft
        kept = [limit for limit in limits if limit not in constant]
        return Problem(self.model, self.free, kept, tuple(self.study.minimize), self.study.solver.elements)

    def _variables_behind(self, name: str) -> list[str]:
        above = self.table.ancestors(name)
        return [row.name for row in self.table.inputs if row.variable and row.name in above] or ["(nothing can)"]

    def _reference(self, name: str) -> float:
        value = self.start_values[name]
        if not np.isfinite(value):
            horizon = self.model.start[self.model.index["horizon"]]
            self.progress(f"{name} is not reached by the study's own start within {horizon:g} s")
            return float(horizon)
        return value if value != 0.0 else 1.0

    def _solver(self, warm: bool) -> Any:
        if warm not in self._solvers:
            options = {
                **_IPOPT, **(_WARM if warm else {}),
                "max_iter": self.study.solver.max_iterations, "tol": self.study.solver.tolerance,
            }  # fmt: skip
            self._solvers[warm] = ca.nlpsol(
                "design", "ipopt", self.problem.function, {"ipopt": options, "print_time": False}
            )
        return self._solvers[warm]

    # --- starts ---

    def begin_points(self) -> Iterator[Array]:
        """Inputs to start from: the study's own, then random ones between the bounds, seeded."""
        yield self.model.start
        random = np.random.default_rng(self.study.solver.seed)
        for _ in range(self.study.solver.starts - 1):
            yield self.random_point(random)

    def random_point(self, random: np.random.Generator) -> Array:
        """Inputs with every free number drawn evenly between its bounds (of its logarithm, where it is positive)."""
        point = self.model.start.copy()
        for free in self.free:
            low, high = free.to_unknown(free.lower), free.to_unknown(free.upper)
            point[self.model.index[free.name]] = free.to_value(random.uniform(low, high))
        return point

    def _guess(self, inputs: Array) -> Array:
        """Unknowns at a point: the free numbers, and the switch simulated there (the start's where it stalls)."""
        switch = self.simulator.run(inputs) if inputs is not self.model.start else self.start_switch
        if not np.isfinite(switch.values["response_time"]):
            switch = self.start_switch
        parts = [np.array([f.to_unknown(inputs[self.model.index[f.name]]) for f in self.free])]
        for block in self.problem.blocks:
            end = switch.values[block.event]
            end = end if np.isfinite(end) else switch.trajectory.times[-1]
            parts += [guess(switch.trajectory, self.problem.elements).ravel(order="F"), [np.log(max(end, 1e-3))]]
        for name in self.problem.peaks:
            row = self.table.row(name)
            assert isinstance(row, Path)
            parts.append([switch.values[name] / self.problem.peak_scale(row)])
        return np.concatenate(parts)

    # --- solving ---

    def solve(self, fixed: Mapping[str, float] | None = None, warm: _Run | None = None, number: int = 0,
              begin: Array | None = None) -> _Run:  # fmt: skip
        """Run IPOPT once from `begin` (the study's start), or warm from an earlier run, with some numbers fixed."""
        inputs = self.model.start if begin is None else begin
        clock = time.perf_counter()
        lower, upper = self._bounds(fixed or {})
        solver = self._solver(warm is not None)
        arguments: dict[str, Any] = {"x0": self._guess(inputs) if warm is None else warm.unknowns}
        if warm is not None:
            arguments |= {"lam_g0": warm.multipliers, "lam_x0": warm.bound_multipliers}
        weights = [self.study.minimize[name] / self.reference[name] for name in self.problem.minimize]
        equations = self.problem.equation_count
        rest = len(self.problem.limits) + self.problem.peak_count
        answer = solver(
            **arguments, p=np.concatenate([self.model.start, weights]), lbx=lower, ubx=upper,
            lbg=np.concatenate([np.zeros(equations), np.full(rest, -np.inf)]), ubg=np.zeros(equations + rest),
        )  # fmt: skip
        stats = solver.stats()
        unknowns = np.asarray(answer["x"]).ravel()
        seconds = time.perf_counter() - clock
        self.seconds["solve"] += seconds
        end = self._inputs_of(unknowns)
        start = Start(
            number=number, status=stats["return_status"], converged=bool(stats["success"]),
            iterations=int(stats["iter_count"]), objective=float(answer["f"]), seconds=seconds,
            begin=self._free_values(inputs), end=self._free_values(end),
        )  # fmt: skip
        return _Run(start, end, unknowns, np.asarray(answer["lam_g"]).ravel(), np.asarray(answer["lam_x"]).ravel())

    def _bounds(self, fixed: Mapping[str, float]) -> tuple[Array, Array]:
        lower = np.full(self.problem.unknown_count, -np.inf)
        upper = np.full(self.problem.unknown_count, np.inf)
        for i, free in enumerate(self.free):
            low, high = (fixed[free.name],) * 2 if free.name in fixed else (free.lower, free.upper)
            lower[i], upper[i] = free.to_unknown(low), free.to_unknown(high)
        return lower, upper

    def _inputs_of(self, unknowns: Array) -> Array:
        inputs = self.model.start.copy()
        for i, free in enumerate(self.free):
            inputs[self.model.index[free.name]] = min(max(free.to_value(unknowns[i]), free.lower), free.upper)
        return inputs

    def _free_values(self, inputs: Array) -> dict[str, float]:
        return {free.name: float(inputs[self.model.index[free.name]]) for free in self.free}

    # --- the account of a solution ---

    def solution(self, run: _Run, starts: tuple[Start, ...]) -> Solution:
        """Simulate and check a run's design again, and say what holds it."""
        switch = self.simulator.run(run.inputs)
        values = self.model.values(run.inputs, switch.values)
        held = self._held(run, values)
        feasible = all(h.residual <= self._tolerance(h.name) for h in held)
        if run.start.converged:
            status = "optimal" if feasible else "converged, but the check outside the solver fails"
        else:
            status = f"not converged: {run.start.status}"
        return Solution(
            status=status, feasible=feasible, model=self.model, inputs=run.inputs, switch=switch, values=values,
            objective=sum(w * values[n] / self.reference[n] for n, w in self.study.minimize.items()),
            starts=starts, held=held, reference=self.reference, seconds=dict(self.seconds),
        )  # fmt: skip

    def _tolerance(self, name: str) -> float:
        output = name.split(" ")[0]
        if output not in self.model.output_names:
            return ALGEBRAIC_TOLERANCE
        above = (output.partition("@")[0], *self.table.ancestors(output))
        switched = any(isinstance(self.table.row(base), Event | Path) for base in above)
        return SWITCH_TOLERANCE if switched else ALGEBRAIC_TOLERANCE

    def _held(self, run: _Run, values: dict[str, float]) -> tuple[Held, ...]:
        first = self.problem.equation_count
        prices = run.multipliers[first : first + len(self.problem.limits)]
        objective = run.start.objective or 1.0
        found = [
            Held(limit.name, in_words(limit, self.table), float(limit.residual(values[limit.output])),
                 float(price / objective), limit.origin)  # fmt: skip
            for limit, price in zip(self.problem.limits, prices, strict=True)
        ]
        for i, free in enumerate(self.free):
            value, price = run.inputs[self.model.index[free.name]], run.bound_multipliers[i]
            for sense, bound, sign in (("<=", free.upper, 1.0), (">=", free.lower, -1.0)):
                limit = Limit(free.name, sense, bound, abs(bound) or free.reference, "vary")  # type: ignore[arg-type]
                per_scale = limit.scale / (value if free.logarithmic else free.reference)
                found.append(Held(
                    limit.name, in_words(limit, self.table), float(limit.residual(value)),
                    max(sign * float(price), 0.0) * per_scale / objective, "vary",
                ))  # fmt: skip
        return tuple(found)


def optimize(study: Study, catalog: Catalog, table: Table, progress: Progress = lambda _: None) -> Solution:
    """Find the best design of a study: every start, every listed choice. Raises InputError, InfeasibleError."""
    best: tuple[Optimizer, _Run] | None = None
    starts: list[Start] = []
    seconds = {"set_up": 0.0, "solve": 0.0}
    for records in _record_choices(study, table):
        optimizer = Optimizer(_with_records(study, records), catalog, table, progress)
        for run in _runs(optimizer, progress):
            run.start = _numbered(run.start, len(starts), records)
            starts.append(run.start)
            if best is None or _better(run.start, best[1].start):
                best = (optimizer, run)
        seconds = {key: seconds[key] + optimizer.seconds[key] for key in seconds}
    assert best is not None  # there is always one combination and one start
    optimizer, run = best
    optimizer.seconds = seconds
    return optimizer.solution(run, tuple(starts))


def _runs(optimizer: Optimizer, progress: Progress) -> Iterator[_Run]:
    """Every start on the relaxed problem; where sizes are listed, every combination of them after that, warm."""
    relaxed = []
    for number, begin in enumerate(optimizer.begin_points()):
        run = optimizer.solve(number=number, begin=begin)
        progress(f"start {number + 1} of {optimizer.study.solver.starts}: {run.start.status}, {run.start.iterations} it.")
        relaxed.append(run)
    listed = {
        name: vary.values for name, vary in optimizer.study.vary.items()
        if isinstance(vary, Options) and name in {free.name for free in optimizer.free}
    }  # fmt: skip
    if not listed:
        yield from relaxed
        return
    best = min(relaxed, key=lambda run: (not run.start.converged, run.start.objective))
    combinations = list(itertools.product(*listed.values()))
    if len(combinations) > MAX_COMBINATIONS:
        raise InputError(f"vary: {len(combinations)} combinations of listed sizes; the limit is {MAX_COMBINATIONS}")
    for combination in combinations:
        fixed = {name: float(value) for name, value in zip(listed, combination, strict=True)}
        run = optimizer.solve(fixed, warm=best if best.start.converged else None)
        if not run.start.converged:
            run = optimizer.solve(fixed)
        yield run


def _better(one: Start, other: Start) -> bool:
    return (not one.converged, one.objective) < (not other.converged, other.objective)


def _numbered(start: Start, number: int, records: Mapping[str, str]) -> Start:
    return Start(**{**start.__dict__, "number": number, "choices": dict(records)})


def _record_choices(study: Study, table: Table) -> Iterator[dict[str, str]]:
    """Every combination of the records and options a study lists."""
    listed = {
        name: [str(value) for value in vary.values]
        for name, vary in study.vary.items()
        if isinstance(vary, Options) and not isinstance(table.row(name), Input)
    }
    for combination in itertools.product(*listed.values()):
        yield dict(zip(listed, combination, strict=True))


def _with_records(study: Study, records: Mapping[str, str]) -> Study:
    if not records:
        return study
    vary = {name: value for name, value in study.vary.items() if name not in records}
    return study.model_copy(update={"module": {**study.module, **records}, "vary": vary})


def distinct_optima(solution: Solution) -> list[Start]:
    """Return one converged start for each different optimum, the best first; two are one within 1e-4 of objective."""
    found: list[Start] = []
    for start in sorted((s for s in solution.starts if s.converged), key=lambda s: s.objective):
        if not any(abs(start.objective - other.objective) <= SAME_OPTIMUM * abs(other.objective) for other in found):
            found.append(start)
    return found


__all__ = ["Event", "Held", "Optimizer", "Solution", "Start", "distinct_optima", "optimize"]
