"""Bend and mandrels on the spring maker's sheet; nothing on it leaves the frame."""

from __future__ import annotations

import pytest
from cad_designs import design_of
from ezdxf.tools.text_size import text_size

from tvimdesign.cad.drawing.drawing_sheet import SIZE
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
