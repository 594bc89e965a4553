"""The refusal of a module that is no geometry: the values that clash, and what cures it."""

from __future__ import annotations

import re

import pytest

from tvimdesign.base.errors import InputError
from tvimdesign.base.units import parse_quantity
from tvimdesign.solve.nlp.constraints import refuse_impossible
from tvimdesign.study import Study, read_study_text

NARROW = "vary: {pcl_outer_radius: [12 mm, 20 mm]}\nminimize: module_mass\n"


def study_of(text: str) -> Study:
    """Return a study in shear mode."""
    return read_study_text(f"mode: shear\n{text}", "test")


def refusal(study: Study) -> str:
    """Return the message that refuses a study."""
    with pytest.raises(InputError) as caught:
        refuse_impossible(study)
    return str(caught.value)


def test_the_values_that_clash_are_named_with_the_defaults() -> None:
    assert "It follows from pcl_outer_radius 20 mm, pcl_inner_radius 26 mm (default)." in refusal(study_of(NARROW))


@pytest.mark.parametrize("text", [NARROW, "module: {placement_radius: 20 mm}\n"])
def test_each_cure_that_is_advised_cures(text: str) -> None:
    study = study_of(text)
    cures = re.findall(r"(\w+) (\S+ mm)[,.]", refusal(study).partition("One of these is enough: ")[2])
    assert cures
    for name, value in cures:
        module = {**study.module, name: parse_quantity(value, "mm")}
        refuse_impossible(study.model_copy(update={"module": module}))
