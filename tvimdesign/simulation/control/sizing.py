"""The constants of a module's controller, from its working cycle and its heat equation."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from tvimdesign.physics.heat_flow import heat
from tvimdesign.physics.polymers.polymer import ZERO_CELSIUS
from tvimdesign.simulation.control.controller import Controller, reaction_curve
from tvimdesign.simulation.working_cycle.cycle import Cycle, Simulator, Trajectory
from tvimdesign.simulation.working_cycle.device_functions import ResolvedModule
from tvimdesign.simulation.working_cycle.phase_functions import PhaseFunctions
from tvimdesign.simulation.working_cycle.symbols import ca

Array = NDArray[np.float64]
CELLS = 8  # Cells of the estimated layer at most; fewer where explicit steps would not be stable
ROWS = 32  # Rows of the layer's tables over the melting window, and over all temperatures
COLDEST, HOTTEST = -40.0, 200.0  # Temperatures of the tables' ends [degC]
_RATINGS = ("heater", "structure", "pcl", "liner")
_LEAST = 1e-12


def controller_of(resolved: ResolvedModule) -> Controller | None:
    """Return the controller of a module; None if it never gets soft."""
    options, model, inputs = resolved.study.control, resolved.functions, resolved.functions.start
    simulator = Simulator(model)
    cycle = simulator.run(inputs, resolved.current_profiles)
    values = model.values(inputs, cycle.values)
    if not np.isfinite([values["response_time"], values["softening_time"]]).all():
        return None
    phase, course = model.phases["softening"], cycle.trajectories["softening"]
    end, current = course.states[:, -1], float(course.currents[-1])
    seen = phase.evaluated(("stack_profile",), lambda now: [now.near, now.far, now.through_layer[-1]])
    near = float(seen(end, current, inputs)[0])
    slope, by_state, by_current, of_near = _linearised(phase, end, current, inputs)
    lag, period = options.thermistor_lag, options.period
    curve = reaction_curve(by_state, by_current, of_near, (options.driver_lag, lag), period, values["response_time"])
    gain, integral_time = curve.gains()
    ratings = [
        values[f"{part}_temperature_margin"] for part in _RATINGS if part != "liner" or values.get("liner_depth")
    ]
    drive = resolved.current_profiles.get("softening") or simulator.constant_drive("softening", inputs)
    moments, currents = ((*drive.moments, drive.moments[-1] + 1.0), (*drive.currents, drive.currents[-1]))
    springs, band = (float(resolved.quantity(name)) for name in ("spring_stiffness", "softening_band"))
    layer = _layer(resolved.quantity("stack"), period)
    resistance, capacity, loss = _behind(seen, cycle, inputs, float(resolved.quantity("ambient_temperature")))
    return Controller(
        period=period,
        sensor_lag=lag,
        heating=curve.slope,
        balance=current - slope / curve.slope,
        gain=gain,
        integral_time=integral_time,
        observer_sensed=2.0 / lag,  # all poles of the observer at the sensor's own
        observer_near=3.0 / lag,
        observer_drift=1.0 / lag**2,
        hottest=near + max(0.0, min(ratings)),
        soft=values["soft_threshold"] / band,
        stiff=values["joint_impedance@cold"],
        band=band,
        springs=springs,
        cooling=-float(simulator.constant_drive("stiffening", inputs).currents[0]),
        cooled=float(resolved.quantity("temperature@cold")),
        **layer,
        behind_resistance=max(resistance, 0.5 / layer["layer_conductance"]),
        behind_capacity=capacity,
        behind_loss=loss,
        profile_time=tuple(moments),
        profile_current=tuple(currents),
        **_tables(resolved, course, springs),
    )


def _linearised(
    phase: PhaseFunctions, state: Array, current: float, inputs: Array
) -> tuple[float, Array, Array, Array]:
    """Return how fast the hot face heats [K/s], and the heat equation's and the face's derivatives, at an instant."""
    y, u = ca.SX.sym("state", len(state)), ca.SX.sym("current")
    rates = phase.rates(y, u, inputs)
    near = phase.evaluated(("stack_profile",), lambda now: [now.near])(y, u, inputs)
    values = [rates, ca.jacobian(rates, y), ca.jacobian(rates, u), ca.jacobian(near, y)]
    moving, by_state, by_current, of_near = (
        np.asarray(ca.densify(value)) for value in ca.Function("linearised", [y, u], values)(state, current)
    )
    return float(of_near[0] @ moving.ravel()), by_state, by_current.ravel(), of_near.ravel()


def _tables(resolved: ResolvedModule, course: Trajectory, springs: float) -> dict[str, Any]:
    """Return by temperature what a layer and the structure are, the structure as it is in the switch."""
    model, inputs = resolved.functions, resolved.functions.start
    phase, place = model.either_way, model.index["ambient_temperature"]
    start, stop = (float(resolved.quantity(f"pcl_melting_{name}")) for name in ("start", "end"))
    every = np.linspace(ZERO_CELSIUS + COLDEST, ZERO_CELSIUS + HOTTEST, ROWS)
    temperatures = np.unique(np.concatenate([every, np.linspace(start, stop, ROWS)]))
    seen = phase.evaluated(
        ("layer_stiffness_now", "support_now", "stack_profile"), lambda layer, other, now: [*layer, *other, now.near]
    )
    layers = []
    for kelvin in temperatures:
        changed = inputs.copy()
        changed[place] = kelvin
        state = np.asarray(model.phases["softening"].initial(changed)).ravel()
        numbers = np.asarray(seen(phase.begin(state, changed), 0.0, changed)).ravel()
        layers.append((heat.ENTHALPY_SCALE * state[2], 1.0 / complex(numbers[0], numbers[1])))
    enthalpies, compliances = (np.array(column) for column in zip(*layers, strict=True))
    along = [np.asarray(seen(phase.begin(state, inputs), 0.0, inputs)).ravel() for state in course.states.T]
    *_, stored, lost, near = np.array(along).T
    behind = 1.0 / (stored + 1j * lost)
    near = np.maximum.accumulate(near)
    structure = np.interp(temperatures, near, behind.real) + 1j * np.interp(temperatures, near, behind.imag)
    softness = 1.0 / np.abs(springs + 1.0 / (compliances + structure))
    # What is looked up by softness needs rows that rise.
    softness = np.maximum.accumulate(softness) * (1.0 + 1e-9 * np.arange(len(temperatures)))
    columns = {
        "temperature": temperatures, "enthalpy": enthalpies, "softness": softness,
        "compliance": compliances.real, "loss": -compliances.imag,
        "structure": structure.real, "structure_loss": -structure.imag,
    }  # fmt: skip
    return {f"layer_{name}": tuple(values.tolist()) for name, values in columns.items()}


def _layer(stack: heat.Stack, period: float) -> dict[str, Any]:
    """Return the cells of the layer: as many as explicit steps of a period bear, half of what is stable."""
    conductivity, specific_heat = float(stack.conductivity_melt), float(stack.melting.specific_heat_melt)
    diffused = np.sqrt(4.0 * conductivity / (float(stack.density) * specific_heat) * period)
    cells = int(np.clip(float(stack.thickness) / diffused, 1, CELLS))
    return {
        "layer_cells": cells,
        "layer_conductance": float(conductivity * stack.area * cells / stack.thickness),
        "cell_mass": float(stack.density * stack.area * stack.thickness / cells),
    }


def _behind(seen: Any, cycle: Cycle, inputs: Array, ambient: float) -> tuple[float, float, float]:
    """Return resistance, capacity and loss of a body behind the layer that takes up heat as the module's does.

    Resistance and capacity by least squares over the switch, without loss; the loss where the joint stays soft for
    good.
    """
    from scipy.optimize import nnls  # half a second, for studies with a controller alone

    course = cycle.trajectories["softening"]
    columns = np.repeat(inputs[:, None], len(course.times), axis=1)
    _, far, flow = np.asarray(seen.map(len(course.times))(course.states, course.currents[None, :], columns))
    taken = np.concatenate([[0.0], np.cumsum(0.5 * (flow[1:] + flow[:-1]) * np.diff(course.times))])
    scale = max(float(taken[-1]), _LEAST), max(float(np.max(np.abs(flow))), _LEAST)
    shares = nnls(np.column_stack([taken / scale[0], flow / scale[1]]), far - ambient)[0]
    resistance, capacity = shares[1] / scale[1], scale[0] / max(shares[0], _LEAST)
    loss = 0.0
    if "softening" in cycle.balances:
        *state, current = cycle.balances["softening"]
        _, far_stays, flow_stays = (float(number) for number in np.asarray(seen(state, current, inputs)).ravel())
        loss = max(flow_stays, 0.0) / max(far_stays - ambient - flow_stays * resistance, 1.0)
    return float(resistance), float(capacity), float(loss)
