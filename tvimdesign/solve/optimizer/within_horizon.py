"""A switch that ends: an optimum may take longer than is simulated, where nothing that is asked for limits its time.

A power, voltage or temperature at its peak is smallest where the layer barely gets as hot as it must, hours later. The
problem has every switch end within `horizon`, as nothing is known of it beyond. If that bound is active at an optimum,
the study is solved again with an explicit limit, which is reported.
"""

from __future__ import annotations

from tvimdesign.solve.nlp.problem import LATEST
from tvimdesign.solve.nlp.solver_run import Run
from tvimdesign.solve.optimizer.optimizer import Optimizer
from tvimdesign.study import Study
from tvimdesign.study.study import Requirement

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
