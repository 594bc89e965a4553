"""The best combination of listed sizes by Bonmin, the mixed-integer solver in CasADi's wheel: an oracle for ours.

Each listed number is the sum of its sizes times unknowns that are zero or one and add up to one. With those between
zero and one it is any number between its smallest and its largest size, as in a box of our own search. Of Bonmin's
algorithms only B-BB, NLP-based branch and bound, is right here: B-Hyb and B-iFP call problems infeasible that are not.
Source: Bonami et al., Discrete Optimization 5 (2008) 186.
"""

from __future__ import annotations

import os
import time
from collections.abc import Sequence
from concurrent.futures import ProcessPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from dataclasses import dataclass
from multiprocessing import get_context
from typing import Any

import casadi as ca
import numpy as np

from tvimdesign.device import table_for
from tvimdesign.solve.discrete.discrete_choices import Sizes, discrete_sizes
from tvimdesign.solve.discrete.relaxation import Relaxation
from tvimdesign.solve.nlp.problem import Problem
from tvimdesign.solve.nlp.problem_parts import Objective, Parameters, Point
from tvimdesign.solve.nlp.solution import SolverEffort
from tvimdesign.solve.nlp.solver_run import Run
from tvimdesign.solve.optimizer.optimizer import Optimizer
from tvimdesign.study import Study

_OPTIONS = {
    "algorithm": "B-BB", "bb_log_level": 0, "print_level": 0, "sb": "yes",
    "linear_solver": "mumps", "mu_init": 1e-3, "tol": 1e-8, "hessian_approximation": "limited-memory",
}  # fmt: skip


@dataclass(frozen=True)
class Chosen:
    """Result of Bonmin."""

    success: bool
    objective: float
    choices: dict[str, float]
    seconds: float
    """Of the processor, for the search alone."""


def best_by_bonmin(study: Study, reference: dict[str, float]) -> Chosen:
    """Solve a study of listed sizes from its optimum between them; in a process of its own.

    Bonmin prints a line for each problem whatever its options, and may end the interpreter where a problem in its tree
    does not converge (so it did with `most-fractional` branching): then there is no success.
    """
    try:
        with ProcessPoolExecutor(1, get_context("spawn")) as pool:
            return pool.submit(_alone, study, reference).result()
    except BrokenProcessPool:
        return Chosen(success=False, objective=np.inf, choices={}, seconds=0.0)


def _alone(study: Study, reference: dict[str, float]) -> Chosen:
    """Solve in a process of its own."""
    os.dup2(os.open(os.devnull, os.O_WRONLY), 1)
    table = table_for(study.mode)
    relaxation = Relaxation(0, Optimizer(study, reference), {}, discrete_sizes(study, table), SolverEffort())
    relaxation.starts()
    return _search(relaxation.optimizer, relaxation.sizes, relaxation.optima[0])


def _search(optimizer: Optimizer, sizes: Sizes, near: Run) -> Chosen:
    places = {free.name: i for i, free in enumerate(optimizer.free)}
    chosen = [places[name] for name in sizes.names]
    values = [
        np.array([optimizer.free[place].to_unknown(size) for size in listed])
        for place, listed in zip(chosen, sizes.sizes, strict=True)
    ]
    objective = Objective(optimizer.study.minimize)
    listed = _Listed(optimizer.problem, optimizer.parameters(objective), chosen, values)
    count, binaries = optimizer.problem.unknown_count, sum(map(len, values))
    settings = {
        "bonmin": _OPTIONS, "print_time": False, "show_eval_warnings": False,
        "pass_nonlinear_variables": False, "pass_nonlinear_constraints": False,
        "discrete": [False] * count + [True] * binaries,
    }  # fmt: skip
    held = _Held()
    solver, _calls = _solver(listed, held, settings)
    begin = [
        near.unknowns,
        *(_shares_at(near.unknowns[place], value) for place, value in zip(chosen, values, strict=True)),
    ]
    ends, zeros = optimizer.ends({}, objective), np.zeros(2 * len(chosen))
    optimizer.problem.grids = near.grids
    clock = time.process_time()
    solution = solver(
        x0=np.concatenate(begin),
        lbx=np.append(ends["lbx"], np.zeros(binaries)), ubx=np.append(ends["ubx"], np.ones(binaries)),
        lbg=np.append(ends["lbg"], zeros), ubg=np.append(ends["ubg"], zeros),
    )  # fmt: skip
    unknowns = np.asarray(solution["x"]).ravel()
    choices = {name: float(optimizer.free[places[name]].to_value(unknowns[places[name]])) for name in sizes.names}
    return Chosen(bool(solver.stats()["success"]), float(solution["f"]), choices, time.process_time() - clock)


class _Listed:
    """A problem with its listed numbers as sums of their sizes times unknowns between zero and one, which come last."""

    def __init__(
        self, problem: Problem, parameters: Parameters, chosen: list[int], values: list[np.ndarray[Any, Any]]
    ) -> None:
        self._problem, self._parameters = problem, parameters
        count = problem.unknown_count
        self.unknown_count, self.row_count = count + sum(map(len, values)), problem.row_count + 2 * len(values)
        self._sums = np.zeros((2 * len(values), self.unknown_count))
        last = count
        for i, (place, listed) in enumerate(zip(chosen, values, strict=True)):
            shares = slice(last, last + len(listed))
            self._sums[2 * i, place], self._sums[2 * i, shares], self._sums[2 * i + 1, shares] = 1.0, -listed, 1.0
            last = shares.stop

    def at(self, x: np.ndarray[Any, Any]) -> Point:
        more = self.unknown_count - self._problem.unknown_count
        point = self._problem.at(x[: self._problem.unknown_count], self._parameters)
        sums = self._sums @ x
        sums[1::2] -= 1.0
        return point._replace(
            gradient=np.append(point.gradient, np.zeros(more)), rows=np.append(point.rows, sums),
            jacobian=np.vstack([np.pad(point.jacobian, ((0, 0), (0, more))), self._sums]),
        )  # fmt: skip


def _shares_at(value: float, values: np.ndarray[Any, Any]) -> np.ndarray[Any, Any]:
    """Shares of the two sizes on either side that come to a value."""
    above = int(np.clip(np.searchsorted(values, value), 1, len(values) - 1)) if len(values) > 1 else 0
    shares = np.zeros(len(values))
    if above:
        share = float(np.clip((value - values[above - 1]) / (values[above] - values[above - 1]), 0.0, 1.0))
        shares[above - 1], shares[above] = 1.0 - share, share
    else:
        shares[0] = 1.0
    return shares


def _solver(listed: _Listed, held: _Held, settings: dict[str, Any]) -> tuple[Any, list[_Part]]:
    """Return nlpsol's Bonmin for a programme, and what it calls, which lives as long."""
    unknowns, rows = listed.unknown_count, listed.row_count
    held.programme = listed
    x, p = ca.MX.sym("x", unknowns), ca.MX.sym("p", 0)
    calls = [
        _Part(held, unknowns, size, sloped=sloped, part=part)
        for sloped in (False, True)
        for part, size in (("objective", 1), ("rows", rows))
    ]
    f, g, (same_f, gradient), (same_g, jacobian) = (call(x) for call in calls)
    derivatives = {
        "grad_f": ca.Function("grad_f", [x, p], [same_f, gradient], ["x", "p"], ["f", "grad_f_x"]),
        "jac_g": ca.Function("jac_g", [x, p], [same_g, jacobian], ["x", "p"], ["g", "jac_g_x"]),
        "no_nlp_grad": True, "calc_lam_p": False,
    }  # fmt: skip
    problem = {"x": x, "p": p, "f": f, "g": g}
    return ca.nlpsol("listed", "bonmin", problem, {**settings, **derivatives}), calls


class _Held:
    """The programme of the run."""

    programme: _Listed
    at = b""  # Unknowns of the last point, and the programme there: Bonmin takes it in four parts
    point: Point
    error: BaseException | None = None


class _Part(ca.Callback):
    """Objective or constraints at a point, to CasADi; with their derivatives where `sloped`."""

    def __init__(self, held: _Held, unknowns: int, size: int, *, sloped: bool, part: str) -> None:
        super().__init__()
        self._held, self._unknowns, self._size, self._sloped, self._part = held, unknowns, size, sloped, part
        self.construct(f"{part}{int(sloped)}", {})

    def get_n_in(self) -> int:
        return 1

    def get_n_out(self) -> int:
        return 2 if self._sloped else 1

    def get_sparsity_in(self, _: int) -> Any:
        return ca.Sparsity.dense(self._unknowns)

    def get_sparsity_out(self, place: int) -> Any:
        return ca.Sparsity.dense(self._size, self._unknowns if place else 1)

    def has_eval_buffer(self) -> bool:
        return True  # a matrix of CasADi's takes ten times as long to make

    def eval_buffer(self, arguments: Sequence[memoryview], results: Sequence[memoryview | None]) -> int:
        """Write the results; anything but zero says that there are none."""
        held, at = self._held, arguments[0].tobytes()
        try:
            if at != held.at:
                held.point, held.at = held.programme.at(np.frombuffer(at)), at
        except BaseException as error:  # CasADi would swallow it
            held.error = error
            return 1
        point = held.point
        of_objective = self._part == "objective"
        computed: tuple[Any, Any] = (point.rows, point.jacobian)
        if of_objective:
            computed = (point.objective, point.gradient)
        for result, values in zip(results, computed, strict=False):
            if result is not None:
                np.frombuffer(result)[:] = values.ravel(order="F") if isinstance(values, np.ndarray) else values
        return 0
