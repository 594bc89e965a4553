"""A module under its controller: heat equation by the engine, driver and thermistor with their lags."""

from dataclasses import dataclass
from math import exp
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from tvimdesign.base.errors import SimulationError
from tvimdesign.engine.integrator import adapted
from tvimdesign.physics.heat_flow import heat
from tvimdesign.simulation.control.controller import Controller, RunningController
from tvimdesign.simulation.working_cycle.current_profile import CurrentProfile
from tvimdesign.simulation.working_cycle.device_functions import DeviceFunctions
from tvimdesign.simulation.working_cycle.phase_instants import Instant

Array = NDArray[np.float64]
TOLERANCE = 1e-3
"""Largest error of a step in the scaled state: a tenth of a kelvin."""
SOFT = "softening_time"
"""Event from which on the joint is soft, whatever ends a switch."""
_NONE = np.zeros(0)


class Lags(NamedTuple):
    """Time constants [s] of what is between controller and module."""

    thermistor: float
    driver: float


@dataclass(frozen=True)
class Controlled:
    """A switch to soft under a controller; a row a period."""

    times: Array
    currents: Array
    """Asked of the driver [A]."""
    near: Array
    """Hot face of the layer [K]."""
    hot: Array
    """Hot side of the pads [K]."""
    impedances: Array
    """As the controller estimates them [N*m/rad]."""
    due: Array
    """Logarithm of the soft threshold over the joint's impedance: soft from zero on."""

    @property
    def soft_after(self) -> float:
        """Time until the joint is soft [s]; infinite if it never is."""
        return float(self.times[np.argmax(self.due >= 0.0)]) if np.any(self.due >= 0.0) else np.inf


class ControlledModule:
    """One module with numbers of its own; its layer melts with its history, as in the FMU."""

    def __init__(self, model: DeviceFunctions, inputs: Array) -> None:
        """Start everywhere at ambient temperature."""
        self.inputs, self.engine = inputs, model.either_way_engine
        self.target = float(inputs[model.index["target_temperature"]])
        self.horizon = float(inputs[model.index["horizon"]])
        self.start = np.asarray(self.engine.phase.initial(inputs)).ravel()

    def uncontrolled(self, drive: CurrentProfile) -> float:
        """Return the time until the joint is soft by a current alone [s]; infinite if it never is."""
        _, moments, _ = self.engine.simulate(
            self.inputs, drive, self.start, [SOFT], self.horizon, TOLERANCE, going_on=True
        )
        return moments[SOFT].time if SOFT in moments else np.inf

    def switch(self, constants: Controller, lags: Lags, seconds: float, impedance: float = 0.0) -> Controlled:
        """Simulate so many seconds with an impedance asked for, soft unless given. Raises SimulationError."""
        size, period = self.engine.size, constants.period
        before = Instant(0.0, _NONE, self.start, np.zeros((len(self.start), 0)), 0.0, _NONE)
        run, start, _, _ = self.engine._begin(self.inputs, np.zeros((len(self.inputs), 0)), before)
        y, ahead, step = start.state.copy(), np.zeros(start.state.size), period
        y[:size] = self.start

        def seen(current: float) -> tuple[float, float]:
            near = self.target + heat.TEMPERATURE_SCALE * run.value("near_face_time", y[:size], current)
            return near, run.value("peak_peltier_temperature", y[:size], current)

        near, _ = seen(0.0)
        thermistor, current, controller = near, 0.0, RunningController(constants, near)
        rows = []
        for k in range(int(np.ceil(seconds / period))):
            requested = controller.step(thermistor, impedance)
            left = period
            decay = exp(-period / lags.driver)
            mean = requested + (current - requested) * lags.driver / period * (1.0 - decay)
            current = requested + (current - requested) * decay
            while left > 1e-9 * period:
                taken, step = adapted(
                    run.motion.system, run.registers[2], y, mean, 0.0, min(step, left), TOLERANCE, ahead
                )
                if taken == 0.0:
                    raise SimulationError("the module cannot be simulated under its controller; check its inputs")
                left -= taken
            now, hot = seen(current)
            thermistor, near = lagged(thermistor, near, now, period, lags.thermistor), now
            due = run.value(SOFT, y[:size], current)
            rows.append(((k + 1) * period, requested, near, hot, controller.impedance, due))
        return Controlled(*np.array(rows).T)


def lagged(reading: float, before: float, now: float, seconds: float, lag: float) -> float:
    """Return the reading of a first-order lag [s] after some seconds over which what it reads changes evenly."""
    slope = (now - before) / seconds
    return now - slope * lag + (reading - before + slope * lag) * exp(-seconds / lag)
