"""Exact derivatives against differences: every output by every input, response times by every design variable."""

from collections.abc import Mapping

import numpy as np
import pytest
from event_derivatives import differences, found_by_engine, shown_by_cvodes
from numpy.typing import NDArray

from tvimdesign.device import table_for
from tvimdesign.simulation.working_cycle.cycle import Supplied
from tvimdesign.simulation.working_cycle.device_functions import DeviceFunctions
from tvimdesign.simulation.working_cycle.symbols import ca

Array = NDArray[np.float64]
# Not the depth of a hub that has none: it has no share of itself by which it could be changed.
VARIABLES = [row.name for row in table_for("shear").inputs if row.variable and row.default != 0.0]
EVENTS = ("near_face_time", "mean_time", "far_face_time", "softening_time", "response_time")


def compare_with_differences(model: DeviceFunctions, numbers: Mapping[str, float]) -> None:
    """Compare the derivatives of every output by every input with those of differences."""
    inputs, cycle = ca.MX.sym("inputs", len(model.names)), ca.MX.sym("cycle", len(model.switch_names))
    supplied = np.array([numbers[name] for name in model.switch_names])
    every = model.outputs(model.output_names)
    jacobian = ca.Function("jacobian", [inputs, cycle], [ca.jacobian(every(inputs, cycle), inputs)])
    exact = np.asarray(ca.DM(jacobian(model.start, supplied)).full())
    which = [i for i, name in enumerate(model.names) if name != "rotor_cells"]  # a shape, not a number
    shown = differences(lambda x: every(x, supplied), model.start, which, 1e-4)
    values = np.asarray(every(model.start, supplied)).ravel()
    # What a relative change of the input does to the output, relative: the two agree to 1e-6 of the larger.
    relative = np.abs(model.start[which]) / np.where(values == 0.0, 1.0, np.abs(values))[:, None]
    error = np.abs(exact[:, which] - shown) * relative
    allowed = 1e-6 * np.maximum(1.0, np.abs(exact[:, which]) * relative)
    wrong = [(model.output_names[i], model.names[which[j]]) for i, j in np.argwhere(error > allowed)]
    assert not wrong
    assert np.all(np.isfinite(exact))


@pytest.mark.gate
def test_every_output_has_the_derivatives_of_differences(model, numbers):
    compare_with_differences(model, numbers)


def test_outputs_of_compression_have_the_derivatives_of_differences(squeezed_model, squeezed_switch):
    compare_with_differences(squeezed_model, squeezed_switch.values)


def test_derivatives_by_the_switch_are_those_of_differences(unity, numbers):
    supplied = np.array([numbers[name] for name in unity.switch_names])
    cycle = ca.MX.sym("cycle", len(supplied))
    every = unity.outputs(unity.output_names)
    jacobian = ca.Function("jacobian", [cycle], [ca.jacobian(every(unity.start, cycle), cycle)])
    # Steps within 0.1 %: the margin of the thermal cut-out has a kink 0.2 % above the heater's temperature.
    shown = differences(lambda x: every(unity.start, x), supplied, list(range(len(supplied))), 5e-4)
    values = np.abs(np.asarray(every(unity.start, supplied)).ravel())[:, None]
    exact = np.asarray(ca.DM(jacobian(supplied)).full())
    # Of a small rest of two large numbers, as the margin to a hot point that is just reached, the larger counts.
    allowed = 1e-9 * np.maximum(np.maximum(values, np.abs(exact * supplied)), 1e-6)
    error = np.abs(exact - shown) * supplied
    wrong = [(unity.output_names[i], unity.switch_names[j]) for i, j in np.argwhere(~(error <= allowed))]
    assert not wrong


@pytest.fixture(scope="module")
def shown_by_simulation(unity: DeviceFunctions) -> dict[str, Array]:
    """Derivatives of all event times by every design variable, from CVODES's simulations of changed designs."""
    return shown_by_cvodes(unity, EVENTS, VARIABLES)


@pytest.fixture(scope="module")
def supplied(unity: DeviceFunctions) -> Supplied:
    """Return the engine's values and derivatives by every design variable."""
    return found_by_engine(unity, VARIABLES)


@pytest.mark.gate
@pytest.mark.parametrize("event", EVENTS)
def test_response_times_have_the_derivatives_that_simulations_show(event, unity, shown_by_simulation, supplied, table):
    assert {row.name for row in unity.phases["softening"].events} == set(EVENTS)
    place = unity.switch_names.index(event)
    time = supplied.values[place]
    for name, shown, exact in zip(VARIABLES, shown_by_simulation[event], supplied.slopes[place], strict=True):
        # 1e-3 of the derivative, or of the time itself where the variable hardly matters.
        scale = max(abs(shown) * unity.start[unity.index[name]], 0.01 * time) / unity.start[unity.index[name]]
        assert exact == pytest.approx(shown, abs=1e-3 * scale), name
        if name not in {*table.ancestors(event), table.phase("softening").current_input}:
            assert exact == 0.0, name


SQUEEZED = ("block_depth", "block_height", "vane_thickness", "pcl_outer_radius", "current")


@pytest.mark.slow
def test_response_times_of_compression_have_those_derivatives(squeezed_model):
    model, events = squeezed_model, ("far_face_time", "softening_time")
    by_cvodes, engine = shown_by_cvodes(model, events, SQUEEZED), found_by_engine(model, SQUEEZED)
    for event in events:
        place = model.switch_names.index(event)
        for name, difference, exact in zip(SQUEEZED, by_cvodes[event], engine.slopes[place], strict=True):
            start = model.start[model.index[name]]
            # 1e-3 of the derivative; 1e-4 of the time itself where the variable hardly matters, as depth to softening.
            allowed = 1e-3 * max(abs(difference) * start, 0.1 * engine.values[place]) / start
            assert exact == pytest.approx(difference, abs=allowed), (event, name)
