"""The study that `tvimdesign new` writes is one that the reader takes."""

import re

from tvimdesign.study import given, read_study_text, template_text
from tvimdesign.study.sections.all_sections import NAMES


def test_the_template_is_a_study() -> None:
    study = read_study_text(template_text(), "template.yaml")
    assert study.task == "optimize"
    assert given(study)["spring_material"].name == study.module["spring_material"]


def test_its_commented_lines_are_good_too() -> None:
    text = template_text()
    for name in re.findall(r"^  # (\w+): ", text, re.MULTILINE):
        text = re.sub(rf"^  {name}: .*\n", "", text, flags=re.MULTILINE)
    study = read_study_text(re.sub(r"^  # (\w+: )", r"  \1", text, flags=re.MULTILINE), "template.yaml")
    assert {"wire_diameter", "pcl_grade"} <= set(study.vary)


def test_it_shows_every_section_but_the_users_catalogue() -> None:
    shown = re.findall(r"^(\w+):", template_text(), re.MULTILINE)
    assert [name for name in NAMES if name not in shown] == ["catalog"]
