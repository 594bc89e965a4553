"""The wiring diagram has each heater in its string, what feeds them, and is a picture that programs read."""

from __future__ import annotations

from xml.etree import ElementTree

import pytest
from cad_designs import TILES, design_of

from tvimdesign.cad.assembly.bill_of_materials import beside
from tvimdesign.cad.assembly.wiring import strings, wiring_svg


@pytest.mark.parametrize(
    ("wiring", "expected"),
    [
        ("series", [[1, 2, 3, 4, 5, 6]]),
        ("arcs_parallel", [[1, 2], [3, 4], [5, 6]]),
        ("all_parallel", [[1], [2], [3], [4], [5], [6]]),
    ],
)
def test_heaters_are_in_strings_as_they_are_wired(wiring: str, expected: list[list[int]]) -> None:
    assert strings(design_of("wired", TILES | {"heater_wiring": wiring})) == expected


def test_the_diagram_names_what_is_bought() -> None:
    design = design_of("wired", TILES)
    design.values.update(peak_voltage=9.0, peak_current=2.6)
    picture = ElementTree.fromstring(wiring_svg(design, beside(design, {})))
    words = [text.text for text in picture.iter("{http://www.w3.org/2000/svg}text")]
    assert {"LRS-50-12", "2992 (G2 24v13)", "thermal cut-out", "heater 6", "3 thermistors"} <= set(words)
