"""The best combination of listed sizes by Bonmin, the mixed-integer solver in CasADi's wheel: an oracle for ours.

Each listed number is the sum of its sizes times unknowns that are zero or one and add up to one. With those between
zero and one it is any number between its smallest and its largest size, as in a box of our own search. Of Bonmin's
algorithms only B-BB, NLP-based branch and bound, is right here: B-Hyb and B-iFP call problems infeasible that are not.
Source: Bonami et al., Discrete Optimization 5 (2008) 186.
"""

from __future__ import annotations

import os
import time
from concurrent.futures import ProcessPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from dataclasses import dataclass
from multiprocessing import get_context
from typing import Any

import numpy as np

from tvimdesign.device import table_for
from tvimdesign.simulation.working_cycle.casadi_setup import ca
from tvimdesign.solve.discrete.discrete_choices import Sizes, discrete_sizes
from tvimdesign.solve.discrete.relaxation import Relaxation
from tvimdesign.solve.nlp.derivatives import derivatives_of
from tvimdesign.solve.nlp.ipopt import NLP
from tvimdesign.solve.nlp.objective import Objective
from tvimdesign.solve.nlp.solution import SolverEffort
from tvimdesign.solve.nlp.solver_run import Run
from tvimdesign.solve.optimizer.optimizer import Optimizer
from tvimdesign.study import Study

_OPTIONS = {
    "algorithm": "B-BB", "bb_log_level": 0, "print_level": 0, "sb": "yes",
    "linear_solver": "mumps", "mumps_pivtol": 1e-2, "mu_init": 1e-3, "tol": 1e-8,
}  # fmt: skip


@dataclass(frozen=True)
class Chosen:
    """What Bonmin came to."""

    success: bool
    objective: float
    choices: dict[str, float]
    seconds: float
    """Of the processor, for the search alone."""


def best_by_bonmin(study: Study, reference: dict[str, float]) -> Chosen:
    """Solve a study of listed sizes from its optimum between them; in a process of its own.

    Bonmin prints a line for each problem whatever it is told, and may end the interpreter where a problem in its tree
    does not converge (so it did with `most-fractional` branching): then there is no success.
    """
    try:
        with ProcessPoolExecutor(1, get_context("spawn")) as pool:
            return pool.submit(_alone, study, reference).result()
    except BrokenProcessPool:
        return Chosen(success=False, objective=np.inf, choices={}, seconds=0.0)


def _alone(study: Study, reference: dict[str, float]) -> Chosen:
    """What the process of its own does."""
    os.dup2(os.open(os.devnull, os.O_WRONLY), 1)
    table = table_for(study.mode)
    relaxation = Relaxation(0, Optimizer(study, reference), {}, discrete_sizes(study, table), SolverEffort())
    relaxation.starts()
    return _search(relaxation.optimizer, relaxation.sizes, relaxation.optima[0])


def _search(optimizer: Optimizer, sizes: Sizes, near: Run) -> Chosen:
    whole, places = optimizer.problem.function, {free.name: i for i, free in enumerate(optimizer.free)}
    count, begin = whole["x"].numel(), [near.unknowns]
    shares, rows = [], []
    for name, listed in zip(sizes.names, sizes.sizes, strict=True):
        place = places[name]
        values = np.array([optimizer.free[place].to_unknown(size) for size in listed])
        share = ca.MX.sym(name, len(listed))
        shares.append(share)
        rows += [whole["x"][place] - ca.dot(share, values), ca.sum1(share) - 1.0]
        begin.append(_shares_at(near.unknowns[place], values))
    x = ca.vertcat(whole["x"], *shares)
    function = ca.Function("listed", [x, whole["p"]], [whole["f"], ca.vertcat(whole["g"], *rows)], *NLP)
    binaries = x.numel() - count
    options: dict[str, Any] = {
        "bonmin": _OPTIONS, "print_time": False,
        "discrete": [False] * count + [True] * binaries, "show_eval_warnings": False, **derivatives_of(function),
    }  # fmt: skip
    solver = ca.nlpsol("bonmin", "bonmin", function, options)
    objective = Objective(optimizer.study.minimize)
    ends, zeros = optimizer.ends({}, objective), np.zeros(len(rows))
    clock = time.process_time()
    found = solver(
        x0=np.concatenate(begin), p=optimizer.parameters(objective),
        lbx=np.append(ends["lbx"], np.zeros(binaries)), ubx=np.append(ends["ubx"], np.ones(binaries)),
        lbg=np.append(ends["lbg"], zeros), ubg=np.append(ends["ubg"], zeros),
    )  # fmt: skip
    unknowns = np.asarray(found["x"]).ravel()
    choices = {name: float(optimizer.free[places[name]].to_value(unknowns[places[name]])) for name in sizes.names}
    return Chosen(bool(solver.stats()["success"]), float(found["f"]), choices, time.process_time() - clock)


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
