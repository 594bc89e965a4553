"""The lock: what a joint without springs holds and drags against integrals over its layer, and its how-to's study."""

import csv
import json
import re

import numpy as np
import pytest
from device_values import inputs_of, values_of
from hypothesis import given, settings
from hypothesis import strategies as st
from support import ROOT

from tvimdesign.base.errors import InputError
from tvimdesign.device import table_for
from tvimdesign.solve.result import answer
from tvimdesign.study import read_study_text

MM = 1e-3
LISTING = re.search(r'```yaml title="gripper_lock.yaml"\n(.*?)```', (ROOT / "docs/how-to/lock.md").read_text(), re.S)
SIZES = {
    "inner": st.floats(12.0, 20.0), "width": st.floats(6.0, 15.0), "count": st.integers(2, 3),
    "filled": st.floats(0.6, 0.9), "thickness": st.floats(0.4, 2.0),
}  # fmt: skip


def ring(power: int, inner: float, outer: float, angle: float) -> float:
    """Integral of r^power over the area of a sector of a ring, in closed form."""
    return angle * (outer ** (power + 2) - inner ** (power + 2)) / (power + 2)


@settings(max_examples=20, deadline=None)
@given(**SIZES, speed=st.floats(1e-3, 3.0), turn=st.floats(0.05, 1.0))
def test_a_molten_film_drags_and_a_frozen_ring_holds_as_integrals_say(
    inner, width, count, filled, thickness, speed, turn
):
    span, inner, outer = 2.0 * np.pi * filled / count, inner * MM, (inner + width) * MM
    sizes = {"pcl_inner_radius": inner, "pcl_outer_radius": outer, "arc_count": float(count), "arc_span": span}
    values = values_of(
        "layer_drag_torque drag_torque friction_torque melt_stress pcl_viscosity@hot "
        "layer_holding_torque bond_strength turned_overlap",
        "lock", **sizes, pcl_thickness=thickness * MM, turn_speed=speed, melt_memory=1.0, stroke=turn,
        pcl_bond_strength=1e6,
    )  # fmt: skip
    viscosity = values["pcl_viscosity@hot"]
    torque = viscosity * speed * ring(2, inner, outer, count * span) / (thickness * MM)
    assert values["layer_drag_torque"] == pytest.approx(torque, rel=1e-9)
    assert values["melt_stress"] == pytest.approx(viscosity * speed * outer / (thickness * MM), rel=1e-9)
    assert values["drag_torque"] == pytest.approx(torque + values["friction_torque"], rel=1e-12)
    left, strength = count * (span - turn), values["bond_strength"]
    # The rim reaches its strength first; were all of the ring at it, it would hold the integral of r dA.
    assert values["layer_holding_torque"] == pytest.approx(strength / outer * ring(2, inner, outer, left), rel=1e-9)
    whole = strength * ring(1, inner, outer, left)
    assert inner / outer * whole < values["layer_holding_torque"] < whole
    assert values["turned_overlap"] == pytest.approx(left / (count * span), rel=1e-12)


def test_a_lock_has_nothing_of_springs():
    table, sprung = table_for("lock"), table_for("shear")
    of_springs = {row.name for row in sprung.quantities if row.group == "Springs"}
    assert table.by_name.keys() & of_springs == {"spring_stiffness", "spring_stiffness_half_stroke"}  # of other outputs
    left = [row for row in table.outputs if row.sprung]
    assert {"spring_count", "spring_stiffness", "springs_mass", "pin_friction_torque"} <= {row.name for row in left}
    assert not any(row.rules or row.advice or row.ratings or row.headline or row.needs for row in left)
    values = table.evaluate(inputs_of("lock"), ["spring_stiffness", "springs_mass", "spring_count", "lost_motion"])
    assert [values[name] for name in ("spring_stiffness", "springs_mass", "spring_count")] == [0.0, 0.0, 0.0]
    # No output of anything else is gone.
    gone = sprung.by_name.keys() - table.by_name.keys()
    assert all(row.sprung for row in sprung.outputs if row.name in gone)
    with pytest.raises(InputError, match="wire_diameter is of shear mode, this study is lock mode"):
        read_study_text("mode: lock\nmodule: {wire_diameter: 1 mm}\n")


def test_the_lock_of_all_defaults_keeps_every_rule():
    table, module = table_for("lock"), inputs_of("lock")
    for row in table.outputs:
        if row.rules and row.exists(module) and row.name not in table.behind_supplied:
            value = table.evaluate(module, [row.name])[row.name]
            for rule in row.rules:
                assert value <= rule.value if rule.sense == "<=" else value >= rule.value - 1e-15, row.name


@pytest.mark.gate
def test_the_page_s_lock_is_optimal_as_the_page_says():
    assert LISTING is not None
    optimum = answer(read_study_text(LISTING[1]))
    assert optimum.solution is not None
    values = optimum.design.values
    assert values["holding_torque"] >= 1.0
    assert values["drag_torque"] <= 0.2
    page = (ROOT / "docs/how-to/lock.md").read_text()
    written = re.search(
        r"It is (\S+) mm wide and (\S+) mm high, weighs (\S+) g, holds (\S+) N·m and drags (\S+) N·m", page
    )
    assert written is not None
    shown = [
        f"{1e3 * values['envelope_diameter']:.0f}", f"{1e3 * values['envelope_height']:.0f}",
        f"{1e3 * values['module_mass']:.0f}", f"{values['holding_torque']:.2f}", f"{values['drag_torque']:.2f}",
    ]  # fmt: skip
    assert list(written.groups()) == shown
    assert f"lets go after {values['response_time']:.0f} s and holds after {values['return_time']:.0f} s" in page


@pytest.mark.slow
def test_the_page_s_metal_lock_takes_as_long_as_the_page_says():
    assert LISTING is not None
    text = LISTING[1].replace("module:\n", "module:\n  pcl_grade: fields_metal\n").replace("80 degC", "70 degC")
    values = answer(read_study_text(text)).design.values
    times = f"takes {values['response_time']:.0f} s and {values['return_time']:.0f} s"
    assert times in (ROOT / "docs/how-to/lock.md").read_text()


@pytest.mark.slow
def test_the_page_s_lock_becomes_parts_without_springs(tvimdesign, tmp_path):
    assert LISTING is not None
    (tmp_path / "gripper_lock.yaml").write_text(LISTING[1])
    done = tvimdesign("run", tmp_path / "gripper_lock.yaml", "--no-plots", "--out", tmp_path / "out")
    assert done.returncode == 0, done.stderr
    assert "drags" in done.stdout
    cad = tmp_path / "out/cad"
    assert all(check["ok"] for check in json.loads((cad / "checks.json").read_text())["checks"])
    parts = {row["part"] for row in csv.DictReader((cad / "bom.csv").read_text("utf-8-sig").splitlines())}
    assert {"housing", "rotor", "link", "retainer", "pcl_arc", "heater", "mount_screw"} <= parts
    assert not {part for part in parts if part.startswith(("spring", "adjuster", "tang", "setting"))}
    assert not (cad / "springs").exists()
    note = (cad / "assembly.md").read_text()
    assert "turn by hand from stop to stop" in note
    assert "every leg" not in note
