"""The script of a module draws its solids with CadQuery alone, and follows the numbers at its top."""

from __future__ import annotations

import re
from typing import Any

import pytest
from cad_designs import CASES, design_of

from tvimdesign.cad.assembly.assembly import MODULES, drawn_parts
from tvimdesign.cad.assembly.module_script import module_script
from tvimdesign.cad.geometry.dimensions import Dimensions, dimensions

EXACT = 1e-9


def script_of(name: str) -> tuple[Dimensions, str]:
    mode, changes = CASES[name]
    design = design_of(name, changes, mode)
    return dimensions(design), module_script(design, dimensions(design)).decode()


def drawn_by(script: str) -> dict[str, Any]:
    assert "tvimdesign" not in script.partition('"""\n')[2]
    names: dict[str, Any] = {"__name__": "script"}
    exec(compile(script, "module.py", "exec"), names)
    return names


@pytest.mark.parametrize(
    "name",
    [
        "paper",
        pytest.param("tiles", marks=pytest.mark.gate),
        pytest.param("driven", marks=pytest.mark.gate),
        pytest.param("odd blocks", marks=pytest.mark.gate),
        pytest.param("tiles in vanes", marks=pytest.mark.gate),
    ],
)
def test_its_solids_and_their_places_are_those_of_the_module(name: str) -> None:
    dims, script = script_of(name)
    names, solids = drawn_by(script), drawn_parts(dims)
    assert names["PARTS"].keys() == solids.keys()
    for kind, draw in names["PARTS"].items():
        assert draw().Volume() == pytest.approx(solids[kind].Volume(), rel=EXACT), kind
    stand = MODULES[dims.mode].stand(dims, solids)
    assert names["PLACES"].keys() == stand.keys()
    for part, (kind, location) in names["PLACES"].items():
        off = stand[part].Center() - solids[kind].moved(location).Center()
        assert off.Length < 1e-6, part


def test_a_part_follows_a_number_that_is_changed() -> None:
    dims, script = script_of("paper")
    thicker = re.sub(r"^link_thickness = .*$", f"link_thickness = {2.0 * dims.link_thickness}", script, flags=re.M)
    before, after = (drawn_by(text)["PARTS"]["link"]().Volume() for text in (script, thicker))
    assert after == pytest.approx(2.0 * before, rel=EXACT)
