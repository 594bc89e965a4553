"""The working cycle of many designs at once: within 0.2 % of the simulator, for each design whatever its neighbours."""

from collections.abc import Callable

import numpy as np
import pytest
from support import ROOT, fine

from tvimdesign.device import table_for
from tvimdesign.simulation.working_cycle.device_functions import DeviceFunctions
from tvimdesign.simulation.working_cycle.trajectory import Cycle
from tvimdesign.solve.batch.cycle_kernel import CycleKernel, Pace
from tvimdesign.study import given, read_study

Build = Callable[..., DeviceFunctions]
WITHIN = 2e-3  # the accuracy that is asked for
MOVING = ["current", "ambient_temperature", "peltier_seebeck", "peltier_resistance", "pcl_latent_heat"]
SOFTENING = ["near_face_time", "far_face_time", "softening_time", "response_time", "switch_energy", "peak_power"]
AT_THE_END = ["response_time", "switch_energy", "peak_power"]
"""What is wanted of most modules: it takes longer steps than what comes earlier."""
# As drawn the far face stalls: aluminium draws the heat out. With more current it reaches 100 degC.
CURRENT = {"driven_joint": 3.0, "machined_compression": 2.5, "machined_shear": 3.0}
BACK = ["stiffening_time", "frozen_time", "stiffening_energy", "peak_cold_side_temperature", "hold_power"]


def _pace(model: DeviceFunctions, cycle: Cycle) -> Pace:
    ends = {name: cycle.values[phase.phase.ends] for name, phase in model.phases.items()}
    return Pace({name: end if np.isfinite(end) else 100.0 for name, end in ends.items()}, cycle.balances)


def _columns(model: DeviceFunctions, count: int) -> np.ndarray:
    """Return the design as drawn, and others up to a tenth off in every moving input; ambient by 3 K."""
    start = np.array([[model.start[model.index[name]]] for name in MOVING])
    width = np.where(np.array(MOVING)[:, None] == "ambient_temperature", 3.0, 0.1 * start)
    off = np.random.default_rng(5).uniform(-1.0, 1.0, (len(MOVING), count))
    off[:, 0] = 0.0
    return start + width * off


def _worst(model: DeviceFunctions, names: list[str], count: int) -> float:
    """Largest difference from the converged simulation, as a share of it."""
    simulator, columns = fine(model), _columns(model, count)
    kernel = CycleKernel(model, MOVING, names)
    pace = _pace(model, simulator.run(model.start))
    usual, found = kernel(columns, pace), kernel(columns, kernel.fitted(pace, columns[:, 0]))
    phases = list(kernel.phases)
    worst = 0.0
    for i in range(count):
        inputs = model.start.copy()
        inputs[[model.index[name] for name in MOVING]] = columns[:, i]
        values = simulator.run(inputs, phases=phases).values
        expected = np.array([values[name] for name in kernel.names])
        happens = np.isfinite(expected)
        assert happens.any()
        for one in (usual, found):
            assert np.array_equal(np.isfinite(one[:, i]), happens)
            worst = max(worst, float(np.max(np.abs(one[happens, i] / expected[happens] - 1.0))))
    return worst


@pytest.mark.gate
def test_the_switch_is_within_the_accuracy_asked_for(build: Build) -> None:
    assert _worst(build(), SOFTENING, 4) < WITHIN
    assert _worst(build(), AT_THE_END, 4) < WITHIN


@pytest.mark.slow
@pytest.mark.parametrize("design", ["as it is", "thin", "thick", "aluminium", "sink", "equilibrium"])
def test_the_whole_cycle_is_within_the_accuracy_asked_for(build: Build, design: str) -> None:
    model = build(design, 24)
    names = [name for name in [*SOFTENING, *BACK] if name in model.switch_names]
    assert _worst(model, names, 6) < WITHIN


@pytest.mark.slow
@pytest.mark.parametrize("study", sorted(path.stem for path in (ROOT / "studies").glob("*.yaml")))
def test_every_shipped_study_is_within_the_accuracy_asked_for(study: str) -> None:
    read = read_study(ROOT / f"studies/{study}.yaml")
    table = table_for(read.mode)
    inputs = given(read)
    if study in CURRENT:
        inputs["current"] = CURRENT[study]
    model = DeviceFunctions(table, inputs, tuple(read.operating_points), read.solver.cells)
    assert _worst(model, SOFTENING, 6) < WITHIN
    assert _worst(model, AT_THE_END, 6) < WITHIN


def test_no_bit_hangs_on_workers_or_neighbours(build: Build, switch_of: Callable[[str], Cycle]) -> None:
    model = build()
    kernel = CycleKernel(model, MOVING, ["response_time", "switch_energy"])
    pace, columns = _pace(model, switch_of("as it is")), _columns(model, 540)  # more than a block
    alone = kernel(columns, pace)
    assert np.array_equal(alone, kernel(columns, pace, workers=2))
    assert np.array_equal(alone[:, 510:513], kernel(columns[:, 510:513], pace))
    fitted = kernel.fitted(pace, columns[:, 0])
    assert np.array_equal(kernel(columns, fitted)[:, 510:513], kernel(columns[:, 510:513], fitted))


def test_what_never_ends_is_infinite_and_its_neighbours_are_not(
    build: Build, switch_of: Callable[[str], Cycle]
) -> None:
    model = build()
    kernel = CycleKernel(model, ["current"], ["response_time", "switch_energy", "peak_power"])
    found = kernel(np.array([[0.06, 1.5]]), _pace(model, switch_of("as it is")))
    assert np.isinf(found[:2, 0]).all()
    assert np.isfinite(found[:, 1]).all()
    assert np.isfinite(found[2, 0])  # a peak is one of a stage that never ends, too
