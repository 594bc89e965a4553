"""Numbers that press on an end of their range, put exactly there: IPOPT ends a little inside."""

from __future__ import annotations

from dataclasses import replace

from tvimdesign.solve.nlp.solver_run import Ends, Run
from tvimdesign.solve.optimizer.optimizer import Optimizer

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
