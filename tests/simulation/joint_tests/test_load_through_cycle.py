"""A load while the layer melts and freezes: against scipy's Radau with inertia on other unknowns, and passivity."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray
from scipy.integrate import solve_ivp

from tvimdesign.base.errors import InputError
from tvimdesign.physics.layers import lasting_load
from tvimdesign.simulation.joint_tests.case import cases
from tvimdesign.simulation.joint_tests.load_through_cycle import (
    Carried,
    Changing,
    SliceHistory,
    carry,
    changing,
    slice_histories,
    support_of,
)
from tvimdesign.simulation.working_cycle.resolved_module import resolve_study
from tvimdesign.study import read_study_text

Array = NDArray[np.float64]
SPRINGS, STRUCTURE, INERTIA, LOAD = 5.61, 919.0, 4.156e-4, 0.5834
SUPPORT = lasting_load.Support(SPRINGS, STRUCTURE)
SOLID = np.array([(1e10, 2.0e5), (10.0, 2e4), (0.1, 2e4)])
MELT = np.array([(2e-2, 150.0), (2e-3, 250.0), (2e-4, 600.0)])


def cycle(front: Array, count: int, end: float, samples: int = 161) -> tuple[Array, Callable[[float], Array]]:
    """Logarithms of relaxation times and stiffnesses of slices that melt one after the other and freeze again.

    Returns them at samples, and as a smooth function of time: (what, mode, slice).
    """
    depth = (np.arange(count) + 0.5) / count
    solid, melt = np.log(SOLID.T * [[1.0], [count]]), np.log(MELT.T * [[1.0], [count]])

    def at(time: float) -> Array:
        molten = 1.0 / (1.0 + np.exp(-(time - front[0] - 4.0 * depth))) / (1.0 + np.exp(time - front[1] - 4.0 * depth))
        return np.asarray(solid[:, :, None] + (melt - solid)[:, :, None] * molten)

    times = np.linspace(0.0, end, samples)
    return np.stack([at(time) for time in times], axis=-1), at


def with_inertia(at: Callable[[float], Array], count: int, times: Array) -> Array:
    """Angle over time from elastic strains, each slice's angle found from d/dt of equal torques, and the mass."""
    size = 3 * count

    def rates(time: float, y: Array) -> Array:
        tau, k = np.exp(at(time))
        growth = ((at(time + 1e-5) - at(time - 1e-5)) / 2e-5)[1]
        e = y[2:].reshape(3, count)
        torque = np.mean(np.sum(k * e, axis=0))
        # delta' of every slice and M' from: sum k e' + k' e = M', M'/S = theta' - sum delta'.
        lost = np.sum(k * (e / tau + np.maximum(growth, 0.0) * e) - k * growth * e, axis=0)
        matrix = np.zeros((count + 1, count + 1))
        matrix[:count, :count] = np.diag(np.sum(k, axis=0))
        matrix[:count, count] = -1.0
        matrix[count] = [1.0] * count + [1.0 / STRUCTURE]
        delta = np.linalg.solve(matrix, np.append(lost, y[1]))[:count]
        strain = delta - e / tau - np.maximum(growth, 0.0) * e
        return np.concatenate([[y[1], (LOAD - SPRINGS * y[0] - torque) / INERTIA], strain.ravel()])

    _, k = np.exp(at(0.0))
    soft = 1.0 / STRUCTURE + np.sum(1.0 / np.sum(k, axis=0))
    angle = LOAD * soft / (1.0 + SPRINGS * soft)
    start = np.tile((LOAD - SPRINGS * angle) / np.sum(k, axis=0), (3, 1))
    solved = solve_ivp(
        rates, (0.0, times[-1]), np.concatenate([[angle, 0.0], start.ravel()]), method="Radau", t_eval=times,
        rtol=1e-5, atol=1e-9,
    )  # fmt: skip
    assert solved.success
    assert size + 2 == len(solved.y)
    return np.asarray(solved.y[0])


@pytest.fixture(scope="module")
def there_and_back() -> tuple[Carried, Callable[[float], Array]]:
    logarithms, at = cycle(np.array([4.0, 18.0]), 2, 40.0, 401)
    times = np.linspace(0.0, 40.0, 401)
    return carry(Changing(logarithms, times), SUPPORT, LOAD, times), at


@pytest.mark.slow
def test_loaded_link_moves_as_radau_with_inertia_says(there_and_back: tuple[Carried, Callable[[float], Array]]) -> None:
    carried, at = there_and_back
    some = slice(None, None, 20)
    assert carried.angle[some] == pytest.approx(with_inertia(at, 2, carried.times[some]), abs=2e-4 * 0.104)


def test_link_creeps_as_the_layer_melts_and_stays_when_it_freezes(
    there_and_back: tuple[Carried, Callable[[float], Array]],
) -> None:
    carried, _ = there_and_back
    assert carried.angle[0] < 0.01 * 0.104
    soft = carried.angle[carried.times <= 18.0][-1]
    assert soft == pytest.approx(LOAD / SPRINGS, rel=1e-3)
    assert carried.angle[-1] == pytest.approx(soft, rel=1e-3)
    # The load taken off, the springs pull on a frozen joint: all but their share of its stiffness stays.
    frozen = SPRINGS + 1.0 / (1.0 / STRUCTURE + 1.0 / np.sum(SOLID[:, 1]))
    assert carried.unloaded_angle == pytest.approx(carried.angle[-1] - LOAD / frozen, rel=1e-4)


@pytest.mark.slow
@settings(max_examples=12, deadline=None)
@given(st.floats(2.0, 20.0), st.floats(2.0, 20.0), st.integers(1, 4))
def test_melting_and_freezing_under_load_only_lose_energy(start: float, wait: float, count: int) -> None:
    logarithms, _ = cycle(np.array([start, start + wait]), count, 50.0)
    carried = carry(Changing(logarithms, np.linspace(0.0, 50.0, 161)), SUPPORT, LOAD, np.linspace(0.0, 50.0, 161))
    potential = carried.energy - LOAD * carried.angle
    assert np.max(np.diff(potential)) <= 1e-6 * LOAD * 0.104


def test_lossy_structure_creeps_behind_a_frozen_layer_as_radau_says() -> None:
    structure = [(1e15, 600.0), (0.05, 80.0), (0.5, 70.0), (5.0, 60.0), (50.0, 50.0)]
    times = np.linspace(0.0, 40.0, 81)
    layer = np.repeat(np.log(SOLID.T)[:, :, None, None], 81, axis=3)
    carried = carry(Changing(layer, times, structure), lasting_load.Support(SPRINGS, 1e12), LOAD, times)
    (slow, soft), (slower, softer) = np.array(structure).T, SOLID.T
    most = SPRINGS + np.sum(soft) * np.sum(softer) / (np.sum(soft) + np.sum(softer))

    def angles(state: Array) -> tuple[float, float]:
        """Angles of the link and across the layer, from the dashpots' of structure and layer."""
        give, inner = state[: len(slow)], state[len(slow) :]
        matrix = np.array([[SPRINGS + np.sum(soft), -np.sum(soft)], [-np.sum(soft), np.sum(soft) + np.sum(softer)]])
        right = [LOAD + np.sum(soft * give), np.sum(softer * inner) - np.sum(soft * give)]
        link, across = np.linalg.solve(matrix, right)
        return float(link), float(across)

    def rates(_: float, state: Array) -> Array:
        link, across = angles(state)
        return np.concatenate([(link - across - state[: len(slow)]) / slow, (across - state[len(slow) :]) / slower])

    start = np.zeros(len(slow) + len(slower))
    moved = solve_ivp(rates, (0.0, 40.0), start, method="Radau", t_eval=times, rtol=1e-8, atol=1e-12).y
    again = np.array([angles(state)[0] for state in moved.T])
    assert carried.angle[0] == pytest.approx(LOAD / most, rel=1e-9)
    assert carried.angle == pytest.approx(again, rel=1e-4)
    assert again[-1] > 1.2 * again[0]
    # The layer's share is what the springs leave, and no energy comes from nowhere.
    assert carried.layer_torque == pytest.approx(LOAD - SPRINGS * carried.angle, rel=1e-6)
    assert np.max(np.diff(carried.energy - LOAD * carried.angle)) <= 1e-9


@pytest.mark.slow
def test_module_heated_under_load_lets_go_before_the_switch_ends() -> None:
    resolved = resolve_study(read_study_text("mode: shear\n", "a test"))
    history = slice_histories(resolved)
    assert history.temperatures.shape == (resolved.study.solver.cells, len(history.times))
    assert history.temperatures[:, 0] == pytest.approx(resolved.quantity("ambient_temperature"), abs=0.01)
    # Heating ends as the far face reaches the target, half a slice beyond the middle of the last.
    hottest = int(np.argmax(history.temperatures[0]))
    last, target = history.temperatures[-2:, hottest], resolved.quantity("target_temperature")
    assert last[1] - target == pytest.approx(0.5 * (last[0] - last[1]), rel=0.3)
    assert history.fractions[:, 0] == pytest.approx(1.0, abs=1e-3)
    assert history.fractions[:, hottest] == pytest.approx(0.0, abs=1e-2)
    assert np.min(history.fractions[:, -1]) > 0.1  # a fifth frozen is as stiff as the structure around it
    load = 0.1 * resolved.quantity("spring_stiffness")
    carried = carry(changing(resolved, history), support_of(resolved), load, history.times)
    # Put on at once, the load finds the joint as stiff as all Maxwell elements of structure and layer in series.
    ambient = {**resolved.values, "temperature@cold": resolved.quantity("ambient_temperature")}
    case = next(one for one in cases(replace(resolved, values=ambient)) if one.point == "cold")
    stiffest = case.joint.spring_stiffness + sum(stiffness for _, stiffness in case.modes)
    assert carried.angle[0] == pytest.approx(load / stiffest, rel=5e-3)
    assert stiffest > 1.05 * resolved.table.evaluate(ambient, ["joint_stiffness@cold"])["joint_stiffness@cold"]
    assert carried.angle[hottest] == pytest.approx(0.1, rel=1e-3)
    assert carried.angle[-1] == pytest.approx(0.1, rel=1e-3)
    # The load taken off, the springs cannot pull a frozen joint back.
    assert carried.unloaded_angle > 0.09


@pytest.mark.parametrize(
    ("times", "slices", "said"),
    [([0.0], 2, "must rise"), ([0.0, 1.0, 1.0], 2, "must rise"), ([0.0, 2.0, 1.0], 2, "must rise"),
     ([0.0, 1.0], 3, "one row")],
)  # fmt: skip
def test_history_that_does_not_go_together_is_refused(times: list[float], slices: int, said: str) -> None:
    with pytest.raises(InputError, match=said):
        SliceHistory(np.array(times), np.zeros((2, len(times))), np.zeros((slices, len(times))))
