"""Exact derivatives of the compression module against differences: outputs by inputs, response times by variables."""

import numpy as np
import pytest
from event_derivatives import differences, event_gradient

from tvimdesign.device import table_for
from tvimdesign.simulation.working_cycle.casadi_setup import ca
from tvimdesign.simulation.working_cycle.cycle import Simulator
from tvimdesign.simulation.working_cycle.device_functions import DeviceFunctions
from tvimdesign.simulation.working_cycle.trajectory import Cycle

TABLE = table_for("compression")
EVENTS = ("far_face_time", "softening_time")
VARIABLES = ("block_depth", "block_height", "vane_thickness", "pcl_outer_radius", "current")


def test_every_output_has_the_derivatives_by_every_input_that_differences_show(
    squeezed_model: DeviceFunctions, squeezed_switch: Cycle
) -> None:
    model = squeezed_model
    inputs, cycle = ca.MX.sym("inputs", len(model.names)), ca.MX.sym("cycle", len(model.switch_names))
    supplied = np.array([squeezed_switch.values[name] for name in model.switch_names])
    jacobian = ca.Function("jacobian", [inputs, cycle], [ca.jacobian(model.every_output(inputs, cycle), inputs)])
    exact = np.asarray(ca.DM(jacobian(model.start, supplied)).full())
    which = [i for i, name in enumerate(model.names) if name != "rotor_cells"]  # a shape, not a number
    shown = differences(lambda x: model.every_output(x, supplied), model.start, which, 1e-4)
    values = np.asarray(model.every_output(model.start, supplied)).ravel()
    relative = np.abs(model.start[which]) / np.where(values == 0.0, 1.0, np.abs(values))[:, None]
    error = np.abs(exact[:, which] - shown) * relative
    allowed = 1e-6 * np.maximum(1.0, np.abs(exact[:, which]) * relative)
    assert not [(model.output_names[i], model.names[which[j]]) for i, j in np.argwhere(error > allowed)]
    assert np.all(np.isfinite(exact))


@pytest.fixture(scope="module")
def shown_by_simulation(squeezed_model: DeviceFunctions, squeezed_simulator: Simulator) -> dict[str, np.ndarray]:
    """Derivatives of the event times by some variables, from simulations of changed designs."""

    def times(inputs: np.ndarray) -> np.ndarray:
        values = squeezed_simulator.run(inputs, phases=["softening"]).values
        return np.array([values[event] for event in EVENTS])

    which = [squeezed_model.index[name] for name in VARIABLES]
    return dict(zip(EVENTS, differences(times, squeezed_model.start, which, 1e-3), strict=True))


@pytest.mark.slow
@pytest.mark.parametrize("event", EVENTS)
def test_response_times_have_the_derivatives_that_simulations_show(
    event: str, squeezed_model: DeviceFunctions, squeezed_switch: Cycle, shown_by_simulation: dict[str, np.ndarray]
) -> None:
    model = squeezed_model
    time, gradient = event_gradient(model, squeezed_switch, event)
    assert time == pytest.approx(squeezed_switch.values[event], rel=5e-4)
    for name, difference in zip(VARIABLES, shown_by_simulation[event], strict=True):
        start = model.start[model.index[name]]
        # 1e-3 of the derivative; 1e-4 of the time itself where the variable hardly matters, as depth to softening.
        allowed = 1e-3 * max(abs(difference) * start, 0.1 * time) / start
        assert gradient[model.index[name]] == pytest.approx(difference, abs=allowed), name
