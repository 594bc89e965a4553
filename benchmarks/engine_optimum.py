"""Optimise over the free numbers alone: CasADi's table, the engine as a function with its Jacobian, IPOPT on both.

The same study, free numbers, limits, start and solver settings as the product's search without margins. Processor
times of both in one run. `--steps` sets how fine the engine steps.
"""

from __future__ import annotations

import argparse
import time
from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
from engine_module import Module
from engine_network import STEPS, Array
from quick import Quick
from scipy.optimize import Bounds, minimize

from tvimdesign.simulation.working_cycle.casadi_setup import ca
from tvimdesign.solve.nlp.ipopt import _ANYWHERE, _USUAL
from tvimdesign.solve.optimizer.optimizer import Optimizer
from tvimdesign.study import read_study

STUDIES = ("studies/paper_shear.yaml", "studies/compare_shear.yaml")


_QUASI_NEWTON = {
    "hessian_approximation": "limited-memory", "limited_memory_aug_solver": "extended", "max_iter": 300,
}  # fmt: skip


class Solved(NamedTuple):
    """An optimum: unknowns, objective, what the solver says, and evaluations with gradient."""

    unknowns: Array
    objective: float
    status: str
    evaluations: int


class Point:
    """Objective, limits and their slopes at one point: the table on what the engine gives. Keeps the last point."""

    def __init__(self, module: Module, table: Any) -> None:
        """Join a module's engine and the table's rows with their slopes by unknowns and the cycle's values."""
        self.module, self._table, self._last = module, Quick(table), b""
        self.rows, self.slopes = np.zeros(0), np.zeros((0, 0))

    def at(self, unknowns: Array) -> Point:
        """Evaluate where the unknowns are new."""
        if unknowns.tobytes() != self._last:
            self._last, count = unknowns.tobytes(), len(self.module.free)
            cycle, by = self.module.run(unknowns)
            both = self._table(unknowns, cycle)
            self.rows, self.slopes = both[:, 0], both[:, 1 : count + 1] + both[:, count + 1 :] @ by
        return self

    def forget(self) -> None:
        """Forget the last point."""
        self._last = b""


class Rows(ca.Callback):  # type: ignore[misc, unused-ignore]  # CasADi has no types
    """Some rows at a point, to CasADi: their values and, where wanted, their slopes."""

    def __init__(self, point: Point, rows: slice, count: int, *, sloped: bool) -> None:
        """Give `count` rows."""
        super().__init__()
        self._at, self._rows, self._count, self._sloped = point, rows, count, sloped
        self.construct("rows", {})

    def get_n_in(self) -> int:
        """Return the count of arguments."""
        return 1

    def get_n_out(self) -> int:
        """Return the count of results."""
        return 2 if self._sloped else 1

    def get_sparsity_in(self, _: int) -> Any:
        """Return the shape of the unknowns."""
        return ca.Sparsity.dense(len(self._at.module.free))

    def get_sparsity_out(self, place: int) -> Any:
        """Return the shape of a result."""
        return ca.Sparsity.dense(self._count, len(self._at.module.free) if place else 1)

    def eval(self, arguments: Any) -> list[Any]:
        """Return the rows, and their slopes."""
        found = self._at.at(np.asarray(arguments[0]).ravel())
        values = [ca.DM(found.rows[self._rows])]
        return [*values, ca.DM(found.slopes[self._rows])] if self._sloped else values


class Search:
    """One study's problem over its free numbers."""

    def __init__(self, optimizer: Optimizer, steps: float = STEPS) -> None:
        """Write the table's part with its derivatives, and give IPOPT both."""
        problem, model, study = optimizer.problem, optimizer.model, optimizer.study
        supplied = [row.name for row in optimizer.table.supplied if row.name in problem._needed]
        self.module = Module(model, optimizer.free, supplied, steps)
        self.start = np.array([one.to_unknown(model.start[model.index[one.name]]) for one in optimizer.free])
        ends = ([one.to_unknown(getattr(one, end)) for one in optimizer.free] for end in ("lower", "upper"))
        self.lower, self.upper = (np.array(one) for one in ends)
        known = ca.SX.sym("cycle", len(supplied))
        cycle = ca.vertcat(*(known[supplied.index(n)] if n in supplied else np.nan for n in model.switch_names))
        of = dict(
            zip(
                problem.wanted, ca.vertsplit(model.outputs(problem.wanted)(self.module.inputs, cycle)), strict=True
            )
        )  # fmt: skip
        objective = sum(weight / optimizer.reference[name] * of[name] for name, weight in study.minimize.items())
        rows = ca.vertcat(objective, *(limit.residual(of[limit.output]) for limit in problem.limits))
        slopes = ca.densify(ca.jacobian(rows, ca.vertcat(self.module.unknowns, known)))
        table = ca.Function("table", [self.module.unknowns, known], [ca.cse(ca.horzcat(rows, slopes))])
        self.point = Point(self.module, table)
        self._ipopt = self._written(study.solver.tolerance, len(problem.limits))

    def _written(self, tolerance: float, limits: int) -> Any:
        x, p = ca.MX.sym("x", len(self.start)), ca.MX.sym("p", 0)
        self._calls = [
            Rows(self.point, rows, count, sloped=sloped)
            for sloped in (False, True)
            for rows, count in ((slice(1), 1), (slice(1, None), limits))
        ]
        f, g, (same_f, gradient), (same_g, jacobian) = (call(x) for call in self._calls)
        settings = {**_USUAL, **_ANYWHERE, **_QUASI_NEWTON, "tol": tolerance}
        options: Any = {
            "grad_f": ca.Function("grad_f", [x, p], [same_f, gradient], ["x", "p"], ["f", "grad_f_x"]),
            "jac_g": ca.Function("jac_g", [x, p], [same_g, jacobian], ["x", "p"], ["g", "jac_g_x"]),
            "no_nlp_grad": True, "calc_lam_p": False, "print_time": False, "show_eval_warnings": False,
            "ipopt": settings,
        }  # fmt: skip
        problem: Any = {"x": x, "p": p, "f": f, "g": g}
        return ca.nlpsol("engine", "ipopt", problem, options)

    def solve(self) -> Solved:
        """Solve by IPOPT from the study's start."""
        before = self._begin()
        found = self._ipopt(x0=self.start, lbx=self.lower, ubx=self.upper, lbg=-np.inf, ubg=0.0)
        stats = self._ipopt.stats()
        used = self.module.evaluations - before
        return Solved(np.asarray(found["x"]).ravel(), float(found["f"]), stats["return_status"], used)

    def solve_by_slsqp(self) -> Solved:
        """Solve by scipy's SLSQP from the study's start."""
        before, of = self._begin(), self.point.at
        slsqp: Any = minimize  # its types know no constraints' Jacobians
        limits: Any = {"type": "ineq", "fun": lambda x: -of(x).rows[1:], "jac": lambda x: -of(x).slopes[1:]}
        found = slsqp(
            lambda x: of(x).rows[0], self.start, jac=lambda x: of(x).slopes[0], method="SLSQP",
            bounds=Bounds(self.lower, self.upper), constraints=limits, options={"maxiter": 200, "ftol": 1e-9},
        )  # fmt: skip
        return Solved(found.x, float(found.fun), str(found.message), self.module.evaluations - before)

    def _begin(self) -> int:
        self.point.forget()
        return self.module.evaluations


class Timed(NamedTuple):
    """What something took [s of the processor], and what it came to."""

    seconds: float
    value: Any


def timed(action: Callable[[], Any], repeats: int = 1) -> Timed:
    """Return the least time of some runs."""
    best, value = np.inf, None
    for _ in range(repeats):
        begin = time.process_time()
        value = action()
        best = min(best, time.process_time() - begin)
    return Timed(float(best), value)


def compared(file: str, steps: float, repeats: int) -> list[tuple[str, str]]:
    """Return the lines of the comparison for one study."""
    study = read_study(file).model_copy(update={"robust": None})
    optimizer = timed(lambda: Optimizer(study))
    today_first, today = timed(optimizer.value.solve), timed(optimizer.value.solve, repeats)
    fine = optimizer.value.on_grid(24, 5).solve()
    search = timed(lambda: Search(optimizer.value, steps))
    module, start = search.value.module, search.value.start
    first = timed(lambda: module.run(start))
    once, numbers = timed(lambda: module.run(start), 20), timed(lambda: module._split(start), 20)
    solved, other = timed(search.value.solve, repeats), timed(search.value.solve_by_slsqp, repeats)
    return [
        ("free numbers, limits, nodes", f"{len(start)}, {len(optimizer.value.problem.limits)}, {module.network.nodes}"),
        ("today: set-up [s]", f"{optimizer.seconds:.3f}"),
        ("today: first solve, solver built [s]", f"{today_first.seconds:.3f}"),
        ("today: solve again [s]", f"{today.seconds:.3f}"),
        ("today: iterations, objective", f"{today.value.start.iterations}, {today.value.start.objective:.8f}"),
        ("today: objective on 24 elements", f"{fine.start.objective:.8f}"),
        ("engine: table and network written [s]", f"{search.seconds:.3f}"),
        ("engine: first call, compiled or loaded [s]", f"{first.seconds:.3f}"),
        ("engine: numbers of the network with slopes [ms]", f"{1e3 * numbers.seconds:.3f}"),
        ("engine: one evaluation with gradient [ms]", f"{1e3 * once.seconds:.3f}"),
        ("engine: IPOPT, solve [s]", f"{solved.seconds:.4f}"),
        ("engine: IPOPT, evaluations, status", f"{solved.value.evaluations}, {solved.value.status}"),
        ("engine: IPOPT, objective", f"{solved.value.objective:.8f}"),
        ("engine: SLSQP, solve [s]", f"{other.seconds:.4f}"),
        ("engine: SLSQP, evaluations, status", f"{other.value.evaluations}, {other.value.status}"),
        ("engine: SLSQP, objective", f"{other.value.objective:.8f}"),
        ("today's solve over IPOPT on the engine", f"{today.seconds / solved.seconds:.2f}"),
        ("today's solve over SLSQP on the engine", f"{today.seconds / other.seconds:.2f}"),
    ]  # fmt: skip


def main() -> None:
    """Print the comparison."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("studies", nargs="*", default=STUDIES, help="study files")
    parser.add_argument("--steps", type=float, default=STEPS, help="steps in about the time that heats the layer")
    parser.add_argument("--repeats", type=int, default=5, help="solves of each, of which the fastest counts")
    chosen = parser.parse_args()
    for file in chosen.studies:
        print(file)
        for name, value in compared(file, chosen.steps, chosen.repeats):
            print(f"  {name:50}{value}", flush=True)


if __name__ == "__main__":
    main()
