"""Benchmarks give all contenders the same problem, and tell a right answer from a wrong one."""

import numpy as np
import pytest
import switch
import yaml
from as_plain_python import by_hand, hand_module
from contenders import Once, by_tvimdesign, lsoda
from front import ManyDesigns
from optimum import exact
from reference_problem import Reference, study
from support import ROOT

from tvimdesign.device.components.hard_stops import SLIVER
from tvimdesign.simulation.working_cycle.device_functions import DeviceFunctions
from tvimdesign.study import given, read_study

SEAT = ("thermistor_window_gap", "thermistor_arc_gap")
"""Of a thermistor that this module does not have."""
CONSTANT = (
    "soft_reach", "stiff_reach", "key_width_margin", "key_pitch_margin", "hub_recess_margin", "free_angle_margin",
    "spring_torque_full_stroke",
)  # fmt: skip
"""Limits that are one for all designs of this problem, or that none can break: on impedance, keys that it has none of,
the hub's recess, the free angle of springs, which are all sorted to 1 degree, and their torque, which turns with the
rotor."""
BY_STOP_WIDTH = ("stop_face_safety", "stop_post_safety", "stop_width_margin")
"""Limits that by hand go on where stops have no room: the table keeps them at a sliver, where SLSQP is lost."""


@pytest.fixture(scope="module")
def reference() -> Reference:
    return Reference(study())


def test_the_functions_of_the_rivals_are_those_of_the_product(reference):
    cycle = reference.optimizer.multistart.cycle
    values = reference.model.values(reference.model.start, cycle)
    assert lsoda(1e-9)(reference, reference.begin) == pytest.approx(values["response_time"], rel=1e-4)
    rows = reference.rows(reference.begin, values["response_time"])
    assert rows[0] == pytest.approx(3.0)  # three outputs, each over its value at the start
    assert rows[1:] == pytest.approx([limit.residual(values[limit.output]) for limit in reference.limits])


def test_our_own_row_is_an_optimum_to_an_independent_integrator(reference):
    optimum = by_tvimdesign(reference, reference.begin)
    objective, broken = exact(reference, optimum.design)
    assert broken < 1e-6
    # No feasible step of a thousandth to either side of any variable is better.
    once = Once(reference, lsoda(1e-9))
    for i in range(len(optimum.design)):
        for step in (-1e-3, 1e-3):
            logs = np.log(optimum.design) + step * (np.arange(len(optimum.design)) == i)
            inside = np.all(np.exp(logs) <= reference.upper) and np.all(np.exp(logs) >= reference.lower)
            if inside and np.all(once.room(logs) >= 0.0):
                assert once.objective(logs) > objective * (1.0 - 1e-6)


def equations_by_hand(design: np.ndarray, sensitive: bool = False) -> tuple[np.ndarray, np.ndarray]:
    count = hand_module.OUTPUTS + hand_module.RESIDUALS
    rows, slopes = np.zeros(count), np.zeros((count, len(design)))
    by_hand.evaluate(np.log(design), rows, slopes, sensitive)
    return rows, slopes


def others(reference: Reference) -> list[np.ndarray]:
    return [reference.begin, *reference.random_starts(2)]


@pytest.mark.gate
def test_the_arithmetic_written_by_hand_is_the_tables(reference):
    names = yaml.safe_load((ROOT / "tests/cases/hand_rows.yaml").read_text("utf-8"))
    place = {f"{limit.output} {limit.sense}": i for i, limit in enumerate(reference.limits, start=1)}
    assert {name.split()[0] for name in place.keys() - set(names)} <= {*CONSTANT, *SEAT}
    compared_rows = [place[name] for name in names]
    by_width = np.array([reference.limits[i - 1].output in BY_STOP_WIDTH for i in compared_rows])
    sizes = reference.model.outputs(["envelope_volume", "module_mass", "stop_width"])
    for design in [reference.begin, *reference.random_starts(3)]:
        rows = np.zeros(hand_module.OUTPUTS + hand_module.RESIDUALS)
        hand_module.measure(design, rows, np.zeros(hand_module.HEAT))
        expected = np.asarray(sizes(reference.inputs(design), np.ones(len(reference.model.switch_names)))).ravel()
        assert rows[:2] == pytest.approx(expected[:2], rel=1e-12)
        residuals, from_rows = reference.rows(design, 100.0)[compared_rows], rows[hand_module.OUTPUTS :]
        no_room = by_width & (expected[2] <= SLIVER)
        assert from_rows[~no_room] == pytest.approx(residuals[~no_room], rel=1e-9, abs=1e-12)
        assert np.all(residuals[no_room] > 0.0)
        assert np.all(from_rows[no_room] > residuals[no_room])
    assert pytest.approx(reference.begin, rel=1e-12) == by_hand.PUBLISHED
    assert by_hand.ByHand().objective(np.log(reference.begin)) == pytest.approx(3.0)


@pytest.mark.gate
def test_the_switch_written_by_hand_is_the_tables(reference):
    rows, _ = equations_by_hand(reference.begin)
    assert rows[2] == pytest.approx(lsoda(1e-9)(reference, reference.begin), rel=2e-5)


@pytest.mark.slow
def test_the_optimum_by_hand_is_ours(reference):
    design, _ = by_hand.by_hand(reference.begin, reference.lower, reference.upper)
    ours = exact(reference, by_tvimdesign(reference, reference.begin).design)
    objective, broken = exact(reference, design)
    assert objective == pytest.approx(ours[0], rel=1e-6)
    assert broken < 1e-6


@pytest.mark.slow
def test_the_slopes_written_by_hand_are_those_of_its_values(reference):
    _, slopes = equations_by_hand(reference.begin, sensitive=True)
    for i in range(len(reference.begin)):
        aside = 1e-4 * (np.arange(len(reference.begin)) == i)
        low, high = (equations_by_hand(reference.begin * np.exp(side * aside))[0] for side in (-1.0, 1.0))
        slope, expected = slopes[:, i], (high - low) / 2e-4
        assert slope[2] == pytest.approx(expected[2], rel=1e-4, abs=5e-3)  # seconds, of 170
        assert np.delete(slope, 2) == pytest.approx(np.delete(expected, 2), rel=1e-4, abs=1e-7)


@pytest.mark.gate
def test_a_generation_is_given_the_same_problem(reference):
    designs = others(reference)
    many = ManyDesigns(reference, ("response_time", "module_mass"), pace=100.0)
    outputs, residuals = many(np.array(designs).T.copy())
    for i, design in enumerate(designs):
        seconds = lsoda(1e-9)(reference, design)
        assert outputs[0, i] == pytest.approx(seconds, rel=2e-3)
        assert residuals[:-1, i] == pytest.approx(reference.rows(design, seconds)[1:], rel=1e-9, abs=1e-12)
        assert residuals[-1, i] < 0.0


@pytest.fixture(scope="module")
def model() -> DeviceFunctions:
    study = read_study(switch.STUDY)
    table = study.table
    return DeviceFunctions(table, given(study), tuple(study.operating_points), study.solver.cells)


def test_equations_by_hand_and_compiled_are_the_same(model):
    hand, machine = switch.written_by_hand(model, sparse=True), switch.compiled(model)
    assert hand.start == pytest.approx(machine.start)
    generator = np.random.default_rng(1)
    for _ in range(5):
        state = hand.start * generator.uniform(0.9, 4.0, hand.start.size)
        assert hand.rates(0.0, state) == pytest.approx(machine.rates(0.0, state), rel=1e-9, abs=1e-12)
        gaps = np.asarray(hand.gaps(0.0, state)) / np.array([100.0, 100.0, 100.0, 1.0])
        assert gaps == pytest.approx(machine.gaps(0.0, state), rel=1e-9, abs=1e-12)
        slope = machine.jacobian(0.0, state)
        assert np.all((slope == 0.0) | (hand.sparsity == 1.0))
        shift = 1e-6 * generator.standard_normal(state.size)
        change = machine.rates(0.0, state + shift) - machine.rates(0.0, state - shift)
        assert change == pytest.approx(2.0 * slope @ shift, rel=1e-4, abs=1e-10)


@pytest.mark.gate
def test_all_rows_find_the_same_times(model):
    machine = switch.compiled(model)
    ours = switch.by_tvimdesign(model)(0.0)
    assert switch.by_scipy(machine, "LSODA")(1e-9) == pytest.approx(ours, rel=1e-4)
    assert switch.by_scipy(machine, "BDF")(1e-7) == pytest.approx(ours, rel=1e-4)
    assert switch.by_scipy(switch.written_by_hand(model, sparse=True), "BDF")(1e-5) == pytest.approx(ours, rel=1e-4)
