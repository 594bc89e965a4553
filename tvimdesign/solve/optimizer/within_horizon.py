"""A switch that ends: an optimum may take longer than is simulated, where nothing that is asked for limits its time.

A power, voltage or temperature at its peak is smallest where the layer barely gets as hot as it must, hours later. The
equations of the problem have such a switch end; simulated, it does not within `horizon`, and nothing is known of it.
"""

from __future__ import annotations

from tvimdesign.solve.nlp.solver_run import Run
from tvimdesign.solve.optimizer.optimizer import Optimizer
from tvimdesign.study import Study
from tvimdesign.study.study import Requirement

LATEST = 0.98
"""Share of the horizon at which an event must have come: times of the problem are up to 1.4 % off those simulated."""


def ending_in_time(study: Study, optimizer: Optimizer, run: Run) -> Study | None:
    """The study with limits on the times that a run has beyond the horizon; None where it has none, or no design."""
    latest = LATEST * float(optimizer.model.start[optimizer.model.index["horizon"]])
    limited = {one.output for one in study.require if one.sense == "<=" and one.limit <= latest}
    times = run.times
    late = [event for event, time in times.items() if time > latest and event not in limited]
    if not late or not run.start.converged:
        return None
    limits = [Requirement(output=event, sense="<=", limit=latest, text="within the horizon") for event in late]
    kept = [one for one in study.require if one.sense != "<=" or one.output not in late]
    return study.model_copy(update={"require": (*kept, *limits)})
