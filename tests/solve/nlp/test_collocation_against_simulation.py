"""The switch as equations gives the times, states and energies of the simulated switch."""

from collections.abc import Callable

import numpy as np
import pytest

from tvimdesign.simulation.working_cycle.casadi_setup import ca
from tvimdesign.simulation.working_cycle.device_functions import DeviceFunctions
from tvimdesign.simulation.working_cycle.trajectory import Cycle, Trajectory
from tvimdesign.solve.nlp.transcription import ORDER, guess, phase_block, radau

DESIGNS = ("as it is", "thin", "thick", "aluminium")
EVENTS = ("near_face_time", "mean_time", "far_face_time", "response_time")
ELEMENTS = 3
FINER = {"aluminium": 4}
"""What is beside the pads under aluminium takes heat within seconds: three elements are 6e-4 off, four 2e-4."""


def solve(model: DeviceFunctions, cycle: Cycle, event: str, elements: int) -> tuple[float, np.ndarray, np.ndarray]:
    """Final time of the collocated switch, its states at every point, the start first, and the points' weights in s."""
    inputs = ca.MX.sym("inputs", len(model.names))
    phase = model.phases["softening"]
    block = phase_block(phase, event, elements, inputs, phase.initial(inputs), inputs[model.index["current"]])
    unknowns = ca.vertcat(ca.vec(block.states), block.log_time)
    newton = ca.rootfinder(
        "newton", "newton", ca.Function("system", [unknowns, inputs], [block.equations]), {"abstol": 1e-10}
    )
    time = cycle.values[event]
    ends = np.linspace(0.0, time, 500)
    simulated = cycle.trajectory
    states = np.array([np.interp(ends, simulated.times, row) for row in simulated.states])
    begin = np.append(
        guess(Trajectory(times=ends, states=states, currents=np.zeros(500)), elements).ravel(order="F"), np.log(time)
    )
    solution = newton(begin, model.start)
    every, weights = ca.Function("every", [unknowns, inputs], [block.every, block.weights])(solution, model.start)
    return float(np.exp(float(solution[-1]))), np.asarray(ca.DM(every).full()), np.asarray(weights).ravel()


@pytest.mark.parametrize("design", DESIGNS)
@pytest.mark.parametrize("event", EVENTS)
def test_few_elements_find_the_times_of_the_simulation(
    design: str, event: str, build: Callable[..., DeviceFunctions], switch_of: Callable[[str], Cycle]
) -> None:
    cycle = switch_of(design)
    time, _, _ = solve(build(design), cycle, event, FINER.get(design, ELEMENTS))
    assert time == pytest.approx(cycle.values[event], rel=5e-4)


@pytest.mark.parametrize("design", DESIGNS)
def test_softening_lies_inside_melting_and_wants_more_elements(
    design: str, build: Callable[..., DeviceFunctions], switch_of: Callable[[str], Cycle]
) -> None:
    cycle = switch_of(design)
    coarse, _, _ = solve(build(design), cycle, "softening_time", ELEMENTS)
    fine, _, _ = solve(build(design), cycle, "softening_time", 12)
    assert coarse == pytest.approx(cycle.values["softening_time"], rel=2e-3)
    assert fine == pytest.approx(cycle.values["softening_time"], rel=5e-4)


@pytest.mark.parametrize(("count", "first"), [(2 * ELEMENTS, 1 + ORDER), (8 * ELEMENTS, 0)])
def test_states_at_the_points_are_those_of_the_simulation(
    count: int, first: int, build: Callable[..., DeviceFunctions], switch_of: Callable[[str], Cycle]
) -> None:
    """Three elements find the time, but blur what melts within one of their points; six still do in the first."""
    model, cycle = build(), switch_of("as it is")
    time, every, _ = solve(model, cycle, "response_time", count)
    fractions = np.concatenate([[0.0], *((i + radau()[0]) / count for i in range(count))])
    simulated = cycle.trajectory.at(fractions)
    assert time == pytest.approx(cycle.values["response_time"], rel=5e-4)
    # Temperatures over 100 K and enthalpies over 1e5 J/kg: within half a kelvin.
    assert np.max(np.abs(every - simulated)[:, first:]) < 5e-3


def test_quadrature_of_the_points_gives_the_energy_of_the_simulation(
    build: Callable[..., DeviceFunctions], switch_of: Callable[[str], Cycle]
) -> None:
    model, cycle = build(), switch_of("as it is")
    time, every, weights = solve(model, cycle, "response_time", ELEMENTS)
    power_at = model.phases["softening"].watch(["switch_energy"])
    power = [float(power_at(column, 1.5, model.start)) for column in every.T[1:]]
    assert weights @ power == pytest.approx(cycle.values["switch_energy"], rel=1e-3)
    assert np.sum(weights) == pytest.approx(time, rel=1e-12)
