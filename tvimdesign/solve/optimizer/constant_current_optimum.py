"""Optimum with constant currents: a search for profiles starts there and is compared with it."""

from __future__ import annotations

from tvimdesign.solve.nlp.solution import Constant
from tvimdesign.solve.nlp.solver_run import Array, Run
from tvimdesign.solve.optimizer.optimizer import Optimizer


class ConstantCurrentOptimum:
    """Optimum with constant currents. It is solved first: a search for profiles starts there and
    is compared with it.
    """

    def __init__(self, optimizer: Optimizer) -> None:
        """Set up; do nothing if no current follows a profile."""
        self.optimizer = optimizer.with_constant_currents()
        self.best: Run | None = None

    def beyond(self, begin: Array) -> Array:
        """Inputs of the optimum with constant currents from a start; the start itself where there is none."""
        if self.optimizer is None:
            return begin
        run = self.optimizer.solve(begin=begin)
        if not run.start.converged:
            return begin
        if self.best is None or run.start.objective < self.best.start.objective:
            self.best = run
        return run.inputs

    def found(self) -> Constant | None:
        """Return the best simulated optimum with constant currents; None if there is none."""
        if self.optimizer is None or self.best is None:
            return None
        cycle = self.optimizer.simulator.run(self.best.inputs)
        values = self.optimizer.model.values(self.best.inputs, cycle.values)
        inputs = {name: float(self.best.inputs[i]) for name, i in self.optimizer.model.index.items()}
        return Constant(self.best.start.objective, {**inputs, **values})
