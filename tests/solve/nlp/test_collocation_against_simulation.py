"""The switch as equations gives the times, states and energies of the simulated switch."""

from collections.abc import Callable

import numpy as np
import pytest

from tvimdesign.simulation.casadi_setup import ca
from tvimdesign.simulation.cycle import Switch, Trajectory
from tvimdesign.simulation.device_functions import Model
from tvimdesign.solve.nlp.transcription import guess, radau, stage_block

DESIGNS = ("as it is", "thin", "thick", "aluminium")
EVENTS = ("near_face_time", "mean_time", "far_face_time", "response_time")
ELEMENTS = 3


def solve(model: Model, switch: Switch, event: str, elements: int) -> tuple[float, np.ndarray, np.ndarray]:
    """Final time of the collocated switch, its states at every point, the start first, and the points' weights in s."""
    inputs = ca.MX.sym("inputs", len(model.names))
    stage = model.stages["softening"]
    block = stage_block(stage, event, elements, inputs, stage.initial(inputs), inputs[model.index["current"]])
    unknowns = ca.vertcat(ca.vec(block.states), block.log_time)
    newton = ca.rootfinder(
        "newton", "newton", ca.Function("system", [unknowns, inputs], [block.equations]), {"abstol": 1e-10}
    )
    time = switch.values[event]
    ends = np.linspace(0.0, time, 500)
    simulated = switch.trajectory
    states = np.array([np.interp(ends, simulated.times, row) for row in simulated.states])
    begin = np.append(
        guess(Trajectory(times=ends, states=states, currents=np.zeros(500)), elements).ravel(order="F"), np.log(time)
    )
    solution = newton(begin, model.start)
    every, weights = ca.Function("every", [unknowns, inputs], [block.every, block.weights])(solution, model.start)
    return float(np.exp(float(solution[-1]))), np.asarray(ca.DM(every).full()), np.asarray(weights).ravel()


@pytest.mark.parametrize("design", DESIGNS)
@pytest.mark.parametrize("event", EVENTS)
def test_three_elements_find_the_times_of_the_simulation(
    design: str, event: str, build: Callable[..., Model], switch_of: Callable[[str], Switch]
) -> None:
    switch = switch_of(design)
    time, _, _ = solve(build(design), switch, event, ELEMENTS)
    assert time == pytest.approx(switch.values[event], rel=5e-4)


@pytest.mark.parametrize("design", DESIGNS)
def test_softening_lies_inside_melting_and_wants_more_elements(
    design: str, build: Callable[..., Model], switch_of: Callable[[str], Switch]
) -> None:
    switch = switch_of(design)
    coarse, _, _ = solve(build(design), switch, "softening_time", ELEMENTS)
    fine, _, _ = solve(build(design), switch, "softening_time", 12)
    assert coarse == pytest.approx(switch.values["softening_time"], rel=2e-3)
    assert fine == pytest.approx(switch.values["softening_time"], rel=5e-4)


def test_states_at_the_points_are_those_of_the_simulation(
    build: Callable[..., Model], switch_of: Callable[[str], Switch]
) -> None:
    model, switch = build(), switch_of("as it is")
    count = 2 * ELEMENTS  # three find the time, but blur what melts within one of their points
    time, every, _ = solve(model, switch, "response_time", count)
    fractions = np.concatenate([[0.0], *((i + radau()[0]) / count for i in range(count))])
    simulated = switch.trajectory.at(fractions)
    assert time == pytest.approx(switch.values["response_time"], rel=5e-4)
    # Temperatures over 100 K and enthalpies over 1e5 J/kg: within half a kelvin after the first element.
    assert np.max(np.abs(every - simulated)[:, 4:]) < 5e-3


def test_quadrature_of_the_points_gives_the_energy_of_the_simulation(
    build: Callable[..., Model], switch_of: Callable[[str], Switch]
) -> None:
    model, switch = build(), switch_of("as it is")
    time, every, weights = solve(model, switch, "response_time", ELEMENTS)
    power_at = model.stages["softening"].watch(["switch_energy"])
    power = [float(power_at(column, 1.5, model.start)) for column in every.T[1:]]
    assert weights @ power == pytest.approx(switch.values["switch_energy"], rel=1e-3)
    assert np.sum(weights) == pytest.approx(time, rel=1e-12)
