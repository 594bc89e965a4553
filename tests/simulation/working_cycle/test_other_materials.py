"""Metals, waxes, glasses and layers that heat themselves: working cycles, and the range of the solid fraction."""

from functools import cache

import numpy as np
import pytest

from tvimdesign.device.table.quantity import STIFFENING
from tvimdesign.simulation.working_cycle.cycle import Simulator
from tvimdesign.simulation.working_cycle.device_functions import DeviceFunctions
from tvimdesign.simulation.working_cycle.melt_history import fractions_at, frozen_on_cooling
from tvimdesign.simulation.working_cycle.resolved_module import ResolvedModule, resolve_study
from tvimdesign.simulation.working_cycle.trajectory import Cycle
from tvimdesign.study import given, read_study_text

METAL, WAX, GLASS = "pcl_grade: fields_metal", "pcl_grade: paraffin_rt60", "pcl_grade: pla"
COMB = "pcl_grade: conductive_pla, peltier_module: comb_electrodes, current: 0.6 A, target_temperature: 80 degC"
BLOCKS = "lead_hole_diameter: 1 mm, electrode_gap: 12 mm, corner_radius: 0.2 mm"
CELLS = 10


@cache
def model(mode: str, module: str) -> DeviceFunctions:
    study = read_study_text(f"mode: {mode}\nmodule: {{{module}}}\n", "a test")
    return DeviceFunctions(study.table, given(study), ("cold", "hot"), CELLS)


def circuit(built: DeviceFunctions) -> tuple[float, float]:
    """Resistance of layer and pads [ohm]."""
    numbers = {name: float(built.start[i]) for name, i in built.index.items()}
    found = built.table.evaluate({**built.words, **numbers}, ["layer_resistance", "pads"])
    return found["layer_resistance"], found["pads"].resistance


@cache
def cycle(mode: str, module: str) -> Cycle:
    built = model(mode, module)
    return Simulator(built).run(built.start)


@pytest.mark.parametrize("mode", ["shear", "compression"])
@pytest.mark.parametrize("module", [METAL, WAX, GLASS])
def test_what_has_no_kinetics_freezes_as_it_melts(mode: str, module: str) -> None:
    phases = model(mode, module).phases
    sizes = {name: phases[name].state_size for name in phases}
    assert len(set(sizes.values())) == 1
    times = cycle(mode, module).values
    assert times["stiffening_time"] == pytest.approx(times["equilibrium_stiffening_time"], rel=2e-5)


def test_a_polymer_still_freezes_late() -> None:
    phases = model("shear", "pcl_grade: pcl_80k").phases
    assert phases["stiffening"].state_size == phases["equilibrium_stiffening"].state_size + CELLS


@pytest.mark.parametrize(("mode", "module"), [("shear", COMB), ("shear", GLASS), ("compression", METAL)])
def test_symbols_are_the_same_as_floats(mode: str, module: str) -> None:
    built = model(mode, module)
    phase = built.phases["stiffening"]
    state = np.asarray(phase.initial(built.start)).ravel() + 0.1 * np.arange(phase.state_size) / phase.state_size
    given_numbers = {**built.words, **{name: float(built.start[i]) for name, i in built.index.items()}}
    known = {**given_numbers, "phase": STIFFENING, "state": state, "drive_current": -0.3}
    found = built.table.evaluate_instant(known, ["state_rates", "impedance_now", "electrical_power"])
    rates = np.asarray(phase.rates(state, -0.3, built.start)).ravel()
    assert rates == pytest.approx(found["state_rates"], rel=1e-9, abs=1e-12)
    assert float(phase.impedance_now(state, -0.3, built.start)) == pytest.approx(found["impedance_now"], rel=1e-9)


def test_a_layer_that_heats_itself_takes_its_power_and_is_hottest_inside() -> None:
    built, run = model("shear", COMB), cycle("shear", COMB)
    whole = sum(circuit(built))
    assert run.values["peak_power"] == pytest.approx(0.6**2 * whole, rel=1e-6)
    assert run.values["peak_voltage"] == pytest.approx(0.6 * whole, rel=1e-6)
    assert run.values["switch_energy"] == pytest.approx(0.6**2 * whole * run.values["response_time"], rel=1e-4)
    # The far face, behind plastic, waits for 80 degC; the middle of the layer is then warmer than both faces.
    assert run.values["peak_pcl_temperature"] > 353.15 + 0.1


@pytest.mark.slow
def test_blocks_heat_themselves_as_well() -> None:
    run = cycle("compression", f"{COMB}, {BLOCKS}")
    assert 0.0 < run.values["response_time"] < 3600.0


def test_a_layer_that_heats_itself_is_evenly_warm_sooner_than_one_on_pads() -> None:
    """With the same power the far face waits for no heat to come through a plastic."""
    inside = cycle("shear", COMB).values
    watts = inside["peak_power"]
    foil = "peltier_resistance: 20 ohm, peltier_module: polyimide_foil_24v"
    built = model("shear", f"pcl_grade: conductive_pla, {foil}, current: 1 A, target_temperature: 80 degC")
    start = built.start.copy()
    start[built.index["current"]] = np.sqrt(watts / circuit(built)[1])
    outside = Simulator(built).run(start).values
    assert outside["peak_power"] == pytest.approx(watts, rel=1e-6)
    assert inside["far_face_time"] < 0.95 * outside["far_face_time"]


def resolved(module: str) -> ResolvedModule:
    return resolve_study(read_study_text(f"mode: shear\nmodule: {{{module}}}\n", "a test"))


def test_a_wax_in_its_range_is_known_to_kelvins_not_to_history() -> None:
    # 53 to 62 degC, each one kelvin either way: at 57 degC 5/9 is frozen, 4/9 to 6/9.
    found = fractions_at(resolved(WAX), 57.0 + 273.15)
    assert found == pytest.approx((4.0 / 9.0, 5.0 / 9.0, 6.0 / 9.0), abs=0.01)


@pytest.mark.parametrize("rate", [0.001, 10.0])
def test_a_wax_that_cools_is_frozen_as_it_melted_at_any_rate(rate: float) -> None:
    frozen = frozen_on_cooling(resolved(WAX), rate)
    assert [frozen(273.15 + at) for at in (70.0, 57.0, 40.0)] == pytest.approx([0.0, 5.0 / 9.0, 1.0], abs=0.01)
