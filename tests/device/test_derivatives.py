"""Exact derivatives against differences: every output by every input, response times by every design variable."""

from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from tvimdesign.device import Table, table_for
from tvimdesign.simulation.working_cycle.casadi_setup import ca
from tvimdesign.simulation.working_cycle.cycle import Simulator
from tvimdesign.simulation.working_cycle.device_functions import DeviceFunctions
from tvimdesign.simulation.working_cycle.trajectory import Cycle
from tvimdesign.solve.nlp.transcription import guess, phase_block

Array = NDArray[np.float64]
# Not the depth of a hub that has none: it has no share of itself by which it could be changed.
VARIABLES = [row.name for row in table_for("shear").inputs if row.variable and row.default != 0.0]
EVENTS = ("near_face_time", "mean_time", "far_face_time", "softening_time", "response_time")
ELEMENTS = 128


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


def test_every_output_has_the_derivatives_by_every_input_that_differences_show(
    model: DeviceFunctions, numbers: dict[str, float]
) -> None:
    inputs, cycle = ca.MX.sym("inputs", len(model.names)), ca.MX.sym("cycle", len(model.switch_names))
    supplied = np.array([numbers[name] for name in model.switch_names])
    jacobian = ca.Function("jacobian", [inputs, cycle], [ca.jacobian(model.every_output(inputs, cycle), inputs)])
    exact = np.asarray(ca.DM(jacobian(model.start, supplied)).full())
    which = [i for i, name in enumerate(model.names) if name != "rotor_cells"]  # a shape, not a number
    shown = differences(lambda x: model.every_output(x, supplied), model.start, which, 1e-4)
    values = np.asarray(model.every_output(model.start, supplied)).ravel()
    # What a relative change of the input does to the output, relative: the two agree to 1e-6 of the larger.
    relative = np.abs(model.start[which]) / np.where(values == 0.0, 1.0, np.abs(values))[:, None]
    error = np.abs(exact[:, which] - shown) * relative
    allowed = 1e-6 * np.maximum(1.0, np.abs(exact[:, which]) * relative)
    wrong = [(model.output_names[i], model.names[which[j]]) for i, j in np.argwhere(error > allowed)]
    assert not wrong
    assert np.all(np.isfinite(exact))


def test_every_output_of_a_switch_has_the_derivatives_by_the_switch_that_differences_show(
    unity: DeviceFunctions, numbers: dict[str, float]
) -> None:
    supplied = np.array([numbers[name] for name in unity.switch_names])
    cycle = ca.MX.sym("cycle", len(supplied))
    jacobian = ca.Function("jacobian", [cycle], [ca.jacobian(unity.every_output(unity.start, cycle), cycle)])
    shown = differences(lambda x: unity.every_output(unity.start, x), supplied, list(range(len(supplied))), 1e-3)
    values = np.abs(np.asarray(unity.every_output(unity.start, supplied)).ravel())[:, None]
    exact = np.asarray(ca.DM(jacobian(supplied)).full())
    # Of a small rest of two large numbers, as the margin to a hot point that is just reached, the larger counts.
    allowed = 1e-9 * np.maximum(np.maximum(values, np.abs(exact * supplied)), 1e-6)
    error = np.abs(exact - shown) * supplied
    wrong = [(unity.output_names[i], unity.switch_names[j]) for i, j in np.argwhere(~(error <= allowed))]
    assert not wrong


def event_gradient(model: DeviceFunctions, cycle: Cycle, event: str) -> tuple[float, Array]:
    """Time of an event by collocation, and its derivative by every input from the implicit function theorem."""
    inputs = ca.MX.sym("inputs", len(model.names))
    phase = model.phases["softening"]
    current = inputs[model.index["current"]]
    block = phase_block(phase, event, ELEMENTS, inputs, phase.initial(inputs), current)
    unknowns = ca.vertcat(ca.vec(block.states), block.log_time)
    system = ca.Function("system", [unknowns, inputs], [block.equations])
    solve = ca.rootfinder("solve", "newton", system, {"abstol": 1e-11, "max_iter": 50})
    time = cycle.values[event]
    scaled = guess(cycle.trajectory, ELEMENTS) if event == "response_time" else _until(cycle, time)
    begin = np.append(scaled.ravel(order="F"), np.log(time))
    gradient = ca.Function("gradient", [inputs], [ca.jacobian(solve(begin, inputs)[-1], inputs)])
    found = float(np.asarray(solve(begin, model.start))[-1, 0])
    return float(np.exp(found)), np.exp(found) * np.asarray(ca.DM(gradient(model.start)).full()).ravel()


def _until(cycle: Cycle, time: float) -> Array:
    """Guess of the states at the collocation points of a switch that ends at another time than the simulated one."""
    trajectory = cycle.trajectory
    times = np.linspace(0.0, time, 400)
    states = np.array([np.interp(times, trajectory.times, row) for row in trajectory.states])
    return guess(type(trajectory)(times=times, states=states, currents=np.zeros(400)), ELEMENTS)


@pytest.fixture(scope="module")
def shown_by_simulation(unity: DeviceFunctions, simulator: Simulator) -> dict[str, Array]:
    """Derivatives of all event times by every design variable, from simulations of changed designs."""

    def times(inputs: Array) -> Array:
        values = simulator.run(inputs, phases=["softening"]).values
        return np.array([values[event] for event in EVENTS])

    jacobian = differences(times, unity.start, [unity.index[name] for name in VARIABLES], 1e-3)
    return dict(zip(EVENTS, jacobian, strict=True))


@pytest.mark.parametrize("event", EVENTS)
def test_response_times_have_the_derivatives_that_simulations_show(
    event: str, unity: DeviceFunctions, cycle: Cycle, shown_by_simulation: dict[str, Array], table: Table
) -> None:
    assert {row.name for row in unity.phases["softening"].events} == set(EVENTS)
    time, gradient = event_gradient(unity, cycle, event)
    assert time == pytest.approx(cycle.values[event], rel=5e-4)
    for name, shown in zip(VARIABLES, shown_by_simulation[event], strict=True):
        exact = gradient[unity.index[name]]
        # 1e-3 of the derivative, or of the time itself where the variable hardly matters.
        scale = max(abs(shown) * unity.start[unity.index[name]], 0.01 * time) / unity.start[unity.index[name]]
        assert exact == pytest.approx(shown, abs=1e-3 * scale), name
        if name not in {*table.ancestors(event), table.phase("softening").current_input}:
            assert exact == 0.0, name
