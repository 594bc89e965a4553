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

from tvimdesign.simulation.working_cycle.casadi_setup import ca
from tvimdesign.solve.nlp.ipopt import _ANYWHERE, _USUAL
from tvimdesign.solve.optimizer.optimizer import Optimizer
from tvimdesign.study import read_study

STUDIES = ("studies/paper_shear.yaml", "studies/compare_shear.yaml")


class Engine(ca.Callback):  # type: ignore[misc, unused-ignore]
    """The engine to CasADi: unknowns to the cycle's values and their Jacobian, kept for one point."""

    def __init__(self, module: Module) -> None:
        """Wrap a module."""
        super().__init__()
        self.module, self._point, self._answer = module, b"", (np.zeros(0), np.zeros(0))
        self.construct("engine", {})

    def get_n_in(self) -> int:
        """Return the count of arguments."""
        return 1

    def get_n_out(self) -> int:
        """Return the count of results."""
        return 2

    def get_sparsity_in(self, _: int) -> Any:
        """Return the shape of the unknowns."""
        return ca.Sparsity.dense(len(self.module.free))

    def get_sparsity_out(self, place: int) -> Any:
        """Return the shape of the values, or of their Jacobian."""
        return ca.Sparsity.dense(len(self.module.wanted), len(self.module.free) if place else 1)

    def eval(self, arguments: Any) -> list[Any]:
        """Run the engine at a point that is new."""
        point = np.asarray(arguments[0]).ravel()
        if point.tobytes() != self._point:
            self._point, self._answer = point.tobytes(), self.module.run(point)
        return [ca.DM(one) for one in self._answer]


class Search:
    """One study's problem over its free numbers."""

    def __init__(self, optimizer: Optimizer, steps: float = STEPS) -> None:
        """Write the table's part with its derivatives, and give IPOPT both."""
        problem, model = optimizer.problem, optimizer.model
        supplied = [row.name for row in optimizer.table.supplied if row.name in problem._needed]
        self.module = Module(model, optimizer.free, supplied, steps)
        self.start = np.array([one.to_unknown(model.start[model.index[one.name]]) for one in optimizer.free])
        self.bounds = [
            np.array([one.to_unknown(getattr(one, end)) for one in optimizer.free]) for end in ("lower", "upper")
        ]
        known = ca.SX.sym("cycle", len(supplied))
        cycle = ca.vertcat(*(known[supplied.index(n)] if n in supplied else np.nan for n in model.switch_names))
        values = model.outputs(problem.wanted)(self.module.inputs, cycle)
        of = dict(zip(problem.wanted, ca.vertsplit(values), strict=True))
        objective = sum(
            weight / optimizer.reference[name] * of[name] for name, weight in optimizer.study.minimize.items()
        )
        rows = ca.vertcat(objective, *(limit.residual(of[limit.output]) for limit in problem.limits))
        slopes = ca.densify(ca.jacobian(rows, ca.vertcat(self.module.unknowns, known)))
        both, arguments = ca.cse(ca.horzcat(rows, slopes)), [self.module.unknowns, known]
        table = ca.Function("table", arguments, [both[0, 0], both[1:, 0]])
        sloped = ca.Function("sloped", arguments, [both[0, 0], both[1:, 0], both[0, 1:], both[1:, 1:]])
        self._solver = self._written(table, sloped, optimizer.study.solver.tolerance)

    def _written(self, table: Any, sloped: Any, tolerance: float) -> Any:
        self._engine = Engine(self.module)
        x, p, count = ca.MX.sym("x", len(self.start)), ca.MX.sym("p", 0), len(self.start)
        cycle, by = self._engine(x)
        f, g = table(x, cycle)
        same_f, same_g, df, dg = sloped(x, cycle)
        gradient = (df[:count] + ca.mtimes(df[count:], by)).T
        jacobian = dg[:, :count] + ca.mtimes(dg[:, count:], by)
        settings = {**_USUAL, **_ANYWHERE, "hessian_approximation": "limited-memory", "tol": tolerance, "max_iter": 300}
        options = {
            "grad_f": ca.Function("grad_f", [x, p], [same_f, gradient], ["x", "p"], ["f", "grad_f_x"]),
            "jac_g": ca.Function("jac_g", [x, p], [same_g, jacobian], ["x", "p"], ["g", "jac_g_x"]),
            "no_nlp_grad": True, "calc_lam_p": False, "print_time": False, "show_eval_warnings": False,
            "ipopt": settings,
        }  # fmt: skip
        return ca.nlpsol("engine", "ipopt", {"x": x, "p": p, "f": f, "g": g}, options)

    def solve(self, start: Array | None = None) -> tuple[Array, float, str, int]:
        """Return the unknowns at the optimum, the objective, IPOPT's status and its iterations."""
        self._engine._point = b""
        begin = self.start if start is None else start
        found = self._solver(x0=begin, lbx=self.bounds[0], ubx=self.bounds[1], lbg=-np.inf, ubg=0.0)
        stats = self._solver.stats()
        return np.asarray(found["x"]).ravel(), float(found["f"]), stats["return_status"], stats["iter_count"]


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
    module.evaluations = 0
    solved = timed(search.value.solve)
    evaluations = module.evaluations
    again = timed(search.value.solve, repeats)
    _, objective, status, iterations = solved.value
    _, exact, _, _ = Search(optimizer.value, 8.0 * steps).solve()
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
        ("engine: solve [s]", f"{again.seconds:.4f}"),
        ("engine: iterations, evaluations, status", f"{iterations}, {evaluations}, {status}"),
        ("engine: objective", f"{objective:.8f}"),
        ("engine: objective with steps of an eighth", f"{exact:.8f}"),
        ("today's solve over the engine's", f"{today.seconds / again.seconds:.2f}"),
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
