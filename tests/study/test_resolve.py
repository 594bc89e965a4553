"""From a study to what a table is evaluated with."""

from collections.abc import Callable
from typing import Any

import pytest

from tvimdesign.base.errors import InputError
from tvimdesign.study import Study, given

Read = Callable[..., Study]
BASE = "mode: shear\nmodule: {pcl_thickness: 1 mm, %s}\n"
VARY = "minimize: module_mass\nvary: {%s}\n"


def _given(read: Read, module: str = "", more: str = "") -> dict[str, Any]:
    return given(read(BASE % module + more))


def test_every_input_and_choice_has_a_value(read: Read) -> None:
    study = read(BASE % "wire_diameter: 2 mm" + "operating_points: {warm: {temperature: 60 degC}}")
    result = given(study)
    points = {f"{row.name}@{point}" for row in study.table.inputs if row.per_point for point in ("cold", "hot", "warm")}
    fixed = {row.name for row in study.table.inputs if not row.per_point}
    assert set(result) == points | fixed | {row.name for row in study.table.choices}
    assert result["wire_diameter"] == pytest.approx(2e-3)
    assert result["coil_diameter"] == 24e-3
    assert result["temperature@warm"] == pytest.approx(333.15)
    assert (result["rate_model"], result["peltier"].name) == ("bending", "flexible_1600")


def test_the_study_before_the_record_before_the_default(read: Read) -> None:
    assert _given(read)["youngs_modulus"] == 203.4e9
    assert _given(read, "spring_material: stainless_302")["youngs_modulus"] == 193e9
    assert _given(read, "youngs_modulus: 200 GPa")["youngs_modulus"] == pytest.approx(200e9)


def test_what_has_no_value_is_named(read: Read) -> None:
    with pytest.raises(InputError, match="pcl_thickness has no value; give it under `module`, in mm"):
        given(read("mode: shear"))
    with pytest.raises(InputError, match=r"youngs_modulus has no value \(mystery_steel has no value"):
        _given(read, "spring_material: mystery_steel")


@pytest.mark.parametrize(
    ("module", "vary", "name", "value"),
    [
        ("", "wire_diameter: [1 mm, 2 mm]", "wire_diameter", 2e-3),
        ("", "wire_diameter: [3 mm, 4 mm]", "wire_diameter", 3e-3),
        ("", "wire_diameter: [2 mm, 3 mm]", "wire_diameter", 2.413e-3),
        ("wire_diameter: 1.5 mm", "wire_diameter: [1 mm, 2 mm]", "wire_diameter", 1.5e-3),
        ("wire_diameter: 1.5 mm", "wire_diameter: {from: 1 mm, to: 2 mm, start: 1.1 mm}", "wire_diameter", 1.1e-3),
        ("", "wire_diameter: {catalog: metric, to: 2.2 mm}", "wire_diameter", 2e-3),
        ("wire_diameter: 1.1 mm", "wire_diameter: {catalog: metric}", "wire_diameter", 1e-3),
        ("", "arc_count: {choose: [3, 6]}", "arc_count", 3.0),
        ("", "rate_model: {choose: [smi]}", "rate_model", "smi"),
        ("", "rate_model: {choose: [smi, bending]}", "rate_model", "bending"),
        ("rate_model: smi", "rate_model: {choose: [bending, smi]}", "rate_model", "smi"),
    ],
)
def test_what_varies_starts_within(read: Read, *, module: str, vary: str, name: str, value: float | str) -> None:
    result = _given(read, module, VARY % vary)[name]
    assert result == (value if isinstance(value, str) else pytest.approx(value))


def test_a_varied_input_without_any_value_starts_in_the_middle(read: Read) -> None:
    study = read("mode: shear\n" + VARY % "pcl_thickness: [1 mm, 2 mm]")
    assert given(study)["pcl_thickness"] == pytest.approx(1.5e-3)


def test_a_varied_record_takes_its_fields_along(read: Read) -> None:
    result = _given(read, "", VARY % "spring_material: {choose: [stainless_302]}")
    assert result["youngs_modulus"] == 193e9


def test_the_table_accepts_it(read: Read) -> None:
    study = read(BASE % "")
    result = study.table.evaluate(given(study), ["joint_stiffness@hot", "envelope_diameter"])
    assert result["envelope_diameter"] == pytest.approx(0.138)
