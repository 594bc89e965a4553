"""Designs that are read again: of this version, and of another."""

import copy
import json
import random
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
import yaml
from cad_designs import shipped_design
from support import STUDIES

from tvimdesign.base.errors import InputError, TvimError
from tvimdesign.simulation.working_cycle.resolved_module import resolve_design
from tvimdesign.study import StudyError, read_study, read_tree
from tvimdesign.study.design import JsonPlaces, design_json, read_design, write_design
from tvimdesign.study.sections.all_sections import written
from tvimdesign.study.tree import tree_of_values


def _plain() -> Any:
    return json.loads(design_json(shipped_design("paper_shear")))


def test_a_design_that_lacks_an_input_is_of_another_version(tmp_path: Path) -> None:
    other = write_design(shipped_design("paper_shear"), tmp_path / "design.json")
    assert read_design(other).mode == "shear"
    plain = _plain()
    del plain["values"]["wire_diameter"]
    other.write_text(json.dumps(plain))
    with pytest.raises(InputError, match=r"has no wire_diameter: another version wrote it; write it anew"):
        read_design(other)


def _set(*path: str | int, to: Any) -> Callable[[Any], None]:
    def change(plain: Any) -> None:
        for step in path[:-1]:
            plain = plain[step]
        plain[path[-1]] = to

    return change


EDITS: dict[str, tuple[Callable[[Any], None], str]] = {
    "a word for a number": (_set("study", "module", "stroke", to=None), r"study\.module\.stroke: Input should be a"),
    "an end of a range": (
        _set("study", "vary", "current", "upper", to="x"), r"study\.vary\.current\.upper: Input should"
    ),
    "an input that is text": (_set("study", "module", "stroke", to="0.1 rad"), r"stroke: is the text .0\.1 rad"),
    "an input of its study": (_set("study", "module", "strok", to=0.1), "did you mean 'stroke'"),
    "a value of its study": (_set("study", "module", "stroke", to=9.0), r"study\.module\.stroke: .* above the upper"),
    "a limit on nothing": (_set("study", "require", 0, "output", to="stiffnes"), "no such name: 'stiffnes'"),
    "a mode": (_set("mode", to="sheer"), "did you mean 'shear'"),
    "another mode": (_set("study", "mode", to="compression"), "the design's mode is shear"),
    "a choice": (_set("choices", "cold_side", to="opened"), "did you mean 'open'"),
    "a choice that is none": (_set("choices", "wire_diameter", to="x"), "no such choice: 'wire_diameter'"),
    "a number that is text": (_set("values", "module_mass", to="66 g"), r"values\.module_mass: Input should be"),
    "a number out of range": (_set("values", "wire_diameter", to=1.0), r"values\.wire_diameter: 1000 mm is outside"),
    "a profile of no phase": (_set("current_profiles", to={"rest": {}}), "no such phase: 'rest'"),
    "a profile that is none": (_set("current_profiles", to={"softening": {"moments": [0]}}), "is no profile"),
    "a field": (_set("colour", to="red"), "colour: unknown name"),
}  # fmt: skip


@pytest.mark.parametrize("name", EDITS)
def test_an_edited_design_is_refused_in_words_with_the_line(name: str, tmp_path: Path) -> None:
    change, expected = EDITS[name]
    plain = _plain()
    change(plain)
    edited = tmp_path / "design.json"
    edited.write_text(json.dumps(plain, indent=2))
    with pytest.raises(StudyError, match=expected) as reported:
        read_design(edited)
    assert all(problem.line > 0 for problem in reported.value.problems)


def test_a_folder_of_records_whose_name_is_too_long_is_not_there(tmp_path: Path) -> None:
    plain = _plain()
    plain["study"]["catalog_folder"] = "9" * 5000
    edited = tmp_path / "design.json"
    edited.write_text(json.dumps(plain))
    with pytest.raises(TvimError, match="the catalogue folder is not there"):
        resolve_design(read_design(edited))


def test_all_mistakes_of_a_design_and_its_version_are_reported(tmp_path: Path) -> None:
    plain = _plain()
    plain |= {"tvimdesign": "2019.1"}
    plain["values"]["wire_diameter"] = 1.0
    plain["choices"]["cold_side"] = "opened"
    edited = tmp_path / "design.json"
    edited.write_text(json.dumps(plain))
    with pytest.raises(StudyError) as reported:
        read_design(edited)
    assert {problem.path for problem in reported.value.problems} == {
        "tvimdesign",
        "values.wire_diameter",
        "choices.cold_side",
    }
    assert "another version wrote it: '2019.1'" in str(reported.value)


ODD: list[Any] = [
    None, True, 0, -1, 1e308, "x", "", [], {}, [1], {"a": 1}, "nan", "shear", "../../etc", "[/bold]", "\ud800",
]  # fmt: skip


def _paths(node: Any, path: tuple[Any, ...] = ()) -> Iterator[tuple[Any, ...]]:
    yield path
    for key, value in node.items() if isinstance(node, dict) else enumerate(node) if isinstance(node, list) else ():
        yield from _paths(value, (*path, key))


def test_no_edit_of_a_design_ends_in_a_traceback(tmp_path: Path) -> None:
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
def test_a_study_written_from_what_was_read_is_read_the_same(path: Path) -> None:
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
def test_places_are_those_of_yaml(indent: int | None) -> None:
    plain: dict[str, Any] = json.loads(design_json(shipped_design("paper_compression")))
    plain["name"] = 'a "quote", a \\, {[ and é'
    text = json.dumps(plain, indent=indent, ensure_ascii=False)
    places = JsonPlaces(text.encode())
    loader: Any = getattr(yaml, "CSafeLoader", yaml.SafeLoader)
    every = [item for item in marks(yaml.compose(text, Loader=loader)) if "@" not in item[0]]
    for path, line, column in random.Random(1).sample(every, 30):
        assert (places.at(path).line, places.at(path).column) == (line, column)


def test_a_step_that_is_not_there_is_where_the_last_one_is() -> None:
    places = JsonPlaces(b'{"a": [1,\n {"b": 2}], "c": 3}')
    assert [(places.at(path).line, places.at(path).column) for path in ("a.1.b.x", "a.7", "c.d", "", "z")] == [
        (2, 3), (1, 2), (2, 13), (1, 1), (1, 1),
    ]  # fmt: skip


@pytest.mark.parametrize("data", [b"", b"{", b"\xff\xfe\x00", b"[" * 5000])
def test_of_a_broken_file_no_line_is_known(data: bytes) -> None:
    assert JsonPlaces(data).at("a").line == 0
