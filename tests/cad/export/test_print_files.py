"""Files for printers and meshes of faces."""

import io
import zipfile
from math import cos, pi, tau
from xml.etree import ElementTree as ET

import cadquery as cq
import numpy as np
import pytest
import trimesh
from cad_designs import BEARINGS, BLOCKS, DRIVEN, SPRUNG_BLOCKS, TILES, design_of
from hypothesis import given
from hypothesis import strategies as st
from plate_copies import copies_on_a_plate

from tvimdesign.base.errors import GeometryError
from tvimdesign.cad.assembly.assembly import MODULES, drawn_part
from tvimdesign.cad.export import mesh as meshing
from tvimdesign.cad.export import print_files
from tvimdesign.cad.export.mesh import CHORD, Mesh, face_meshes, solid_mesh
from tvimdesign.cad.export.step_file import Product, read_part, write_assembly, write_part
from tvimdesign.cad.geometry.dimensions import dimensions
from tvimdesign.cad.geometry.features import holes, levels, upright_cylinders
from tvimdesign.cad.geometry.kinds import KINDS, PRODUCTION, Production, supported_levels
from tvimdesign.cad.inspection.printing import printing_checks

UP = Production(down="bottom", why="")
OVER = Production(down="top", why="")
PRODUCT = Product(name="bracket & <foot>", colour=(1.0, 0.5, 0.0), material="PETG", density=1270.0)


def bracket() -> cq.Solid:
    """Return a block of 40 x 30 x 10 mm on z = 5 with a through hole of 6, a blind one of 4 from above, a boss of 8."""
    block = cq.Solid.makeBox(40, 30, 10, cq.Vector(0, 0, 5))
    through = cq.Solid.makeCylinder(3, 10, cq.Vector(10, 15, 5))
    blind = cq.Solid.makeCylinder(2, 4, cq.Vector(30, 15, 11))
    boss = cq.Solid.makeCylinder(4, 6, cq.Vector(20, 15, 15))
    across = cq.Solid.makeCylinder(1.5, 30, cq.Vector(20, 0, 10), cq.Vector(0, 1, 0))
    return block.fuse(boss).cut(through, blind, across).Solids()[0]


def cup() -> cq.Solid:
    """Return a cup of 20 mm with a post in it: its inside is no hole."""
    body = cq.Solid.makeCylinder(10, 10).cut(cq.Solid.makeCylinder(8, 8, cq.Vector(0, 0, 2)))
    return body.fuse(cq.Solid.makeCylinder(2, 5, cq.Vector(0, 0, 2))).Solids()[0]


def test_upright_cylinders_are_read_off_a_solid_and_its_mirror():
    cylinders = [(face.radius, face.x, face.bottom, face.top, face.concave) for face in upright_cylinders(bracket())]
    assert cylinders == [(2, 30, 11, 15, True), (3, 10, 5, 15, True), (4, 20, 15, 21, False)]
    assert all(face.is_round and not face.is_central for face in upright_cylinders(bracket()))
    assert levels(bracket()) == [5, 11, 15, 21]
    mirrored = bracket().mirror("XZ").Solids()[0]
    assert [face.concave for face in upright_cylinders(mirrored)] == [True, True, False]
    (arc,) = upright_cylinders(cut_in_half())
    assert arc.span == pytest.approx(pi)
    assert cos(arc.middle) == pytest.approx(-1.0)
    assert not arc.is_round


def test_holes_are_empty_also_beside_faces_that_would_cut_them():
    assert [hole.radius for hole in holes(bracket())] == [2, 3]
    assert holes(cup()) == []
    # A slot's walls and floor, a pin's round face and a level edge all end before the hole.
    slot = cq.Solid.makeBox(4, 12, 5, cq.Vector(6, 9, 5)).rotate(cq.Vector(8, 15, 0), cq.Vector(8, 15, 1), 30)
    pin = cq.Solid.makeCylinder(14, 3, cq.Vector(20, 36, 10)).intersect(BLOCK.translate(cq.Vector(0, 0, 10)))
    part = bored(pin).cut(slot).Solids()[0]
    assert [hole.radius for hole in holes(part)] == [8]


BLOCK = cq.Solid.makeBox(40, 30, 10)


def bored(*more: cq.Solid) -> cq.Solid:
    """Return the block with a through hole of 16 in its middle, and what else stands in that."""
    return BLOCK.cut(cq.Solid.makeCylinder(8, 10, cq.Vector(20, 15, 0))).fuse(*more).Solids()[0]


BARS = {
    "nothing": ([], True),
    "a web across it": ([cq.Solid.makeBox(40, 1, 10, cq.Vector(0, 20, 0))], False),
    "a web at its rim": ([cq.Solid.makeBox(40, 1, 2, cq.Vector(0, 22.5, 4))], False),
    "a level sheet halfway up": ([cq.Solid.makeBox(40, 30, 0.5, cq.Vector(0, 0, 4))], False),
    "a round bar across it": ([cq.Solid.makeCylinder(1, 30, cq.Vector(20, 0, 5), cq.Vector(0, 1, 0))], False),
    "a cone in it": ([cq.Solid.makeCone(3, 1, 6, cq.Vector(20, 15, 2)),
                      cq.Solid.makeBox(20, 1, 1, cq.Vector(20, 15, 3))], False),
}  # fmt: skip


@pytest.mark.parametrize("name", BARS)
def test_what_stands_in_a_hole_is_found_whatever_its_faces(name):
    inside, empty = BARS[name]
    part = bored(*inside) if inside else bored(cq.Solid.makeBox(1, 1, 1, cq.Vector(0, 0, 10)))
    plug = cq.Solid.makeCylinder(7.99, 10, cq.Vector(20, 15, 0))
    assert (plug.intersect(part).Volume() < 1e-6) == empty  # the kernel's word
    assert any(hole.radius == 8 and (hole.bottom, hole.top) == (0, 10) for hole in holes(part)) == empty


def test_holes_are_wider_and_parts_lie_on_their_side_in_print():
    part = bracket()
    printed = print_files.as_printed(part, UP, 0.3)
    less = pi * ((3.15**2 - 3.0**2) * 10 + (2.15**2 - 2.0**2) * 4)
    # The hole across goes through the middle of no upright one.
    assert part.Volume() - printed.Volume() == pytest.approx(less, rel=1e-6)
    assert [hole.radius for hole in holes(printed)] == [2.15, 3.15]
    assert print_files.as_printed(part, UP, 0.0).Volume() == pytest.approx(part.Volume(), rel=1e-12)
    up, over = print_files.as_printed(bracket(), UP, 0.0), print_files.as_printed(bracket(), OVER, 0.0)
    assert (up.BoundingBox().zmin, over.BoundingBox().zmin) == pytest.approx((0.0, 0.0), abs=1e-9)
    # Turned over, the boss is what stands on the bed, and the plate's lower face is up.
    assert levels(up) == [0, 6, 10, 16]
    assert levels(over) == [0, 6, 10, 16]
    assert up.isInside(cq.Vector(20, 15, 15))
    assert over.isInside(cq.Vector(20, -15, 1))
    assert not over.isInside(cq.Vector(5, -15, 1))


def test_every_kind_says_how_it_is_come_by():
    cases = (
        ("all", BEARINGS | DRIVEN),
        ("blocks", SPRUNG_BLOCKS | {"housing_base": "separate"}, "compression"),
        ("pinned", {"leg_pin": "iso_8734_3", "leg_pin_length": 12e-3}),
        ("tiles", TILES | {"thermistor_diameter": 1.1e-3, "liner_material": "peek", "liner_thickness": 0.8e-3}),
    )
    dims = [dimensions(design_of(*case)) for case in cases]
    kinds = {kind for dims_of in dims for kind in MODULES[dims_of.mode].kinds(dims_of)}
    assert kinds == set(PRODUCTION) == set(KINDS)
    assert all(making.why for making in PRODUCTION.values())


def test_the_mesh_error_is_known_on_any_surface():
    part = cq.Solid.makeCylinder(20, 5)
    body, measured = print_files.printed_mesh("disc", part)
    rim = body.vertices[np.abs(np.hypot(*body.vertices[:, :2].T) - 20.0) < 1e-6]
    azimuths = np.unique(np.round(np.arctan2(rim[:, 1], rim[:, 0]), 9))
    widest = np.diff([*azimuths, azimuths[0] + tau]).max()
    assert measured == pytest.approx(20.0 * (1.0 - cos(0.5 * widest)), rel=1e-6)
    assert 0.0 < measured < 0.05
    assert body.is_watertight
    ball = cq.Solid.makeSphere(10)
    face, mesh = next(pair for pair in face_meshes(ball) if pair[0].geomType() == "SPHERE")
    finest = print_files._distance(face, mesh)
    coarse = Mesh(mesh.vertices * 0.99, mesh.faces)
    assert finest < 0.05
    assert print_files._distance(face, coarse) == pytest.approx(0.1 + 0.99 * finest, rel=1e-3)
    # A ring of 10 mm and 2 mm about an axis along y through (1, 2, 3).
    ring = cq.Solid.makeTorus(10.0, 2.0, cq.Vector(1, 2, 3), cq.Vector(0, 1, 0))
    (face,) = ring.Faces()
    points = np.array([(16.0, 2.0, 3.0), (1.0, 7.0, 13.0), (-8.0, 2.0, 3.0), (1.0, 2.0, 3.0), (7.0, 2.5, 11.0)])
    by_hand = [3.0, 3.0, 1.0, 8.0, 1.5]
    assert print_files._from_surface(face, points) == pytest.approx(by_hand)


def test_print_files_have_unit_name_material_and_the_part():
    body, _ = print_files.printed_mesh("bracket", bracket())
    data = print_files.threemf_bytes(body, PRODUCT)
    with zipfile.ZipFile(io.BytesIO(data)) as archive:
        assert archive.testzip() is None
        assert {entry.date_time for entry in archive.infolist()} == {(1980, 1, 1, 0, 0, 0)}
        root = ET.fromstring(archive.read("3D/3dmodel.model"))
    space = {"m": "http://schemas.microsoft.com/3dmanufacturing/core/2015/02"}
    assert root.attrib["unit"] == "millimeter"
    base, thing = root.find(".//m:base", space), root.find(".//m:object", space)
    assert base is not None
    assert thing is not None
    assert base.attrib == {"name": "PETG", "displaycolor": "#FF8000"}
    assert thing.attrib["name"] == "bracket & <foot>"
    points = np.array([[float(point.attrib[axis]) for axis in "xyz"] for point in root.iterfind(".//m:vertex", space)])
    corners = [[int(face.attrib[key]) for key in ("v1", "v2", "v3")] for face in root.iterfind(".//m:triangle", space)]
    read = trimesh.Trimesh(points, corners)
    assert read.is_watertight
    assert read.volume == pytest.approx(body.volume, rel=1e-6)
    read = trimesh.load_mesh(io.BytesIO(print_files.stl_bytes(body)), file_type="stl")
    assert read.is_watertight
    assert read.volume == pytest.approx(bracket().Volume(), rel=2e-3)


def test_a_step_part_says_its_volume_area_and_centroid_or_is_refused(tmp_path):
    # A block of 10 x 20 x 30 mm with a hole of 6 mm at (5, 5).
    part = cq.Solid.makeBox(10, 20, 30).cut(cq.Solid.makeCylinder(3, 30, cq.Vector(5, 5, 0))).Solids()[0]
    write_part(tmp_path / "part.step", part, PRODUCT)
    solid, reported = read_part(tmp_path / "part.step")
    bore = 9.0 * pi
    assert reported.volume == pytest.approx(30.0 * (200.0 - bore), rel=1e-9)
    assert reported.area == pytest.approx(2.0 * (200.0 - bore) + 60.0 * 30.0 + 6.0 * pi * 30.0, rel=1e-9)
    assert reported.centroid == pytest.approx((5.0, (200.0 * 10.0 - bore * 5.0) / (200.0 - bore), 15.0), rel=1e-9)
    assert solid.Volume() == pytest.approx(reported.volume, rel=1e-9)
    text = (tmp_path / "part.step").read_text()
    for words in ("AP242", "geometric validation property", "VOLUME_MEASURE", "AREA_MEASURE", "centre point"):
        assert words in text
    box = cq.Solid.makeBox(1, 1, 1)
    write_assembly(tmp_path / "a.step", "a", {"box_1": box}, {"box_1": PRODUCT})
    with pytest.raises(GeometryError, match="volume, area and centroid"):
        read_part(tmp_path / "a.step")


def cut_in_half() -> cq.Solid:
    whole = cq.Solid.makeCylinder(5, 3)
    return whole.intersect(cq.Solid.makeBox(10, 20, 10, cq.Vector(-10, -10, -1))).Solids()[0]


def test_the_tip_of_a_drilled_hole_does_not_open_the_mesh():
    """Check a cone apart from its plate's axis, which has a triangle of no size at its tip."""
    tip = cq.Solid.makeCone(1.25, 0.0, 0.75, cq.Vector(4.907, -4.856, 2.0), cq.Vector(0, 0, -1))
    drilled = cq.Workplane().box(20.0, 20.0, 8.0).val().cut(
        cq.Solid.makeCylinder(1.25, 2.0, cq.Vector(4.907, -4.856, 2.0)), tip
    )  # fmt: skip
    mesh, worst = print_files.printed_mesh("drilled", drilled.Solids()[0])
    assert mesh.is_watertight
    assert mesh.volume == pytest.approx(drilled.Volume(), rel=1e-3)
    assert worst < 0.05


@pytest.mark.parametrize(("mode", "changes"), [("shear", {}), ("compression", BLOCKS)])
def test_its_overhangs_are_those_that_the_print_text_tells(mode, changes):
    dims = dimensions(design_of("printed", changes, mode))
    mesh, levels = solid_mesh(drawn_part(dims, "rotor")), supported_levels("rotor", dims)
    bed = (dims.bed_length, dims.bed_width, dims.bed_height)

    def warned(supported: tuple[tuple[float, float], ...]) -> bool:
        checks = printing_checks("rotor", mesh, "top", dims.overhang_angle, dims.bridge_span, bed, supported)
        return next(check for check in checks if check.name == "rotor: overhang").warned

    assert not warned(levels)
    # Without either of the two it is a fault: the plate with its fillets, and the ends of the pins.
    assert warned(levels[:1])
    assert warned(levels[1:])
    assert warned(((dims.rotor_top_level, dims.rotor_top_level), levels[1]))
    why = PRODUCTION["rotor"].why
    assert "{pins_on_bed}" in why
    assert "supports from the bed" in why


@pytest.mark.parametrize(("worst", "meshed"), [(CHORD, True), (0.0, False)])
def test_a_face_left_out_is_meshed_at_a_finer_chord(worst, meshed, monkeypatch):
    kernel, box = meshing.BRepMesh_IncrementalMesh, cq.Solid.makeBox(3.0, 2.0, 1.0)

    def mesh_below_worst(shape: object, chord: float, *settings: object) -> None:
        if chord < worst:
            kernel(shape, chord, *settings)

    monkeypatch.setattr(meshing, "BRepMesh_IncrementalMesh", mesh_below_worst)
    if meshed:
        assert len(solid_mesh(box).faces) == 12
    else:
        with pytest.raises(GeometryError, match="no triangles"):
            solid_mesh(box)


@pytest.mark.parametrize("seed", range(8))
def test_parts_on_a_bed_lie_apart_and_within_it(seed):
    draw = np.random.default_rng(seed)
    bed, gap = (220.0, 180.0), print_files.GAP
    discs = [(float(radius), 0.0) for radius in draw.uniform(2.0, 80.0, draw.integers(1, 9))]
    bars = [(3.0, float(length)) for length in draw.uniform(5.0, 200.0, draw.integers(1, 9))]
    around = np.linspace(0.0, tau, 60, endpoint=False)
    outlines = [
        np.stack((radius * np.cos(around), radius * np.sin(around) + half * np.sign(np.sin(around))), axis=1)
        for radius, length in (*discs, *bars) for half in (0.5 * length,)
    ]  # fmt: skip
    spots = print_files.lay_out([*outlines, 120.0 * outlines[0] / discs[0][0]], bed)
    assert spots[-1] is None  # larger than the bed
    placed = []
    for spot, (radius, length) in zip(spots, (*discs, *bars), strict=False):
        assert spot is not None
        # The part is what is within its radius of a line from the first point to the last.
        last = np.array([length, 0.0] if spot.turned else [0.0, length])
        first = np.array([spot.x + radius, spot.y + radius])
        assert (np.array([spot.x, spot.y]) >= 0.5 * gap).all()
        assert (first + last + radius <= np.array(bed) - 0.5 * gap).all()
        line = first + np.linspace(0.0, 1.0, 201)[:, None] * last
        for bed_number, other, beside in placed:
            apart = np.hypot(*(line[:, None] - other[None]).transpose(2, 0, 1)).min() - radius - beside
            assert spot.bed != bed_number or apart >= gap - 0.02
        placed.append((spot.bed, line, radius))
    assert {number for number, _, _ in placed} == set(range(1 + max(number for number, _, _ in placed)))


def test_round_parts_fill_the_corners_of_one_bed():
    around = np.linspace(0.0, tau, 90, endpoint=False)
    discs = [radius * np.stack((np.cos(around), np.sin(around)), axis=1) for radius in (75.0, 41.0)]
    spots = print_files.lay_out(discs, (220.0, 220.0))
    assert [spot and spot.bed for spot in spots] == [0, 0]


def test_a_plate_has_every_copy_in_its_place_and_its_settings():
    dims = dimensions(design_of("plate", {}))
    body, _ = print_files.printed_mesh("bracket", print_files.as_printed(bracket(), UP, 0.0))
    temperatures = {"nozzle_temperature": "240", "bed_temperature": "85"}
    data = print_files.plate_bytes(
        "bed 1 of 1",
        [print_files.Laid(body, PRODUCT, [(10.0, 20.0, False), (70.0, 30.0, True)])],
        print_files.description(dims, "PETG", temperatures),
        print_files.slicer_config(dims, 1270.0, temperatures),
    )
    (_, straight), (name, turned) = copies_on_a_plate(data)
    assert name == "bracket & <foot>"
    assert straight.bounds == pytest.approx(np.array([[10.0, 20.0, 0.0], [50.0, 50.0, 16.0]]), abs=1e-6)
    assert turned.bounds == pytest.approx(np.array([[70.0, 30.0, 0.0], [100.0, 70.0, 16.0]]), abs=1e-6)
    assert [copy.volume for copy in (straight, turned)] == pytest.approx([body.volume] * 2)  # turned, not mirrored
    with zipfile.ZipFile(io.BytesIO(data)) as archive:
        lines = archive.read("Metadata/Slic3r_PE.config").decode().splitlines()
        root = ET.fromstring(archive.read("3D/3dmodel.model"))
    settings = dict(line.removeprefix("; ").split(" = ") for line in lines[2:])
    # Three lines of 0.4 mm make the least wall of 1.2 mm; 45 degrees from upright are as many from level.
    assert settings["perimeters"] == "3"
    assert settings["support_material_threshold"] == "45"
    assert settings["bed_shape"] == "0x0,220x0,220x220,0x220"
    assert (settings["temperature"], settings["first_layer_bed_temperature"]) == ("240", "85")
    about = root.find(".//{*}metadata[@name='Description']")
    assert about is not None
    layers = "layers of 0.2 mm, in PrusaSlicer such that flat faces lie between two"
    assert about.text == f"PETG: 0.4 mm nozzle, {layers}, 3 walls, infill 100 %, nozzle at 240 °C, bed at 85 °C"


@given(tops=st.lists(st.floats(0.02, 3.0), min_size=1, max_size=5))
def test_flat_faces_lie_between_two_layers(tops):
    heights = 0.5 + np.cumsum(tops)
    steps = [
        trimesh.creation.box(bounds=[[10.0 * i, 0, 0], [10.0 * i + 10.0, 5.0 + i, z]]) for i, z in enumerate(heights)
    ]
    ranges = print_files.fitted_layers(trimesh.util.concatenate(steps))
    ends = [0.2]
    for low, high, layer in ranges:
        assert low == ends[-1]
        assert (high - low) / layer == pytest.approx(round((high - low) / layer), abs=1e-9)
        assert 0.1 - 1e-6 < layer < 0.3 + 1e-6
        ends.append(high)
    away = [min(abs(ends - height)) for height in heights]
    assert away[-1] < 1e-5  # the largest face
    assert max(away) < 0.1 + 1e-5
