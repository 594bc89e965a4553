"""Every upright face of a part is on its drawing with size, place and heights: on a plate by hand, and on designs."""

import io
import re
from collections.abc import Sequence
from itertools import combinations
from math import atan2, cos, degrees, hypot, pi, sin

import cadquery as cq
import ezdxf
import numpy as np
import pytest
from cad_designs import BEARING_BLOCKS, BEARINGS, BLOCKS, CASES, DRIVEN, TILES, VANE_TILES, design_of
from ezdxf.document import Drawing
from ezdxf.entities import Hatch
from ezdxf.entities.boundary_paths import PolylinePath
from test_drawings import measured, no_text_lies_on_another, sheet_of, texts

from tvimdesign.cad.assembly.assembly import MODULES, drawn_part
from tvimdesign.cad.drawing.drawing_requirements import DrawingRequirements, drawing_requirements
from tvimdesign.cad.drawing.drawing_sheet import figure
from tvimdesign.cad.drawing.feature_rows import FeatureRow, feature_rows
from tvimdesign.cad.drawing.projection import half_section, section
from tvimdesign.cad.geometry.dimensions import dimensions
from tvimdesign.cad.geometry.kinds import PRODUCTION
from tvimdesign.cad.geometry.solids import block, cylinder, sector, turned
from tvimdesign.cad.parts import jigs

BARE = DrawingRequirements("", "", printed=True)
LONG = pytest.mark.slow
DESIGNS = [
    pytest.param("compression", BEARING_BLOCKS, id="bearing blocks"),
    pytest.param("shear", CASES["paper"][1], id="paper", marks=LONG),
    pytest.param("shear", BEARINGS, id="bearings", marks=LONG),
    pytest.param("shear", DRIVEN, id="driven", marks=LONG),
    pytest.param("shear", TILES, id="tiles", marks=LONG),
    pytest.param("compression", BLOCKS, id="blocks", marks=LONG),
    pytest.param("compression", VANE_TILES, id="tiles in vanes", marks=LONG),
]


def described(solid: cq.Shape) -> list[str]:
    return [row.text for row in feature_rows(solid.Solids()[0], BARE)]


def test_rows_have_width_depth_and_azimuth_of_pockets_and_holes():
    # A disc of 80 mm, 10 high: three pockets of 60 degrees, 3 deep, two notches of 8 mm, four holes, a slot.
    pockets = [
        turned(sector(12.0, 20.0, pi / 3.0, 7.0, 10.0), azimuth) for azimuth in (pi / 6.0, 5.0 * pi / 6.0, -pi / 2.0)
    ]
    notches = [turned(block((35.0, 41.0), 8.0, 0.0, 4.0), azimuth) for azimuth in (0.0, pi)]
    holes = [cylinder(2.0, 0.0, 10.0, place) for place in ((24.0, 24.0), (-24.0, 24.0), (-24.0, -24.0), (24.0, -24.0))]
    beside = block((-3.0, 3.0), 5.0, 8.0, 10.0).moved(cq.Location(cq.Vector(0.0, 30.0, 0.0)))
    plate = cylinder(40.0, 0.0, 10.0).cut(*pockets, *notches, *holes, beside)
    assert sorted(described(plate)) == sorted((
        "3× pocket R12 to R20, 60° between ends, middle every 120° from 30°, h 7 to 10 (3)",
        "2× slot 8 wide, mid-plane through the axis, every 180° from 0°, h 0 to 4 (4)",
        "4× hole ⌀4, on ⌀67.88 every 90° from 45°, through",
        # Open nowhere: its two pairs of walls stand 5 apart about y = 30, and 6 apart about x = 0.
        "slot 5 wide, mid-plane 30 from the axis, square to it at 90°, h 8 to 10 (2)",
        "slot 6 wide, mid-plane through the axis, at 90°, h 8 to 10 (2)",
        "flats 70 wide, mid-plane through the axis, along 90°, h 0 to 4 (4)",  # the notches' ends
    ))  # fmt: skip


def test_rows_of_walls_end_where_they_are_no_part_of_a_vane():
    # A pocket of 60 degrees from x on, 3 deep; a hole through the wall at its end makes two walls of that.
    pocket = turned(sector(12.0, 30.0, pi / 3.0, 7.0, 10.0), pi / 6.0)
    x, y = 20.0 * cos(pi / 3.0), 20.0 * sin(pi / 3.0)
    disc = cylinder(40.0, 0.0, 10.0).cut(pocket, cylinder(3.0, 0.0, 10.0, (x, y)))
    walls = [text for text in described(disc) if text.startswith("wall")]
    assert sorted(walls) == [
        "wall through the axis, R12 to R17 at 60°, faces clockwise, h 7 to 10 (3)",
        "wall through the axis, R12 to R30 at 0°, faces counter-clockwise, h 7 to 10 (3)",
        "wall through the axis, R23 to R30 at 60°, faces clockwise, h 7 to 10 (3)",
    ]
    # An upright prism on three corners, its sides 4 from the axis and out of it, and a pit of that form.
    corners = [(8.0 * cos(2.0 * pi * corner / 3.0), 8.0 * sin(2.0 * pi * corner / 3.0)) for corner in range(3)]
    prism = cq.Workplane().polyline(corners).close().extrude(5.0).val()
    assert isinstance(prism, cq.Solid)
    assert described(prism) == ["3× wall 4 from the axis, faces outwards every 120° from 60°, h 0 to 5 (5)"]
    pit = cylinder(20.0, 0.0, 10.0).cut(prism)
    assert described(pit) == ["3× wall 4 from the axis, faces inwards every 120° from 0°, h 0 to 5 (5)"]
    # A rib from x 5 to 20 and y -20 to 20 that a notch breaks at y 4 to 6: flats of two lengths.
    notch = block((4.0, 21.0), 2.0, 0.0, 4.0).moved(cq.Location(cq.Vector(0.0, 5.0, 0.0)))
    ribs = cylinder(40.0, -2.0, 0.0).fuse(block((5.0, 20.0), 40.0, 0.0, 4.0).cut(notch))
    alike = "flats 15 wide, mid-plane 12.5 from the axis, square to azimuths at 0°"
    assert sorted(text for text in described(ribs) if text.startswith(alike)) == [
        # At x = 20: y from 4 to -20, and from 6 to 20.
        f"{alike}, R20.4 to R28.28, h 2 to 6 (4)",
        f"{alike}, R20.88 to R28.28, h 2 to 6 (4)",
    ]
    # Four grooves part the wall into arcs of 82 degrees, two of them behind a vane of 86 degrees.
    grooves = [
        turned(block((28.0, 31.0), 4.0, -1.0, 9.0), azimuth) for azimuth in (pi / 4, 3 * pi / 4, -pi / 4, -3 * pi / 4)
    ]
    wall = cylinder(34.0, 0.0, 9.0).cut(cylinder(30.0, 1.0, 9.0), *grooves)
    vanes = [turned(sector(12.0, 20.0, 1.5, 0.5, 5.0), azimuth) for azimuth in (0.0, pi)]
    of_vanes = [text for text in described(wall.fuse(*vanes)) if "between ends" in text]
    assert of_vanes == ["2× raised sector R12 to R20, 85.94° between ends, middle every 180° from 0°, h 1 to 5 (4)"]


@pytest.mark.slow
@pytest.mark.parametrize(("mode", "changes"), DESIGNS)
def test_every_upright_face_of_every_part_has_a_dimension(mode, changes):
    design = design_of("dimensioned", changes, mode)
    dims = dimensions(design)
    parts = {kind: drawn_part(dims, kind) for kind in MODULES[mode].drawn(dims)}
    cast = parts[jigs.part_of(tuple(parts))]
    fixtures = {kind: draw(dims, cast).Solids()[0] for kind, draw in jigs.DRAWN.items()}
    fixtures |= {jigs.FORK: jigs.fork(dims).Solids()[0]} if dims.spring_count else {}
    for kind, solid in (parts | fixtures).items():
        if kind in fixtures or PRODUCTION[kind].drawn:
            rows = feature_rows(solid, drawing_requirements(kind, dims, design.choices))
            document = ezdxf.read(io.StringIO(sheet_of(design, kind, solid).dxf().decode()))
            lines = texts(document)
            assert all(row.text in lines for row in rows), kind
            assert len({row.text for row in rows}) == len(rows), kind
            for index, row in enumerate(rows, start=1):
                assert lines.count(str(index)) >= (2 if row.points else 1), (
                    f"{kind}: {row.text} has no number in the plan"
                )
            check_faces(kind, solid, rows, document)
            no_text_lies_on_another(kind, document)
            no_leader_crosses_another(kind, document)
            no_number_lies_on_a_section_s_mark(kind, document)


def check_faces(kind: str, solid: cq.Solid, rows: list[FeatureRow], document: Drawing) -> None:
    """Compare every upright face with the figures in the rows' texts, those about the axis against dimensions."""
    lowest, dimensioned = solid.BoundingBox().zmin, measured(document)
    for face in solid.Faces():
        box = face.BoundingBox()
        heights = f"h {figure(box.zmin - lowest)} to {figure(box.zmax - lowest)} ("
        level = [row for row in rows if heights in row.text or row.through or row.what == "corners"]
        ends = box.zmin - lowest, box.zmax - lowest  # The height of a boss has the fillet at its foot
        level += [row for row in rows if row.what == "boss" and row.bottom <= ends[0] and abs(row.top - ends[1]) < 1e-3]
        if face.geomType() == "CYLINDER":
            axis = face._geomAdaptor().Cylinder()
            radius, place = axis.Radius(), axis.Location()
            from_axis = hypot(place.X(), place.Y())
            if from_axis < 1e-6 and min(abs(2.0 * radius - size) for size in dimensioned) < 1e-4:
                continue
            assert any(has_cylinder(row, radius, from_axis) for row in level), f"{kind}: cylinder R{radius} {heights}"
        elif abs(face.normalAt().z) < 1e-9:
            assert any(has_wall(row, face) for row in level) or has_width(rows, face, solid), (
                f"{kind}: wall at {face.Center()} {heights}"
            )


def has_cylinder(row: FeatureRow, radius: float, from_axis: float) -> bool:
    sizes = {f"⌀{figure(2.0 * radius)}", f"R{figure(radius)}"}
    is_sized = any(re.search(rf"{re.escape(size)}(?![\d.])", row.size) for size in sizes)
    if row.what in ("corners", "pocket", "raised sector", "sector") or from_axis < 1e-6:
        return is_sized
    return is_sized and (f"on ⌀{figure(2.0 * from_axis)} " in row.place or row.place.startswith(("x ", "over")))


def has_width(rows: list[FeatureRow], face: cq.Face, solid: cq.Solid) -> bool:
    """Return whether rows without a place, as of what is bought, tell how wide the part is across all of a face."""
    normal, lowest = face.normalAt(), solid.BoundingBox().zmin
    reached, end = (level - lowest for level in (face.BoundingBox().zmin, face.BoundingBox().zmax))
    for row in sorted(rows, key=lambda each: each.bottom):
        level = lowest + 0.5 * (row.bottom + row.top)
        walls = [wall for wall in solid.Faces() if wall.BoundingBox().zmin < level < wall.BoundingBox().zmax]
        across = [(wall.Center().x * normal.x + wall.Center().y * normal.y) for wall in walls]
        is_wide = not row.place and row.size == f"{figure(max(across) - min(across))} wide"
        if is_wide and abs(row.bottom - reached) < 1e-3 and row.top < end + 1e-3:
            reached = row.top
    return abs(reached - end) < 1e-3


def has_wall(row: FeatureRow, face: cq.Face) -> bool:
    middle, normal = face.Center(), face.normalAt()
    offset = middle.x * normal.x + middle.y * normal.y
    if row.what in ("pocket", "raised sector", "sector"):
        (between,) = re.findall(r"([\d.]+)° between ends", row.size)
        azimuth = degrees(atan2(middle.y, middle.x))
        return any(
            abs(abs((azimuth - wall + 180.0) % 360.0 - 180.0) - 0.5 * float(between)) < 0.02 for wall in row.azimuths
        )
    if row.what in ("slot", "flats"):
        (width,) = re.findall(r"([\d.]+) wide", row.size)
        away = re.findall(r"mid-plane (-?[\d.]+) from", row.place) or ["0"]
        return any(
            abs(abs(offset) - abs(abs(float(away[0])) + side * 0.5 * float(width))) < 0.02 for side in (-1.0, 1.0)
        )
    if row.what == "wall" and abs(offset) < 1e-3:
        at = f"{figure(degrees(atan2(middle.y, middle.x)) % 360.0)}°"
        return row.size == "through the axis" and (at in row.place or not row.place.startswith("R"))
    is_behind = "faces inwards" in row.place
    return row.what == "wall" and row.size == f"{figure(abs(offset))} from the axis" and is_behind == (offset < 0.0)


def no_leader_crosses_another(kind: str, document: Drawing) -> None:
    lines = [line for line in document.modelspace().query("LINE") if line.dxf.layer == "DIMENSION"]
    ends = [((line.dxf.start.x, line.dxf.start.y), (line.dxf.end.x, line.dxf.end.y)) for line in lines]
    for (start, end), (other, far) in combinations(ends, 2):
        along, across = (end[0] - start[0], end[1] - start[1]), (far[0] - other[0], far[1] - other[1])
        turn = along[0] * across[1] - along[1] * across[0]
        if turn:
            gap = other[0] - start[0], other[1] - start[1]
            first = (gap[0] * across[1] - gap[1] * across[0]) / turn
            second = (gap[0] * along[1] - gap[1] * along[0]) / turn
            assert not (0.0 <= first <= 1.0 and 0.0 <= second <= 1.0), f"{kind}: leaders cross at {start}, {other}"


def no_number_lies_on_a_section_s_mark(kind: str, document: Drawing) -> None:
    """Circles around numbers against straight strokes and arrows: a plan's own outlines are chains."""
    space = document.modelspace()
    strokes = [(line.dxf.start, line.dxf.end) for line in space.query("LINE") if line.dxf.layer in ("OUTLINE", "FINE")]
    arrows = [(solid.dxf.vtx0, solid.dxf.vtx2) for solid in space.query("SOLID")]
    # The wider circles of the layer; the others are the leaders' ends.
    circles = [entity.dxf for entity in space.query("CIRCLE") if entity.dxf.layer == "DIMENSION"]
    largest = max((arrowhead.radius for arrowhead in circles), default=0.0)
    for circle in (arrowhead for arrowhead in circles if arrowhead.radius == largest):
        for start, end in (*strokes, *arrows):
            share = min(1.0, max(0.0, (circle.center - start).dot(end - start) / (end - start).magnitude ** 2))
            gap = circle.center.distance(start.lerp(end, share)) - circle.radius
            assert gap > 0.0, f"{kind}: the number at {circle.center} lies on the mark from {start} to {end}"


@pytest.mark.parametrize(
    ("case", "kind"),
    [("paper", "link"), ("paper", "heater"), ("tiles", "heater"), ("blocks", "pcl_block"),
     ("bearings", "adjuster")],  # whose two sections are taken near each other
)  # fmt: skip
def test_no_number_lies_where_a_section_is_marked(case, kind):
    mode, changes = CASES[case]
    design = design_of("marked", changes, mode)
    sheet = sheet_of(design, kind, drawn_part(dimensions(design), kind))
    document = ezdxf.read(io.StringIO(sheet.dxf().decode()))
    assert {"A", "1"} <= set(texts(document))
    no_text_lies_on_another(kind, document)
    no_number_lies_on_a_section_s_mark(kind, document)
    no_leader_crosses_another(kind, document)


@pytest.mark.gate
def test_a_housing_with_vanes_is_cut_through_the_middle_of_a_vane():
    design = design_of("vanes", BEARING_BLOCKS, "compression")
    dims = dimensions(design)
    solid = drawn_part(dims, "housing")
    document = ezdxf.read(io.StringIO(sheet_of(design, "housing", solid).dxf().decode()))
    hatched = [hatch for hatch in document.modelspace().query("HATCH") if isinstance(hatch, Hatch)]
    paths = [path for hatch in hatched for path in hatch.paths.paths if isinstance(path, PolylinePath)]
    loops = [path.vertices for path in paths]
    # The rotor's vanes are drawn on x, the housing's in the middle between them.
    through_vane = (*section(solid).cut, *half_section(solid, pi / dims.count("vane_count")).cut)
    expected = [outline.points for face in through_vane for outline in face]
    assert sorted(map(area, loops)) == pytest.approx(sorted(map(area, expected)))
    assert sorted(map(area, expected)) != pytest.approx(
        sorted(area(outline.points) for face in (*section(solid).cut, *half_section(solid, 0.25 * pi).cut)
               for outline in face)
    )  # fmt: skip


def area(corners: Sequence[Sequence[float]]) -> float:
    """Return of a polygon."""
    x, y = np.array([corner[:2] for corner in corners]).T
    return abs(0.5 * float(np.dot(x, np.roll(y, -1)) - np.dot(y, np.roll(x, -1))))


def test_one_height_reads_alike_wherever_it_stands():
    # A half is rounded up, and what two faces make of 23.155 differs by less than a nanometre.
    assert {figure(23.155), figure(23.155 - 1e-9), figure(23.155 + 1e-9)} == {"23.16"}
    assert figure(-0.001) == "0"
    design = design_of("heights", CASES["paper"][1])
    solid = drawn_part(dimensions(design), "rotor")
    document = ezdxf.read(io.StringIO(sheet_of(design, "rotor", solid).dxf().decode()))
    dimensioned = {dimension.dxf.text for dimension in document.modelspace().query("DIMENSION")}
    heights = {height for text in texts(document) for height in re.findall(r"h ([\d.]+) to ([\d.]+) \(", text)}
    assert heights
    dims = dimensions(design)
    # Core and pins are round from the end of their fillet on, which no flat face lies at.
    fillet = figure(dims.rotor_top_level + dims.foot_fillet - dims.core_bottom_level)
    assert {height for pair in heights for height in pair} - {fillet} <= dimensioned


def test_hidden_lines_are_dashed_along_circles_and_corners():
    design = design_of("hidden", BEARINGS)
    solid = drawn_part(dimensions(design), "housing")
    document = ezdxf.read(io.StringIO(sheet_of(design, "housing", solid).dxf().decode()))
    hidden = [entity for entity in document.modelspace() if entity.dxf.layer == "HIDDEN"]
    assert document.layers.get("HIDDEN").dxf.linetype == "HIDDEN"
    assert sum(line.dxftype() in ("CIRCLE", "ARC") for line in hidden) >= 4  # the feet, at the least
    assert all(line.dxf.flags & 128 for line in hidden if line.dxftype() == "LWPOLYLINE")


def test_threads_are_drawn_by_iso_6410_and_placed_by_half_their_play():
    design = design_of("threads", BEARING_BLOCKS, "compression")
    dims = dimensions(design)
    solid = drawn_part(dims, "rotor")
    document = ezdxf.read(io.StringIO(sheet_of(design, "rotor", solid).dxf().decode()))
    arcs = [arc for arc in document.modelspace().query("ARC") if arc.dxf.layer == "FINE"]
    threads = [arc.dxf for arc in arcs if (arc.dxf.end_angle - arc.dxf.start_angle) % 360.0 == pytest.approx(270.0)]
    screw = dims.link_screw_diameter
    assert sum(arc.radius == pytest.approx(0.5 * screw) for arc in threads) == 4
    play = dims.link_screw_clearance - screw
    rows = feature_rows(solid, drawing_requirements("rotor", dims, design.choices))
    (frame,) = next(row.frames for row in rows if row.asks == "link's screws")
    zone = float(frame.within.removeprefix("⌀"))
    # Both patterns at the ends of their zones leave the screw just free.
    assert zone <= 0.5 * play + 1e-9 < zone + 0.05
    assert frame.datums == "CB"
