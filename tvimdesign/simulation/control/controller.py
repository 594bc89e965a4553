"""The controller of the heater's current: its constants from the module, and its law as the microcontroller has it.

A PI law with the switch's own current as its ceiling; an observer of the layer's hot face from thermistor and current;
and a column of cells behind that face for the joint's impedance. All constants follow from the module: the gains by
the SIMC rule from the reaction curve of the heat equation, linearised where the switch ends. Sources: [S] Skogestad,
J. Process Control 13 (2003) 291; [Z] Ziegler and Nichols, Trans. ASME 64 (1942) 759 (reaction curve); [A] Astrom and
Hagglund, Advanced PID Control (2006), sec. 3.5 (conditional integration) and 4.5 (disturbance as a state).

A module under its controller: heat equation by the engine, driver and thermistor with their lags.
"""

from dataclasses import dataclass
from itertools import pairwise
from math import exp, hypot, log
from typing import NamedTuple

import numpy as np

from tvimdesign.base.errors import SimulationError
from tvimdesign.engine.integrator import adapted
from tvimdesign.physics.heat_flow import heat
from tvimdesign.simulation.working_cycle.current_profile import Array, CurrentProfile
from tvimdesign.simulation.working_cycle.device_functions import DeviceFunctions
from tvimdesign.simulation.working_cycle.phase_instants import Instant


@dataclass(frozen=True)
class Controller:
    """Constants of a controller, SI; in C they have the same names."""

    period: float
    sensor_lag: float
    heating: float  # Rise of the hot face by current, of the reaction curve's tangent [K/(A s)]
    balance: float  # Current at which the hot face stands still where the switch ends [A]
    gain: float  # [A/K]
    integral_time: float
    observer_sensed: float
    observer_near: float
    observer_drift: float
    hottest: float
    """Highest set-point of the hot face: where the switch ends, and higher as far as ratings leave room [K]."""
    soft: float  # Impedance of the soft joint [N*m/rad]
    stiff: float
    band: float  # Factor of an impedance within which it counts as reached
    springs: float
    cooling: float  # Current of the way back [A]
    cooled: float  # Temperature of the hot face down to which that current cools [K]
    layer_conductance: float  # Between cells of the layer [W/K]
    cell_mass: float
    behind_resistance: float  # Between the layer's last cell and what is behind it [K/W]
    behind_capacity: float
    behind_loss: float  # To the air [W/K]
    layer_cells: int
    profile_time: tuple[float, ...]
    profile_current: tuple[float, ...]
    layer_temperature: tuple[float, ...]
    layer_enthalpy: tuple[float, ...]
    layer_compliance: tuple[float, ...]
    layer_loss: tuple[float, ...]
    """Real and, below zero, imaginary compliance of a layer at one temperature [rad/(N*m)]."""
    layer_structure: tuple[float, ...]
    layer_structure_loss: tuple[float, ...]  # Loss of the structure, by the temperature of the hot face
    layer_softness: tuple[float, ...]  # One over the joint's impedance with such a layer [rad/(N*m)]


class RunningController:
    """A controller that runs, as controller.c does."""

    def __init__(self, constants: Controller, thermistor: float) -> None:
        """Start with the joint at rest, everywhere at the temperature of the thermistor [K]."""
        self.constants = constants
        self.sensed = self.near = self.behind = self.ambient = thermistor
        self.drift = self.integral = self.current = self.time = 0.0
        enthalpy = _between(constants.layer_temperature, constants.layer_enthalpy, thermistor)
        self.enthalpy = [enthalpy] * constants.layer_cells
        self.impedance = constants.stiff

    def _estimate(self, thermistor: float) -> None:
        """Go on by a period."""
        c, h, error, sensed = self.constants, self.constants.period, thermistor - self.sensed, self.sensed
        self.sensed += h * ((self.near - sensed) / c.sensor_lag + c.observer_sensed * error)
        self.near += h * (c.heating * (self.current - c.balance) + self.drift + c.observer_near * error)
        self.drift += h * c.observer_drift * error
        cells = [_between(c.layer_enthalpy, c.layer_temperature, enthalpy) for enthalpy in self.enthalpy]
        flow = [2.0 * c.layer_conductance * (self.near - cells[0])]
        flow += [c.layer_conductance * (hotter - colder) for hotter, colder in pairwise(cells)]
        flow.append((cells[-1] - self.behind) / c.behind_resistance)
        compliance = _between(c.layer_temperature, c.layer_structure, self.near)
        loss = _between(c.layer_temperature, c.layer_structure_loss, self.near)
        for i, cell in enumerate(cells):
            self.enthalpy[i] += h * (flow[i] - flow[i + 1]) / c.cell_mass
            compliance += _between(c.layer_temperature, c.layer_compliance, cell) / c.layer_cells
            loss += _between(c.layer_temperature, c.layer_loss, cell) / c.layer_cells
        self.behind += h * (flow[-1] - c.behind_loss * (self.behind - self.ambient)) / c.behind_capacity
        size = compliance * compliance + loss * loss
        self.impedance = hypot(c.springs + compliance / size, loss / size)

    def step(self, thermistor: float, impedance: float) -> float:
        """Return the current [A] of the next period, below zero to cool, for an impedance [N*m/rad]."""
        c = self.constants
        self._estimate(thermistor)
        if impedance >= c.stiff:
            self.integral = self.time = 0.0
            self.current = -c.cooling if self.near > c.cooled else 0.0
            return self.current
        impedance = max(impedance, c.soft)
        most = _between(c.profile_time, c.profile_current, min(self.time, c.profile_time[-1]))
        hold = _between(c.layer_softness, c.layer_temperature, 1.0 / impedance)
        hold = min(hold, c.hottest)
        share = min(max(log(self.impedance / impedance) / log(c.band), 0.0), 1.0)
        error = hold + share * (c.hottest - hold) - self.near
        wanted = c.balance + c.gain * error + self.integral
        self.current = min(max(wanted, 0.0), most)
        if self.current == wanted or (wanted > most) == (error < 0.0):
            self.integral += c.gain * c.period / c.integral_time * error
        self.time += c.period
        return self.current


def _between(x: tuple[float, ...], y: tuple[float, ...], at: float) -> float:
    """Interpolate straight between the rows of a table that rises in x, and go straight on beyond it."""
    i = 1
    while i < len(x) - 1 and at > x[i]:
        i += 1
    return y[i - 1] + (y[i] - y[i - 1]) * (at - x[i - 1]) / (x[i] - x[i - 1])


@dataclass(frozen=True)
class ReactionCurve:
    """Step response of a linear system as an integrator with a dead time: the tangent where it is steepest [Z]."""

    slope: float
    dead_time: float

    def gains(self) -> tuple[float, float]:
        """Return the gain and the integral time [s] by SIMC [S], closed as quickly as the dead time: tight control."""
        closed = 2.0 * self.dead_time
        return float(1.0 / (self.slope * closed)), float(4.0 * closed)


def reaction_curve(a: Array, b: Array, c: Array, lags: tuple[float, ...], period: float, until: float) -> ReactionCurve:
    """Return the reaction curve of dx/dt = a x + b u, y = c x behind some lags [s], half a period of delay counted."""
    from scipy.linalg import expm  # a third of a second, for studies with a controller alone

    size = len(a)
    matrix = np.zeros((size + len(lags) + 1, size + len(lags) + 1))
    matrix[:size, :size], matrix[:size, -1] = a, b
    before = np.append(c, np.zeros(len(lags) + 1))
    for place, lag in enumerate(lags, size):
        matrix[place] = before / lag
        matrix[place, place] -= 1.0 / lag
        before = np.eye(len(matrix))[place]
    step, state = expm(matrix * period), np.eye(len(matrix))[-1]
    response = [0.0]
    for _ in range(max(int(until / period), 2)):
        state = step @ state
        response.append(float(before @ state))
    slopes = np.diff(response) / period
    steepest = int(np.argmax(slopes))
    middle = 0.5 * (response[steepest] + response[steepest + 1])
    dead = (steepest + 0.5) * period - middle / slopes[steepest]
    return ReactionCurve(float(slopes[steepest]), dead + 0.5 * period)


TOLERANCE = 1e-3  # Largest error of a step in the scaled state: a tenth of a kelvin
SOFT = "softening_time"  # Event from which on the joint is soft, whatever ends a switch
_NONE = np.zeros(0)


class Lags(NamedTuple):
    """Time constants [s] of what is between controller and module."""

    thermistor: float
    driver: float


@dataclass(frozen=True)
class Controlled:
    """A switch to soft under a controller; a row a period."""

    times: Array
    currents: Array  # Asked of the driver [A]
    near: Array  # Hot face of the layer [K]
    hot: Array  # Hot side of the pads [K]
    impedances: Array  # As the controller estimates them [N*m/rad]
    due: Array  # Logarithm of the soft threshold over the joint's impedance: soft from zero on

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

    def switch(self, constants: Controller, lags: Lags, seconds: float) -> Controlled:
        """Simulate so many seconds with no impedance asked for: soft. Raises SimulationError."""
        size, period = self.engine.size, constants.period
        before = Instant(0.0, _NONE, self.start, np.zeros((len(self.start), 0)), 0.0, _NONE)
        run, start, _, _ = self.engine._begin(self.inputs, np.zeros((len(self.inputs), 0)), before)
        y, ahead, step = start.state.copy(), np.zeros(start.state.size), period
        y[:size] = self.start

        def seen(current: float) -> tuple[float, float]:
            near = self.target + heat.TEMPERATURE_SCALE * run.value("near_face_time", y[:size], current)
            return near, run.value("peak_heater_temperature", y[:size], current)

        near, _ = seen(0.0)
        thermistor, current, controller = near, 0.0, RunningController(constants, near)
        rows = []
        for k in range(int(np.ceil(seconds / period))):
            requested = controller.step(thermistor, 0.0)
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
