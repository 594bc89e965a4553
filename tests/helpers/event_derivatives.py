"""Derivatives by differences of a function and of CVODES, and the engine's exact ones in finer steps."""

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray
from support import fine

from tvimdesign.simulation.working_cycle.cycle import CycleEngine, Supplied
from tvimdesign.simulation.working_cycle.device_functions import DeviceFunctions
from tvimdesign.simulation.working_cycle.phase_instants import Grid

Array = NDArray[np.float64]
FINER = 16
"""At a search's own steps the derivative of `softening_time` by one radius is 2 % off, at a quarter of them 0.2 %."""


def differences(function: Any, at: Array, which: list[int], share: float) -> Array:
    """Jacobian by a central stencil of fourth order; the step is a share of the value."""
    columns = []
    for i in which:
        step = share * (abs(at[i]) or 1.0)
        shifted = []
        for times in (-2, -1, 1, 2):
            point = at.copy()
            point[i] += times * step
            shifted.append(np.asarray(function(point)).ravel())
        far_below, below, above, far_above = shifted
        columns.append((far_below - 8.0 * below + 8.0 * above - far_above) / (12.0 * step))
    return np.column_stack(columns)


def shown_by_cvodes(model: DeviceFunctions, events: Sequence[str], variables: Sequence[str]) -> dict[str, Array]:
    """Derivatives of event times of the softening by some inputs, by differences of CVODES's simulations."""
    simulator = fine(model)

    def times(inputs: Array) -> Array:
        values = simulator.run(inputs, phases=["softening"]).values
        return np.array([values[event] for event in events])

    jacobian = differences(times, model.start, [model.index[name] for name in variables], 1e-3)
    return dict(zip(events, jacobian, strict=True))


def found_by_engine(model: DeviceFunctions, variables: Sequence[str]) -> Supplied:
    """Return the engine's values and their derivatives by some inputs, in steps a sixteenth as long as a search's."""
    engine, grids = CycleEngine(model), dict[str, Grid]()
    along = np.zeros((len(model.start), len(variables)))
    for j, name in enumerate(variables):
        along[model.index[name], j] = 1.0
    events = {row.name for row in model.phases["softening"].events}
    engine.run(model.start, along[:, :0], events, grids)
    finer = {
        name: Grid(
            [share / FINER for share in grid.shares for _ in range(FINER)],
            {row: FINER * k for row, k in grid.events.items()},
        )
        for name, grid in grids.items()
    }
    return engine.run(model.start, along, events, finer)
