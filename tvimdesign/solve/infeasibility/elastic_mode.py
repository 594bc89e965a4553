"""The problem with limits that give: what is found where they cannot all be kept, and how far each must move.

Every limit gets a slack, its residual beyond zero; what is made small is the weighted sum of the slacks (so that few
limits move, not all a little), with a trace of the study's own objective to settle what is left open. Equations and
ranges stay as they are. Weights, and which limits count at all, are numbers: one problem, built once, answers all.
Source: Nocedal and Wright, Numerical Optimization, 2nd ed. (2006), section 18.5 (the elastic mode).
"""

from __future__ import annotations

import time
from collections.abc import Collection
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np

from tvimdesign.solve.nlp.extended_problem import ExtendedProblem
from tvimdesign.solve.nlp.ipopt import ProgrammeSolver, solver_of
from tvimdesign.solve.nlp.problem_parts import Objective, Parameters
from tvimdesign.solve.nlp.solver_run import Array, Run
from tvimdesign.solve.optimizer.optimizer import Optimizer

TRACE = 1e-4
"""Weight of the study's own objective beside the slacks."""
FEASIBILITY_TOL = 1e-5
"""Slack, as a share of a limit's scale, below which it counts as none."""
_ROOM = 1e-2
"""What slacks begin with beyond what the first point needs."""


@dataclass(frozen=True)
class ElasticSolution:
    """Result of one run of the elastic problem."""

    run: Run
    """Without multipliers: those of the elastic problem say nothing of the study's objective."""
    slacks: Array
    """How far each limit was broken, in its scale; limits that did not count have none."""
    pressing: Array
    """Multiplier of each limit: its weight where it gives, above 0 where it is part of the conflict."""
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
        """Add the slacks."""
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
                no_equations, np.where(counts[each], 0.0, np.inf), np.full(objectives, np.inf),
                np.zeros(problem.own_count),
            ]),
        )  # fmt: skip
        return self._settled(answer, begin, parameters, time.perf_counter() - clock)

    @cached_property
    def _solver(self) -> ProgrammeSolver:
        problem = self.optimizer.problem
        return solver_of(problem.unknown_count + self.count, problem.row_count, self.optimizer.study.solver)

    def _settled(self, answer: dict[str, Any], begin: Array, parameters: Parameters, seconds: float) -> ElasticSolution:
        problem = self.optimizer.problem
        size, unknowns = problem.unknown_count, np.asarray(answer["x"]).ravel()
        first, last = self.equations, self.equations + len(self._slack_of)
        pressing = np.zeros(self.count)
        np.add.at(pressing, self._slack_of, np.asarray(answer["lam_g"]).ravel()[first:last])
        ends = np.asarray(answer["lam_x"]).ravel()[: len(self.optimizer.free)]
        bare = {"x": unknowns[:size], "f": answer["f"], "lam_g": np.zeros(problem.row_count), "lam_x": np.zeros(size)}
        run = self.optimizer.record(bare, self._solver.stats(), begin, seconds, parameters)
        return ElasticSolution(run, np.maximum(unknowns[size:], 0.0), pressing, ends)
