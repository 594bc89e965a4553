"""A Peltier pad alone, in steady states: Seebeck coefficient, resistance and conductance.

V = S (T_h - T_c) + I R, and at the cold face S I T_c - I^2 R/2 - K (T_h - T_c) = q + g (T_a - T_c): what the pad draws
from it is what is put in, q, and what leaks in through the insulation, g (physics/heat_flow/peltier.py).
"""

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np

from tvimdesign.physics.heat_flow import peltier
from tvimdesign.simulation.measurement.fitting.fit import fitted
from tvimdesign.simulation.measurement.fitting.problem import Channel, Parameter, Problem, Values
from tvimdesign.simulation.measurement.measurement import Measurement, Settings, rows_of
from tvimdesign.simulation.measurement.reading.data_file import Array, Block
from tvimdesign.simulation.working_cycle.symbols import ca

_COLUMNS = ("current", "voltage", "hot_temperature", "cold_temperature")
_LEAST_DIFFERENCE = 5.0  # K
_SPREAD = 0.2  # Range of the currents over the largest from which on they are several
_ONE_CURRENT = (
    "One current cannot tell Seebeck coefficient, resistance and conductance apart: many of them have this voltage and "
    "these temperatures. Measure at several; no record is written."
)


def measure(blocks: Sequence[Block], settings: Settings, *, profiles: bool = True) -> Measurement:
    """Fit blocks of steady states. Raises InputError for what lacks."""
    channels: list[Channel] = []
    faces: list[Parameter] = []
    starts, differences = [], []
    for i, block in enumerate(blocks):
        current, voltage, hot, cold = rows_of(block, _COLUMNS)
        with_heat = "cold_heat" in block.columns
        heat = rows_of(block, [*_COLUMNS, "cold_heat"])[-1] if with_heat else np.full(len(hot), settings["cold_heat"])
        starts.append(_start(current, voltage, hot, cold))
        differences.append(float(np.max(np.abs(hot - cold))))
        names = [f"hot_{i}_{row}" for row in range(len(hot))]
        faces += [
            Parameter(name, "degC", "Temperature of the hot face", temperature, positive=False, nuisance=True)
            for name, temperature in zip(names, hot, strict=True)
        ]
        state = _State(current, names, heat, settings["leak"], settings["ambient"])
        channels += [
            Channel(f"voltage of {block.file}", "V", voltage, state.voltage, current, "current", "A",
                    step=block.step("voltage")),
            Channel(f"faces of {block.file}", "degC", np.concatenate([hot, cold]), state.faces,
                    np.concatenate([current, current]), "current", "A",
                    step=block.step("hot_temperature", "cold_temperature"), sensors=2),
        ]  # fmt: skip
    seebeck, resistance, conductance = np.median(starts, axis=0)
    fit = fitted(
        Problem([
            Parameter("seebeck", "mV/K", "Voltage for each kelvin between the faces", seebeck),
            Parameter("resistance", "ohm", "Resistance", resistance),
            Parameter("conductance", "W/K", "Conductance from face to face", conductance),
            *faces,
        ], channels),
        profiles=profiles,
    )  # fmt: skip
    values = {name: fit[name] for name in ("seebeck", "resistance", "conductance")}
    notes = _notes(settings, max(differences))
    currents = np.concatenate([rows_of(block, ["current"])[0] for block in blocks])
    if np.ptp(currents) <= _SPREAD * np.max(np.abs(currents)):
        return Measurement(fit, (_ONE_CURRENT, *notes))
    return Measurement(fit, tuple(notes), values)


def cold_temperature(module: peltier.PeltierModule, current: Any, hot: Any, heat: Any, leak: float, air: float) -> Any:
    """Return the cold face's temperature [K] at which `cold_side_heat` is what is put in and leaks in, linear in it."""
    at_zero = peltier.cold_side_heat(module, current, hot, 0.0)
    slope = peltier.cold_side_heat(module, current, hot, 1.0) - at_zero
    return (heat + leak * air - at_zero) / (slope + leak)


def _module(values: Values) -> peltier.PeltierModule:
    return peltier.PeltierModule(values["seebeck"], values["resistance"], values["conductance"])


class _State(NamedTuple):
    """Steady states of a table; the hot face's true temperatures are unknowns, as thermocouples err on both faces."""

    current: Array
    hot: Sequence[str]
    heat: Array
    leak: float
    ambient: float

    def _both(self, values: Values) -> tuple[Any, Any]:
        hot = ca.vertcat(*(values[name] for name in self.hot))
        current, heat = ca.DM(self.current), ca.DM(self.heat)
        return hot, cold_temperature(_module(values), current, hot, heat, self.leak, self.ambient)

    def faces(self, values: Values) -> Any:
        """Return temperatures of the hot faces, then of the cold ones [K]."""
        return ca.vertcat(*self._both(values))

    def voltage(self, values: Values) -> Any:
        """Return the voltages [V]."""
        return peltier.voltage(_module(values), ca.DM(self.current), *self._both(values))


def _start(current: Array, voltage: Array, hot: Array, cold: Array) -> tuple[float, float, float]:
    """Return S and R by lines, then K from the heat of the row with the largest difference."""
    table = np.column_stack([hot - cold, current])
    seebeck, resistance = np.abs(np.linalg.lstsq(table, voltage, rcond=None)[0])
    most = int(np.argmax(np.abs(hot - cold)))
    drawn = seebeck * current[most] * cold[most] - 0.5 * current[most] ** 2 * resistance
    conductance = abs(drawn / (hot[most] - cold[most])) if hot[most] != cold[most] else 0.1
    return max(float(seebeck), 1e-6), max(float(resistance), 1e-6), max(float(conductance), 1e-6)


def _notes(settings: Settings, difference: float) -> list[str]:
    notes = []
    if settings["leak"] == 0.0:
        notes.append(
            "The cold face is taken as insulated (--set leak=0.02W/K says otherwise): what leaks in counts as "
            "conductance of the pad."
        )
    if difference < _LEAST_DIFFERENCE:
        notes.append(
            f"The faces differ by {difference:.1f} K at most: more current tells Seebeck and resistance apart."
        )
    return notes
