"""One study's problem, built once, asked again and again: the design that is best in one thing within some bounds."""

import json
import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import asdict, dataclass, field, replace
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from tvimdesign import __version__
from tvimdesign.base.errors import InputError, SimulationError, TimeOverError
from tvimdesign.base.results_folder import PROGRESS, ResultsFolder
from tvimdesign.base.units import format_quantity
from tvimdesign.simulation.working_cycle.current_profile import Array, CurrentProfile
from tvimdesign.solve.nlp.constraints import in_words, make_constraint
from tvimdesign.solve.nlp.problem_parts import Objective
from tvimdesign.solve.nlp.solution import Solution
from tvimdesign.solve.nlp.solver_run import NO_DESIGN, Progress, Run, Trace, meaning
from tvimdesign.solve.optimizer.optimizer import Optimizer
from tvimdesign.solve.optimizer.verify_optimum import CYCLE_TOLERANCE, is_met
from tvimdesign.study import Options, SolverOptions, Study

OUT_OF_TIME = "the time limit of the search was over: raise `solver.time_limit`"
ONE_POINT = 2e-3  # Share by which two designs must differ to be two: the simulation's tolerance
MOST_BEGINS = 3
"""Count of the study's optima, the best ones, from which an end is sought: warm, as a cold start may leave them for
a worse one."""


@dataclass(frozen=True)
class Point:
    """One design of a front."""

    where: str  # Which point it is, in words
    values: dict[str, float]
    """Every input and, of the outputs, those that its objective and limits hang on, in SI by full name; once it is
    completed, every output."""
    current_profiles: dict[str, Any]
    trace: Trace | None = field(default=None, repr=False, compare=False)
    """What the solver left behind, for a neighbour to begin from."""
    objective: Objective | None = field(default=None, repr=False, compare=False)
    """What it is the best for; None for the study's own optimum."""
    cost: float = math.inf  # That objective at the solver's optimum
    root: int = 0  # The end it descends from, neighbour by neighbour


@dataclass(frozen=True)
class Failure:
    """A point that was asked for and has no design: which one, and why."""

    where: str
    reason: str
    infeasible: bool = False  # True if the search ended at limits that cannot all be met nearby


class FolderMemory:
    """The answers of a trade-off as files, one for each design that was sought, in their order."""

    def __init__(self, folder: ResultsFolder, study: Study) -> None:
        """Use what the folder holds; raises InputError where that is of another study or another version."""
        self._folder = folder
        solver = study.solver.model_copy(update={"time_limit": SolverOptions().time_limit})  # it changes no design
        asked_for = study.model_copy(update={"solver": solver})
        request = {"tvimdesign": __version__, "study": asked_for.model_dump(mode="json")}
        known = _read(folder.path / PROGRESS / "asked.json")
        if known is not None and known != request:
            raise InputError(f"{folder.out}: holds the front of another study or version; --overwrite to begin anew")
        folder.write_json(f"{PROGRESS}/asked.json", request)

    def recall(self, number: int, objective: Objective) -> Point | Failure | None:
        """Return the answer to a question; None where it is not there, or was of another objective."""
        known = _read(self._folder.path / PROGRESS / f"{number:04d}.json")
        if known is None or known["goal"] != _plain_objective(objective):
            return None
        if "reason" in known:
            return Failure(known["where"], known["reason"])
        trace = Trace(*(np.array(known["trace"][name]) for name in Trace._fields))
        entries = {name: known[name] for name in ("where", "values", "current_profiles", "cost", "root")}
        return Point(**entries, trace=trace, objective=objective)

    def keep(self, number: int, objective: Objective, outcome: Point | Failure) -> None:
        """Write an answer, every digit of it."""
        reported: dict[str, Any] = {"goal": _plain_objective(objective), "where": outcome.where}
        if isinstance(outcome, Failure):
            reported["reason"] = outcome.reason
        else:
            assert outcome.trace is not None  # whatever was sought has one
            reported |= {name: getattr(outcome, name) for name in ("values", "current_profiles", "cost", "root")}
            reported["trace"] = {name: getattr(outcome.trace, name).tolist() for name in Trace._fields}
        self._folder.write(f"{PROGRESS}/{number:04d}.json", json.dumps(reported))


def _plain_objective(objective: Objective) -> dict[str, Any]:
    return {"weights": dict(objective.weights), "bounds": [asdict(bound) for bound in objective.bounds]}


def _read(path: Path) -> dict[str, Any] | None:
    try:
        content: dict[str, Any] = json.loads(path.read_bytes())
    except (FileNotFoundError, ValueError):
        return None
    return content


class Tradeoff:
    """One study's problem with outputs that can be weighed and bounded; listed sizes and records stay the optimum's."""

    def __init__(
        self, study: Study, solution: Solution, optimizer: Optimizer, runs: Sequence[Run],
        progress: Progress = lambda _: None, memory: FolderMemory | None = None,
    ) -> None:  # fmt: skip
        """Begin from what found a study's optimum: `optimize` hands it to `keep`."""
        self.optimizer, self.progress, self._memory = optimizer, progress, memory
        chosen = {
            name: float(solution.inputs[solution.model.index[name]])
            for name, vary in optimizer.study.vary.items()
            if isinstance(vary, Options)
        }
        self._margins = dict(optimizer.margins)
        """Those of the optimum: every point begins with them, so that it hangs on no point before."""
        self._fixed = {name: (size, size) for name, size in chosen.items()}
        self.listed = [name for name, vary in study.vary.items() if isinstance(vary, Options)]
        self.reference = {name: abs(solution.values[name]) or 1.0 for name in optimizer.problem.objectives}
        numbers = [start.number for start in solution.distinct_optima()][:MOST_BEGINS]
        self._optima = [run for number in numbers for run in runs if run.start.number == number]
        inputs = {name: float(solution.inputs[i]) for name, i in solution.model.index.items()}
        current_profiles = {phase: profile.plain() for phase, profile in solution.current_profiles.items()}
        self.optimum = Point("the optimum", {**inputs, **solution.values}, current_profiles)
        if self._optima:
            self.optimum = replace(self.optimum, trace=self._optima[0].trace)
        self.points: list[Point] = [self.optimum]
        self.ends: dict[str, Point] = {}  # Where the least of an output was found before, by output
        self.requests = 0  # Count of the designs that were sought

    def weights(self, weights: dict[str, float]) -> dict[str, float]:
        """Weights of ratios to the optimum, as the problem takes them: over what it was built with."""
        built = self.optimizer.reference
        return {name: weight * built[name] / self.reference[name] for name, weight in weights.items()}

    def best(
        self, objective: Objective, where: str, near: Point | None = None, guess: Trace | None = None
    ) -> Point | Failure:
        """Return the best design for an objective: from a guess, a point nearby, or the study's optima and start.

        Where a design that was found before keeps the bounds and is better, this has ended in a worse optimum: then
        also from there.
        """
        answer = self._remembered(objective, where, partial(self._search, objective, where, near, guess))
        if isinstance(answer, Point):
            self._leave_time()
        return answer

    def _remembered(self, objective: Objective, where: str, search: Callable[[], Point | Failure]) -> Point | Failure:
        """Return the answer to a question that is remembered, or else what a search finds in time, which is then."""
        number, self.requests = self.requests, self.requests + 1
        answer = self._memory.recall(number, objective) if self._memory else None
        if answer is None and not self.optimizer.deadline.passed:
            self.progress(where)
            answer = search()
            if isinstance(answer, Failure) and self.optimizer.deadline.passed:
                return Failure(where, OUT_OF_TIME)
            if self._memory:
                self._memory.keep(number, objective, answer)
        if isinstance(answer, Point):
            self.points.append(answer)
        return answer or Failure(where, OUT_OF_TIME)

    def beside(self, point: Point, objective: Objective, where: str, *, cold: bool) -> Point | Failure:
        """Return the best design for an objective, sought from one point alone: warm, then `cold` if asked."""
        answer = self._from(point, objective, where, math.inf)
        if cold and isinstance(answer, Failure) and point.trace is not None:
            answer = self._from(replace(point, trace=None), objective, where, math.inf)
        if isinstance(answer, Point):
            self.points.append(answer)
        return answer

    def prices(self, point: Point) -> dict[str, float]:
        """Return the multiplier of each limit and end of a range at a point, by its words, the largest first."""
        assert point.trace is not None  # a point that a solver found has one
        table, problem = self.optimizer.table, self.optimizer.problem
        rows = point.trace.multipliers[problem.equation_count :]
        prices = {in_words(limit, table): abs(float(row)) for limit, row in zip(problem.limits, rows, strict=False)}
        for free, multiplier in zip(self.optimizer.free, point.trace.bound_multipliers, strict=False):
            upper = make_constraint(table, free.name, "<=", free.upper, "vary")
            lower = make_constraint(table, free.name, ">=", free.lower, "vary")
            prices[in_words(upper if multiplier > 0.0 else lower, table)] = abs(float(multiplier))
        return dict(sorted(prices.items(), key=lambda item: -item[1]))

    def _leave_time(self) -> None:
        """Leave time for the whole cycle of every point to be simulated, which takes about as long as setting up."""
        self.optimizer.deadline.leave(self.optimizer.seconds["set_up"] * (2 + len(self.points)))

    def again(self, point: Point, other: Point) -> Point | None:
        """Return a point solved again from another one; None if no better one results."""
        assert point.objective is not None  # the study's own optimum is never asked for again
        search = partial(self._from, other, point.objective, point.where, point.cost)
        answer = self._remembered(point.objective, f"{point.where}, from another side", search)
        if isinstance(answer, Failure):
            return None
        return replace(answer, where=point.where, root=other.root)

    def completed(self, point: Point) -> Point | Failure:
        """Return a point with every output of the whole working cycle, needed by the problem or not."""
        if self.optimizer.deadline.late.passed:
            return Failure(point.where, OUT_OF_TIME)
        inputs = self._inputs(point)
        current_profiles = {phase: CurrentProfile.from_plain(plain) for phase, plain in point.current_profiles.items()}
        try:
            cycle = self.optimizer.simulator.run(inputs, current_profiles)
        except SimulationError as error:
            return Failure(point.where, str(error))
        return replace(point, values=point.values | self.optimizer.model.values(inputs, cycle.values))

    def _search(self, objective: Objective, where: str, near: Point | None, guess: Trace | None) -> Point | Failure:
        answer: Point | Failure = Failure(where, "nothing to begin from")
        if guess is not None:
            answer = self._checked([self._warm(guess, objective)], objective, where)
        if near is not None and isinstance(answer, Failure):
            answer = self._checked([self._cold(self._inputs(near), objective)], objective, where)
        if isinstance(answer, Failure):
            answer = self._checked([self._warm(run.trace, objective) for run in self._optima], objective, where)
        if isinstance(answer, Failure):
            begins = [self.optimizer.model.start, self._inputs(self.optimum)]
            answer = self._checked([self._cold(begin, objective) for begin in begins], objective, where)
        if near is not None and isinstance(answer, Point):
            answer = replace(answer, root=near.root)
        keeping = [
            point for point in self.points if all(bound.residual(point.values) <= 0.0 for bound in objective.bounds)
        ]
        best = min(keeping, key=lambda point: self._value(point, objective), default=None)
        if best and (isinstance(answer, Failure) or self._better(best, answer, objective)):
            again = self._from(best, objective, where, math.inf if isinstance(answer, Failure) else answer.cost)
            answer = replace(again, root=best.root) if isinstance(again, Point) else answer
        return answer

    def _better(self, point: Point, other: Point, objective: Objective) -> bool:
        """Return whether a design is better than another by more than the simulation's tolerance."""
        return self._value(point, objective) < self._value(other, objective) * (1.0 - ONE_POINT)

    def _value(self, point: Point, objective: Objective) -> float:
        built = self.optimizer.reference
        return sum(weight * point.values[name] / built[name] for name, weight in objective.weights.items())

    def _from(self, point: Point, objective: Objective, where: str, beaten: float) -> Point | Failure:
        """Return the best design from a point, if it costs less than the value to beat."""
        run = self._cold(self._inputs(point), objective) if point.trace is None else self._warm(point.trace, objective)
        if run.start.converged and not run.start.objective < beaten * (1.0 - ONE_POINT):
            return Failure(where, "no better")
        return self._checked([run], objective, where)

    def _inputs(self, point: Point) -> Array:
        return np.array([point.values[name] for name in self.optimizer.model.names])

    def _warm(self, trace: Trace, objective: Objective) -> Run:
        return self.optimizer.solve(self._fixed, warm=trace, objective=objective)

    def _cold(self, begin: Array, objective: Objective) -> Run:
        return self.optimizer.solve(self._fixed, begin=begin, objective=objective)

    def _checked(self, runs: Sequence[Run], objective: Objective, where: str) -> Point | Failure:
        """Return the best of some runs that satisfies every limit in simulation, or the reason why there is none."""
        last = runs[-1].start.status if runs else ""
        reason = f"not converged: {meaning(last).words}" if runs else "nothing to begin from"
        for run in self._robust(
            sorted((run for run in runs if run.start.converged), key=lambda r: r.start.objective), objective
        ):
            checked = self._simulated(run, objective, where)
            if isinstance(checked, Point):
                return checked
            reason = checked
        return Failure(where, reason, last == NO_DESIGN)

    def _robust(self, runs: Sequence[Run], objective: Objective) -> Iterator[Run]:
        """Runs as they are; of a robust study sought again, from the optimum's margins to their own."""
        if not self.optimizer.study.robust:
            yield from runs
            return
        from tvimdesign.solve.uncertainty.robust import settle

        for run in runs:
            try:
                settled = settle(self.optimizer, run, self._fixed, objective)
            except TimeOverError:
                return
            finally:
                self.optimizer.margins = dict(self._margins)
            if settled.start.converged:
                yield settled

    def _simulated(self, run: Run, objective: Objective, where: str) -> Point | str:
        """Return the simulated design after a check of every limit, or the violated limit in words."""
        optimizer, problem = self.optimizer, self.optimizer.problem
        try:
            cycle = optimizer.simulator.run(run.inputs, run.current_profiles, phases=problem.phases)
        except SimulationError as error:
            return str(error)
        every = optimizer.model.values(run.inputs, cycle.values)
        values = {name: every[name] for name in problem.known}
        table = optimizer.table
        for limit in problem.limits:
            if not is_met(limit, values[limit.output], table):
                value = format_quantity(values[limit.output], table.unit(limit.output))
                return f"converged, but simulated it violates {in_words(limit, table)}: {value}"
        for bound in objective.bounds:
            size = sum(abs(factor * values[name]) for name, factor in bound.factors.items())
            if not bound.residual(values) <= CYCLE_TOLERANCE * size:
                return "converged, but simulated it is not where it was sought"
        inputs = {name: float(run.inputs[i]) for name, i in optimizer.model.index.items()}
        current_profiles = {phase: profile.plain() for phase, profile in run.current_profiles.items()}
        return Point(where, {**inputs, **values}, current_profiles, run.trace, objective, run.start.objective)
