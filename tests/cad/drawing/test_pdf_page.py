"""A sheet as PDF: a sound file, with lines, curves and letters where and as wide as the drawing has them."""

from __future__ import annotations

import re
import zlib

import pytest

from tvimdesign.cad.drawing.drawing_sheet import DrawingSheet

MM = 72.0 / 25.4


def content(data: bytes) -> list[str]:
    """The lines of the page's content."""
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
