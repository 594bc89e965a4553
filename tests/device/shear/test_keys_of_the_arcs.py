"""Keys of the PCL arcs: what they hold, what they take of the plate, and when there is no room for them."""

import numpy as np
import pytest
from device_values import inputs_of, values_of

from tvimdesign.catalog import Catalog
from tvimdesign.device import table_for

MM = 1e-3
TABLE = table_for("shear")
RULES = ("key_margin", "key_depth_margin", "key_width_margin", "key_pitch_margin")


def test_keys_hold_by_their_section_with_a_safety() -> None:
    values = values_of("key_holding_torque key_depth", key_count=3, key_diameter=2.5 * MM)
    yielding = Catalog().record("polymers", "pcl_80k").value("tensile_yield")
    # Twelve of 2.5 mm on a radius of 33 mm.
    expected = 12 * yielding / np.sqrt(3.0) * 0.25 * np.pi * 2.5e-3**2 * 33e-3
    assert values["key_holding_torque"] == pytest.approx(expected, rel=1e-9)
    assert values["key_depth"] == pytest.approx(2.8 * MM)
    shallow = values_of("key_holding_torque", rotor_thickness=2.0 * MM, key_diameter=2.5 * MM)
    # 0.8 mm deep they press into their pockets before they shear off.
    assert shallow["key_holding_torque"] == pytest.approx(12 * yielding * 2.5e-3 * 0.8e-3 * 33e-3, rel=1e-9)
    rows = ["key_safety", "layer_torque@cold", "bond_traction@cold", "hold_torque", "layer_polar_moment",
            "key_holding_torque"]  # fmt: skip
    values = TABLE.evaluate(inputs_of(), rows)
    assert values["key_safety"] == pytest.approx(values["key_holding_torque"] / values["layer_torque@cold"])
    assert 0.9 * values["hold_torque"] < values["layer_torque@cold"] < values["hold_torque"]  # the springs are soft
    at_rim = values["layer_torque@cold"] * 40e-3 / values["layer_polar_moment"]
    assert values["bond_traction@cold"] == pytest.approx(at_rim)


def test_no_keys_weigh_hold_and_forbid_nothing() -> None:
    rows = "pcl_volume pcl_area key_depth key_holding_torque rotor_volume rotor_inertia " + " ".join(RULES)
    # Arcs no key would fit in, and a plate as thin as can be printed.
    none = values_of(rows, key_count=0, key_diameter=8 * MM, rotor_thickness=1.2 * MM)
    assert none["pcl_volume"] == pytest.approx(none["pcl_area"] * 1e-3, rel=1e-12)
    assert none["key_depth"] == none["key_holding_torque"] == 0.0
    assert min(none[name] for name in RULES) > 0.0
    full = values_of(rows, key_count=0)
    keyed = values_of(rows)
    one = np.pi * 1.25e-3**2
    assert full["rotor_volume"] - keyed["rotor_volume"] == pytest.approx(12 * one * 2.8e-3, rel=1e-9)
    about_axis = 12 * one * 2.8e-3 * 1270.0 * (33e-3**2 + 0.5 * 1.25e-3**2)
    assert full["rotor_inertia"] - keyed["rotor_inertia"] == pytest.approx(about_axis, rel=1e-9)


def test_each_margin_of_the_keys_is_what_its_drawing_gives() -> None:
    # In mm: three keys of 2.5 on 33 in each arc from 26 to 40, walls of 1.2 and pins of 2.0 as printed.
    span = 0.854548
    drawn = {
        "key_margin": 2.5 - 2.0, "key_depth_margin": 4.0 - 1.2 - 0.625, "key_width_margin": 14.0 - 2.5 - 1.2,
        "key_pitch_margin": abs(33.0 - 33.0 * np.exp(1j * span / 3.0)) - 2.5 - 1.2,
    }  # fmt: skip
    found = values_of(" ".join(RULES), arc_span=span)
    assert {name: value / MM for name, value in found.items()} == pytest.approx(drawn)
    # One key in an arc has half of it to either end.
    alone = values_of("key_pitch_margin", arc_span=span, key_count=1)["key_pitch_margin"]
    assert alone / MM == pytest.approx(abs(33.0 - 33.0 * np.exp(1j * span)) - 2.5 - 1.2)
