"""Common reference that divides the minimised outputs of all compared studies, so that all minimise the same.

A study alone divides each output by its value at its own start. Of two studies with the same weights one would then
pay less for a second than the other, because it was drawn slower.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence

from tvimdesign.base.errors import TvimError
from tvimdesign.simulation.working_cycle.cycle import Simulator
from tvimdesign.simulation.working_cycle.device_functions import DeviceFunctions
from tvimdesign.study import Study, given

Values = Mapping[str, float]


def at_its_start(study: Study) -> dict[str, float] | None:
    """Return the minimised outputs of a study as drawn, SI; None if it cannot be simulated."""
    table = study.table
    try:
        model = DeviceFunctions(table, given(study), tuple(study.operating_points), study.solver.cells)
        values = model.values(model.start, Simulator(model).run(model.start).values)
    except TvimError:
        return None
    horizon = float(model.start[model.index["horizon"]])
    return {name: values[name] if math.isfinite(values[name]) else horizon for name in study.minimize}


def common(starts: Sequence[Values | None]) -> dict[str, float]:
    """Geometric mean of every output over the studies, whatever their order; of nothing but zeros, one."""
    known = [values for values in starts if values is not None]
    names = dict.fromkeys(name for values in known for name in values)
    sizes = {name: [abs(values[name]) for values in known if values[name] != 0.0] for name in names}
    return {name: math.exp(math.fsum(map(math.log, of)) / len(of)) if of else 1.0 for name, of in sizes.items()}
