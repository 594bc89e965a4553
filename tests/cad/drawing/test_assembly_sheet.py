"""The general-assembly drawing: every line of the bill that is drawn has a balloon on its part, free of the others."""

import io
from itertools import combinations
from math import cos, dist, sin
from typing import Any, NamedTuple

import cadquery as cq
import ezdxf
import ezdxf.bbox
import numpy as np
import pytest
from cad_designs import CASES, design_of, shipped_design
from ezdxf.document import Drawing
from manifold3d import CrossSection
from matplotlib.path import Path
from sheet_texts import no_text_lies_on_another, texts

from tvimdesign.cad.assembly.assembly import drawn_parts, installed_coils, place
from tvimdesign.cad.assembly.assembly_data import instances
from tvimdesign.cad.assembly.bill_of_materials import Item, as_ordered, bill
from tvimdesign.cad.drawing.assembly_sections import AssemblySection, assembly_sections, outlines, pointed_at
from tvimdesign.cad.drawing.assembly_sheet import assembly_sheet, balloon_leaders
from tvimdesign.cad.drawing.drawing_sheet import MARGIN, DrawingSheet
from tvimdesign.cad.export.mesh import Instance, solid_mesh
from tvimdesign.cad.geometry.dimensions import dimensions
from tvimdesign.cad.geometry.kinds import kind_of
from tvimdesign.study.design import Design

RADIUS = 2.7  # Of a balloon on paper [mm]
STUDIES = ("elbow_printed", "elbow_machined", "ankle", "finger", "wrist_joint", "fast_switch")
"""Those whose search starts where every part can be built."""
QUICK = {"paper", "blocks"}
ALL = [pytest.param(name, marks=[] if name in QUICK else pytest.mark.slow) for name in (*CASES, *STUDIES)]


class Drawn(NamedTuple):
    design: Design
    items: list[Item]
    placed: dict[str, cq.Solid]
    sections: list[AssemblySection]
    sheet: DrawingSheet
    document: Drawing


@pytest.fixture(scope="module", params=ALL)
def drawn(request: pytest.FixtureRequest) -> Drawn:
    name = request.param
    design = shipped_design(name) if name in STUDIES else design_of(name, CASES[name][1], CASES[name][0])
    dims = dimensions(design)
    solids = drawn_parts(dims)
    placed = place(dims, solids)
    items = as_ordered(bill(design, {}, placed))
    meshed = instances(dims, solids, placed)
    sheet = assembly_sheet(design.name, items, placed, meshed, installed_coils(dims))
    document = ezdxf.read(io.StringIO(sheet.dxf().decode()))
    return Drawn(design, items, placed, assembly_sections(meshed), sheet, document)


class Balloon(NamedTuple):
    """A balloon on a sheet, in the drawing's coordinates."""

    number: int
    middle: tuple[float, float]
    edge: tuple[float, float]  # Where its leader ends at its circle
    foot: tuple[float, float]


def balloons(drawn: Drawn) -> list[Balloon]:
    space, scale = drawn.document.modelspace(), drawn.sheet.scale
    circles = [circle for circle in space.query("CIRCLE") if abs(circle.dxf.radius * scale - RADIUS) < 1e-6]
    lines = [((line.dxf.start.x, line.dxf.start.y), (line.dxf.end.x, line.dxf.end.y)) for line in space.query("LINE")]
    read = []
    for middle in ((circle.dxf.center.x, circle.dxf.center.y) for circle in circles):
        number = next(text for text in space.query("TEXT") if dist(text.get_placement()[1].vec2, middle) < 1e-6)
        foot, edge = next(line for line in lines if abs(dist(line[1], middle) * scale - RADIUS) < 1e-6)
        read.append(Balloon(int(number.dxf.text), middle, edge, foot))
    return read


def crosses(first: Balloon, other: Balloon) -> bool:
    def side(line: Balloon, point: tuple[float, float]) -> float:
        return float(np.linalg.det([np.subtract(line.edge, line.foot), np.subtract(point, line.foot)]))

    return (side(first, other.foot) * side(first, other.edge) < 0.0) and (
        side(other, first.foot) * side(other, first.edge) < 0
    )


def test_each_line_of_the_bill_has_one_balloon_and_no_two_meet(drawn):
    read = balloons(drawn)
    assert sorted(balloon.number for balloon in read) == [*range(1, len(drawn.items) + 1)]
    for first, other in combinations(read, 2):
        both = drawn.design.name, first.number, other.number
        assert dist(first.middle, other.middle) * drawn.sheet.scale > 2.0 * RADIUS + 0.5, both
        assert not crosses(first, other), both


def contains(part: CrossSection, point: tuple[float, float]) -> bool:
    return sum(Path(ring).contains_point(point) for ring in part.to_polygons()) % 2 == 1


def test_leaders_end_on_the_part_of_their_number(drawn):
    polylines = [line.get_points("xy") for line in drawn.document.modelspace().query("LWPOLYLINE[layer=='OUTLINE']")]
    views, start = [], 0
    for section in drawn.sections:
        chains = [chain for part in section.parts.values() for chain in outlines(part)]
        shift = np.subtract(polylines[start][0], chains[0].points[0])
        assert np.allclose(polylines[start], np.array(chains[0].points) + shift)
        views.append((section, shift, np.vstack([chain.points for chain in chains]) + shift))
        start += len(chains)
    for balloon in balloons(drawn):
        section, shift = next(
            (section, shift)
            for section, shift, points in views
            if (points.min(axis=0) <= balloon.foot).all() and (balloon.foot <= points.max(axis=0)).all()
        )
        x, z = np.subtract(balloon.foot, shift)
        there = [name for name, part in section.parts.items() if contains(part, (x, z))]
        item = drawn.items[balloon.number - 1]
        own = [name for name in there if kind_of(name) in item.solids]
        assert own, (item.kind, there)
        # On the solid itself, too, where the half plane stands in the module.
        along, azimuth = (x, section.right) if x >= 0.0 else (-x, section.left)
        point = cq.Vector(along * cos(azimuth), along * sin(azimuth), z)
        assert any(drawn.placed[name].isInside(point, 0.06) for name in own), item.kind


def test_the_sheet_stays_inside_its_frame_and_can_be_read(drawn):
    width, height = (length / drawn.sheet.scale for length in drawn.sheet.size)
    margin = MARGIN / drawn.sheet.scale
    box = ezdxf.bbox.extents(drawn.document.modelspace())
    assert box.extmin.x >= margin - 1e-6
    assert box.extmin.y >= margin - 1e-6
    assert box.extmax.x <= width - margin + 1e-6
    assert box.extmax.y <= height - margin + 1e-6
    no_text_lies_on_another(drawn.design.name, drawn.document)
    assert drawn.document.audit().errors == []
    written = texts(drawn.document)
    assert {f"{section.letter} – {section.letter}" for section in drawn.sections} <= set(written)
    kinds = [item.kind.replace("_", " ") for item in drawn.items]
    assert [text for text in written if text in kinds] == kinds[::-1]
    sizes = {text.strip("⌀") for text in (dimension.dxf.text for dimension in drawn.document.query("DIMENSION"))}
    for name in ("envelope_diameter", "envelope_height"):
        assert any(abs(float(size) - 1e3 * drawn.design.values[name]) < 0.1 for size in sizes), (name, sizes)


def test_a_cut_part_is_drawn_as_it_is_cut():
    """Cut a tube, and a pin beside it that only a plane through it meets."""
    ring = cq.Solid.makeCylinder(10, 30).cut(cq.Solid.makeCylinder(5, 30)).Solids()[0]
    pin = cq.Solid.makeCylinder(1, 6, cq.Vector(0, 20, 0))
    solids = {"housing": ring, "leg_pin_1": pin}
    placed = {name: Instance(solid_mesh(solid, 0.01, 0.05), np.eye(4)) for name, solid in solids.items()}
    section, *others = assembly_sections(placed)
    assert others == []
    assert section.parts["housing"].area() == pytest.approx(2 * 5 * 30, rel=1e-3)
    assert section.parts["leg_pin_1"].area() == pytest.approx(2 * 6, rel=1e-3)
    points = {name: part.points() for name, part in placed.items()}
    # Behind the plane one sees the back of the bore: its upper and lower edge.
    behind = np.vstack([line.points for line in section.behind(solids, points)])
    assert set(np.round(behind[np.abs(behind[:, 0]) < 4.9][:, 1], 3)) == {0.0, 30.0}
    feet = pointed_at({1: ["housing"], 2: ["leg_pin"]}, [section], 1.0)
    assert [len(points) for points in feet[0].values()] == [2, 1]


def test_leaders_to_balloons_in_a_row_do_not_cross():
    draw = np.random.default_rng(3)
    for _ in range(20):
        feet: dict[int, Any] = {number: [tuple(draw.uniform(0.0, 60.0, 2))] for number in range(1, 9)}
        slots = np.array([(7.5 * step, 75.0) for step in range(9)] + [(75.0, 7.5 * step) for step in range(9)])
        leaders = balloon_leaders(feet, slots)
        drawn = [Balloon(number, end, end, foot) for number, (foot, end) in leaders.items()]
        assert len({balloon.middle for balloon in drawn}) == 8
        assert not any(crosses(first, other) for first, other in combinations(drawn, 2))
