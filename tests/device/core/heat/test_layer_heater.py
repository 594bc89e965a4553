"""A module whose layer heats itself between combs: its resistance, its supply, and what cannot stand together."""

import pytest

from tvimdesign.base.errors import InputError
from tvimdesign.device import table_for
from tvimdesign.physics.heat_flow import shape_factors
from tvimdesign.study import given, read_study_text
from tvimdesign.study.study import Study

COMB = "pcl_grade: conductive_pla, peltier_module: comb_electrodes"
WANTED = ["pcl_area", "pcl_depth", "layer_resistance", "electrode_gap_margin"]


def study(mode: str, module: str) -> Study:
    return read_study_text(f"mode: {mode}\nmodule: {{{module}}}\n", "a test")


@pytest.mark.parametrize(("mode", "count"), [("shear", 4.0), ("compression", 12.0)])
def test_layers_in_series_have_the_square_of_their_number_times_the_whole_layer_s(mode: str, count: float) -> None:
    values = given(study(mode, f"{COMB}, electrode_gap: 12 mm"))
    found = table_for(mode).evaluate(values, [*WANTED, "heater_count"])
    assert found["heater_count"] == count
    one = shape_factors.comb_resistance(0.15, found["pcl_depth"], found["pcl_area"] / count, 12e-3, 1e-3)
    assert found["layer_resistance"] == pytest.approx(count * one, rel=1e-12)
    halves = table_for(mode).evaluate({**values, "heater_strings": 2.0}, WANTED)
    assert halves["layer_resistance"] == pytest.approx(found["layer_resistance"] / 4.0, rel=1e-12)
    assert found["electrode_gap_margin"] == pytest.approx(12e-3 - found["pcl_depth"])


def test_pads_that_heat_have_no_layer_in_their_circuit() -> None:
    found = table_for("shear").evaluate(given(study("shear", "")), WANTED)
    assert (found["layer_resistance"], found["electrode_gap_margin"]) == (0.0, 0.0)


@pytest.mark.parametrize(
    ("module", "said"),
    [
        ("peltier_module: comb_electrodes", "pcl_resistivity has no value, needed as heat_source is layer .*pcl_80k"),
        ("heat_source: layer", "electrode_gap has no value, needed as heat_source is layer .*flexible_1600"),
        (
            f"{COMB}, cooling_current: 1 A",
            "cooling_current of 1 A and peltier_module comb_electrodes",
        ),
    ],
)
def test_what_cannot_stand_together_is_named(module: str, said: str) -> None:
    own = "pcl_resistivity: 0.1 ohm.m, " if module.startswith("heat_source") else ""
    with pytest.raises(InputError, match=said):
        given(study("shear", own + module))


def test_rigid_modules_cannot_feed_the_layer() -> None:
    module = "heat_source: layer, peltier_module: qc_17, pcl_resistivity: 0.1 ohm.m, electrode_gap: 2 mm, "
    values = given(study("shear", f"{module} electrode_width: 1 mm"))
    with pytest.raises(InputError, match="heat_source: layer needs a heater that lies on the layer; qc_17 is rigid"):
        table_for("shear").evaluate(values, ["layer_resistance"])
