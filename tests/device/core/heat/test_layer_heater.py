"""A module whose layer heats itself between combs: its resistance, its supply, and what cannot stand together."""

import numpy as np
import pytest
from stiff_when_warm import STIFF_WHEN_WARM
from support import cases_of

from tvimdesign.base.errors import InputError
from tvimdesign.base.units import ZERO_CELSIUS
from tvimdesign.catalog import Catalog
from tvimdesign.device import table_for
from tvimdesign.device.core.heater_form import HeaterFuse, heater_fuse
from tvimdesign.device.table.quantity import SOFTENING
from tvimdesign.physics.heat_flow import heat, shape_factors
from tvimdesign.physics.layers import layer
from tvimdesign.study import given, read_study_text
from tvimdesign.study.study import Study

COMB = "pcl_grade: conductive_pla, heater_module: comb_electrodes"
WANTED = ["pcl_area", "pcl_depth", "layer_resistance", "electrode_gap_margin"]


def study(mode: str, module: str) -> Study:
    return read_study_text(f"mode: {mode}\nmodule: {{{module}}}\n", "a test")


@pytest.mark.parametrize(("mode", "count"), [("shear", 4.0), ("compression", 12.0)])
def test_resistance_of_layers_in_series(mode, count):
    values = given(study(mode, f"{COMB}, electrode_gap: 12 mm"))
    resistances = table_for(mode).evaluate(values, [*WANTED, "heater_count"])
    assert resistances["heater_count"] == count
    comb = shape_factors.comb_resistance(0.15, resistances["pcl_depth"], resistances["pcl_area"] / count, 12e-3, 1e-3)
    assert resistances["layer_resistance"] == pytest.approx(count * comb, rel=1e-12)
    halves = table_for(mode).evaluate({**values, "heater_strings": 2.0}, WANTED)
    assert halves["layer_resistance"] == pytest.approx(resistances["layer_resistance"] / 4.0, rel=1e-12)
    assert resistances["electrode_gap_margin"] == pytest.approx(12e-3 - resistances["pcl_depth"])


def test_what_cannot_heat_or_be_held_is_named():
    cold_start = table_for("shear").evaluate(given(study("shear", "")), WANTED)
    assert (cold_start["layer_resistance"], cold_start["electrode_gap_margin"]) == (0.0, 0.0)
    module = "heat_source: layer, heater_module: qc_17, pcl_resistivity: 0.1 ohm.m, electrode_gap: 2 mm, "
    values = given(study("shear", f"{module} electrode_width: 1 mm"))
    with pytest.raises(InputError, match="heat_source: layer needs a heater that lies on the layer; qc_17 is rigid"):
        table_for("shear").evaluate(values, ["layer_resistance"])
    with pytest.raises(InputError, match="no type stays closed at the heater's 230 degC, the highest at 225 degC"):
        chosen(230.0, 1.0, heater=250.0)
    with pytest.raises(InputError, match=r"no type bears the heater's 20 A, the strongest 16 A"):
        chosen(80.0, 20.0, heater=120.0)


@cases_of("layer_heater", "not_together")
def test_what_cannot_stand_together_is_named(module, message):
    own = "pcl_resistivity: 0.1 ohm.m, " if module.startswith("heat_source") else ""
    with pytest.raises(InputError, match=message):
        given(study("shear", own + module))


RECORD = Catalog().record("thermal_fuses", "ultimheat_5ma3")


def chosen(hottest: float, current: float, **bears: float) -> HeaterFuse:
    """For a heater in degC and A, with what each thing bears in degC."""
    ratings = {what: celsius + ZERO_CELSIUS for what, celsius in bears.items()}
    return heater_fuse(RECORD, hottest + ZERO_CELSIUS, current, ratings)


@cases_of("layer_heater", "cut_outs")
def test_the_cut_out_opens_before_the_least_rating(hottest, current, bears, designation, opens, holds, above):
    fuse = chosen(hottest, current, **bears)
    assert fuse.designation == designation
    assert (fuse.opens_at - ZERO_CELSIUS, fuse.holds - ZERO_CELSIUS) == pytest.approx((opens, holds))
    assert fuse.opens_at - fuse.opens_from == pytest.approx(10.0)
    assert fuse.opens_from >= hottest + ZERO_CELSIUS + 5.0
    assert fuse.above == tuple(above)


@cases_of("layer_heater", "other_makers")
def test_other_makers_have_types_for_polycarbonate_and_aluminium(name, hottest, structure, designation, above):
    record = Catalog().record("thermal_fuses", name)
    fuse = heater_fuse(record, hottest + ZERO_CELSIUS, 2.5, {"structure": structure + ZERO_CELSIUS})
    assert (fuse.designation, fuse.above) == (designation, tuple(above))
    with pytest.raises(InputError, match=r"no type bears the heater's 10\.1 A, the strongest 10 A"):
        heater_fuse(record, 330.0, 10.1, {"structure": 400.0})


TABLE = table_for("shear")


def test_dashpots_and_molten_slices_take_up_the_work_of_a_period():
    # T = b dphi/dt over a period of phi = A sin(2 pi f t): b A^2 2 pi^2 f^2, integrated here; a rigid support.
    damping, amplitude, frequency = 1.85, 0.104, 1.0
    turns = np.linspace(0.0, 1.0, 20001)
    speed = 2.0 * np.pi * frequency * amplitude * np.cos(2.0 * np.pi * turns)
    work = np.trapezoid(damping * speed**2, turns / frequency)
    alone = (0.0, layer.loss_stiffness(damping, frequency))
    assert layer.dissipation(alone, alone, amplitude, frequency) == pytest.approx(frequency * work, rel=1e-6)
    # A spring in series with a dashpot of the same stiffness at this frequency: half of the motion's square is left.
    stiffness, amplitude = 10.0, 0.1
    behind = layer.series_stiffness(0.0, stiffness, stiffness)
    heat_alone = layer.dissipation((0.0, stiffness), (0.0, stiffness), amplitude, 2.0)
    assert layer.dissipation((0.0, stiffness), behind, amplitude, 2.0) == pytest.approx(0.5 * heat_alone, rel=1e-12)
    shares = layer.loss_shares(np.array([1e4, 1e8]), np.array([2e4, 4e6]))
    assert np.sum(shares) == pytest.approx(1.0)
    assert shares[1] < 1e-4


def test_the_paper_s_module_heats_by_a_watt_at_one_hertz(inputs):
    # An independent reading of the published module, whose melt had 2.8 kPa s then, found 1.1 W.
    frequencies = {"frequency@hot": 1.0, "frequency@cold": 1.0, "pcl_zero_shear_viscosity": 2.8e3}
    given = {**inputs, **STIFF_WHEN_WARM, "temperature@hot": 373.15, "temperature@cold": 303.15, **frequencies}
    hot, cold = TABLE.evaluate(given, ["viscous_heating@hot", "viscous_heating@cold"]).values()
    assert hot == pytest.approx(1.1, rel=0.1)
    assert cold < 0.01 * hot  # the torque that turns the hot joint by its stroke hardly turns the frozen one


def test_motion_heats_the_layer_and_nothing_else(inputs):
    given = {**inputs, **STIFF_WHEN_WARM, "temperature@hot": 373.15, "frequency@hot": 2.0}
    stack = TABLE.evaluate(given, ["stack"])["stack"]
    instant = {**given, "phase": SOFTENING, "state": heat.initial_state(stack, 5, 373.15), "drive_current": 0.0}
    still, moving = (
        TABLE.evaluate({**instant, "motion": motion}, ["state_rates"])["state_rates"]
        for motion in ("at_rest", "moving")
    )
    gained = moving - still
    cell = stack.density * stack.area * stack.thickness / 5.0
    watts = TABLE.evaluate(given, ["viscous_heating@hot"])["viscous_heating@hot"]
    assert heat.ENTHALPY_SCALE * cell * np.sum(gained[2:7]) == pytest.approx(watts, rel=1e-3)
    assert np.all(np.delete(gained, slice(2, 7)) == 0.0)
