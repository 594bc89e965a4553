"""Account of a requested yield: modules that satisfy the limits, limits that lose the others, and the cost."""

from __future__ import annotations

from tvimdesign.solve.nlp.constraints import in_words
from tvimdesign.solve.nlp.solution import LostTo, YieldReached
from tvimdesign.solve.nlp.solver_run import Run
from tvimdesign.solve.optimizer.optimizer import Optimizer
from tvimdesign.solve.uncertainty.yields import Drawn, yields_of

_NAMED = 3


def account_of_yield(optimizer: Optimizer, run: Run, nominal: Run, share: float) -> YieldReached:
    """Draw modules apart from those the design was found by, and simulate the `nominal` optimum without margins.

    Raises TimeOverError where the time is over first.
    """
    deadline = optimizer.deadline.late
    yields, seed = yields_of(optimizer), optimizer.study.solver.seed
    drawn = yields.at(run.inputs, seed + 1, deadline)
    without = yields.at(nominal.inputs, deadline=deadline).together.share
    table, points = optimizer.table, tuple(optimizer.study.operating_points)
    cycle = optimizer.simulator.run_to_show(nominal.inputs, nominal.current_profiles)
    values = optimizer.model.values(nominal.inputs, cycle.values)
    names = [name for name in table.names(points) if table.output(name).headline]
    return YieldReached(
        asked=share, modules=drawn.residuals.shape[1], shares=drawn.shares, together=drawn.together.share,
        lost_to=tuple(_lost(drawn, optimizer)), nominal_together=without,
        nominal={name: float(values[name]) for name in dict.fromkeys([*optimizer.study.minimize, *names])},
    )  # fmt: skip


def _lost(drawn: Drawn, optimizer: Optimizer) -> list[LostTo]:
    """Return the limits that most modules violate, the worst first, with the strongest contributors to their spread."""
    worst = sorted(drawn.limits, key=lambda limit: drawn.shares[limit.name])[:_NAMED]
    return [
        LostTo(in_words(limit, optimizer.table), drawn.shares[limit.name], _first(drawn.carriers(limit.name)))
        for limit in worst if drawn.shares[limit.name] < 1.0
    ]  # fmt: skip


def _first(carriers: dict[str, float]) -> dict[str, float]:
    return dict(list(carriers.items())[:_NAMED])
