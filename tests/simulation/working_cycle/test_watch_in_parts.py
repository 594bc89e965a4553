"""What an event waits for, put together of several functions: the same value and the same derivatives as in one."""

from __future__ import annotations

import numpy as np
import pytest

from tvimdesign.simulation.working_cycle.casadi_setup import ca
from tvimdesign.simulation.working_cycle.device_functions import DeviceFunctions
from tvimdesign.simulation.working_cycle.resolved_module import resolve_study
from tvimdesign.study import read_study_text


def model_of(mode: str, criterion: str, lip: str = "none") -> DeviceFunctions:
    lips = f", melt_lip: {lip}" if mode == "shear" else ""
    text = f"mode: {mode}\nmodule: {{response_criterion: {criterion}{lips}}}\nsolver: {{cells: 4}}\n"
    resolved = resolve_study(read_study_text(text, "a test"))
    return DeviceFunctions(resolved.table, resolved.values, resolved.points, resolved.study.solver.cells)


@pytest.mark.parametrize(("mode", "lip"), [("shear", "none"), ("shear", "rings"), ("compression", "none")])
def test_the_parts_have_the_value_and_the_derivatives_of_the_whole(mode: str, lip: str) -> None:
    model = model_of(mode, "softening", lip)
    phase = model.phases["softening"]
    cold = np.asarray(phase.initial(model.start)).ravel()
    state = ca.MX.sym("state", len(cold))
    functions = []
    for watch in (phase.watch(["response_time"]), phase.watch_in_parts(["response_time"])):
        value = watch(state, 0.5, model.start)
        hessian, gradient = ca.hessian(value, state)
        functions.append(ca.Function("f", [state], [value, gradient, hessian]))
    for share in (0.1, 1.0, 3.0):  # cold, melting, molten; no two entries alike
        at = cold * (1.0 + share + 0.01 * np.arange(len(cold)) / len(cold))
        for one, other in zip(*(function(at) for function in functions), strict=True):
            np.testing.assert_allclose(other.full(), one.full(), rtol=0.0, atol=1e-12 * np.max(np.abs(one.full())))


def test_the_moduli_are_a_call_of_their_own_where_they_are_asked_for() -> None:
    def calls(criterion: str) -> int:
        model = model_of("shear", criterion)
        phase = model.phases["softening"]
        state, inputs = ca.MX.sym("state", phase.state_size), ca.MX.sym("inputs", len(model.names))
        graph = ca.Function("graph", [state, inputs], [phase.watch_in_parts(["response_time"])(state, 0.5, inputs)])
        return sum(graph.instruction_id(k) == ca.OP_CALL for k in range(graph.n_instructions()))

    # Surroundings, places and profile of the end, temperatures, what the slices have in common, slices, layer, joint.
    assert calls("softening") == 8
    assert calls("mean") == 1
