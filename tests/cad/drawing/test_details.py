"""Details of sections: what is under a millimetre and dimensioned is drawn again, to a scale at which it is read."""

import io
from math import pi, sqrt

import cadquery as cq
import ezdxf
import pytest
from ezdxf.document import Drawing

from tvimdesign.cad.drawing.details import area_within, lines_within, small_steps
from tvimdesign.cad.drawing.drawing_requirements import DrawingRequirements
from tvimdesign.cad.drawing.drawings import part_sheet
from tvimdesign.cad.drawing.projection import Arc, Chain, View, section
from tvimdesign.cad.export.step_file import Product
from tvimdesign.cad.geometry.features import levels

WHAT = Product(name="rotor", colour=(0.5, 0.5, 0.5), material="petg", density=1270.0)
ASKED = DrawingRequirements(tolerances="ISO 2768-1 m", surface="as printed", printed=True)


def stepped(step: float) -> cq.Solid:
    """Return a disc of 60 mm with a raised rim, and a hole."""
    rim = cq.Solid.makeCylinder(30.0, 5.0 + step).cut(cq.Solid.makeCylinder(28.0, 5.0 + step))
    disc = cq.Solid.makeCylinder(30.0, 5.0).cut(cq.Solid.makeCylinder(4.0, 5.0))
    return disc.fuse(rim).clean().Solids()[0]


def drawn(step: float) -> Drawing:
    sheet = part_sheet("rotor", stepped(step), WHAT, "a module", ASKED)
    return ezdxf.read(io.StringIO(sheet.dxf().decode()))


@pytest.mark.parametrize(("step", "title"), [(0.4, "X (20:1)"), (0.74, "X (10:1)"), (0.05, "X (50:1)")])
def test_a_step_under_a_millimetre_is_drawn_to_scale_with_its_height(step: float, title: str) -> None:
    document = drawn(step)
    said = [entity.dxf.text for entity in document.modelspace().query("TEXT")]
    assert said.count("X") == 1
    assert title in said
    texts = [one.dxf.text for one in document.modelspace().query("DIMENSION")]
    assert f"{step:g}" in texts
    scale = float(title.split("(")[1].split(":", maxsplit=1)[0])
    shown = [one for one in document.modelspace().query("DIMENSION") if one.dxf.text == f"{step:g}"]
    paper = {round(one.get_measurement() * _sheet_scale(said), 2) for one in shown}
    assert round(scale * step, 2) in paper, "the enlarged step is as long on paper as its scale says"


def _sheet_scale(said: list[str]) -> float:
    over, under = said[said.index("Scale") + 1].split(":")
    return float(over) / float(under)


def test_small_steps_are_cut_out_at_a_circle() -> None:
    said = {entity.dxf.text for entity in drawn(1.5).modelspace().query("TEXT")}
    assert "X" not in said
    solid = stepped(0.4)
    view = section(solid)
    (step,) = small_steps([view], levels(solid), 1.0)
    assert (step.low, step.high) == (pytest.approx((30.0, 5.0)), pytest.approx((30.0, 5.4))) or step.low[0] == 28.0
    assert small_steps([view], [0.0, 5.0], 1.0) == []
    assert small_steps([view], levels(solid), 20.0) == []  # 8 mm on paper
    view = View(arcs=(Arc((0.0, 0.0), 0.5, 0.0, 360.0),), chains=(Chain(((-5.0, 1.0), (5.0, 1.0))),))
    parts = lines_within(view, (0.0, 0.0), 2.0)
    long = max(parts, key=lambda part: abs(part[1][0] - part[0][0]))
    assert long == (pytest.approx((-sqrt(3.0), 1.0)), pytest.approx((sqrt(3.0), 1.0)))
    assert len(parts) == 1 + 72  # the small circle in chords of 5 degrees
    square = [(-9.0, -9.0), (9.0, -9.0), (9.0, 9.0), (-9.0, 9.0)]
    corners = area_within(square, (0.0, 0.0), 2.0)
    twice = sum(x * high - far * y for (x, y), (far, high) in zip(corners, [*corners[1:], corners[0]], strict=True))
    assert 0.5 * twice == pytest.approx(4.0 * pi, rel=2e-3)
    assert area_within(square, (30.0, 0.0), 2.0) == []
