"""What a robust problem adds to limits on algebraic outputs, by exact moments: modules that spread then keep them."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

from tvimdesign.simulation.working_cycle.device_functions import DeviceFunctions
from tvimdesign.solve.nlp.constraints import Constraint, on_cycle
from tvimdesign.solve.nlp.moments import moments
from tvimdesign.study import Study


def back_offs_of(model: DeviceFunctions, study: Study, limits: Sequence[Constraint]) -> Callable[[Any], dict[str, Any]]:
    """What is added to the residual of each limit on an algebraic output: its mean's shift and so many deviations."""
    assert study.robust is not None
    assert study.robust.sigma is not None
    sigma = study.robust.sigma
    algebraic = [limit for limit in limits if not on_cycle(model.table, limit.output)]
    if not algebraic:
        return lambda _: {}
    of_inputs = moments(
        model, study.tolerances, [limit.output for limit in algebraic], [limit.scale for limit in algebraic]
    )  # fmt: skip

    def back_offs(inputs: Any) -> dict[str, Any]:
        shift, deviation = of_inputs(inputs)
        return {
            limit.name: ((shift[i] if limit.sense == "<=" else -shift[i]) + sigma * deviation[i]) / limit.scale
            for i, limit in enumerate(algebraic)
        }

    return back_offs
