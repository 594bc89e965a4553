"""The reference problem from many Sobol starts by the product's own multistart: how many converge.

A start that does not converge has its diagnosis; points at which no search begins are counted by the reason.
"""

from __future__ import annotations

import argparse
import time

from reference_problem import study

from tvimdesign.device import table_for
from tvimdesign.solve.discrete.discrete_choices import discrete_sizes
from tvimdesign.solve.discrete.relaxation import Relaxation
from tvimdesign.solve.nlp.solution import SolverEffort, same_optimum
from tvimdesign.solve.nlp.solver_run import meaning
from tvimdesign.solve.optimizer.optimizer import Optimizer


def main() -> None:
    """Print the count."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--starts", type=int, default=200)
    count = parser.parse_args().starts
    sought = study()
    sought = sought.model_copy(update={"solver": sought.solver.model_copy(update={"starts": count})})
    table = table_for(sought.mode)
    begin = time.process_time()
    relaxation = Relaxation(0, Optimizer(sought), {}, discrete_sizes(sought, table), SolverEffort())
    starts = [run.start for run in relaxation.starts()]
    seconds = time.process_time() - begin
    converged = [start for start in starts if start.converged]
    iterations = sum(start.iterations for start in starts) / len(starts)
    again = sum(start.second_try for start in starts)
    print(f"{len(converged)} of {count} starts converged in {seconds:.1f} s, {iterations:.1f} iterations a start")
    print(f"{again} only from a feasible design; passed over: {relaxation.optimizer.multistart.passed_over}")
    for optimum in relaxation.optima:
        reached = sum(same_optimum(start, optimum.start) for start in converged)
        print(f"objective {optimum.start.objective:.8f}: {reached}")
    for start in starts:
        if not start.converged:
            print(f"{start.status}: {meaning(start.status).words}; started at {start.begin}")


if __name__ == "__main__":
    main()
