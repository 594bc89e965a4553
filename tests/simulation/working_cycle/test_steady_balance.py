"""Current and power of a soft steady state: against a long simulation, the first law, and two dimensions."""

import sys

import numpy as np
import pytest
from another_stack import FLOOR, AnotherStack, value_of
from numpy.typing import NDArray
from scipy.integrate import solve_ivp
from support import ROOT, study_path, tight

sys.path.insert(0, str(ROOT / "validation" / "heat_sector"))

from compare import Judge, model_of, plane_of

from tvimdesign.device import table_for
from tvimdesign.simulation.working_cycle.cycle import Simulator
from tvimdesign.simulation.working_cycle.device_functions import DeviceFunctions
from tvimdesign.study import given, read_study

Array = NDArray[np.float64]
DESIGNS = ("as it is", "thick", "sink")


@pytest.mark.parametrize("design", DESIGNS)
def test_at_the_hold_current_the_layer_stays_where_the_switch_ended(design, build, switch_of):
    # Another integration over hours from the switch's end: the far face comes back to the target and stays.
    model, cycle = build(design), switch_of(design)
    phase, amps = model.phases["softening"], cycle.values["hold_current"]
    jacobian = phase.rates.jacobian()
    long = solve_ivp(
        lambda _, y: np.asarray(phase.rates(y, amps, model.start)).ravel(), (0.0, 2e5),
        cycle.trajectories["softening"].states[:, -1], method="BDF", rtol=1e-9, atol=1e-11,
        jac=lambda _, y: np.asarray(jacobian(y, amps, model.start, 0)[0]),
    )  # fmt: skip
    end = long.y[:, -1]
    gap = float(phase.watch(["response_time"])(end, amps, model.start))
    assert gap == pytest.approx(0.0, abs=1e-6)  # in hundreds of kelvin
    assert end == pytest.approx(cycle.balances["softening"][:-1], abs=1e-6)
    power = float(phase.watch(["hold_power"])(end, amps, model.start))
    assert cycle.values["hold_power"] == pytest.approx(power, rel=1e-6)


@pytest.mark.parametrize("design", DESIGNS)
def test_what_holds_the_layer_is_what_the_air_takes(design, build, switch_of):
    model, cycle = build(design), switch_of(design)
    phase, balance = model.phases["softening"], cycle.balances["softening"]
    assert np.max(np.abs(np.asarray(phase.rates(balance[:-1], balance[-1], model.start)))) < 1e-9
    value, sink = value_of(model), design == "sink"
    another = AnotherStack(value, sink=sink)
    seen = np.asarray(phase.temperatures(balance[:-1], balance[-1], model.start)).ravel() - 273.15
    cold, outer = seen[0], seen[4 + model.cells + int(value("rotor_cells")) - 1]
    beside = seen[4 + model.cells + int(value("rotor_cells")) :]
    lost = np.sum(another.strips * another._flux(beside[:4], value("rotor_coefficient"), another.to_face[0]))
    seen_by_another = another.everywhere(0.0)
    seen_by_another[0], seen_by_another[FLOOR] = cold, beside[-9:]
    lost += np.sum(another._through(seen_by_another)[1])
    lost += _plate_loss(another, outer, 0.5 * value("rotor_thickness") / value("rotor_cells"))
    if sink:
        lost += value("sink_area") * another._flux(beside[4], value("sink_coefficient"))
    else:
        lost += another.window * another._flux(cold, value("cold_side_coefficient"))
    # The pads' power with the rounding of its corner at zero left out; the plate's face radiates at its cell's heat.
    assert cycle.values["hold_power"] == pytest.approx(lost, rel=2e-3)


def _plate_loss(another: AnotherStack, outermost: float, half: float) -> float:
    face = outermost
    for _ in range(50):
        flux = another._flux(face, another.value("rotor_coefficient"))
        face = 0.5 * face + 0.5 * (outermost - half / another.value("structure_conductivity") * flux)
    return another.area * flux


def test_less_current_lets_the_layer_cool_and_more_heats_it(build, switch_of):
    model, cycle = build(), switch_of("as it is")
    phase, balance = model.phases["softening"], cycle.balances["softening"]
    for share, sign in ((0.95, -1.0), (1.05, 1.0)):
        solved = solve_ivp(
            lambda _, y, amps=share * balance[-1]: np.asarray(phase.rates(y, amps, model.start)).ravel(),
            (0.0, 1e4), balance[:-1], method="LSODA", rtol=1e-8, atol=1e-10,
        )  # fmt: skip
        gap = float(phase.watch(["response_time"])(solved.y[:, -1], share * balance[-1], model.start))
        assert sign * gap > 0.01


def test_holding_takes_less_than_the_switch_and_never_without_one(switch_of, build):
    for design in DESIGNS:
        values = switch_of(design).values
        assert 0.0 < values["hold_power"] < values["peak_power"]
        assert 0.0 < values["hold_current"] < values["peak_current"]
    model = build()
    inputs = model.start.copy()
    inputs[model.index["current"]] = 0.4
    assert tight(model).run(inputs).values["hold_power"] == np.inf


@pytest.mark.parametrize("design", ["as it is", "sink"])
def test_what_holds_the_layer_does_not_depend_on_how_fast_it_was_heated(design, build, switch_of):
    model = build(design)
    simulator, place = tight(model), model.index["current"]
    for amps in (1.8, 4.0, 12.0):
        inputs = model.start.copy()
        inputs[place] = amps
        values = simulator.run(inputs, phases=["softening"]).values
        for name in ("hold_current", "hold_power"):
            assert values[name] == pytest.approx(switch_of(design).values[name], rel=1e-8), name


@pytest.mark.gate
def test_a_steady_state_ignores_last_digits_of_the_switch_s_end():
    # The optimum of compare_shear.yaml, where Newton's method with shortened steps stopped dead now and then.
    study = read_study(ROOT / "validation/fe_structure/studies/compare_shear.yaml")
    sizes = {
        "wire_diameter": 1.8558e-3, "coil_diameter": 8e-3, "coil_count": 3.0, "placement_radius": 25.182e-3,
        "core_radius": 7.5293e-3, "link_thickness": 5.2372e-3, "rotor_rim": 1e-3, "pcl_inner_radius": 11.929e-3,
        "pcl_outer_radius": 17.845e-3, "arc_span": 1.31931, "pcl_thickness": 1.87755e-3,
    }  # fmt: skip
    table = table_for("shear")
    model = DeviceFunctions(table, given(study) | sizes, tuple(study.operating_points), study.solver.cells)
    simulator = Simulator(model)
    currents = []
    for step in range(40):
        inputs = model.start.copy()
        inputs[model.index["pcl_thickness"]] *= 1.0 + 1e-8 * step
        currents.append(simulator.run(inputs, phases=["softening"]).values["hold_current"])
    assert currents == pytest.approx([currents[0]] * 40, rel=1e-8)


DAYS = 2e5  # s
OPTIMUM_OF_THAT_DAY = {
    "wire_diameter": 1.81288e-3, "coil_diameter": 8e-3, "coil_count": 3.0, "placement_radius": 31.6415e-3,
    "core_radius": 7.52928e-3, "link_thickness": 5.16203e-3, "pcl_inner_radius": 11.92928e-3,
    "pcl_outer_radius": 23.84339e-3, "arc_span": 1.3193123, "pcl_thickness": 0.6e-3, "current": 1.6288039,
}  # fmt: skip


@pytest.mark.parametrize(
    ("study", "sizes"),
    [("paper_shear", OPTIMUM_OF_THAT_DAY), ("paper_reconstructed", {})],
    ids=["optimum", "published"],
)
def test_the_plane_stays_at_the_target_by_the_product_s_current(study, sizes):
    path = study_path(study)
    model = model_of(path, **sizes)
    amps = Simulator(model).run(model.start, phases=["softening"]).values["hold_current"]
    held = model_of(path, **{**sizes, "current": amps})
    judge = Judge(held, plane_of(held, 0.7))
    _, states = judge.plane.heat(DAYS, 30)
    rise = judge.known["target_temperature"] - judge.known["ambient_temperature"]
    assert judge.far_face(states[-1]) - judge.plane.ambient == pytest.approx(rise, rel=0.03)
