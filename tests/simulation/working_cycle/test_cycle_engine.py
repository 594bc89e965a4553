"""The cycle with derivatives: smooth, near CVODES, in few steps; other materials; symbols for numpy's functions."""

from collections.abc import Callable
from functools import cache
from typing import Any

import hypothesis
import numpy as np
import pytest
from hypothesis import strategies as st
from support import STUDIES, fine, study_path

from tvimdesign.device.table.quantity import STIFFENING
from tvimdesign.simulation.working_cycle.curves import fractions_at, frozen_on_cooling
from tvimdesign.simulation.working_cycle.cycle import Array, Cycle, CycleEngine, Simulator, Supplied
from tvimdesign.simulation.working_cycle.device_functions import DeviceFunctions, ResolvedModule, resolve_study
from tvimdesign.simulation.working_cycle.phase_instants import Drive, Grid
from tvimdesign.simulation.working_cycle.symbols import ca, symbols
from tvimdesign.study import drawn, given, read_study, read_study_text

EXACT = 3e-3
"""Relative error of values that an optimum is sought with; those that are reported are within 1e-4."""
MOVED = ("current", "pcl_thickness", "rotor_thickness", "cooling_current", "ambient_temperature")
MOST = {"softening": 60, "stiffening": 60, "equilibrium_stiffening": 25}
"""Steps of a phase of the shear module as it is: a guard of how fast it is, without a clock."""


def directions(model: DeviceFunctions) -> Array:
    """Return a column for each input, by its own size (temperatures by 100 K), and one that moves all of them."""
    columns = []
    for name in MOVED:
        column, i = np.zeros(len(model.start)), model.index[name]
        column[i] = 100.0 if name.endswith("temperature") else model.start[i]
        columns.append(column)
    return np.column_stack([*columns, np.sum(columns, axis=0)])


def compare(model: DeviceFunctions, value_at: Callable[[Array, Array], Supplied], names: list[str]) -> None:
    """Compare derivatives of all that is finite with a stencil of fourth order."""
    along, by = directions(model), 1e-4  # values ripple by 1e-7 of themselves as maxima pass from sample to sample
    begin = value_at(model.start, along)
    known = np.isfinite(begin.values)
    assert {name for name, here in zip(model.switch_names, known, strict=True) if here} >= set(names)
    nothing = np.zeros((len(model.start), 0))
    for j in range(along.shape[1]):
        far_below, below, above, far_above = (
            value_at(model.start + times * by * along[:, j], nothing).values[known] for times in (-2, -1, 1, 2)
        )
        slope = (far_below - 8.0 * below + 8.0 * above - far_above) / (12.0 * by)
        largest = np.max(np.abs(begin.slopes[known]), axis=1) + 1e-3 * np.abs(begin.values[known])
        gap = np.abs(slope - begin.slopes[known, j]) / largest
        assert np.max(gap) < 1e-5, (j, np.array(model.switch_names)[known][np.argmax(gap)], np.max(gap))


@pytest.mark.gate
@pytest.mark.parametrize("design", ["as it is", "sink"])
def test_derivatives_of_all_values_are_those_of_the_values(design, build):
    model = build(design, melt_memory=1.0)  # with one that fades within 3 K the soft time ripples by 1.2e-5
    grids: dict[str, Grid] = {}
    compare(
        model, lambda inputs, along: CycleEngine(model).run(inputs, along, None, grids),
        ["response_time", "switch_energy", "stiffening_time", "hold_power", "peak_power", "peak_pcl_temperature"],
    )  # fmt: skip
    assert set(grids) == set(model.phases)


def drive(model: DeviceFunctions, inputs: Array, along: Array) -> Drive:
    """Return a current of three pieces over a time that both follow the current of the inputs, with tangents."""
    i = model.index["current"]
    shares, moments = np.array([0.5, 1.5, 0.9, 1.1]), np.array([0.0, 20.0, 60.0, 150.0])
    size = inputs[i] / model.start[i]
    return Drive(
        moments * size, moments[:, None] * along[i] / model.start[i], shares * inputs[i], shares[:, None] * along[i], 8
    )


def test_derivatives_under_a_current_that_follows_a_profile(build):
    model = build()
    grids: dict[str, Grid] = {}

    def value_at(inputs: Array, along: Array) -> Supplied:
        return CycleEngine(model).run(inputs, along, None, grids, {"softening": drive(model, inputs, along)})

    begin = value_at(model.start, directions(model))
    place = model.switch_names.index("response_time")
    assert begin.values[place] == pytest.approx(150.0, rel=1e-12)
    value, slopes = begin.driven["softening"].short, begin.driven["softening"].of_short
    by, way = 1e-4, directions(model)[:, -1]
    nothing = np.zeros((len(way), 0))
    shorts = [value_at(model.start + times * by * way, nothing).driven["softening"].short for times in (-2, -1, 1, 2)]
    slope = (shorts[0] - 8.0 * shorts[1] + 8.0 * shorts[2] - shorts[3]) / (12.0 * by)
    assert slopes[-1] == pytest.approx(slope, rel=1e-6)
    assert abs(value) > 1e-3  # it need not be over
    compare(model, value_at, ["response_time", "switch_energy", "peak_power"])


@pytest.mark.parametrize("design", ["as it is", "thin", "thick", "aluminium", "sink"])
def test_values_an_optimum_is_sought_with_are_near_those_of_cvodes(design, build, judged):
    model = build(design)
    values = CycleEngine(model).run(model.start, np.zeros((len(model.start), 0))).values
    judge = judged(design).values
    for i, name in enumerate(model.switch_names):
        assert values[i] == pytest.approx(judge[name], rel=EXACT), name


@pytest.mark.slow
@pytest.mark.parametrize("path", STUDIES, ids=lambda path: path.stem)
def test_values_of_a_study_s_optimum_are_near_those_of_cvodes(path):
    study = drawn(read_study(path))
    model = resolve_study(study).functions
    grids: dict[str, Grid] = {}
    values = CycleEngine(model).run(model.start, np.zeros((len(model.start), 0)), None, grids).values
    judge = fine(model).run(model.start).values
    endless = {name for name, phase in model.phases.items() if np.isinf(judge[phase.phase.ends])}
    for i, row in enumerate(study.table.supplied):
        if row.phase in endless:  # CVODES has what it reaches, the engine nothing
            assert np.isinf(values[i])
        else:
            assert values[i] == pytest.approx(judge[row.name], rel=EXACT), row.name
    assert max(len(grid.shares) for grid in grids.values()) <= 80


def test_values_do_not_depend_on_the_number_of_directions(build):
    model = build()
    grids: dict[str, Grid] = {}
    along = directions(model)
    many = CycleEngine(model).run(model.start, along, None, grids)
    alone = CycleEngine(model).run(model.start, along[:, :1], None, grids)
    assert many.values == pytest.approx(alone.values, rel=1e-9)
    assert many.slopes[:, 0] == pytest.approx(alone.slopes[:, 0], rel=1e-7, abs=1e-12)


def test_only_the_phases_that_are_needed_are_stepped(build):
    model = build()
    grids: dict[str, Grid] = {}
    along = np.zeros((len(model.start), 1))
    run = CycleEngine(model).run(model.start, along, {"response_time", "peak_power"}, grids)
    assert set(grids) == {"softening"}
    known = {name for name, value in zip(model.switch_names, run.values, strict=True) if np.isfinite(value)}
    assert known == {"response_time", "peak_power"}


def test_an_event_that_comes_later_than_the_steps_were_made_for_is_found(build):
    model = build()
    grids: dict[str, Grid] = {}
    engine, nothing = CycleEngine(model), np.zeros((len(model.start), 0))
    engine.run(model.start, nothing, None, grids)
    for factor in (0.8, 1.3):
        inputs = model.start.copy()
        inputs[model.index["pcl_thickness"]] *= factor
        judge = fine(model).run(inputs).values
        values = engine.run(inputs, nothing, None, grids).values
        for name in ("response_time", "stiffening_time", "switch_energy"):
            assert values[model.switch_names.index(name)] == pytest.approx(judge[name], rel=EXACT), (factor, name)


def test_a_phase_takes_no_more_steps_than_it_did(build):
    model = build()
    grids: dict[str, Grid] = {}
    CycleEngine(model).run(model.start, np.zeros((len(model.start), 0)), None, grids)
    for name, most in MOST.items():
        assert 2 < len(grids[name].shares) <= most, name


@pytest.mark.gate
@pytest.mark.parametrize("study", ["elbow_printed", "paper_shear"])
def test_a_steady_state_that_changes_steeply_is_found(study):
    # Newton's method alone goes to and fro between currents that melt a part of the elbow's layer and that do not.
    read = drawn(read_study(study_path(study)))
    model = resolve_study(read).functions
    engine, along = CycleEngine(model), np.zeros((len(model.start), 1))
    along[model.index["ambient_temperature"]] = 1.0
    run = engine.run(model.start, along, {"hold_current", "hold_power"})
    judge = fine(model).run(model.start, phases=["softening"]).values
    for name in ("hold_current", "hold_power"):
        place = model.switch_names.index(name)
        assert run.values[place] == pytest.approx(judge[name], rel=1e-6)
        assert run.slopes[place, 0] < 0.0


METAL, WAX, GLASS = "pcl_grade: fields_metal", "pcl_grade: paraffin_rt60", "pcl_grade: pla"
COMB = "pcl_grade: conductive_pla, heater_module: comb_electrodes, current: 0.6 A, target_temperature: 80 degC"
BLOCKS = "lead_hole_diameter: 1 mm, electrode_gap: 12 mm, corner_radius: 0.2 mm"
CELLS = 10


@cache
def model(mode: str, module: str) -> DeviceFunctions:
    study = read_study_text(f"mode: {mode}\nmodule: {{{module}}}\n", "a test")
    return DeviceFunctions(study.table, given(study), ("cold", "hot"), CELLS)


def circuit(built: DeviceFunctions) -> tuple[float, float]:
    """Resistance of layer and pads [ohm]."""
    numbers = {name: float(built.start[i]) for name, i in built.index.items()}
    values = built.table.evaluate({**built.words, **numbers}, ["layer_resistance", "pads"])
    return values["layer_resistance"], values["pads"].resistance


@cache
def cycle(mode: str, module: str) -> Cycle:
    built = model(mode, module)
    return Simulator(built).run(built.start)


@pytest.mark.parametrize("mode", ["shear", "compression"])
@pytest.mark.parametrize("module", [METAL, WAX, GLASS])
def test_what_has_no_kinetics_freezes_as_it_melts(mode, module):
    phases = model(mode, module).phases
    sizes = {name: phases[name].state_size for name in phases}
    assert len(set(sizes.values())) == 1
    times = cycle(mode, module).values
    assert times["stiffening_time"] == pytest.approx(times["equilibrium_stiffening_time"], rel=2e-5)


def test_a_polymer_still_freezes_late():
    phases = model("shear", "pcl_grade: pcl_80k").phases
    assert phases["stiffening"].state_size == phases["equilibrium_stiffening"].state_size + CELLS


@pytest.mark.parametrize(("mode", "module"), [("shear", COMB), ("shear", GLASS), ("compression", METAL)])
def test_symbols_are_the_same_as_floats(mode, module):
    built = model(mode, module)
    phase = built.phases["stiffening"]
    state = np.asarray(phase.initial(built.start)).ravel() + 0.1 * np.arange(phase.state_size) / phase.state_size
    given_numbers = {**built.words, **{name: float(built.start[i]) for name, i in built.index.items()}}
    known = {**given_numbers, "phase": STIFFENING, "state": state, "drive_current": -0.3}
    values = built.table.evaluate_instant(known, ["state_rates", "impedance_now", "electrical_power"])
    rates = np.asarray(phase.rates(state, -0.3, built.start)).ravel()
    assert rates == pytest.approx(values["state_rates"], rel=1e-9, abs=1e-12)
    assert float(phase.watch(["impedance_now"])(state, -0.3, built.start)) == pytest.approx(
        values["impedance_now"], rel=1e-9
    )


def test_a_layer_that_heats_itself_takes_its_power_and_is_hottest_inside():
    built, run = model("shear", COMB), cycle("shear", COMB)
    whole = sum(circuit(built))
    assert run.values["peak_power"] == pytest.approx(0.6**2 * whole, rel=1e-6)
    assert run.values["peak_voltage"] == pytest.approx(0.6 * whole, rel=1e-6)
    assert run.values["switch_energy"] == pytest.approx(0.6**2 * whole * run.values["response_time"], rel=1e-4)
    # The far face, behind plastic, waits for 80 degC; the middle of the layer is then warmer than both faces.
    assert run.values["peak_pcl_temperature"] > 353.15 + 0.1


@pytest.mark.slow
def test_blocks_heat_themselves_as_well():
    run = cycle("compression", f"{COMB}, {BLOCKS}")
    assert 0.0 < run.values["response_time"] < 3600.0


def test_a_layer_that_heats_itself_is_evenly_warm_sooner_than_one_on_pads():
    """With the same power the far face waits for no heat to come through a plastic."""
    inside = cycle("shear", COMB).values
    watts = inside["peak_power"]
    foil = "heater_resistance: 20 ohm, heater_module: polyimide_foil_24v"
    built = model("shear", f"pcl_grade: conductive_pla, {foil}, current: 1 A, target_temperature: 80 degC")
    start = built.start.copy()
    start[built.index["current"]] = np.sqrt(watts / circuit(built)[1])
    outside = Simulator(built).run(start).values
    assert outside["peak_power"] == pytest.approx(watts, rel=1e-6)
    assert inside["far_face_time"] < 0.95 * outside["far_face_time"]


def resolved(module: str) -> ResolvedModule:
    return resolve_study(read_study_text(f"mode: shear\nmodule: {{{module}}}\n", "a test"))


def test_a_wax_in_its_range_is_known_to_kelvins_not_to_history():
    # 53 to 62 degC, each one kelvin either way: at 57 degC 5/9 is frozen, 4/9 to 6/9.
    fractions = fractions_at(resolved(WAX), 57.0 + 273.15)
    assert fractions == pytest.approx((4.0 / 9.0, 5.0 / 9.0, 6.0 / 9.0), abs=0.01)


@pytest.mark.parametrize("rate", [0.001, 10.0])
def test_a_wax_that_cools_is_frozen_as_it_melted_at_any_rate(rate):
    frozen = frozen_on_cooling(resolved(WAX), rate)
    assert [frozen(273.15 + at) for at in (70.0, 57.0, 40.0)] == pytest.approx([0.0, 5.0 / 9.0, 1.0], abs=0.01)


WRITTEN: dict[str, Callable[[Any], Any]] = {
    "arithmetic of entries": lambda x: (x[0] + 2.0) * x[1] - 3.0 / x[2] + x[1] ** 2 - 2 ** x[0] + (-x[2]),
    "numbers on the left": lambda x: 1.0 - x[0] + 2 * x[1] / (4.0 / x[2]) + np.float64(0.3) * x[0],
    "elementwise functions": lambda x: np.sum(
        np.sqrt(x) + np.exp(-x) + np.expm1(x) + np.log(x) + np.log1p(x) + np.sin(x) + np.cos(x) + np.tanh(x)
        + np.arcsin(x / 10.0) + np.arctan(x) + np.abs(-x)
    ),
    "smaller and larger": lambda x: np.fmin(x[0], x[1]) - np.fmax(x[2], 1.0) + np.minimum(0.5, x[1]),
    "angles of two sides": lambda x: np.arctan2(x[0], x[1]),
    "array with array": lambda x: np.sum(x * np.array([1.0, 2.0, 3.0]) + np.array([1.0, 2.0, 3.0]) / x),
    "array with entry": lambda x: np.sum(x * x[0] + x[1] / x - (x[2] - x)),
    "parts of an array": lambda x: np.sum(x[1:] * x[:-1]) + np.sum(np.diff(x) ** 2) + x[-1],
    "arrays put together": lambda x: np.sum(np.append(x, x[0]) * np.array([1.0, -1.0, 2.0, 0.5])) + np.mean(x),
    "a table of two dimensions": lambda x: np.sum(np.reshape(x, (3, 1)) * np.array([[1.0, 2.0]])),
}  # fmt: skip


@pytest.mark.parametrize("what", WRITTEN)
@hypothesis.given(values=st.lists(st.floats(0.1, 9.0), min_size=3, max_size=3))
def test_an_expression_of_symbols_is_what_numpy_computes(what, values):
    column = ca.SX.sym("x", 3)
    written = ca.Function("written", [column], [WRITTEN[what](symbols(column))])
    assert float(written(values)) == pytest.approx(float(WRITTEN[what](np.array(values))), rel=1e-13, abs=1e-13)
