"""Exact derivatives of a module's outputs by its variables, by the engine's sensitivities and the table."""

from collections.abc import Collection, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from tvimdesign.device import Simulated, Table
from tvimdesign.simulation.working_cycle.cycle import CycleEngine
from tvimdesign.simulation.working_cycle.device_functions import DeviceFunctions, ResolvedModule

Array = NDArray[np.float64]

FINER, REPORTED = 2.0, 4.0
"""Fineness of the steps in time where derivatives predict, and where they are reported: a compression module's by the
depth of its blocks is 0.3 % off with the one, 0.02 % with the other, as cells melt one after the other."""


@dataclass(frozen=True)
class OutputSensitivities:
    """Effects of every variable on every output at one design; rows `outputs`, columns `variables`."""

    outputs: tuple[str, ...]
    variables: tuple[str, ...]
    values: Array
    at: Array
    derivatives: Array
    left_out: tuple[str, ...]  # Outputs that never happen in this design, or hang on a current that follows a profile


def output_sensitivities(
    resolved: ResolvedModule, wanted: Sequence[str], by: Sequence[str] | None = None
) -> OutputSensitivities:
    """Differentiate the wanted outputs by every variable of the module, or `by` some inputs. Raises SimulationError."""
    model = resolved.functions
    names = [n for n in wanted if not isinstance(resolved.table.quantity(n), Simulated)]
    variables = by or [row.name for row in resolved.table.inputs if _is_variable(resolved, model, row.name)]
    variables = [name for name in variables if name not in resolved.replaced]
    derivatives = OutputDerivatives(model, names, REPORTED)
    values, slopes, never = derivatives.at(model.start, variables)
    lost = never | behind_profiles(model.table, set(resolved.current_profiles))
    places = [i for i, name in enumerate(names) if not derivatives.supplied[name] & lost]
    left_out = tuple(name for i, name in enumerate(names) if i not in places)
    at = model.start[[model.index[name] for name in variables]]
    return OutputSensitivities(
        tuple(names[i] for i in places), tuple(variables), values[places], at, slopes[places], left_out
    )


class OutputDerivatives:
    """Outputs of one model with their derivatives by some inputs, at any design."""

    def __init__(self, model: DeviceFunctions, outputs: Sequence[str], fineness: float = FINER) -> None:
        self.model, self.outputs = model, tuple(outputs)
        above = {name: {name.partition("@")[0], *model.table.ancestors(name)} for name in outputs}
        self.supplied = {name: behind & set(model.switch_names) for name, behind in above.items()}
        """What each output needs of the cycle."""
        self._tape, self._engine = model.tape(self.outputs), CycleEngine(model, fineness)

    def at(self, inputs: Array, by: Sequence[str]) -> tuple[Array, Array, set[str]]:
        """Return values, derivatives (a column an input), and what the cycle does not supply at a design's inputs.

        Raises SimulationError.
        """
        place = [self.model.index[name] for name in by]
        along = np.zeros((len(inputs), len(place)))
        along[place, range(len(place))] = 1.0
        needed = set().union(*self.supplied.values())
        cycle, of_cycle = (
            np.full(len(self.model.switch_names), np.inf),
            np.zeros((len(self.model.switch_names), len(place))),
        )
        if needed:
            cycle, of_cycle, _ = self._engine.run(inputs, along, needed)
        never = {name for name, value in zip(self.model.switch_names, cycle, strict=True) if not np.isfinite(value)}
        # What nothing wanted depends on may be infinite; it is never read.
        numbers = np.where(np.isfinite(cycle), cycle, 1.0)
        ((values, slopes),) = self._tape.tangents([inputs, numbers], [along, of_cycle])
        return values, slopes, never


def _is_variable(resolved: ResolvedModule, model: DeviceFunctions, name: str) -> bool:
    """Return whether a study may vary a number and this module has it; a count is no variable."""
    row = resolved.table.quantity(name)
    return name in model.index and getattr(row, "variable", False) and not getattr(row, "integer", False)


def behind_profiles(table: Table, driven: Collection[str]) -> set[str]:
    """Return the rows of phases whose current follows a profile, and of phases that come after or are like them."""
    touched = set(driven)
    for phase in table.phases:
        if phase.after in touched or phase.like in touched:
            touched.add(phase.name)
    return {row.name for row in table.supplied if row.phase in touched}
