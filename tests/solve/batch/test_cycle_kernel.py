"""Many designs at once: tapes as CasADi and the C library have them, cycles within 0.2 % of the simulator."""

import itertools
import math
from collections.abc import Callable

import numpy as np
import pytest
from support import STUDIES, digits, fine, study_path

from tvimdesign.device import table_for
from tvimdesign.engine.tape import Tape
from tvimdesign.simulation.working_cycle.cycle import Cycle
from tvimdesign.simulation.working_cycle.device_functions import DeviceFunctions
from tvimdesign.simulation.working_cycle.symbols import ca
from tvimdesign.solve.batch import cycle_kernel
from tvimdesign.solve.batch.batch_model import Kernel, kernel_of
from tvimdesign.solve.batch.cycle_kernel import CycleKernel, Pace
from tvimdesign.study import given, read_study

Build = Callable[..., DeviceFunctions]
WITHIN = 2e-3  # the accuracy that is asked for
MOVING = ["current", "ambient_temperature", "heater_seebeck", "heater_resistance", "pcl_latent_heat"]
SOFTENING = ["near_face_time", "far_face_time", "softening_time", "response_time", "switch_energy", "peak_power"]
AT_THE_END = ["response_time", "switch_energy", "peak_power"]
"""Wanted of most modules: it takes longer steps than what comes earlier."""
ENDS = ["softened_stiffness", "softened_damping", "softened_impedance", "softened_temperature"]
# As drawn the far face stalls: aluminium draws the heat out. With more current it reaches 100 degC.
CURRENT = {"driven_joint": 3.0, "machined_compression": 2.5}
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
    usual, paced = kernel(columns, pace), kernel(columns, kernel.fitted(pace, columns[:, 0]))
    phases = list(kernel.phases)
    worst = 0.0
    for i in range(count):
        inputs = model.start.copy()
        inputs[[model.index[name] for name in MOVING]] = columns[:, i]
        values = simulator.run(inputs, phases=phases).values
        expected = np.array([values[name] for name in kernel.names])
        happens = np.isfinite(expected)
        assert happens.any()
        for reached in (usual, paced):
            assert np.array_equal(np.isfinite(reached[:, i]), happens)
            worst = max(worst, float(np.max(np.abs(reached[happens, i] / expected[happens] - 1.0))))
    return worst


@pytest.mark.gate
def test_the_switch_is_within_the_accuracy_asked_for(build):
    assert _worst(build(), SOFTENING, 4) < WITHIN
    assert _worst(build(), [*AT_THE_END, *ENDS], 4) < WITHIN


@pytest.mark.slow
@pytest.mark.parametrize("design", ["as it is", "thin", "thick", "aluminium", "sink", "equilibrium"])
def test_the_whole_cycle_is_within_the_accuracy_asked_for(build, design):
    model = build(design, 24)
    names = [name for name in [*SOFTENING, *BACK] if name in model.switch_names]
    assert _worst(model, names, 6) < WITHIN


@pytest.mark.slow
@pytest.mark.parametrize("study", [*(path.stem for path in STUDIES), *CURRENT])
def test_every_study_is_within_the_accuracy_asked_for(study):
    read = read_study(study_path(study))
    table = table_for(read.mode)
    inputs = given(read)
    if study in CURRENT:
        inputs["current"] = CURRENT[study]
    model = DeviceFunctions(table, inputs, tuple(read.operating_points), read.solver.cells)
    assert _worst(model, SOFTENING, 6) < WITHIN
    assert _worst(model, AT_THE_END, 6) < WITHIN


def test_no_bit_hangs_on_workers_or_neighbours(build, switch_of, monkeypatch):
    monkeypatch.setattr(cycle_kernel, "BLOCK", 32)
    model = build()
    kernel = CycleKernel(model, MOVING, ["response_time", "switch_energy"])
    pace, columns = _pace(model, switch_of("as it is")), _columns(model, 36)  # more than a block
    alone = kernel(columns, pace)
    assert np.array_equal(alone, kernel(columns, pace, workers=2))
    assert np.array_equal(alone[:, 30:33], kernel(columns[:, 30:33], pace))
    fitted = kernel.fitted(pace, columns[:, 0])
    assert np.array_equal(kernel(columns, fitted)[:, 30:33], kernel(columns[:, 30:33], fitted))


def test_what_never_ends_is_infinite_and_its_neighbours_are_not(build, switch_of):
    model = build()
    kernel = CycleKernel(model, ["current"], ["response_time", "switch_energy", *ENDS, "peak_power"])
    values = kernel(np.array([[0.06, 1.5]]), _pace(model, switch_of("as it is")))
    assert np.isinf(values[:-1, 0]).all()
    assert np.isfinite(values[:, 1]).all()
    assert np.isfinite(values[-1, 0])  # a peak is one of a stage that never ends, too


UNARY = ("exp", "log", "log1p", "expm1", "sqrt", "sin", "cos", "tan", "asin", "acos", "atan", "sinh", "cosh", "tanh",
       "fabs", "erf", "floor", "ceil", "sign")  # fmt: skip
PLACES = [
    0.0, -0.0, 1.0, -1.0, 0.5, 2.0, 3.0, -2.5, 0.7071, 0.7072, 1.0 - 1e-9, 1.0 + 1e-9, 1.4143, 1e-9, -1e-12, -0.9999,
    50.0, -20.0, 709.0, -745.0, 1e6, 5e-324, 1e-310, 1e300, math.inf, -math.inf, math.nan,
]  # fmt: skip


def test_operations_are_those_of_casadi_and_its_c_library():
    """For every pair of places: edges, and where the series of logarithm and exponential meet."""
    x, y = ca.SX.sym("x"), ca.SX.sym("y")
    entries = [getattr(ca, name)(x) for name in UNARY]
    entries += [x < y, x <= y, x == y, x != y, ca.logic_not(x), ca.logic_and(x, y), ca.logic_or(x, y),
                ca.if_else(x, y, 7.0), ca.if_else(x < y, x, y), ca.copysign(x, y), ca.atan2(x, y), ca.fmin(x, y),
                ca.fmax(x, y), x / y, x * y, -x, x * x, 2 * x, 1 / (x + 3.0)]  # fmt: skip
    function = ca.Function("f", [x, y], [ca.vertcat(*entries)])
    columns = np.array(list(itertools.product(PLACES, repeat=2))).T.copy()
    for place, values in zip(columns.T, Kernel(Tape.of_function(function))(columns).T, strict=True):
        expected = np.asarray(function(*place)).ravel()
        assert values == pytest.approx(expected, rel=1e-15, abs=5e-324, nan_ok=True), place


@pytest.mark.parametrize("study", ["paper_shear", "paper_compression", "wrist_joint"])
def test_the_kernel_of_the_table_agrees_with_casadi(study):
    read = read_study(study_path(study))
    table = table_for(read.mode)
    model = DeviceFunctions(table, given(read), tuple(read.operating_points), read.solver.cells)
    moving = ["wire_diameter", "coil_diameter", "preload_angle", "pcl_inner_radius", "pcl_flexural_modulus", "current"]
    places = [model.index[name] for name in moving]
    columns = model.start[places, None] * np.random.default_rng(1).uniform(0.99, 1.01, (len(moving), 21))
    supplied = np.full((len(model.switch_names), 21), 50.0)
    values = kernel_of(model, model.output_names, moving, model.switch_names)(np.concatenate([columns, supplied]))
    inputs = np.repeat(model.start[:, None], 21, axis=1)
    inputs[places] = columns
    expected = np.asarray(model.outputs(model.output_names)(inputs, supplied))
    for name, ours, theirs in zip(model.output_names, values, expected, strict=True):
        assert ours == pytest.approx(theirs, rel=digits(name, 1e-13), abs=1e-15, nan_ok=True), name


def test_arrays_of_any_order_and_workers_give_the_same_bits():
    x = ca.SX.sym("x", 2)
    kernel = Kernel(Tape.of([x], [x[0] - 2.0 * x[1]]))
    columns = np.arange(20.0).reshape(10, 2).T
    assert kernel(columns)[0] == pytest.approx(columns[0] - 2.0 * columns[1])
    with pytest.raises(ValueError, match="takes 2 rows, got 3"):
        kernel(np.zeros((3, 4)))
    kernel = Kernel(Tape.of([x], [ca.vertcat(ca.exp(x[0]) * ca.log(x[1]), x[0] ** x[1])]))
    columns = np.random.default_rng(2).uniform(0.1, 3.0, (2, 10_007))
    alone = kernel(columns)
    assert alone[1] == pytest.approx(columns[0] ** columns[1], rel=1e-15)
    assert np.array_equal(alone, kernel(columns, workers=2))
