"""Settings of the command line and values from Python meet the reader of study files, and its errors say so."""

from pathlib import Path
from typing import Any

import numpy as np
import pint
import pytest
from support import STUDIES, cases_of, refused, sample_text

from tvimdesign.study import Range, Study, StudyError, read_study_text, read_tree
from tvimdesign.study.text.mistakes import Mistakes
from tvimdesign.study.tree import node_of, tree_of_text, tree_of_values, tree_yaml, with_settings

TEXT = sample_text("set_on_the_command_line")


def read(*settings: str) -> Study:
    return read_tree(with_settings(tree_of_text(TEXT, "x.yaml", "x", Path()), settings))


def problems(*settings: str) -> list[str]:
    with pytest.raises(StudyError) as caught:
        read(*settings)
    return str(caught.value).splitlines()


def test_a_name_fixes_what_is_varied_and_the_last_of_two_counts():
    study = read("pcl_thickness=1.2 mm")
    assert study.module["pcl_thickness"] == pytest.approx(1.2e-3)
    assert list(study.vary) == ["coil_diameter"]
    assert study.task == "optimize"
    study = read("pcl_thickness=1.2 mm", "coil_diameter=24 mm")
    assert (study.task, study.vary, study.minimize) == ("evaluate", {}, {})
    assert read("current=1 A", "current=2 A").module["current"] == 2.0


def test_a_path_sets_what_stands_there_and_leaves_the_rest():
    study = read(
        "module.pcl_thickness=1.2 mm", "require.module_mass=<= 90 g", "operating_points.hot.temperature=90 degC"
    )
    thickness = study.vary["pcl_thickness"]
    assert isinstance(thickness, Range)
    assert thickness.start == pytest.approx(1.2e-3)
    assert {limit.output for limit in study.require} == {"holding_torque", "module_mass"}
    assert study.operating_points["hot"] == {"temperature": pytest.approx(363.15), "frequency": 1.0}


@pytest.mark.parametrize(
    ("setting", "find", "wanted"),
    [
        ("require.holding_torque=>= 15 N.m", lambda s: s.require[0].limit, 15.0),
        ("require.holding_torque=", lambda s: s.require, ()),
        ("vary.coil_diameter=[10 mm, 20 mm]", lambda s: s.vary["coil_diameter"].upper, pytest.approx(0.02)),
        ("solver.starts=1", lambda s: s.solver.starts, 1),
        ("minimize=response_time", lambda s: s.minimize, {"response_time": 1.0}),
        ("motor=none", lambda s: s.module["motor"], "none"),
        ("name=A = B", lambda s: s.name, "A = B"),
    ],
)
def test_what_may_be_set(setting, find, wanted):
    assert find(read(setting)) == wanted


@pytest.mark.parametrize(("setting", "message"), refused("settings"))
def test_a_wrong_setting_is_named_as_the_place(setting, message):
    (line,) = problems(setting)
    assert line.startswith("--set " + setting.partition("\x07")[0])
    assert message in line


def test_mistakes_of_all_settings_and_of_the_file_are_reported_at_once():
    tree = tree_of_text(TEXT.replace("1.5 A", "1.5 V"), "x.yaml", "x", Path())
    with pytest.raises(StudyError) as caught:
        read_tree(with_settings(tree, ["coil_diameter=1 s", "nothing", "solver.starts=many"]))
    assert [problem.file for problem in caught.value.problems] == [
        "--set coil_diameter=1 s", "--set nothing", "--set solver.starts=many", "x.yaml",
    ]  # fmt: skip
    assert caught.value.problems[-1].line == 2


ureg: Any = pint.UnitRegistry()


@pytest.mark.parametrize(
    "value",
    [
        "1.2 mm", (1.2, "mm"), (np.float64(1.2), "mm"), (0.12, "cm"),
        *(ureg.Quantity(size, unit) for size, unit in ((1.2, "mm"), (1.2e-3, "m"), (1200, "um"))),
    ],
    ids=str,
)  # fmt: skip
def test_a_number_with_its_unit_may_be_given_in_many_ways(value):
    tree = tree_of_values({"mode": "shear", "module": {"pcl_thickness": value}}, "Study(...)", Path())
    assert read_tree(tree).module["pcl_thickness"] == pytest.approx(1.2e-3, rel=1e-12)


@cases_of("tree", "units_of_pint")
def test_pints_own_words_for_units_are_read(value, unit):
    from tvimdesign.base.units import parse_quantity

    number = float(value.split(maxsplit=1)[0])
    node = node_of(ureg.Quantity(number, unit), "here", Mistakes("here"))
    wanted = value.split()[1]
    assert parse_quantity(getattr(node, "value", ""), wanted) == pytest.approx(parse_quantity(value, wanted), rel=1e-12)


@pytest.mark.parametrize(
    "pair",
    [
        ["0.6 mm", "2 mm"],
        (0.6, 2, "mm"),
        [(0.6, "mm"), (2, "mm")],
        np.array(["0.6 mm", "2 mm"]),
        (np.array([0.6, 2.0]), "mm"),
        ([0.6, 2.0], "mm"),
        np.linspace(ureg.Quantity(600, "um"), ureg.Quantity(2, "mm"), 2),
    ],
    ids=str,
)
def test_a_range_may_be_given_in_many_ways(pair):
    sections = {"mode": "shear", "vary": {"pcl_thickness": pair}, "minimize": "module_mass"}
    result = read_tree(tree_of_values(sections, "Study(...)", Path())).vary["pcl_thickness"]
    assert isinstance(result, Range)
    assert (result.lower, result.upper) == (pytest.approx(6e-4), pytest.approx(2e-3))


def endless() -> list[Any]:
    items: list[Any] = []
    items.append(items)
    return items


@pytest.mark.parametrize(
    ("value", "message"),
    [
        (1.2, "say the unit"), (float("nan"), "does not start with a number"), (object(), "a value of the type object"),
        ("1 mm\x00", "control character"), (endless(), "nested deeper"), (True, "'true'"), (b"1 mm", "type bytes"),
    ],
)  # fmt: skip
def test_what_cannot_stand_in_a_study_is_refused(value, message):
    with pytest.raises(StudyError) as caught:
        read_tree(tree_of_values({"mode": "shear", "module": {"pcl_thickness": value}}, "Study(...)", Path()))
    assert message in str(caught.value)
    assert {problem.file for problem in caught.value.problems} == {"Study(...)"}


def test_a_changed_study_is_written_as_text_that_reads_as_the_same_study():
    settings = ["pcl_thickness=1.2 mm", 'require.impedance_range=[">= 50", "<= 90"]', "description=it's: one #2, [x]"]
    tree = with_settings(tree_of_text(TEXT, "x.yaml", "x", Path()), settings)
    text = tree_yaml(tree)
    assert "# --set pcl_thickness=1.2 mm" in text.splitlines()
    assert read_study_text(text, "x") == read_tree(tree)
    tree = tree_of_text(f"description: 'null'\n{TEXT}", "x.yaml", "x", Path())
    assert read_study_text(tree_yaml(tree), "x").description == "null"


@pytest.mark.parametrize("path", STUDIES, ids=lambda path: path.stem)
def test_every_shipped_study_survives_being_written(path):
    tree = tree_of_text(path.read_text(), path.name, path.stem, path.parent)
    assert read_study_text(tree_yaml(tree), path.stem, path.parent) == read_tree(tree)
