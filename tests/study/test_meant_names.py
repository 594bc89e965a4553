"""Names that people write instead of the table's, and several limits in one text."""

from __future__ import annotations

import pytest

from tvimdesign.study import read_study_text
from tvimdesign.study.text.mistakes import Mistake, StudyError


def mistake(section: str, name: str, value: str) -> Mistake:
    """Return the mistake of a study that has a line."""
    with pytest.raises(StudyError) as caught:
        read_study_text(f'mode: shear\n{section}: {{{name}: "{value}"}}\n', "test")
    (problem,) = caught.value.problems
    return problem


@pytest.mark.parametrize(
    ("name", "meant"),
    [
        ("outer_diameter", "envelope_diameter"), ("height", "envelope_height"), ("mass", "module_mass"),
        ("weight", "module_mass"), ("stiffness@hot", "joint_stiffness@hot"), ("stiffness", "joint_stiffness@hot"),
        ("stifness@cold", "joint_stiffness@cold"), ("torque", "holding_torque"), ("time", "response_time"),
        ("mass@hot", "module_mass"), ("diamter", "envelope_diameter"), ("module_mas", "module_mass"),
    ],
)  # fmt: skip
def test_a_limit_gets_the_quantity_that_is_meant(name: str, meant: str) -> None:
    assert mistake("require", name, "<= 1 mm").hint == f"did you mean {meant!r}?"
    # What is meant most often stands first among the names.
    assert mistake("require", "xyz", "<= 1 mm").expected.startswith("one of module_mass, envelope_diameter, ")


@pytest.mark.parametrize(
    ("name", "hint"),
    [
        ("outer_diameter", "limit 'envelope_diameter' under `require`"), ("wire", "did you mean 'wire_diameter'?"),
        ("layer_thickness", "did you mean 'pcl_thickness'?"),
    ],
)  # fmt: skip
def test_an_input_gets_the_input_or_the_limit_that_is_meant(name: str, hint: str) -> None:
    assert mistake("module", name, "1 mm").hint == hint


@pytest.mark.parametrize("text", [">= 1 Nm/rad, <= 1.5 Nm/rad", ">= 1 Nm/rad and <= 1.5 Nm/rad", "1 to 1.5 Nm/rad"])
def test_two_limits_in_one_text_become_a_list(text: str) -> None:
    problem = mistake("require", "spring_stiffness", text)
    assert (problem.message, problem.expected) == ("2 limits in one text", 'a list: [">= 1 Nm/rad", "<= 1.5 Nm/rad"]')
