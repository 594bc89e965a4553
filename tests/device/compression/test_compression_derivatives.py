"""Exact derivatives of the compression module against differences: outputs by inputs, response times by variables."""

import numpy as np
import pytest
from event_derivatives import differences, found_by_engine, shown_by_cvodes

from tvimdesign.device import table_for
from tvimdesign.simulation.working_cycle.casadi_setup import ca
from tvimdesign.simulation.working_cycle.device_functions import DeviceFunctions
from tvimdesign.simulation.working_cycle.trajectory import Cycle

TABLE = table_for("compression")
EVENTS = ("far_face_time", "softening_time")
VARIABLES = ("block_depth", "block_height", "vane_thickness", "pcl_outer_radius", "current")


def test_every_output_has_the_derivatives_of_differences(
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


@pytest.mark.slow
def test_response_times_have_the_derivatives_that_simulations_show(squeezed_model: DeviceFunctions) -> None:
    model = squeezed_model
    by_cvodes, found = shown_by_cvodes(model, EVENTS, VARIABLES), found_by_engine(model, VARIABLES)
    for event in EVENTS:
        place = model.switch_names.index(event)
        for name, difference, exact in zip(VARIABLES, by_cvodes[event], found.slopes[place], strict=True):
            start = model.start[model.index[name]]
            # 1e-3 of the derivative; 1e-4 of the time itself where the variable hardly matters, as depth to softening.
            allowed = 1e-3 * max(abs(difference) * start, 0.1 * found.values[place]) / start
            assert exact == pytest.approx(difference, abs=allowed), (event, name)
