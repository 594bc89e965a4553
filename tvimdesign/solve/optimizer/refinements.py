"""Searches around a run of the optimizer: from constant currents, within a longer horizon; ends of ranges."""

from dataclasses import replace

from tvimdesign.solve.nlp.problem import LATEST
from tvimdesign.solve.nlp.solution import Constant
from tvimdesign.solve.nlp.solver_run import Array, Ends, Run
from tvimdesign.solve.optimizer.optimizer import Optimizer
from tvimdesign.study import Study
from tvimdesign.study.study import Requirement


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


_AT_IT = 1e-6
"""Share of that time within which an event comes as late as it may."""


def ending_in_time(study: Study, optimizer: Optimizer, run: Run) -> Study | None:
    """Return the study with limits on the times that a run has at the horizon; None if no times or no design."""
    latest = LATEST * float(optimizer.model.start[optimizer.model.index["horizon"]])
    limited = {limit.output for limit in study.require if limit.sense == "<=" and limit.limit <= latest}
    times = run.times
    late = [event for event, time in times.items() if time > latest * (1.0 - _AT_IT) and event not in limited]
    if not late or not run.start.converged:
        return None
    limits = [Requirement(output=event, sense="<=", limit=latest, text="within the horizon") for event in late]
    others = [limit for limit in study.require if limit.sense != "<=" or limit.output not in late]
    return study.model_copy(update={"require": (*others, *limits)})


_NEAR = 1e-3
"""Room [of an unknown] beyond which a number is not taken to be at its end, however it presses."""
_WORSE = 1e-6
"""Share by which the objective may rise, as rounding does: else the run is left as it was."""


def put_at_bounds(optimizer: Optimizer, run: Run) -> Run:
    """Return a converged run with the numbers that press on an end fixed at it and all others solved again.

    At an interior point the room times the multiplier is the barrier's parameter: what presses more than it has room is
    at its end. Multipliers stay those of the run as it was, as a number that is fixed has none.
    """
    pressed = _pressed(optimizer, run)
    if not run.start.converged or not pressed:
        return run
    fixed = optimizer.solve({**run.within, **pressed}, warm=run)
    before, after = run.start.objective, fixed.start.objective
    if not fixed.start.converged or after > before + _WORSE * abs(before):
        return run
    inputs = fixed.inputs.copy()
    for name, (end, _) in pressed.items():
        inputs[optimizer.model.index[name]] = end
    start = replace(run.start, end={**fixed.start.end, **{name: end for name, (end, _) in pressed.items()}})
    return replace(run, start=start, inputs=inputs, current_profiles=fixed.current_profiles, ends=fixed.ends)


def _pressed(optimizer: Optimizer, run: Run) -> dict[str, Ends]:
    """Return the ends that free numbers press on, each twice to fix the number; none that is already fixed."""
    pressed: dict[str, Ends] = {}
    lower, upper = optimizer.vector.bounds(run.within)
    for i, free in enumerate(optimizer.problem.free):
        ends = run.within.get(free.name, (free.lower, free.upper))
        rooms = (run.unknowns[i] - lower[i], upper[i] - run.unknowns[i])
        presses = (-run.bound_multipliers[i], run.bound_multipliers[i])
        for end, room, press in zip(ends, rooms, presses, strict=True):
            if ends[0] < ends[1] and room < min(press, _NEAR):
                pressed[free.name] = (end, end)
    return pressed
