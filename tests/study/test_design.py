"""Designs and resolved studies."""

import copy
import json
import pickle
import random
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
import yaml
from cad_designs import shipped_design
from support import STUDIES, cases_of

from tvimdesign.base.errors import CatalogError, InputError, TvimError
from tvimdesign.device import table_for
from tvimdesign.simulation.working_cycle.device_functions import resolve_design
from tvimdesign.study import Study, StudyError, given, read_study, read_study_text, read_tree
from tvimdesign.study.design import design_json, json_root, read_design, write_design
from tvimdesign.study.sections import written
from tvimdesign.study.text.yaml_text import place_of
from tvimdesign.study.tree import tree_of_values


def _plain() -> Any:
    return json.loads(design_json(shipped_design("paper_shear")))


def test_a_design_that_lacks_an_input_is_of_another_version(tmp_path):
    other = write_design(shipped_design("paper_shear"), tmp_path / "design.json")
    assert read_design(other).mode == "shear"
    plain = _plain()
    del plain["values"]["wire_diameter"]
    other.write_text(json.dumps(plain))
    with pytest.raises(InputError, match=r"has no wire_diameter: another version wrote it; write it anew"):
        read_design(other)


@cases_of("design", "edits")
def test_an_edited_design_is_refused_in_words_with_the_line(path, to, message, tmp_path):
    plain = place = _plain()
    for step in path[:-1]:
        place = place[step]
    place[path[-1]] = to
    edited = tmp_path / "design.json"
    edited.write_text(json.dumps(plain, indent=2))
    with pytest.raises(StudyError, match=message) as reported:
        read_design(edited)
    assert all(problem.line > 0 for problem in reported.value.problems)


def test_a_folder_of_records_whose_name_is_too_long_is_not_there(tmp_path):
    plain = _plain()
    plain["study"]["catalog_folder"] = "9" * 5000
    edited = tmp_path / "design.json"
    edited.write_text(json.dumps(plain))
    with pytest.raises(TvimError, match="the catalogue folder is not there"):
        resolve_design(read_design(edited))


def test_all_mistakes_of_a_design_and_its_version_are_reported(tmp_path):
    plain = _plain()
    plain |= {"tvimdesign": "2019.1"}
    plain["values"]["wire_diameter"] = 1.0
    plain["choices"]["cold_side"] = "opened"
    edited = tmp_path / "design.json"
    edited.write_text(json.dumps(plain))
    with pytest.raises(StudyError) as reported:
        read_design(edited)
    paths = {problem.path for problem in reported.value.problems}
    assert paths == {"tvimdesign", "values.wire_diameter", "choices.cold_side"}
    assert "another version wrote it: '2019.1'" in str(reported.value)


ODD: list[Any] = [
    None, True, 0, -1, 1e308, "x", "", [], {}, [1], {"a": 1}, "nan", "shear", "../../etc", "[/bold]", "\ud800",
]  # fmt: skip


def _paths(node: Any, path: tuple[Any, ...] = ()) -> Iterator[tuple[Any, ...]]:
    yield path
    for key, value in node.items() if isinstance(node, dict) else enumerate(node) if isinstance(node, list) else ():
        yield from _paths(value, (*path, key))


@pytest.mark.gate
def test_no_edit_of_a_design_ends_in_a_traceback(tmp_path):
    plain = _plain()
    places = [path for path in _paths(plain) if path and path[0] not in ("values", "solution")]
    draw, edited, refused = random.Random(20), tmp_path / "design.json", 0
    for _ in range(150):
        changed, path = copy.deepcopy(plain), draw.choice(places)
        place = changed
        for step in path[:-1]:
            place = place[step]
        if draw.random() < 0.3:
            del place[path[-1]]
        else:
            place[path[-1]] = draw.choice(ODD)
        edited.write_text(json.dumps(changed))
        try:
            resolve_design(read_design(edited))
        except TvimError:
            refused += 1
    assert refused > 75


@pytest.mark.parametrize("path", STUDIES, ids=lambda path: path.stem)
def test_a_study_written_from_what_was_read_is_read_the_same(path):
    study = read_study(path)
    assert read_tree(tree_of_values(written(study), "written", Path())) == study


# --- places in its file ---


def marks(node: yaml.Node, path: str = "") -> Iterator[tuple[str, int, int]]:
    """Yield every path of a document with the place of its key, or of the item."""
    if isinstance(node, yaml.MappingNode):
        for key, value in node.value:
            yield f"{path}{key.value}", key.start_mark.line + 1, key.start_mark.column + 1
            yield from marks(value, f"{path}{key.value}.")
    elif isinstance(node, yaml.SequenceNode):
        for number, item in enumerate(node.value):
            yield f"{path}{number}", item.start_mark.line + 1, item.start_mark.column + 1
            yield from marks(item, f"{path}{number}.")


@pytest.mark.parametrize("indent", [None, 2])
def test_places_are_those_of_yaml(indent):
    plain: dict[str, Any] = json.loads(design_json(shipped_design("paper_compression")))
    plain["name"] = 'a "quote", a \\, {[ and é'
    text = json.dumps(plain, indent=indent, ensure_ascii=False)
    root = json_root(text.encode())
    loader: Any = getattr(yaml, "CSafeLoader", yaml.SafeLoader)
    every = [item for item in marks(yaml.compose(text, Loader=loader)) if "@" not in item[0]]
    for path, line, column in random.Random(1).sample(every, 30):
        assert (place_of(root, path).line, place_of(root, path).column) == (line, column)


def test_a_step_that_is_not_there_is_where_the_last_one_is():
    root = json_root(b'{"a": [1,\n {"b": 2}], "c": 3}')
    places = [place_of(root, path) for path in ("a.1.b.x", "a.7", "c.d", "", "z")]
    assert [(place.line, place.column) for place in places] == [(2, 3), (1, 2), (2, 13), (1, 1), (1, 1)]


@pytest.mark.parametrize("data", [b"", b"{", b"\xff\xfe\x00", b"[" * 5000])
def test_of_a_broken_file_no_line_is_known(data):
    assert place_of(json_root(data), "a").line == 0


Read = Callable[..., Study]
BASE = "mode: shear\nmodule: {pcl_thickness: 1 mm, %s}\n"
VARY = "minimize: module_mass\nvary: {%s}\n"


def _given(read: Read, module: str = "", more: str = "") -> dict[str, Any]:
    return given(read(BASE % module + more))


def test_every_input_has_a_value_that_the_table_accepts(read):
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


def test_values_are_the_study_s_the_record_s_or_the_default(read):
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


@cases_of("design", "starts")
def test_what_varies_starts_within(read, *, module, vary, name, value):
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


def test_copies_have_their_own_mode_and_records(study, mine):
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


def test_what_it_has_opened_is_no_part_of_it(study, mine):
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
