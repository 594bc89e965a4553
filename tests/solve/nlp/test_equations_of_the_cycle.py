"""The optimiser's equations of the whole cycle against its simulation: times, steady state, and exact derivatives."""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.sparse import csc_matrix
from scipy.sparse.linalg import splu
from support import fine

from tvimdesign.device import table_for
from tvimdesign.simulation.working_cycle.casadi_setup import ca
from tvimdesign.simulation.working_cycle.device_functions import DeviceFunctions
from tvimdesign.simulation.working_cycle.resolved_module import resolve_study
from tvimdesign.simulation.working_cycle.trajectory import Cycle
from tvimdesign.solve.nlp.problem import Problem
from tvimdesign.solve.nlp.transcription import guess
from tvimdesign.study import read_study

Array = NDArray[np.float64]
DESIGNS = ("as it is", "thin", "thick", "sink")
VARIABLES = [row.name for row in table_for("shear").inputs if row.variable]
WANTED = ("stiffening_time", "hold_power", "hold_current")


@dataclass
class Solved:
    """The equations of softening, stiffening and holding, solved for one design with nothing free."""

    values: dict[str, float]
    gradients: dict[str, Array]
    """By every input, from the implicit function theorem."""


def solve(model: DeviceFunctions, cycle: Cycle, elements: int) -> Solved:
    """Newton's method on the equations the optimiser hands to IPOPT, from the simulated cycle."""
    problem = Problem(model, (), (), ("stiffening_time", "hold_power"), elements)
    assert problem.events == ["response_time", "stiffening_time"]
    unknowns, parameters = problem.function["x"], problem.function["p"]
    equations = problem.function["g"][: problem.equation_count]
    balance = problem.balances[0].unknowns
    wanted = ca.vertcat(
        problem.blocks[1].final_time,
        model.phases["softening"].watch(["hold_power"])(balance[:-1], balance[-1], parameters[: len(model.names)]),
        balance[-1],
    )
    system = ca.Function(
        "system", [unknowns, parameters],
        [equations, ca.jacobian(equations, unknowns), ca.jacobian(equations, parameters),
         wanted, ca.jacobian(wanted, unknowns), ca.jacobian(wanted, parameters)],
    )  # fmt: skip
    parts = []
    for block in problem.blocks:
        name = block.phase.phase.name
        states = guess(cycle.trajectories[name], problem.elements(name))
        parts += [states.ravel(order="F"), [np.log(cycle.values[block.event])]]
    found = np.concatenate([*parts, cycle.balances["softening"]])
    given = np.append(model.start, [1.0, 1.0])
    for _ in range(30):
        rest, by_unknowns, *_ = system(found, given)
        step = splu(_sparse(by_unknowns)).solve(np.asarray(rest).ravel())
        found = found - step
        if np.max(np.abs(step)) < 1e-10:
            break
    else:
        raise AssertionError("Newton's method does not converge")
    _, by_unknowns, by_parameters, values, values_by_unknowns, values_by_parameters = system(found, given)
    adjoint = splu(_sparse(by_unknowns).T.tocsc()).solve(_sparse(values_by_unknowns).T.toarray())
    gradient = _sparse(values_by_parameters).toarray() - adjoint.T @ _sparse(by_parameters).toarray()
    numbers = np.asarray(values).ravel()
    return Solved(dict(zip(WANTED, numbers, strict=True)), dict(zip(WANTED, gradient, strict=True)))


def _sparse(matrix: object) -> csc_matrix:
    return csc_matrix(ca.DM(matrix).sparse())


@pytest.mark.parametrize("design", DESIGNS)
def test_the_usual_elements_find_stiffening_time_and_hold_power_of_the_simulation(
    design: str, build: Callable[..., DeviceFunctions], switch_of: Callable[[str], Cycle]
) -> None:
    cycle = switch_of(design)
    solved = solve(build(design), cycle, 3)
    assert solved.values["stiffening_time"] == pytest.approx(cycle.values["stiffening_time"], rel=1e-3)
    for name in ("hold_power", "hold_current"):
        assert solved.values[name] == pytest.approx(cycle.values[name], rel=1e-8)


def stencil(model: DeviceFunctions, name: str, share: float = 5e-3) -> Array:
    """Derivatives of the wanted values by one input from simulations of changed designs; fourth order."""
    simulator, place = fine(model), model.index[name]
    step, found = share * (model.start[place] or 1e-3), []
    for times in (-2, -1, 1, 2):
        inputs = model.start.copy()
        inputs[place] += times * step
        values = simulator.run(inputs, phases=["stiffening"]).values
        found.append([values[row] for row in WANTED])
    far_below, below, above, far_above = np.array(found)
    return np.asarray((far_below - 8.0 * below + 8.0 * above - far_above) / (12.0 * step))


@pytest.fixture(scope="module")
def solved(build: Callable[..., DeviceFunctions], switch_of: Callable[[str], Cycle]) -> Solved:
    return solve(build(), switch_of("as it is"), 12)


@pytest.mark.slow
@pytest.mark.parametrize("name", VARIABLES)
def test_stiffening_and_holding_have_the_derivatives_that_simulations_show(
    name: str, build: Callable[..., DeviceFunctions], solved: Solved
) -> None:
    model = build()
    size = model.start[model.index[name]]
    for row, shown in zip(WANTED, stencil(model, name), strict=True):
        exact = solved.gradients[row][model.index[name]]
        # To 1e-3 of the derivative, or of a share of the value where the variable hardly matters: a tenth of a time,
        # whose differences have a noise of 1e-4 s (a simulated stage begins between two samples of the one before).
        share = 0.1 if row == "stiffening_time" else 0.01
        scale = max(abs(shown) * size, share * solved.values[row])
        assert exact * size == pytest.approx(shown * size, abs=1e-3 * scale), row


@pytest.mark.gate
def test_the_cycle_depends_on_what_one_expects_it_to(solved: Solved, build: Callable[..., DeviceFunctions]) -> None:
    by = {row: dict(zip(VARIABLES, (solved.gradients[row][build().index[name]] for name in VARIABLES), strict=True))
          for row in WANTED}  # fmt: skip
    assert by["hold_power"]["current"] == pytest.approx(0.0, abs=1e-9)  # how fast it got hot does not matter
    assert by["hold_power"]["cooling_current"] == pytest.approx(0.0, abs=1e-12)
    assert by["hold_power"]["rotor_thickness"] != 0.0
    assert by["stiffening_time"]["cooling_current"] != 0.0
    assert by["stiffening_time"]["pcl_thickness"] > 0.0  # a thicker layer takes longer


@pytest.mark.slow
def test_a_layer_whose_frozen_edge_runs_through_the_cells_has_elements_enough() -> None:
    """With as many as for softening, `wrist_joint` as it starts would be off by 0.6 %, with twice as many by 0.2 %."""
    study = read_study(Path(__file__).parents[3] / "studies" / "wrist_joint.yaml")
    resolved = resolve_study(study)
    model = DeviceFunctions(resolved.table, resolved.values, resolved.points, study.solver.cells)
    cycle = fine(model).run(model.start)
    found = solve(model, cycle, study.solver.elements).values["stiffening_time"]
    assert found == pytest.approx(cycle.values["stiffening_time"], rel=1e-3)
