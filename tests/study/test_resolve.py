"""From a study, its catalogue and its table to what a table is evaluated with."""

import copy
import pickle
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from tvimdesign.base.errors import CatalogError, InputError
from tvimdesign.device import table_for
from tvimdesign.study import Study, given, read_study_text

Read = Callable[..., Study]
BASE = "mode: shear\nmodule: {pcl_thickness: 1 mm, %s}\n"
VARY = "minimize: module_mass\nvary: {%s}\n"


def _given(read: Read, module: str = "", more: str = "") -> dict[str, Any]:
    return given(read(BASE % module + more))


def test_every_input_has_a_value_that_the_table_accepts(read: Read) -> None:
    study = read(BASE % "wire_diameter: 2 mm" + "operating_points: {warm: {temperature: 60 degC}}")
    result = given(study)
    points = {f"{row.name}@{point}" for row in study.table.inputs if row.per_point for point in ("cold", "hot", "warm")}
    fixed = {row.name for row in study.table.inputs if not row.per_point}
    assert set(result) == points | fixed | {row.name for row in study.table.choices}
    assert result["wire_diameter"] == pytest.approx(2e-3)
    assert result["coil_diameter"] == 24e-3
    assert result["temperature@warm"] == pytest.approx(333.15)
    assert (result["rate_model"], result["peltier"].name) == ("bending", "flexible_1600")
    study = read(BASE % "")
    result = study.table.evaluate(given(study), ["joint_stiffness@hot", "envelope_diameter"])
    assert result["envelope_diameter"] == pytest.approx(0.138)


def test_values_are_the_study_s_the_record_s_or_the_default(read: Read) -> None:
    assert _given(read)["youngs_modulus"] == 203.4e9
    assert _given(read, "spring_material: stainless_302")["youngs_modulus"] == 193e9
    assert _given(read, "youngs_modulus: 200 GPa")["youngs_modulus"] == pytest.approx(200e9)
    with pytest.raises(InputError, match="pcl_thickness has no value; give it under `module`, in mm"):
        given(read("mode: shear"))
    with pytest.raises(InputError, match=r"youngs_modulus has no value \(mystery_steel has no value"):
        _given(read, "spring_material: mystery_steel")
    study = read("mode: shear\n" + VARY % "pcl_thickness: [1 mm, 2 mm]")
    assert given(study)["pcl_thickness"] == pytest.approx(1.5e-3)
    result = _given(read, "", VARY % "spring_material: {choose: [stainless_302]}")
    assert result["youngs_modulus"] == 193e9


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


ROOT = Path(__file__).parents[2]


@pytest.fixture
def study() -> Study:
    return read_study_text("mode: shear\nmodule: {pcl_thickness: 1 mm}\n", "a test")


@pytest.fixture
def mine(tmp_path: Path) -> str:
    shipped = ROOT / "tvimdesign/catalog/data/structure_materials/petg.yaml"
    (tmp_path / "structure_materials").mkdir()
    (tmp_path / "structure_materials/mine.yaml").write_text(shipped.read_text(encoding="utf-8"), encoding="utf-8")
    return str(tmp_path)


def test_copies_have_their_own_mode_and_records(study: Study, mine: str) -> None:
    assert study.catalog is study.catalog
    assert study.table is table_for("shear")
    stored = study.model_copy(update={"module": {}})
    assert stored.catalog is study.catalog
    assert stored.table is study.table
    _ = study.table, study.catalog
    other = study.model_copy(update={"mode": "compression"})
    assert other.table is table_for("compression")
    assert other.catalog is study.catalog
    assert "block_depth" in given(other)
    with pytest.raises(CatalogError, match="no record 'mine'"):
        study.catalog.record("structure_materials", "mine")
    other = study.model_copy(update={"catalog_folder": mine, "module": {"structure_material": "mine"}})
    assert given(other)["structure_material"].name == "mine"
    assert "mine" not in other.model_copy(update={"catalog_folder": None}).catalog.names("structure_materials")


def test_what_it_has_opened_is_no_part_of_it(study: Study, mine: str) -> None:
    fresh = Study.model_validate(study.model_dump())
    assert not {"catalog", "table"} & fresh.__dict__.keys()
    _ = fresh.catalog.record("structure_materials", "petg"), fresh.table
    assert fresh == Study.model_validate(study.model_dump())
    assert fresh.model_dump_json() == study.model_dump_json()
    stored = study.model_copy(update={"catalog_folder": mine})
    result = pickle.loads(pickle.dumps(stored))
    assert not {"catalog", "table"} & result.__dict__.keys()
    assert result == stored
    assert "mine" in result.catalog.names("structure_materials")
    assert copy.deepcopy(stored) == stored
