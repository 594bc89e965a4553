"""Repeated switching: the working cycle again and again, each from where the one before ended, until it is periodic.

The joint is heated until soft, kept so by its hold current, cooled until stiff, and left without current until the
next switch. The engine steps these phases as it does those of one cycle; only the first state is another.

The controller of a module is tried on other modules: its constants are those of the module as drawn, parts differ
within their tolerances, assumed values, thermistor and driver anywhere in their ranges.
"""

from collections.abc import Collection, Mapping
from dataclasses import dataclass, field

import numpy as np

from tvimdesign.simulation.control.controller import ControlledModule, Controller, Lags
from tvimdesign.simulation.control.sizing import Array, controller_of
from tvimdesign.simulation.working_cycle.current_profile import CurrentProfile
from tvimdesign.simulation.working_cycle.cycle import Simulator
from tvimdesign.simulation.working_cycle.device_functions import DeviceFunctions, ResolvedModule
from tvimdesign.simulation.working_cycle.phase_engine import PhaseEngine
from tvimdesign.simulation.working_cycle.phase_instants import Instant, PhaseOutputs
from tvimdesign.simulation.working_cycle.phase_results import PhaseResults
from tvimdesign.solve.nlp import spread
from tvimdesign.solve.optimizer.verify_optimum import exceeded
from tvimdesign.solve.uncertainty.uncertain_inputs import contributors_of, unmeasured_inputs
from tvimdesign.study import Study

HOUR = 3600.0
PERIODIC = 1e-4  # Change of the scaled temperatures over a cycle, a hundredth of a kelvin, below which it is periodic
REACHED = 1e-2
"""Distance of the scaled temperatures from the periodic state, one kelvin, from which on it counts as reached."""
MOST_CYCLES, DEPTH = 200, 4  # Cycles at most, and of how many the next start is extrapolated (Anderson)
FINE = 0.01  # Share to which the highest duty is found
SHOWN = ("response_time", "return_time", "peak_heater_temperature", "peak_cold_side_temperature",
         "peak_pcl_temperature", "peak_liner_temperature", "peak_rotor_temperature")  # fmt: skip
"""What is reported of the periodic cycle."""


@dataclass(frozen=True)
class DutyCycle:
    """One cycle."""

    end: Array  # State when the next switch is due
    taken: float  # Time of all but the rest [s]
    energy: float  # [J]
    values: dict[str, float]
    """What the cycle supplies to the table: highest temperatures, powers, voltages, and the times."""


@dataclass(frozen=True)
class DutyResult:
    """Result of a duty; nothing but its limit if its cycle does not fit between two switches."""

    values: dict[str, float]  # Times and highest temperatures of the periodic cycle, by the quantity's name, SI
    exceeded: tuple[str, ...]  # Ratings that it exceeds, without those the study accepts
    settling: float  # Time from a cold start until the temperatures are within 1 K of the periodic ones [s]
    energy_a_day: float  # [J]
    most: float  # Most switches an hour that keep every rating and leave time for both ways
    limited_by: str  # Limit that more of them would exceed: a rating, or `time`
    quantities: dict[str, float] = field(default_factory=dict)  # Every quantity, with what the periodic cycle supplies


class Duty:
    """The duty of one module; `soft` is how long each switch keeps it soft [s]."""

    def __init__(
        self, model: DeviceFunctions, inputs: Array, current_profiles: dict[str, CurrentProfile], soft: float
    ) -> None:
        """Simulate one cycle from ambient, for its hold current and its values."""
        self.model, self.inputs, self.soft = model, inputs, soft
        simulator = Simulator(model)
        self.cold = simulator.run(inputs, current_profiles)
        self.drives = {name: current_profiles.get(name) or simulator.constant_drive(name, inputs)
                       for name in ("softening", "stiffening")}  # fmt: skip
        balance = self.cold.balances.get("softening")
        self.hold = None if balance is None else CurrentProfile.constant(float(balance[-1]))
        self.heating, self.cooling = model.either_way_engine, model.engines["stiffening"]
        equilibrium = np.asarray(model.phases["softening"].initial(inputs)).ravel()
        self.heat = len(equilibrium)  # Entries of the state that are heat; the others are what is frozen
        self.ambient = np.asarray(model.either_way.begin(equilibrium, inputs)).ravel()
        self.horizon = float(inputs[model.index["horizon"]])

    def cycle(self, state: Array, period: float) -> DutyCycle | None:
        """Return one cycle from a state; None if it never gets soft or stiff. Without time for a rest it has none."""
        runs: list[PhaseOutputs] = []
        soft_after = self._run(runs, "softening", state, self.drives["softening"], None)
        if soft_after is None or (self.soft > 0.0 and self.hold is None):
            return None
        end = soft_after
        if self.soft > 0.0 and self.hold is not None:
            held = self._run(runs, "softening", end.state, self.hold, self.soft)
            assert held is not None
            end = held
        stiff_after = self._run(runs, "stiffening", end.state, self.drives["stiffening"], None)
        if stiff_after is None:
            return None
        end, taken = stiff_after, soft_after.time + self.soft + stiff_after.time
        if period > taken:
            pause = self._run(runs, "stiffening", end.state, CurrentProfile.constant(0.0), period - taken)
            assert pause is not None
            end = pause
        values = {"response_time": soft_after.time, "return_time": stiff_after.time}
        rows = {row.name: row.reduce for phase in (self.heating, self.cooling) for row in phase.phase.paths}
        for run in runs:
            for name, value in run.values.items():
                if rows[name] == "integral":
                    values[name] = values.get(name, 0.0) + value
                elif rows[name] == "maximum":
                    values[name] = max(values.get(name, -np.inf), value)
                else:
                    values.setdefault(name, value)
        energy = values["switch_energy"] + values["stiffening_energy"]
        return DutyCycle(end.state[: self.heating.size], taken, energy, values)

    def _run(
        self, runs: list[PhaseOutputs], name: str, state: Array, profile: CurrentProfile, length: float | None
    ) -> Instant | None:
        """Step a phase until it ends or, with a length, for so long, and add what it supplies."""
        engine: PhaseEngine = self.heating if name == "softening" else self.cooling
        ends = engine.phase.phase.ends
        run, moments, _ = engine.simulate(
            self.inputs, profile, state[: engine.size], [] if length else [ends], length or self.horizon,
            Simulator(self.model).tolerance, throughout=length is not None, going_on=True,
        )  # fmt: skip
        end = run.instants[-1] if length else moments.get(ends)
        if end is not None:
            runs.append(PhaseOutputs(end=end))
            PhaseResults(run).add_paths(runs[-1], None)
        return end

    def periodic(self, period: float, start: Array | None = None) -> tuple[Array, DutyCycle] | None:
        """Return the state to which the cycle returns, and that cycle; None if there is none.

        Temperatures of the next start are extrapolated by Anderson's method; what is frozen follows the last cycle.
        """
        state = self.ambient if start is None else start
        tried: list[Array] = []
        ends: list[Array] = []
        for _ in range(MOST_CYCLES):
            cycle = self.cycle(state, period)
            if cycle is None:
                return None
            change = cycle.end[: self.heat] - state[: self.heat]
            if np.max(np.abs(change)) < PERIODIC:
                return state, cycle
            tried, ends = [*tried[-DEPTH:], change], [*ends[-DEPTH:], cycle.end[: self.heat]]
            state = cycle.end.copy()
            if len(tried) > 1:
                of_change, of_end = np.diff(tried, axis=0).T, np.diff(ends, axis=0).T
                weights = np.linalg.lstsq(of_change, change, rcond=1e-6)[0]
                ahead = of_end @ weights
                state[: self.heat] -= ahead * min(1.0, 0.2 / max(float(np.max(np.abs(ahead))), 1e-12))
        return None

    def settling(self, state: Array, period: float) -> float:
        """Return the time in which cycles from ambient come within a kelvin of a state; infinite if never."""
        now = self.ambient
        for count in range(MOST_CYCLES):
            if np.max(np.abs(now[: self.heat] - state[: self.heat])) < REACHED:
                return count * period
            cycle = self.cycle(now, period)
            if cycle is None:
                break
            now = cycle.end
        return np.inf

    def values_of(self, supplied: Mapping[str, float]) -> dict[str, float]:
        """Return every quantity with what a cycle supplies in place of that from ambient."""
        return self.model.values(self.inputs, {**self.cold.values, **supplied})

    def above(self, supplied: Mapping[str, float], accepted: Collection[str]) -> list[str]:
        """Return the ratings that a cycle exceeds, without those that are accepted."""
        beyond = exceeded(self.values_of(supplied), self.model.table)
        return [limit.output for limit in beyond if limit.output not in accepted]

    def limit(self, period: float, accepted: Collection[str], start: Array | None) -> tuple[str, Array | None]:
        """Return what a duty exceeds, nothing if it keeps all, and its periodic state."""
        returning = self.periodic(period, start)
        if returning is None or returning[1].taken > period:
            return "time", None
        return next(iter(self.above(returning[1].values, accepted)), ""), returning[0]

    def most(self, accepted: Collection[str], requested: float) -> tuple[float, str]:
        """Return the most switches an hour that keep all ratings, and what more would exceed; by bisection."""
        if above := self.above({}, accepted):  # by one switch
            return 0.0, above[0]
        low, high, start, by = 0.0, np.inf, None, ""
        rate, least = requested, 1.0 / 24.0
        while high / max(low, least) > 1.0 + FINE and rate >= least:
            limit, state = self.limit(HOUR / rate, accepted, start)
            if limit:
                high, by = rate, limit
            else:
                low, start = rate, state
            rate = 2.0 * low if np.isinf(high) else np.sqrt(low * high) if low else high / 4.0
        return low, by


def duty_of(
    study: Study, model: DeviceFunctions, inputs: Array, current_profiles: dict[str, CurrentProfile]
) -> DutyResult | None:
    """Return the result of a study's duty; None if it has none."""
    requested = study.duty.switches_per_hour
    if not requested:
        return None
    duty = Duty(model, inputs, current_profiles, study.duty.soft)
    period = HOUR / requested
    returning = duty.periodic(period)
    most, by = duty.most(study.accept, requested)
    if returning is None or returning[1].taken > period:
        return DutyResult({}, (), np.inf, np.inf, most, by)
    state, cycle = returning
    shown = {name: cycle.values[name] for name in SHOWN if name in cycle.values}
    above = tuple(duty.above(cycle.values, study.accept))
    energy, quantities = 24.0 * requested * cycle.energy, duty.values_of(cycle.values)
    return DutyResult(shown, above, duty.settling(state, period), energy, most, by, quantities)


LAG_RANGE = 2.5
"""Factor to either side within which a lag is assumed. TDK B57862: heat capacity 36 mJ/K, 1.7 mW/K in still air; a bead
that 0.1 to 0.5 mm of adhesive (0.2 W/(m K)) holds over 20 mm^2 has 8 to 40 mW/K, 0.9 to 4.5 s. Test: step of current,
reading against the joint's own rise."""
OVERSHOOT, LATE = 3.0, 1.1
"""Limits of a controlled switch: hot face above its highest set-point [K], time to soft over that uncontrolled."""
SHARE = 0.95  # Share of modules that reported values cover
WATCHED = 2.0  # How long a module is watched, in times that it takes without controller


@dataclass(frozen=True)
class ControlResult:
    """A controller on drawn modules; `SHARE` of them have at most these values."""

    controller: Controller
    overshoot: float  # Of the hot face over its highest set-point [K]; below zero if it stays under it
    hottest_pads: float  # Highest temperature of the pads [K]
    settling: float  # Time until soft over that of the same module by the switch's current alone [1]
    settling_of_nominal: float  # Time until soft over that of the module as drawn [1]
    controlled: spread.Yield  # Share within `OVERSHOOT` and `LATE`
    stays_soft: spread.Yield  # Share that stays soft once it is, as long as it is watched


def drawn_modules(resolved: ResolvedModule, count: int) -> list[tuple[Array, Lags]]:
    """Draw inputs and lags of modules, a power of two, by tolerances and ranges of assumed values at once."""
    options, parts, ranges = resolved.study.control, contributors_of(resolved), unmeasured_inputs(resolved)
    parts = [part for part in parts if part.name not in {"current", "cooling_current"}]
    points = spread.sobol_points(len(parts) + len(ranges) + 2, count, resolved.study.solver.seed)
    lags = np.array([options.thermistor_lag, options.driver_lag])
    modules = []
    for point in points:
        values: dict[str, float] = {}
        for quantity, share in zip(ranges, point[len(parts) :], strict=False):
            values[quantity.name] = float(quantity.ppf(share))
        for part, share in zip(parts, point, strict=False):
            moved = values.get(part.name, part.nominal) + float(part.ppf(share)) - part.nominal
            values[part.name] = min(max(moved, part.lower), part.upper)
        known = {name: value for name, value in values.items() if name in resolved.functions.index}
        inputs = resolved.functions.inputs(known)
        modules.append((inputs, Lags(*(lags * LAG_RANGE ** (2.0 * point[-2:] - 1.0)).tolist())))
    return modules


def control_of(resolved: ResolvedModule) -> ControlResult | None:
    """Return the result of a study's controller; None if it asks for none, or the module never gets soft."""
    count = resolved.study.control.draws
    controller = controller_of(resolved) if count else None
    if controller is None:
        return None
    model = resolved.functions
    drive = resolved.current_profiles.get("softening") or Simulator(model).constant_drive("softening", model.start)
    nominal = ControlledModule(model, model.start).uncontrolled(drive)
    rows = []
    for drawn, lags in drawn_modules(resolved, spread.power_of_two(count)):
        module = ControlledModule(model, drawn)
        alone = module.uncontrolled(drive)
        course = module.switch(controller, lags, WATCHED * min(max(alone, nominal), module.horizon))
        soft, stays = course.soft_after, course.due[course.times > course.soft_after]
        over, pads = np.max(course.near) - controller.hottest, np.max(course.hot)
        rows.append((over, pads, soft / alone, soft / nominal, bool(len(stays)) and np.min(stays) >= 0.0))
    values = np.nan_to_num(np.array(rows, dtype=float), nan=np.inf, posinf=np.inf).T
    worst = np.quantile(values[:4], SHARE, axis=1, method="higher").tolist()
    good = (values[0] < OVERSHOOT) & (values[2] <= LATE)
    shares = [spread.share_kept(row) for row in (good, values[4] > 0.0)]
    return ControlResult(controller, *worst, *shares)
