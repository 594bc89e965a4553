"""The spring maker's sheet: bend, mandrels, nothing beyond the frame; and the page that it is drawn on as PDF."""

import re
import zlib
from contextlib import suppress

import pytest
from cad_designs import design_of
from ezdxf.tools.text_size import text_size

from tvimdesign.cad.drawing.drawing_sheet import SIZE, DrawingSheet
from tvimdesign.cad.drawing.spring_sheet import spring_lines, spring_sheet
from tvimdesign.cad.geometry.dimensions import dimensions

FRAME = 10.0  # mm from the paper's edge


@pytest.mark.parametrize("ratio", [1.5, 2.5])
def test_the_spring_sheet_tells_the_bend_and_both_mandrels(ratio: float) -> None:
    design = design_of("bent", {"tang_bend_ratio": ratio})
    dims = dimensions(design)
    lines = {line.name: line for line in spring_lines(design, dims, {})}
    assert float(lines["inside radius of the bend"].value) == pytest.approx(ratio * 2.413, abs=0.005)
    # The wound coil springs back to D, 24.41 mm: 2211/2.413^0.145 MPa over 196.5 GPa, an index of 10.1.
    assert float(lines["winding mandrel"].value) == pytest.approx(24.41 / (1 + 1.698 * 0.1002) - 2.41, abs=0.06)
    assert float(lines["measuring mandrel, at most"].value) == pytest.approx(2.0 * dims.post_radius, abs=0.005)


def test_no_words_of_the_spring_sheet_leave_its_frame() -> None:
    design = design_of("paper", {})
    dims = dimensions(design)
    lines = {line.name: line for line in spring_lines(design, dims, {})}
    sheet = spring_sheet(design, dims, list(lines.values()))
    shown = [text.dxf.text for text in sheet.space.query("TEXT")]
    drawn = [f"{line.get_measurement():.2f}" for line in sheet.space.query("DIMENSION")]
    # A length is the same in the table and in the drawing; torque follows from what is kept, the free angle.
    for name in ("leg, tangential", "tang, parallel to the axis", "mean coil diameter D", "body length, free"):
        assert f"{float(lines[name].value):.2f}" in drawn, name
    torques = [line for name, line in lines.items() if name.startswith("torque")]
    assert [line.tolerance for line in torques] == ["reference", "reference"]
    assert all(f"({line.value}) N.mm" in shown for line in torques)
    assert lines["free angle"].tolerance == "± 18.7"
    for text in sheet.space.query("TEXT"):
        end = sheet.scale * (text.dxf.insert.x + text_size(text).width)
        assert end <= SIZE[0] - FRAME, text.dxf.text


MM = 72.0 / 25.4


def content(sheet: DrawingSheet) -> list[str]:
    """Return the lines of the page's content."""
    data = sheet.pdf()
    streams = [data[found.end() :] for found in re.finditer(rb"stream\n", data)]
    for stream in streams:
        with suppress(zlib.error):
            if "/DeviceRGB CS" in (text := zlib.decompressobj().decompress(stream).decode()):
                return text.splitlines()
    raise AssertionError("no content")


@pytest.mark.parametrize("scale", [0.5, 2.0])
def test_lines_are_as_wide_as_their_layer_says_at_any_scale(scale: float) -> None:
    sheet = DrawingSheet(scale)
    for layer in ("OUTLINE", "FINE", "CENTRE"):
        sheet.lines([(20.0, 30.0), (50.0, 30.0)], layer)
    lines = content(sheet)
    pens = [float(width) / MM for width in re.findall(r"([\d.]+) w", "\n".join(lines))]
    assert pens[-3:] == pytest.approx([0.5, 0.25, 0.18], abs=1e-3)
    assert lines.count(f"{round(20.0 * MM, 6)} {round(30.0 * MM, 6)} m") == 3


def test_a_circle_is_curves_and_letters_are_filled() -> None:
    sheet = DrawingSheet(1.0)
    sheet.space.add_circle((100.0, 100.0), 10.0, dxfattribs={"layer": "OUTLINE"})
    sheet.text("O8", (200.0, 100.0))
    lines = content(sheet)
    stroked = lines.index("S")
    curves = [line for line in lines[:stroked] if line.endswith(" c")]
    assert len(curves) >= 4
    ends = [[float(number) / MM for number in line.split()[4:6]] for line in curves]
    assert all((x - 100.0) ** 2 + (y - 100.0) ** 2 == pytest.approx(100.0, rel=1e-3) for x, y in ends)
    assert any(line.endswith(" c") for line in lines[stroked:])
    assert "f" in lines[stroked:]
