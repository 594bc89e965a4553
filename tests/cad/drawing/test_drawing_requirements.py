"""Fits, surfaces and threads on drawings: ISO 286 against its tables; drawings of milled modules and springs."""

import io
import re
import zlib
from collections.abc import Mapping
from contextlib import suppress
from dataclasses import replace

import ezdxf
import pytest
import yaml
from cad_designs import BEARING_BLOCKS, BEARINGS, CASES, DRIVEN, TILES, VANE_TILES, design_of
from ezdxf.tools.text_size import text_size
from support import ROOT, cases_of
from test_drawings import no_text_lies_on_another, sheet_of, texts

from tvimdesign.base.errors import GeometryError
from tvimdesign.cad.assembly.assembly import drawn_part
from tvimdesign.cad.drawing.drawing_requirements import drawing_requirements, limit_deviations, standard_tolerance
from tvimdesign.cad.drawing.drawing_sheet import SIZE, DrawingSheet
from tvimdesign.cad.drawing.drawings import part_sheet
from tvimdesign.cad.drawing.spring_sheet import spring_lines, spring_sheet
from tvimdesign.cad.export.step_file import product
from tvimdesign.cad.geometry.dimensions import dimensions
from tvimdesign.cad.geometry.features import upright_cylinders
from tvimdesign.cad.geometry.kinds import PRODUCTION
from tvimdesign.cad.jobs.build_plan import fits
from tvimdesign.catalog import Catalog
from tvimdesign.study.design import Design

MILLED = {"process": "machine_6061", "corner_radius": 0.5e-3, "corner_depth_ratio": 40.0}


@cases_of("drawing_requirements", "limit_deviations")
def test_limit_deviations_are_those_of_the_standard(fit, size, lower, upper):
    assert limit_deviations(fit, size) == pytest.approx((1e-3 * lower, 1e-3 * upper))


def test_tolerance_grades_follow_the_standard_s_formula():
    # ISO 286-1: 7, 10, 16, 25, 40 and 64 units i = 0.45 D^(1/3) + 0.001 D at the range's geometric mean, rounded.
    for over, up_to in ((3, 6), (10, 18), (18, 30), (30, 50), (50, 80), (80, 120), (120, 180)):
        mean = (over * up_to) ** 0.5
        unit = 0.45 * mean ** (1 / 3) + 0.001 * mean
        for grade, units in ((5, 7), (6, 10), (7, 16), (8, 25), (9, 40), (10, 64)):
            assert 1e3 * standard_tolerance(grade, up_to) == pytest.approx(units * unit, rel=0.06, abs=1.0)


@pytest.mark.parametrize(
    ("fit", "size"), [("H7", 0.0), ("H7", 501.0), ("H12", 10.0), ("z6", 10.0), ("k8", 10.0), ("H4", 9.0)]
)
def test_what_the_table_has_not_is_refused(fit, size):
    with pytest.raises(GeometryError, match=r"iso_286\.yaml"):
        limit_deviations(fit, size)


def milled(case: Mapping[str, float | str], mode: str) -> Design:
    return design_of("milled", {**case, **MILLED}, mode)


@pytest.mark.parametrize(
    ("case", "mode", "kinds"),
    [(BEARING_BLOCKS, "compression", ("housing", "rotor")), (DRIVEN, "shear", ("motor_hub", "motor_housing"))],
)
def test_what_is_milled_to_the_file_is_within_every_fit(case, mode, kinds):
    design = milled(case, mode)
    for kind in kinds:
        seats = drawing_requirements(kind, dimensions(design), design.choices).seats
        assert seats[0].letter == "B"
        for seat in seats:
            assert seat.fit, f"{kind}: {seat.about} is drawn outside its class"
            assert seat.limits.lower - 1e-9 <= seat.drawn - seat.size <= seat.limits.upper + 1e-9


def test_seats_and_threads_have_fits_where_milled():
    design = milled(BEARING_BLOCKS | {"seat_clearance": 0.05e-3}, "compression")
    seat = drawing_requirements("housing", dimensions(design), design.choices).seats[0]
    assert (seat.fit, seat.size) == ("", seat.drawn)
    assert seat.drawn == pytest.approx(24.1)  # 6802 has 24 mm, and the study a gap of 0.05 mm to each side
    mode, overrides = CASES["paper"]
    design = design_of("paper", overrides, mode)
    requirements = drawing_requirements("rotor", dimensions(design), design.choices)
    # Reamed, in a print too; the core goes into the bore with the play that is in the sizes as drawn.
    assert [(seat.about, seat.fit) for seat in requirements.seats] == [
        ("core in the bore", "js10"),
        ("dowel pins", "H7"),
    ]
    assert requirements.seats[0].size == requirements.seats[0].drawn
    threads = [(thread.screw, thread.made) for thread in requirements.threads]
    assert threads == [("M3", "insert melted in"), ("M3", "insert melted in")]
    reported = yaml.safe_load((ROOT / "tvimdesign/cad/drawing/drawing_requirements.yaml").read_text(encoding="utf-8"))
    words = [entry["about"] for part in ("seats", "threads") for group in reported[part].values() for entry in group]
    assert max(map(len, words)) <= 21  # what the table has room for
    assert {*reported["seats"], *reported["threads"]} <= {kind for kind, making in PRODUCTION.items() if making.drawn}


@pytest.mark.parametrize("process", ["print_pc_bambu", "machine_6061"])
def test_a_spreader_s_pocket_leaves_gaps_that_slip_and_that_are_filled(process):
    design = design_of("tiles", {**TILES, "process": process}, "shear")
    dims = dimensions(design)
    sheets = {kind: drawing_requirements(kind, dims, design.choices) for kind in ("housing", "spreader")}
    note = next(note for note in sheets["housing"].notes if "pockets" in note)
    sides = [float(radius) for radius in re.findall(r"R([\d.]+)", note)]
    gaps = [
        *(dims.pcl_inner_radius - side for side in sides[1::-1]),
        *(side - dims.pcl_outer_radius for side in sides[2:]),
    ]
    assert min(gaps) == pytest.approx(dims.slip_clearance, abs=0.01)
    smaller = float(re.search(r"\+0 / −([\d.]+)", sheets["spreader"].tolerances)[1])
    assert max(gaps) + smaller == pytest.approx(dims.heater_adhesive_gap_fill, abs=0.01)
    assert ("sanding" in str(sheets["housing"].notes)) == (process == "print_pc_bambu")
    block = design_of("in vanes", VANE_TILES, "compression")
    assert "pockets" not in str(drawing_requirements("housing", dimensions(block), block.choices).notes)


SIZED = {"process": "print_pc_bambu", "preload_adjuster": "rotary", "cover": "plate", "radial_clearance": 1.7e-3}


@pytest.mark.parametrize(
    ("hole", "shaft", "about", "gap"),
    [
        ("housing", "rotor", ("bore of the core", "core in the bore"), "running_clearance"),
        ("cover", "rotor", ("core turns in it", "core in the bore"), "running_clearance"),
        ("housing", "adjuster", ("adjusters' pockets", "flange in its pocket"), "slip_clearance"),
    ],
)
def test_a_printed_pair_s_limits_leave_the_play_that_the_model_takes(hole, shaft, about, gap):
    design = design_of("printed", SIZED, "shear")
    pair = [
        next(seat for seat in drawing_requirements(kind, dimensions(design), design.choices).seats if seat.about == of)
        for kind, of in zip((hole, shaft), about, strict=True)
    ]
    wide, narrow = pair
    entry = Catalog().record("processes", "print_pc_bambu").entry(gap)
    assert wide.drawn - narrow.drawn == pytest.approx(2e3 * entry.value, abs=1e-6)
    assert wide.size + wide.limits.lower - narrow.size - narrow.limits.upper >= 2e3 * entry.low
    assert wide.size + wide.limits.upper - narrow.size - narrow.limits.lower <= 2e3 * entry.high
    for seat in pair:
        assert seat.form.endswith(f"; play {2e3 * entry.value:.2g}")


@pytest.mark.gate
@pytest.mark.parametrize(
    ("kind", "about", "size", "tool"),
    [
        ("housing", "bearings' outer rings", "⌀21.1 H8", "reamed"),
        ("rotor", "bearings' inner rings", "⌀14.9 h8", "turned"),
    ],
)
def test_a_printed_seat_of_a_bearing_has_a_class_about_its_size_as_drawn(kind, about, size, tool):
    design = design_of("printed", BEARINGS | {"process": "print_pc"}, "shear")
    dims = dimensions(design)
    requirements = drawing_requirements(kind, dims, design.choices)
    seat = next(seat for seat in requirements.seats if seat.about == about)
    assert (seat.form, seat.frames) == (f"{tool} or eased to size", ())
    assert not any("run-out" in note for note in requirements.notes)
    assert any("dial bore gauge" in note for note in requirements.notes)
    solid, what = drawn_part(dims, kind), product(design, kind)
    document = part_sheet(kind, solid, what, design.name, requirements).document
    no_text_lies_on_another(kind, document)
    loose = part_sheet(kind, solid, what, design.name, replace(requirements, seats=[])).document
    numbers = [
        text for sheet in (document, loose) for text in texts(sheet) if re.fullmatch(rf"{kind}-[0-9a-f]{{8}}", text)
    ]
    assert len(numbers) == len(set(numbers)) == 2  # a part with another fit is another part
    assert size in [line.dxf.text for line in document.modelspace().query("DIMENSION")]
    assert size.removeprefix("⌀").split()[1] in fits(design, dims)[seat.mates]


def test_drawings_of_a_milled_module_have_fits_threads_and_edges():
    lines = {}
    for kind, design in (("motor_housing", milled(DRIVEN, "shear")), ("rotor", milled(BEARING_BLOCKS, "compression"))):
        sheet = sheet_of(design, kind, drawn_part(dimensions(design), kind))
        document = ezdxf.read(io.StringIO(sheet.dxf().decode()))
        assert document.audit().errors == []
        no_text_lies_on_another(kind, document)
        lines[kind] = texts(document)
        dimensioned = [dimension.dxf.text for dimension in document.modelspace().query("DIMENSION")]
        assert {"motor_housing": "⌀24 H6", "rotor": "⌀15 h5"}[kind] in dimensioned
    # Bearing 6802: 15 x 24 mm; ISO 286-2: H6 at 24 mm is +13 / 0, h5 at 15 mm is 0 / -8; IT5 9 and 8.
    assert {"B", "⌀24 H6", "+13 / 0", "24.000 to 24.013", "0.0045", "0.009", "⌀0.009 CZ"} <= set(lines["motor_housing"])
    assert {"B", "⌀15 h5", "0 / -8", "14.992 to 15.000", "0.004", "0.008", "⌀0.008 CZ"} <= set(lines["rotor"])
    # ISO 6410-1 writes thread and length, then hole and depth.
    assert any(text.startswith("4× thread M3-6H × ") and " / ⌀2.5 × " in text for text in lines["rotor"])
    assert any(text.startswith("thread M4-6H × ") for text in lines["rotor"])
    assert "Sizes ISO 2768-1 m; ISO 22081" in lines["rotor"]  # which stands where ISO 2768-2 stood
    assert not any("2768-2" in text for text in lines["rotor"])
    profile, note = "0.4", "Each face within ±0.2 of its place; sizes between faces by ISO 2768-1 m, too."
    assert {profile, note} <= set(lines["rotor"])
    assert any("ISO 13715" in text for text in lines["rotor"])
    assert not any(text.startswith("Printing") for text in lines["rotor"])


def test_holes_beside_threads_and_dowels_are_none():
    mode, overrides = CASES["wrist"]
    design = design_of("wrist", overrides, mode)  # its keys' pockets are 2.5 mm wide, as the hole for the retainer's M3
    cylinders = upright_cylinders(drawn_part(dimensions(design), "rotor"))
    requirements = drawing_requirements("rotor", dimensions(design), design.choices)
    wide = [hole for hole in cylinders if hole.concave and hole.radius == pytest.approx(1.25)]
    assert {hole.is_central for hole in wide} == {True, False}
    assert all((requirements.thread(hole) is not None) == hole.is_central for hole in wide)
    mode, overrides = CASES["paper"]
    design = design_of("paper", {**overrides, "key_diameter": 2e-3, "link_dowel": "iso_8734_2"}, mode)
    dims = dimensions(design)
    cylinders = upright_cylinders(drawn_part(dims, "rotor"))
    requirements = drawing_requirements("rotor", dims, design.choices)
    wide = [hole for hole in cylinders if hole.concave and hole.radius == pytest.approx(0.5 * dims.link_dowel_diameter)]
    seats = [hole for hole in wide if requirements.seat(hole)]
    # The others are pockets that the PCL's keys are in, below the rotor.
    assert len(wide) > len(seats) == dims.count("dowels_fitted")
    assert all(seat.top == pytest.approx(dims.link_bottom_level) for seat in seats)


@pytest.mark.parametrize("case", ["tiles", "tiles in vanes", "paper", "blocks"])
def test_what_is_bought_whole_has_nominal_sizes_and_no_place(case):
    mode, overrides = CASES[case]
    design = design_of(case, overrides, mode)
    dims = dimensions(design)
    sheet = sheet_of(design, "heater", drawn_part(dims, "heater"))
    lines = [text.dxf.text for text in sheet.document.modelspace().query("TEXT")]
    is_whole = case.startswith("tiles")
    assert ("nominal sizes; limits as the maker's" in lines) == is_whole
    assert any("+0 / −0.1" in text for text in lines) != is_whole  # the others are ordered to their outline
    assert not any("axis" in text or "middle at" in text for text in lines)
    if is_whole:
        assert not any("°" in text or "Azimuth" in text for text in lines)
        # Four of the sides; a plate that bears the leads stands beyond the other.
        flats = {"tiles": {"10 wide, h 0 to 3.2 (3.2)", "18 wide, h 0 to 1.6 (1.6)", "20 wide, h 1.6 to 3.2 (1.6)"},
                 "tiles in vanes": {"3.8 wide, h 0 to 15 (15)", "15 wide, h 0 to 15 (15)"}}  # fmt: skip
        assert {text.removeprefix("flats ") for text in lines if text.startswith("flats ")} == flats[case]


@pytest.mark.gate
def test_every_seat_is_a_face_of_its_part():
    for case, mode, kinds in (
        (BEARING_BLOCKS, "compression", ("housing", "rotor", "adjuster", "cover")),
        ({}, "shear", ("housing", "rotor", "link")),
        (DRIVEN, "shear", ("motor_hub", "motor_housing")),
    ):
        design = milled(case, mode)
        for kind in kinds:
            requirements = drawing_requirements(kind, dimensions(design), design.choices)
            there = {requirements.seat(hole) for hole in upright_cylinders(drawn_part(dimensions(design), kind))}
            assert set(requirements.seats) <= there, kind


FRAME = 10.0  # mm from the paper's edge


@pytest.mark.parametrize("ratio", [1.5, 2.5])
def test_the_spring_sheet_tells_the_bend_and_both_mandrels(ratio):
    design = design_of("bent", {"tang_bend_ratio": ratio})
    dims = dimensions(design)
    lines = {line.name: line for line in spring_lines(design, dims, {})}
    assert float(lines["inside radius of the bend"].value) == pytest.approx(ratio * 2.413, abs=0.005)
    # The wound coil springs back to D, 24.41 mm: 2211/2.413^0.145 MPa over 196.5 GPa, an index of 10.1.
    assert float(lines["winding mandrel"].value) == pytest.approx(24.41 / (1 + 1.698 * 0.1002) - 2.41, abs=0.06)
    assert float(lines["measuring mandrel, at most"].value) == pytest.approx(2.0 * dims.post_radius, abs=0.005)


def test_no_words_of_the_spring_sheet_leave_its_frame():
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
    streams = [data[start.end() :] for start in re.finditer(rb"stream\n", data)]
    for stream in streams:
        with suppress(zlib.error):
            if "/DeviceRGB CS" in (text := zlib.decompressobj().decompress(stream).decode()):
                return text.splitlines()
    raise AssertionError("no content")


@pytest.mark.parametrize("scale", [0.5, 2.0])
def test_lines_are_as_wide_as_their_layer_says_at_any_scale(scale):
    sheet = DrawingSheet(scale)
    for layer in ("OUTLINE", "FINE", "CENTRE"):
        sheet.lines([(20.0, 30.0), (50.0, 30.0)], layer)
    lines = content(sheet)
    pens = [float(width) / MM for width in re.findall(r"([\d.]+) w", "\n".join(lines))]
    assert pens[-3:] == pytest.approx([0.5, 0.25, 0.18], abs=1e-3)
    assert lines.count(f"{round(20.0 * MM, 6)} {round(30.0 * MM, 6)} m") == 3


def test_a_circle_is_curves_and_letters_are_filled():
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
