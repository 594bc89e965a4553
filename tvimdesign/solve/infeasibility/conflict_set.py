"""Conflict of a study without a design: the design of least violation and a smallest set of conflicting limits.

The set is found by deletion: of the limits that press on the least violation, each is left out in turn, and stays out
where the rest still cannot be kept. Any one of those left, moved far enough, makes peace in the set; how far it must
move while all other limits hold is asked of the elastic problem once more.

In the elastic problem every limit gets a slack, its residual beyond zero; what is made small is the weighted sum of the
slacks (so that few limits move, not all a little), with a trace of the study's own objective to settle what is left
open. Equations and ranges stay as they are. Weights, and which limits count at all, are numbers: one problem, built
once, answers all.

Sources: Chinneck, Feasibility and Infeasibility in Optimization (2008), ch. 6 and 7; Nocedal and Wright, Numerical
Optimization, 2nd ed. (2006), section 18.5 (the elastic mode).
"""

import time
from collections.abc import Callable, Collection, Sequence
from dataclasses import dataclass, replace
from typing import Any, Literal

import numpy as np

from tvimdesign.base.errors import InfeasibleError, TimeOverError, TvimError
from tvimdesign.base.units import format_quantity, parse_quantity
from tvimdesign.solve.nlp.constraints import Constraint, in_words, make_constraint
from tvimdesign.solve.nlp.decision_vector import ExtendedProblem
from tvimdesign.solve.nlp.problem_parts import Objective, Parameters
from tvimdesign.solve.nlp.solution import ConflictSet, Side, Solution
from tvimdesign.solve.nlp.solver_run import FEASIBLE, OPTIMAL, Array, Progress, Run
from tvimdesign.solve.nlp.sqp import SqpSolver
from tvimdesign.solve.optimizer.optimizer import Optimizer
from tvimdesign.study import Study

TRACE = 1e-4  # Weight of the study's own objective beside the slacks
FEASIBILITY_TOL = 1e-5  # Slack, as a share of a limit's scale, below which it counts as none
_ROOM = 1e-2  # Start of slacks beyond what the first point needs


@dataclass(frozen=True)
class ElasticSolution:
    """Result of one run of the elastic problem."""

    run: Run  # Without multipliers: those of the elastic problem say nothing of the study's objective
    slacks: Array  # How far each limit was broken, in its scale; limits that did not count have none
    pressing: Array  # Multiplier of each limit: its weight where it gives, above 0 where it is part of the conflict
    ends: Array
    """Multipliers of the ranges of the free numbers: above 0 at an upper end that is in the way, below at a lower."""

    @property
    def converged(self) -> bool:
        """Validity of the numbers."""
        return self.run.start.converged

    @property
    def conflict_search(self) -> bool:
        """Feasibility of all limits that counted."""
        return self.converged and bool(np.max(self.slacks, initial=0.0) <= FEASIBILITY_TOL)


class ElasticMode:
    """An optimizer's problem with a slack on every limit, and one for all that a requirement is put on at once."""

    def __init__(self, optimizer: Optimizer) -> None:
        self.optimizer, problem = optimizer, optimizer.problem
        keys = [(limit.part_of or limit.output, limit.sense, limit.limit) for limit in problem.limits]
        places = {key: place for place, key in enumerate(dict.fromkeys(keys))}
        self._slack_of = np.array([places[key] for key in keys], dtype=int)
        self.limits = [replace(problem.limits[keys.index(key)], output=key[0]) for key in places]
        """One limit for each slack: those that one requirement puts on several outputs share one, by its name."""
        self.count, self.equations = len(self.limits), problem.equation_count

    def settle(
        self, weights: Array, begin: Array, unknowns: Array | None = None, within: Collection[int] = ()
    ) -> ElasticSolution:
        """Run it from inputs, or from another run's unknowns; `within` are the limits that count, all unless given."""
        optimizer, problem = self.optimizer, self.optimizer.problem
        clock = time.perf_counter()
        x = optimizer.guess(begin) if unknowns is None else unknowns
        parameters = optimizer.parameters(Objective(optimizer.study.minimize))
        problem.place_grids(x, parameters)
        counts = np.isin(np.arange(self.count), list(within)) if within else np.ones(self.count, dtype=bool)
        each = self._slack_of
        by_slacks = np.zeros((len(each), self.count))
        by_slacks[np.arange(len(each)), each] = -1.0
        residuals = np.zeros(self.count)
        broken = problem.at(x, parameters).rows[self.equations : self.equations + len(each)]
        np.maximum.at(residuals, each, np.nan_to_num(broken))
        slacks = np.where(counts, residuals + _ROOM, 0.0)
        lower, upper = optimizer.vector.bounds({})
        objectives, no_equations = len(problem.objectives), np.zeros(self.equations)
        answer = self._solver(
            ExtendedProblem(problem, parameters, by_slacks, weights, TRACE), optimizer.deadline,
            x0=np.concatenate([x, slacks]),
            lbx=np.concatenate([lower, np.zeros(self.count)]),
            ubx=np.concatenate([upper, np.where(counts, np.inf, 0.0)]),
            lbg=np.concatenate([no_equations, np.full(len(each) + objectives + problem.own_count, -np.inf)]),
            ubg=np.concatenate([
                no_equations, np.where(counts[each], optimizer.limits_less_margins(), np.inf),
                np.full(objectives, np.inf), np.zeros(problem.own_count),
            ]),
        )  # fmt: skip
        return self._settled(answer, begin, parameters, time.perf_counter() - clock)

    @property
    def _solver(self) -> SqpSolver:
        return self.optimizer.solver(self.optimizer.problem.unknown_count + self.count)

    def _settled(self, answer: dict[str, Any], begin: Array, parameters: Parameters, seconds: float) -> ElasticSolution:
        problem = self.optimizer.problem
        size, unknowns = problem.unknown_count, answer["x"]
        first, last = self.equations, self.equations + len(self._slack_of)
        pressing = np.zeros(self.count)
        np.add.at(pressing, self._slack_of, answer["lam_g"][first:last])
        ends = answer["lam_x"][: len(self.optimizer.free)]
        bare = {"x": unknowns[:size], "f": answer["f"], "lam_g": np.zeros(problem.row_count), "lam_x": np.zeros(size)}
        run = self.optimizer.record(bare, self._solver.stats(), begin, seconds, parameters)
        return ElasticSolution(run, np.maximum(unknowns[size:], 0.0), pressing, ends)


_HEAVY = 100.0
"""What breaking a rule of the machine costs against a requirement of the study, or a limit that is to hold."""
_FAINT = 1e-3
"""Multiplier below which a limit or the end of a range has no part in it: the trace of the objective leaves less."""
_MOST_STARTS = 5
_MOST_UNKNOWN = 3
"""Runs without a limit that may end nowhere; then the limits that the least violation breaks are named alone."""


@dataclass(frozen=True)
class ConflictSearch:
    """Result of a search for a conflict: the run of least violation, or a run that satisfies all limits."""

    run: Run
    conflict_set: ConflictSet | None


def find_conflicts(optimizer: Optimizer, failed: Sequence[Run], progress: Progress) -> ConflictSearch | None:
    """Find the conflict of a problem without a converged start; None if not even its switch can be simulated."""
    elastic = ElasticMode(optimizer)
    least = _least_violation(elastic, failed[:_MOST_STARTS], progress)
    if least is None:
        return None
    if least.conflict_search:
        run = optimizer.solve(begin=least.run.inputs, unknowns=least.run.unknowns)
        if not run.start.converged:
            run = least.run
            run.start = replace(run.start, status=FEASIBLE, converged=False)
        return ConflictSearch(run, None)
    members, ends = _conflicting(elastic, least, progress)
    least.run.start = replace(least.run.start, status="Infeasible_Problem_Detected", converged=False)
    return ConflictSearch(least.run, _conflict_set(elastic, least, members, ends, progress))


def second_try(optimizer: Optimizer, run: Run) -> Run:
    """Start a failed run again from a feasible design; return it if it converges, or else the failed one.

    Its start counts the iterations of all.
    """
    elastic = ElasticMode(optimizer)
    settled = elastic.settle(_weights(elastic), optimizer.model.inputs(run.start.begin))
    if not settled.conflict_search:
        return run
    again = optimizer.solve(begin=settled.run.inputs, unknowns=settled.run.unknowns)
    if not again.start.converged:
        return run
    parts = (run.start, settled.run.start, again.start)
    again.start = replace(
        again.start, begin=run.start.begin, second_try=True,
        iterations=sum(part.iterations for part in parts), seconds=sum(part.seconds for part in parts),
    )  # fmt: skip
    return again


def _weights(elastic: ElasticMode) -> Array:
    return np.array([1.0 if limit.origin == "require" else _HEAVY for limit in elastic.limits])


def _least_violation(elastic: ElasticMode, failed: Sequence[Run], progress: Progress) -> ElasticSolution | None:
    """Return the least sum of slacks from the ends of the starts, or else from their beginnings."""
    weights = _weights(elastic)
    solutions: list[ElasticSolution] = []
    for number, run in enumerate(failed, start=1):
        progress(f"searching for the design of least violation, from start {number} of {len(failed)}")
        settled = elastic.settle(weights, run.inputs, run.unknowns)
        if not settled.converged:
            settled = elastic.settle(weights, elastic.optimizer.model.inputs(run.start.begin))
        if settled.converged:
            solutions.append(settled)
        if settled.conflict_search:
            break
    return min(solutions, key=lambda solution: float(weights @ solution.slacks), default=None)


def _conflicting(elastic: ElasticMode, least: ElasticSolution, progress: Progress) -> tuple[list[int], Array]:
    """Return an irreducible set of limits that conflict, and the part that the ends of ranges have in it.

    Where too many runs end nowhere the set would not be small: what is broken then stands for it.
    """
    limits, weights, unknown = elastic.limits, np.ones(elastic.count), 0

    def kept_apart(within: Collection[int]) -> ElasticSolution | None:
        """Return the elastic solution if the limits conflict; None if they do not, or if that is unknown."""
        nonlocal unknown
        settled = elastic.settle(weights, least.run.inputs, least.run.unknowns, within)
        unknown += not settled.converged
        return None if settled.conflict_search or not settled.converged else settled

    candidates = [int(k) for k in np.flatnonzero((least.pressing > _FAINT) | (least.slacks > FEASIBILITY_TOL))]
    settled = kept_apart(candidates)
    if settled is None:
        candidates, settled = list(range(elastic.count)), least
    else:
        candidates = [k for k in candidates if settled.pressing[k] > _FAINT] or candidates
    # The machine's rules leave first, and the study's requirements last: those are what a user can move.
    ordered = sorted(
        candidates, key=lambda place: (limits[place].origin == "require", least.slacks[place] > FEASIBILITY_TOL)
    )
    for number, k in enumerate(ordered, start=1):
        progress(f"looking for the fewest limits that conflict, {number} of {len(ordered)}: without {limits[k].name}")
        fewer = [other for other in candidates if other != k]
        without = kept_apart(fewer) if fewer and k in candidates else None
        if unknown > _MOST_UNKNOWN:
            return [int(k) for k in np.flatnonzero(least.slacks > FEASIBILITY_TOL)], least.ends
        if without is not None:
            candidates, settled = [other for other in fewer if without.pressing[other] > _FAINT] or fewer, without
    return candidates, settled.ends


def _conflict_set(
    elastic: ElasticMode, least: ElasticSolution, members: Sequence[int], ends: Array, progress: Progress
) -> ConflictSet:
    optimizer, limits = elastic.optimizer, elastic.limits
    robust = optimizer.study.robust is not None and optimizer.study.robust.share is not None
    broken = [int(k) for k in np.flatnonzero(least.slacks > FEASIBILITY_TOL)]
    sides = []
    for number, k in enumerate(members, start=1):
        progress(f"how far limits must move, {number} of {len(members)}: {limits[k].name}")
        move, beside, run = _alone(elastic, least.run, k)
        side = _moved(optimizer, limits[k], float(least.slacks[k]), move)
        if robust and move is not None:
            side = _with_margins(elastic, side, k, run)
        sides.append(replace(side, beside=tuple(in_words(limits[other], optimizer.table) for other in beside)))
    return ConflictSet(
        broken=tuple(
            _moved(optimizer, limits[k], float(least.slacks[k]), float(least.slacks[k]) if len(broken) == 1 else None)
            for k in sorted(broken, key=lambda place: -least.slacks[place])
        ),
        sides=tuple(sorted(sides, key=lambda side: (not side.move_words, side.origin != "require"))),
        ends=tuple(_ends_in_words(optimizer, ends)),
    )


def _with_margins(elastic: ElasticMode, side: Side, member: int, nominal: Run) -> Side:
    """Return a limit with where it has to stand for modules that spread about the design that meets all nominally."""
    from tvimdesign.solve.uncertainty.robust import SIGMA, margins_at  # it loads the compiler

    optimizer = elastic.optimizer
    try:
        optimizer.margins = margins_at(optimizer, nominal, SIGMA)
        move, *_ = _alone(elastic, nominal, member)
    except TvimError:  # the margins cannot be computed in time, or not at this design
        move = None
    finally:
        optimizer.margins = {}
    if move is None:
        return side
    robust = _moved(optimizer, elastic.limits[member], side.by, move)
    words = with_margins_in_words(side.move_words, robust.move_words, SIGMA)
    return replace(side, move_words=words, robust_to=robust.move_to)


MARGIN_WORDS = "margin"


def with_margins_in_words(nominal: str, robust: str, sigma: float) -> str:
    """Return where a limit has to stand as drawn, and by an estimate of the margins for tolerances."""
    return f"{nominal} as drawn, to {robust} with {sigma:g} deviations of {MARGIN_WORDS}, an estimate"


_BEYOND = (0.0, 0.25, 0.75)  # Shares of the margin of a conflicting limit, by estimate, that are added to it in turn


def tried_with_margins(study: Study, side: Side, search: Callable[[Study], Solution], progress: Progress) -> Side:
    """Return a conflicting requirement with the value at which a search reaches the yield, or how near that comes.

    A rule, which a study cannot move, is returned as it is.
    """
    if side.origin != "require" or side.robust_to is None or side.move_to is None:
        return side
    output, sense = side.text.split(" ")[:2]
    unit, drawn, share = study.table.unit(output), side.move_words.partition(" as drawn")[0], ""
    for number, beyond in enumerate(_BEYOND, start=1):
        place = format_quantity(side.robust_to + beyond * (side.robust_to - side.move_to), unit)
        progress(f"trying {output} {sense} {place} with margins, {number} of at most {len(_BEYOND)}")
        moved = [
            limit.model_copy(update={"limit": parse_quantity(place, unit)})
            if (limit.output, limit.sense) == (output, sense) else limit for limit in study.require
        ]  # fmt: skip
        try:
            solution = search(study.model_copy(update={"require": tuple(moved)}))
        except (InfeasibleError, TimeOverError):
            return side
        share = f"{100.0 * (solution.yield_reached.together if solution.yield_reached else 0.0):.3g} %"
        if solution.status == OPTIMAL:
            words = f"{drawn} as drawn, to {sense} {place} with {MARGIN_WORDS}s: tried, yield {share}"
            return replace(side, move_words=words)
    words = f"{drawn} as drawn; with {MARGIN_WORDS}s, {sense} {place} gives a yield of {share} only"
    return replace(side, move_words=words)


def _alone(elastic: ElasticMode, begin: Run, member: int) -> tuple[float | None, list[int], Run]:
    """Return the move of one limit, in its scale, that satisfies all others; else the violated others, if known.

    The run is that of the design with the limit moved.
    """
    weights = np.full(elastic.count, _HEAVY)
    weights[member] = 1.0
    settled = elastic.settle(weights, begin.inputs, begin.unknowns)
    if not settled.converged:
        return None, [], settled.run
    others = [int(k) for k in np.flatnonzero(settled.slacks > FEASIBILITY_TOL) if k != member]
    return (None, others, settled.run) if others else (float(settled.slacks[member]), [], settled.run)


def _moved(optimizer: Optimizer, limit: Constraint, by: float, move: float | None) -> Side:
    table = optimizer.table
    sign = 1.0 if limit.sense == "<=" else -1.0
    place = None if move is None else limit.limit + sign * move * limit.scale
    words = "" if place is None else f"{limit.sense} {format_quantity(place, table.unit(limit.output))}"
    return Side(in_words(limit, table), limit.origin, by, place, words)


def _ends_in_words(optimizer: Optimizer, multipliers: Array) -> list[str]:
    """Return the ends of ranges that press, strongest first."""
    order = np.argsort(-np.abs(multipliers), kind="stable")
    lines = []
    for i in (int(place) for place in order if abs(multipliers[place]) > _FAINT):
        free, upper = optimizer.free[i], multipliers[i] > 0.0
        sense: Literal["<=", ">="] = "<=" if upper else ">="
        limit = make_constraint(optimizer.table, free.name, sense, free.upper if upper else free.lower, "vary")
        lines.append(in_words(limit, optimizer.table))
    return lines


def conflict_in_words(conflict_set: ConflictSet) -> list[str]:
    """Return lines on the conflict: the limits, the move each would need, and the ranges that prevent it."""
    seen, alone = "as far as the solver sees from its starts", len(conflict_set.sides) == 1
    if alone:
        side = conflict_set.sides[0]
        lines = [f"{_named(side)} cannot hold within the ranges, {seen}: {_place(side)}."]
    else:
        lines = [f"These cannot hold together, {seen}:"]
        stuck = [side for side in conflict_set.sides if side.beside and not side.move_words]
        lines += [f"  {_named(side)}: {_place(side)}" for side in conflict_set.sides if side not in stuck]
        which = "this" if len(stuck) == 1 else "any of these"
        lines += [f"  moving {which} alone is not enough: {', '.join(map(_named, stuck))}"] if stuck else []
    if conflict_set.ends:
        lines.append(f"Ends of ranges that keep {'it' if alone else 'them'} from it: {', '.join(conflict_set.ends)}.")
    return lines


def _named(side: Side) -> str:
    return side.text if side.origin == "require" else f"{side.text} ({side.origin})"


def _place(side: Side) -> str:
    if side.move_words:
        return f"alone it would have to move to {side.move_words}"
    if side.beside:
        return f"moving it alone is not enough, for then {' and '.join(side.beside)} cannot hold either"
    return "how far it must move is not known"
