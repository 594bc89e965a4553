"""The wiring diagram has each heater in its string, what feeds them, and is a picture that programs read."""

from __future__ import annotations

from itertools import combinations, pairwise
from xml.etree import ElementTree

import pytest
from cad_designs import TILES, design_of

from tvimdesign.cad.assembly.bill_of_materials import Item, beside
from tvimdesign.cad.assembly.heater_leads import NOT_TO_BE_ORDERED
from tvimdesign.cad.assembly.wiring import strings, wiring_svg

SVG = "{http://www.w3.org/2000/svg}"


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


def drawn(changes: dict[str, object]) -> ElementTree.Element:
    """Return the diagram of a module that was switched."""
    design = design_of("wired", changes)
    design.values.update(peak_voltage=9.0, peak_current=2.6)
    return ElementTree.fromstring(wiring_svg(design, beside(design, {})))


def words(picture: ElementTree.Element) -> set[str]:
    """Return the texts of a diagram."""
    return {text.text or "" for text in picture.iter(f"{SVG}text")}


def test_the_diagram_names_what_is_bought() -> None:
    bought = {"IRM-90-12ST (MEAN WELL)", "2992 (G2 24v13)", "thermal cut-out", "heater 6", "3 thermistors"}
    bought |= {"3 resistors", "10 kohm, 1 %", "step-down converter", "Seeed XIAO ESP32C6"}
    assert bought <= words(drawn(TILES))
    design = design_of("wired", TILES)
    misfit = Item("thermal_cutout", 1, False, "", f"Does not fit. {NOT_TO_BE_ORDERED}: 5MA3", 0.6, ())
    assert "to be chosen" in words(ElementTree.fromstring(wiring_svg(design, [misfit])))


def test_only_peltiers_come_with_a_note_on_cooling() -> None:
    assert "cools" in " ".join(words(drawn(TILES)))
    assert "cools" not in " ".join(words(drawn({"peltier_module": "polyimide_foil_24v"})))


@pytest.mark.parametrize("wiring", ["series", "arcs_parallel", "all_parallel"])
def test_no_lines_cross_and_none_runs_through_a_box(wiring: str) -> None:
    picture = drawn(TILES | {"heater_wiring": wiring})
    pieces = []
    for line in picture.iter(f"{SVG}polyline"):
        points = [tuple(map(float, point.split(","))) for point in line.attrib["points"].split()]
        pieces += [spanned(*ends) for ends in pairwise(points)]
    assert not [pair for pair in combinations(pieces, 2) if overlap(*pair)]
    for box in picture.iter(f"{SVG}rect"):
        if "x" in box.attrib:
            x, y, wide, high = (float(box.attrib[name]) for name in ("x", "y", "width", "height"))
            assert not [piece for piece in pieces if overlap(piece, spanned((x, y), (x + wide, y + high)))]


Span = tuple[tuple[float, float], tuple[float, float]]


def spanned(start: tuple[float, ...], stop: tuple[float, ...]) -> Span:
    """Return from where to where two corners reach, across and down."""
    across, down = (sorted(both) for both in zip(start, stop, strict=True))
    return (across[0], across[1]), (down[0], down[1])


def overlap(first: Span, second: Span) -> bool:
    """Return whether two have a place in common; that one only touches the other with its end is none."""
    return all(max(a[0], b[0]) < min(a[1], b[1]) or (a[0] == a[1] and b[0] < a[0] < b[1])
               or (b[0] == b[1] and a[0] < b[0] < a[1]) for a, b in zip(first, second, strict=True))  # fmt: skip
