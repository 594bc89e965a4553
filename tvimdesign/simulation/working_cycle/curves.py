"""Curves to draw: the layer's temperatures over each phase, and stiffness and damping against temperature.

Inside the melting range the solid fraction of a polymer depends on what came before. Cooled from the melt the layer is
still liquid; heated it follows the equilibrium curve, which the record knows to some kelvin only. A metal, a wax or a
glass follows that curve both ways.
"""

from collections.abc import Callable, Mapping
from typing import Any, NamedTuple

import numpy as np

from tvimdesign.physics.polymers import polymer, transitions
from tvimdesign.physics.polymers.polymer import ZERO_CELSIUS
from tvimdesign.simulation.working_cycle.current_profile import Array, CurrentProfile
from tvimdesign.simulation.working_cycle.cycle import Simulator, Trajectory
from tvimdesign.simulation.working_cycle.device_functions import DeviceFunctions, ResolvedModule
from tvimdesign.simulation.working_cycle.phase_functions import FRACTIONS, SHOWN, TEMPERATURES

MEMORY = "melt_memory"
HISTORIES = 5  # Solid fractions, equally spaced from the least to the largest, whose extremes are taken


class Fractions(NamedTuple):
    """Solid fractions [1] at one temperature."""

    low: float  # Cooled from the melt, still liquid; of what freezes as it melts, melting as early as the record allows
    nominal: float  # Heated, on the equilibrium curve
    high: float  # Heated, melting as late as the record allows


def melting_range(resolved: ResolvedModule) -> tuple[float, float]:
    """Return temperatures [K] between which the solid fraction depends on history: earliest start and latest end."""
    melting: polymer.Melting = resolved.quantity("pcl_melting")
    return melting.start + _off(resolved, "melting_start")[0], melting.end + _off(resolved, "melting_end")[1]


def fractions_at(resolved: ResolvedModule, temperature: float) -> Fractions:
    """Return least, nominal and largest solid fraction at a temperature [K]; the same outside the melting range."""
    melting: polymer.Melting = resolved.quantity("pcl_melting")
    nominal = _on_heating(temperature, melting)
    first, last = melting_range(resolved)
    if not first <= temperature <= last:
        return Fractions(nominal, nominal, nominal)
    (start, end), (last_start, last_end) = (
        (_off(resolved, "melting_start")[i], _off(resolved, "melting_end")[i]) for i in (0, 1)
    )
    late = melting._replace(start=melting.start + last_start, end=melting.end + last_end)
    low = 0.0
    if resolved.quantity("pcl_kinetics") is None:
        early = melting._replace(start=melting.start + start, end=melting.end + end)
        low = min(nominal, _on_heating(temperature, early))
    return Fractions(low, nominal, max(nominal, _on_heating(temperature, late)))


def frozen_on_cooling(resolved: ResolvedModule, rate: float) -> Callable[[float], float]:
    """Return a melt's solid fraction [1] by temperature [K], cooled at a rate [K/s]: Nakamura's integral.

    What has no kinetics freezes as it melts, at any rate.
    """
    kinetics: transitions.Kinetics | None = resolved.quantity("pcl_kinetics")
    if kinetics is None:
        melting: polymer.Melting = resolved.quantity("pcl_melting")
        return lambda temperature: _on_heating(temperature, melting)
    temperatures = np.linspace(kinetics.equilibrium_melting + 20.0, 240.0, 4001)
    slowness = transitions.rate_constant(temperatures, kinetics) / rate
    steps = 0.5 * (slowness[1:] + slowness[:-1]) * -np.diff(temperatures)
    extended = np.concatenate([[0.0], np.cumsum(steps)])

    def fraction(temperature: float) -> float:
        psi = np.interp(temperature, temperatures[::-1], extended[::-1])
        return float(transitions.solid_fraction(psi, kinetics))

    return fraction


def intervals(
    resolved: ResolvedModule,
    model: DeviceFunctions,
    inputs: Array,
    cycle: Mapping[str, float],
    current_profiles: Mapping[str, CurrentProfile] | None = None,
) -> dict[str, tuple[float, float]]:
    """Return every output's least and largest value (SI) that a point in the melting range leaves open, by name.

    Damping peaks between the least and the largest solid fraction, so fractions between are tried too. Where the point
    says what soft or stiff means, the cycle is simulated for each of these targets; how it heats is the same.
    """
    ranges: dict[str, tuple[float, float]] = {}
    for point in resolved.points:
        low, nominal, high = fractions_at(resolved, float(inputs[model.index[f"temperature@{point}"]]))
        if low == high:
            continue
        runs, here = [], np.array([name.endswith(f"@{point}") for name in model.output_names])
        for share in (nominal, *np.linspace(low, high, HISTORIES)):
            values_left = left_at(resolved.values, point, float(share), nominal)
            target = _target_as_left(resolved, point, values_left)
            seen = cycle
            if target:
                stated = {**resolved.values, "impedance_targets": "stated", **target}
                stated_model = DeviceFunctions(resolved.table, stated, resolved.points, model.cells)
                seen = Simulator(stated_model).run(stated_model.start, current_profiles).values
            outputs = model.outputs(model.output_names, {f"solid_fraction@{point}": float(share)})
            supplied = [seen[name] for name in model.switch_names]
            values = np.asarray(outputs(inputs, supplied)).ravel()
            if share < nominal and MEMORY in model.index:  # other points are heated still
                without = inputs.copy()
                without[model.index[MEMORY]] = 1.0
                values = np.where(here, np.asarray(outputs(without, supplied)).ravel(), values)
            runs.append(values)
        least, most = np.min(runs, axis=0), np.max(runs, axis=0)
        for name, a, b in zip(model.output_names, least, most, strict=True):
            if not (np.isnan(a) or np.isclose(a, b, rtol=1e-9, atol=0.0)):
                other = ranges.get(name, (a, b))
                ranges[name] = (float(min(a, other[0])), float(max(b, other[1])))
        ranges[f"solid_fraction@{point}"] = (low, high)
    return ranges


def left_at(values: Mapping[str, Any], point: str, share: Any, nominal: Any) -> dict[str, Any]:
    """Return a module's values as a history leaves its layer at a point.

    With a solid fraction below the `nominal` one on heating it was cooled, and its melt has no memory of its crystals.
    """
    left = {**values, f"solid_fraction@{point}": share}
    return left | ({MEMORY: np.where(share < nominal, 1.0, values[MEMORY])} if MEMORY in values else {})


_TARGETS = {"hot": "soft_impedance", "cold": "stiff_impedance"}


def _target_as_left(resolved: ResolvedModule, point: str, left: Mapping[str, Any]) -> dict[str, float]:
    """Return both targets [N*m/rad] with the one of a point as a history leaves it; none if the point sets none."""
    if point not in _TARGETS or resolved.values["impedance_targets"] == "stated":
        return {}
    values = {end: left if end == point else resolved.values for end in _TARGETS}
    return {
        name: float(resolved.table.evaluate(values[end], [f"joint_impedance@{end}"])[f"joint_impedance@{end}"])
        for end, name in _TARGETS.items()
    }


def _on_heating(temperature: float, melting: polymer.Melting) -> float:
    return float(polymer.solid_fraction(polymer.enthalpy(temperature, melting), melting))


def _off(resolved: ResolvedModule, field: str) -> tuple[float, float]:
    """Return the record's range [K] below and above its value; a study's own value is taken to be as sure."""
    entry = resolved.values["pcl_grade"].entry(field)
    low = entry.value if entry.low is None else entry.low
    high = entry.value if entry.high is None else entry.high
    return low - entry.value, high - entry.value


Curves = dict[str, list[float]]
SAMPLES = 161
LOOP_SAMPLES = 73
PHASE_UNITS = {
    "time": "s", "current": "A", "frozen": "1", "joint_impedance": "N*m/rad", "joint_stiffness": "N*m/rad",
    "joint_damping": "N*m*s/rad", "electrical_power": "W", "electrical_energy": "J",
}  # fmt: skip
"""Units of a phase's columns; all others are temperatures [degC]."""


def phase_history(model: DeviceFunctions, inputs: Array, trajectory: Trajectory, phase: str) -> Curves:
    """Return a phase's curves by column: temperatures [degC] through the stack, and the columns of `PHASE_UNITS`.

    Stiffness and damping are those of the joint at the frequency of the operating point where the phase leads; energy
    is what the supply gave since the phase began.
    """
    times, names = trajectory.times, temperature_names(model, inputs, phase)
    wanted = (TEMPERATURES, FRACTIONS, "impedance_now", *SHOWN.values())
    seen = model.engines[phase].at_instants(wanted, inputs, trajectory.states, trajectory.currents)
    kelvin, solid, shown = np.split(seen, [len(names), len(names) + model.cells])
    history, frozen = dict(zip(names, (kelvin - ZERO_CELSIUS).tolist(), strict=True)), np.mean(solid, axis=0)
    drawn = dict(zip(("joint_impedance", *SHOWN), shown, strict=True))
    power = drawn["electrical_power"]
    energy = np.concatenate([[0.0], np.cumsum(0.5 * (power[1:] + power[:-1]) * np.diff(times))])
    more = {"current": trajectory.currents, "frozen": frozen, **drawn,
            "electrical_energy": energy}  # fmt: skip
    return {"time": times.tolist(), **history, **{name: column.tolist() for name, column in more.items()}}


def temperature_names(model: DeviceFunctions, inputs: Array, phase: str) -> list[str]:
    """Return a name for each of a phase's temperatures, in their order."""
    depth = [f"cell_{i + 1}" for i in range(model.cells)]
    plate = [f"rotor_{i + 1}" for i in range(int(inputs[model.index["rotor_cells"]]))]
    names = ["cold_side", "hot_side", "near_face", *depth, "far_face", *plate]
    beside, around, sinks = model.engines[phase].bodies
    names += [*(f"rotor_beside_{i + 1}" for i in range(beside - 1)), "core_and_link", *["sink"] * sinks]
    return [*names, *(f"beside_pads_{i + 1}" for i in range(around - 1)), "housing"]


def torque_loop(stiffness: float, damping: float, frequency: float, amplitude: float) -> tuple[Array, Array]:
    """Return angles [rad] and torques [N*m] of one period in which a joint is turned as a sine.

    T = K phi + b dphi/dt with phi = amplitude sin(2 pi f t): stiffness [N*m/rad], damping [N*m*s/rad], frequency [Hz].
    """
    turned = np.linspace(0.0, 2.0 * np.pi, LOOP_SAMPLES)
    angle = amplitude * np.sin(turned)
    return angle, stiffness * angle + damping * 2.0 * np.pi * frequency * amplitude * np.cos(turned)


def impedance_sweep(resolved: ResolvedModule) -> Curves:
    """Return layer's and joint's stiffness and damping against the layer's temperature [degC] at the hot frequency.

    Each with its least and largest value over what history allows, `..._low` and `..._high`; the middle one is the
    equilibrium curve on heating. `rig` holds the design's numbers.
    """
    celsius = np.linspace(0.0, 120.0, SAMPLES)
    names = ["pcl_stiffness", "pcl_damping", "joint_stiffness", "joint_damping", "solid_fraction"]
    low, nominal, high = np.array([fractions_at(resolved, float(at)) for at in celsius + ZERO_CELSIUS]).T
    shares = np.array([nominal, *(low + part * (high - low) for part in np.linspace(0.0, 1.0, HISTORIES))])
    # Every sample at once; the solid fraction at the hot point is given.
    swept = left_at(resolved.values, "hot", shares, nominal) | {"temperature@hot": celsius + ZERO_CELSIUS}
    values = resolved.table.evaluate(swept, [f"{name}@hot" for name in names])
    curves: Curves = {"temperature": celsius.tolist()}
    for name in names:
        every = np.broadcast_to(values[f"{name}@hot"], shares.shape)
        curves |= {name: every[0].tolist(), f"{name}_low": every.min(axis=0).tolist(),
                   f"{name}_high": every.max(axis=0).tolist()}  # fmt: skip
    return curves
