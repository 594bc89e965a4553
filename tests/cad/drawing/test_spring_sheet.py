"""The spring maker's sheet: bend, mandrels, nothing beyond the frame; and the page that it is drawn on as PDF."""

import re
import zlib

import pytest
from cad_designs import design_of
from ezdxf.addons.drawing.properties import BackendProperties
from ezdxf.npshapes import NumpyPath2d
from ezdxf.path import Path
from ezdxf.tools.text_size import text_size

from tvimdesign.cad.drawing.drawing_sheet import SIZE, DrawingSheet
from tvimdesign.cad.drawing.pdf_page import PdfPage
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
    sheet = spring_sheet(design, dims, spring_lines(design, dims, {}))
    for text in sheet.space.query("TEXT"):
        end = sheet.scale * (text.dxf.insert.x + text_size(text).width)
        assert end <= SIZE[0] - FRAME, text.dxf.text


MM = 72.0 / 25.4
PEN = BackendProperties()


def content(data: bytes) -> list[str]:
    """Return the lines of the page's content."""
    found = re.search(rb"/Length (\d+) /Filter /FlateDecode >>\nstream\n", data)
    assert found
    return zlib.decompress(data[found.end() : found.end() + int(found[1])]).decode().splitlines()


def test_every_object_lies_where_the_table_says() -> None:
    data = DrawingSheet(1.0).pdf()
    table = int(data.split(b"startxref\n")[1].split()[0])
    rows = data[table:].splitlines()
    assert rows[0] == b"xref"
    count = int(rows[1].split()[1])
    for number, row in enumerate(rows[3 : 2 + count], start=1):
        assert data[int(row.split()[0]) :].startswith(b"%d 0 obj\n" % number)
    assert data.endswith(b"%%EOF\n")


@pytest.mark.parametrize("scale", [0.5, 2.0])
def test_lines_are_as_wide_as_their_layer_says_at_any_scale(scale: float) -> None:
    sheet = DrawingSheet(scale)
    for layer in ("OUTLINE", "FINE", "CENTRE"):
        sheet.lines([(20.0, 30.0), (50.0, 30.0)], layer)
    lines = content(sheet.pdf())
    factor = float(lines[0].split()[0])
    assert factor == pytest.approx(scale * MM)
    pens = [float(line.split()[0]) * factor / MM for line in lines if line.endswith("RG")]
    assert pens == pytest.approx([0.5, 0.25, 0.18], abs=1e-3)
    x, y = (float(number) * factor / MM for number in lines[lines.index("S") + 1 :][0].split()[:2])
    assert (x, y) == pytest.approx((20.0, 30.0), abs=1e-3)


def test_a_circle_is_curves_and_letters_are_filled() -> None:
    sheet = DrawingSheet(1.0)
    sheet.space.add_circle((100.0, 100.0), 10.0, dxfattribs={"layer": "OUTLINE"})
    sheet.text("O8", (200.0, 100.0))
    lines = content(sheet.pdf())
    curves = [line for line in lines if line.endswith(" c")]
    assert len(curves) > 8
    ends = [tuple(map(float, line.split()[4:6])) for line in curves[:4]]
    assert all((x - 100.0) ** 2 + (y - 100.0) ** 2 == pytest.approx(100.0, rel=1e-3) for x, y in ends)
    assert lines.count("f") == 1
    assert lines[-1] == "f"


def test_each_step_of_a_path_is_written_with_its_own_corners() -> None:
    path = Path((0.0, 0.0))
    path.line_to((9.0, 0.0))
    path.curve3_to((9.0, 9.0), (12.0, 3.0))  # the end first, then the corner it bends towards
    path.move_to((-3.0, 0.0))
    path.curve4_to((0.0, 6.0), (-2.0, 2.0), (-1.0, 4.0))
    page = PdfPage((420.0, 297.0), 1.0)
    page.draw_path(NumpyPath2d(path), PEN)
    page.draw_filled_paths([NumpyPath2d(path)], PEN)
    steps = [
        "0.0000 0.0000 m", "9.0000 0.0000 l", "11.0000 2.0000 11.0000 5.0000 9.0000 9.0000 c",
        "-3.0000 0.0000 m", "-2.0000 2.0000 -1.0000 4.0000 0.0000 6.0000 c",
    ]  # fmt: skip
    lines = content(page.bytes())
    assert lines[2:8] == [*steps, "S"]
    assert lines[9:] == [*steps, "f"]
