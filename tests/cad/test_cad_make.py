"""The child process and its files; random designs within a study's bounds are refused by a named rule, or sound."""

import hashlib
import json
import queue
import re
import subprocess
import sys
from pathlib import Path

import cadquery as cq
import matplotlib.image
import numpy as np
import pytest
import random_choices
import random_designs
import trimesh
from manifold3d import Manifold, Mesh64
from plate_copies import copies_on_a_plate
from support import study_path

from tvimdesign.base import processes
from tvimdesign.base.child_process import read_lines
from tvimdesign.base.errors import GeometryError, InputError
from tvimdesign.base.processes import ProcessorLimit, ProcessorTimeError
from tvimdesign.cad import make, make_cad
from tvimdesign.cad.assembly.assembly import MODULES
from tvimdesign.cad.assembly.assembly_data import _linear
from tvimdesign.cad.export.step_file import Product, in_fixed_order, write_assembly
from tvimdesign.cad.geometry.dimensions import dimensions
from tvimdesign.cad.geometry.kinds import KINDS
from tvimdesign.cad.make import _messages, _report
from tvimdesign.device import table_for
from tvimdesign.study import read_study
from tvimdesign.study.design import write_design

COPIES = {"shear": 4, "compression": 12}
"""Pads, and pieces of PCL, of the paper's size."""


@pytest.mark.gate
def test_every_file_is_there_and_every_check_holds(made):
    design, report, steps, _ = made
    assert report.failed == ()
    assert report.notes == ()
    assert report.reused == ()
    expected = {"assembly.step", "assembly.glb", "assembly.json", "assembly.md", "bom.csv", "preview.png",
                "views/exploded.png", "views/section.png", "views/wiring.svg", "module.py", "springs/spring.pdf",
                "springs/spring.csv", "print/plate_1.3mf"}  # fmt: skip
    pictures = {file for file in report.files if file.startswith("views/step_")}
    note = (report.folder / "assembly.md").read_text("utf-8")
    assert sorted(pictures) == sorted(re.findall(r"\((views/step_\d+\.png)\)", note))
    assert len(pictures) == len(re.findall(r"^\d+\. ", note, re.M))
    expected |= pictures
    for kind in MODULES[design.mode].kinds(dimensions(design)):
        expected.add(f"step/{kind}.step")
        bought = kind in {"heater", "heater_lead", "spring_right", "spring_left", "link_screw", "link_dowel",
                          "retainer_screw", "thermal_cutout", "link_insert", "retainer_insert"}  # fmt: skip
        expected |= set() if bought else {f"print/{kind}.stl", f"print/{kind}.3mf"}
    expected |= {f"step/{piece}.step" for piece in ("casting_mould", "casting_lid", "setting_fork")}
    expected |= {
        f"{folder}/{piece}.{form}"
        for piece in ("casting_mould", "casting_lid", "setting_fork")
        for folder, form in (("print", "stl"), ("print", "3mf"), ("drawings", "dxf"), ("drawings", "pdf"))
    }
    expected |= {
        f"{folder}/test_pieces.{form}" for folder, form in (("step", "step"), ("print", "stl"), ("print", "3mf"))
    }
    cast = "pcl_arc" if design.mode == "shear" else "pcl_block"
    for kind in ("housing", "rotor", "link", "retainer", "heater", cast, "assembly"):
        expected |= {f"drawings/{kind}.dxf", f"drawings/{kind}.pdf"}
    cut = {file for file in report.files if file.endswith("_cut.dxf")}
    assert {"drawings/link_cut.dxf", "drawings/retainer_cut.dxf"} <= cut
    expected |= cut
    assert set(report.files) == expected
    files = {path.relative_to(report.folder).as_posix() for path in report.folder.rglob("*") if path.is_file()}
    assert files == set(report.files)
    names = {step.partition(", ")[2] for step in steps}  # beside its number among all
    assert {f"drawing: {kind}" for kind in ("housing", "rotor", "spring right")} <= names


@pytest.mark.gate
def test_the_bed_has_every_printed_part_on_its_flat_side(made):
    copies = copies_on_a_plate((made.report.folder / "print/plate_1.3mf").read_bytes())
    names = [name for name, _ in copies]
    # PETG is too soft for the casting jig.
    assert sorted(names) == ["housing", "link", "retainer", "rotor", "setting_fork", "setting_fork"]
    bodies = [Manifold(Mesh64(body.vertices, body.faces.astype(np.uint64))) for _, body in copies]
    for number, (name, body) in enumerate(copies):
        printed = trimesh.load_mesh(made.report.folder / f"print/{name}.stl")
        assert body.volume == pytest.approx(printed.volume, rel=1e-6), name
        assert body.bounds[0][2] == pytest.approx(0.0, abs=1e-6), name
        assert (body.bounds[0][:2] > 2.5).all(), name
        assert (body.bounds[1] < [217.5, 217.5, 250.0]).all(), name
        assert all(bodies[number].min_gap(other, 10.0) >= 5.0 for other in bodies[:number]), name
    check = next(check for check in made.report.checks if check.name == "print/plate_1.3mf")
    assert check.ok


@pytest.mark.gate
def test_moving_parts_are_compared_with_all_they_could_meet(made):
    pairs = {
        "shear": {"rotor | spring_right_1", "housing | spring_left_2"},
        "compression": {"rotor | pcl_block_1", "heater_2 | pcl_block_1", "housing | pcl_block_1"},
    }
    reported = {check.name for check in made.report.checks}
    # From stop to stop, 0.02 rad beyond the stroke of 0.104 rad.
    for angle in ("-0.1240", "-0.0620", "+0.0620", "+0.1240") if made.whole else ("-0.1240",):
        assert {f"{pair} at {angle} rad" for pair in pairs[made.design.mode]} <= reported


@pytest.mark.gate
def test_step_and_mesh_read_back_with_names_and_colours(made):
    for kind in MODULES[made.design.mode].kinds(dimensions(made.design)):
        copies = {"link_screw": 4, "link_insert": 4, "link_dowel": 4}.get(kind, 1)
        if kind in ("pcl_arc", "pcl_block", "heater", "heater_lead"):
            copies = COPIES[made.design.mode] * (2 if kind == "heater_lead" else 1)
        expected = 1e9 * made.design.values[KINDS[kind].volume] / copies
        solid = cq.importers.importStep(str(made.report.folder / f"step/{kind}.step")).val()
        assert isinstance(solid, cq.Solid)
        assert solid.Volume() == pytest.approx(expected, rel=1e-5), kind
        printed = made.report.folder / f"print/{kind}.stl"
        if printed.exists():
            mesh = trimesh.load_mesh(printed)
            assert mesh.is_watertight, kind
            assert mesh.volume == pytest.approx(expected, rel=1e-2), kind
            assert mesh.bounds[0][2] == pytest.approx(0.0, abs=1e-6), f"{kind} is not on the bed"
    path = made.report.folder / "assembly.step"
    parts = {name: (shape, colour) for shape, name, _, colour in cq.Assembly.importStep(str(path))}
    # Four of the kinds made once, the cut-out, springs, five screws and as many inserts, four pins; two leads a pad.
    assert len(parts) == 23 + 4 * COPIES[made.design.mode]
    for name, (shape, colour) in parts.items():
        kind = name.split("/")[-1].rstrip("_0123456789")
        assert isinstance(shape, cq.Solid)
        assert colour.toTuple()[:3] == pytest.approx(KINDS[kind].colour, abs=0.01)
    text = path.read_text()
    assert "AP242" in text
    assert "'petg'" in text
    assert "2000-01-01T00:00:00" in text
    scene = trimesh.load_scene(made.report.folder / "assembly.glb")
    values = made.design.values
    width, height = values["envelope_diameter"], values["envelope_height"]
    assert scene.extents == pytest.approx([width, height, width], rel=1e-3)
    assert {"housing", "spring_left_4", f"heater_{COPIES[made.design.mode]}"} <= set(scene.graph.nodes_geometry)
    # glTF 2.0, 3.9.2: factors are linear. By IEC 61966-2-1 half of full sRGB is 0.214 of the light.
    assert _linear(0.5) == pytest.approx(0.2140, abs=5e-5)
    factors = scene.geometry["rotor"].visual.material.baseColorFactor[:3] / 255.0
    assert factors == pytest.approx([_linear(part) for part in KINDS["rotor"].colour], abs=1.0 / 255.0)


@pytest.mark.gate
def test_pictures_show_the_parts_and_what_is_cut(made):
    image = matplotlib.image.imread(made.report.folder / "views/section.png")[:560, :, :3]
    for kind in ("heater", "pcl_arc" if made.design.mode == "shear" else "pcl_block", "rotor", "housing"):
        hue = np.array(KINDS[kind].colour) / max(KINDS[kind].colour)
        bright = image.max(axis=2)
        alike = np.abs(image / np.maximum(bright, 1e-6)[:, :, None] - hue).max(axis=2) < 0.06
        assert np.count_nonzero(alike & (bright > 0.3)) > 150, kind
    rows, columns = np.nonzero(np.any(image < 0.95, axis=2))
    assert rows.min() > 0  # nothing is cropped
    assert columns.min() > 0
    assert columns.max() < image.shape[1] - 1
    image = matplotlib.image.imread(made.report.folder / "preview.png")[:700, :, :3]
    drawn = np.any(np.abs(image - 1.0) > 0.05, axis=2)
    assert 0.2 < drawn.mean() < 0.9
    for colour in ((0.92, 0.62, 0.20), (0.95, 0.93, 0.82), (0.15, 0.48, 0.38)):
        assert np.any(np.abs(image - colour).max(axis=2) < 0.1)


@pytest.mark.slow
def test_a_design_gives_the_same_bytes_on_another_day(made, tmp_path, monkeypatch):
    write_design(made.design, tmp_path / "design.json")
    monkeypatch.setenv("PYTHONHASHSEED", "12345")
    monkeypatch.setenv("SOURCE_DATE_EPOCH", "1700000000")
    again = make_cad(tmp_path / "design.json", tmp_path / "again")
    assert again.reused == ()
    for name in made.report.files:
        first, second = ((folder / name).read_bytes() for folder in (made.report.folder, again.folder))
        assert hashlib.sha256(first).digest() == hashlib.sha256(second).digest(), name


def test_colours_are_written_in_the_order_of_their_parts():
    def block(number: int, context: int) -> str:
        styles = "MECHANICAL_DESIGN_GEOMETRIC_PRESENTATION_REPRESENTATION"
        return (
            f"#{number} = {styles}('',(\n    #{number + 1}),#{context});\n#{number + 1} = COLOUR_RGB('',0.{context});\n"
        )

    head, end = "#1 = A();\n#2 = B();\n", "ENDSEC;\n"
    ordered = in_fixed_order(head + block(3, 2) + block(5, 1) + end)
    other = in_fixed_order(head + block(3, 1) + block(5, 2) + end)
    assert ordered == other
    assert ordered.startswith(head + "#3 = MECHANICAL")
    assert "#4),#1);" in ordered
    assert ordered.endswith(end)
    styles, colour = "MECHANICAL_DESIGN_GEOMETRIC_PRESENTATION_REPRESENTATION", "COLOUR_RGB('',0.3);\n"
    ordered = in_fixed_order(f"{head}#3 = {styles}('',(#4),#1);\n#4 = {colour}#5 = {styles}('',(#4),#2);\n{end}")
    other = in_fixed_order(f"{head}#3 = {styles}('',(#4),#2);\n#4 = {colour}#5 = {styles}('',(#4),#1);\n{end}")
    assert ordered == other == f"{head}#3 = {styles}('',(#4),#1);\n#4 = {colour}#5 = {styles}('',(#4),#2);\n{end}"


def test_a_name_in_any_script_survives_step(tmp_path):
    box = cq.Solid.makeBox(1, 1, 1)
    product = Product(name="box", colour=(1, 0, 0), material="Stahl für Übung", density=7850.0)
    write_assembly(tmp_path / "a.step", "Gelenk ü'; #5 = 日本", {"box_1": box}, {"box_1": product})
    assert (tmp_path / "a.step").read_bytes().isascii()
    assert cq.Assembly.importStep(str(tmp_path / "a.step")).name == "Gelenk ü'; #5 = 日本"


@pytest.mark.slow
def test_a_coil_that_cannot_be_built_names_the_spring(job):
    with pytest.raises(GeometryError, match="spring"):
        job(coil_diameter=2.1e-3)


@pytest.mark.slow
def test_a_part_the_model_has_wrong_is_written_and_reported(job):
    report = job(retainer_thickness=2.6e-3)
    assert "retainer_volume" in {check.name for check in report.failed}
    assert (report.folder / "step/retainer.step").exists()


def test_a_process_that_reports_no_progress_is_an_error(job, monkeypatch):
    monkeypatch.setattr(make, "LIMIT", 0.05)
    monkeypatch.setattr(processes, "CHECK_EVERY", 0.05)
    with pytest.raises(GeometryError, match=r"the CAD process failed: it was stopped after 0.05 s of processor time"):
        job()


@pytest.mark.slow
def test_a_child_that_reports_progress_gets_more_time(monkeypatch):
    monkeypatch.setattr(processes, "CHECK_EVERY", 0.05)
    burn = "    end = time.process_time() + 0.4\n    while time.process_time() < end: pass\n"
    says = f"import json, time\nfor step in range(8):\n    print(json.dumps({{'progress': step}}), flush=True)\n{burn}"
    for more, ends in (("", True), ("while True: pass", False)):
        child = subprocess.Popen([sys.executable, "-S", "-c", says + more], stdout=subprocess.PIPE, text=True)
        try:
            lines: queue.Queue[str | None] = queue.Queue()
            read_lines(child, lines.put)
            heard = _messages(lines, ProcessorLimit(child.pid, 2.5))  # eight steps are 3.2 s
            assert [next(heard)["progress"] for _ in range(8)] == list(range(8))
            with pytest.raises(StopIteration if ends else ProcessorTimeError):
                next(heard)
        finally:
            child.kill()
            child.wait()


def test_a_crash_names_the_part():
    with pytest.raises(GeometryError, match="rotor: the CAD process ended with code -11"):
        _report(Path(), {"progress": "rotor"}, "the CAD process ended with code -11", "")


@pytest.mark.gate
def test_no_design_is_an_input_error(tmp_path):
    with pytest.raises(InputError, match="no such file"):
        make_cad(tmp_path / "none.json", tmp_path / "cad")


STUDIES = {"shear": "wrist_joint", "compression": "wrist_compression"}


def tally(mode: str, count: int) -> random_designs.Tally:
    return random_designs.run(read_study(study_path(STUDIES[mode])), count, seed=20)


@pytest.mark.slow
@pytest.mark.parametrize(("mode", "count"), [("shear", 12), ("compression", 8)])
def test_designs_of_either_mode_that_keep_the_rules_are_sound(mode, count):
    counted = tally(mode, count)
    assert counted.failed == []
    assert counted.built == count
    assert counted.refused["rotor_spring_gap"] > 0


@pytest.mark.slow
def test_a_design_with_a_fault_is_reported():
    draws = random_designs.Draws(read_study(study_path("wrist_joint")), seed=20)
    good = next(draws.keeping_rules(1, random_designs.Tally()))
    bad = good.model_copy(update={"values": good.values | {"housing_volume": 1.01 * good.value("housing_volume")}})
    wrong, _ = random_designs.faults(bad, inspect=False)
    assert [text.split(":")[0] for text in wrong] == ["housing_volume"]


@pytest.mark.slow
def test_slivers_are_reported_where_a_process_makes_only_thick_walls():
    draws = random_designs.Draws(read_study(study_path("wrist_compression")), seed=20)
    good = next(draws.keeping_rules(1, random_designs.Tally()))
    assert random_designs.slivers(good) == []
    thick = good.model_copy(update={"values": good.values | {"minimum_wall": 1.5 * good.value("minimum_wall")}})
    assert any("the thinnest wall" in text for text in random_designs.slivers(thick))


def test_random_choices_are_refused_by_name_or_satisfy_the_rules():
    drawn = [random_choices.drawn(index, 3, inspect=True) for index in range(12)]
    ended = [choice for choice in drawn if isinstance(choice, random_choices.Ended)]
    assert len(ended) < len(drawn)
    assert {choice.by for choice in ended} <= {row.name for mode in STUDIES for row in table_for(mode).quantities}


@pytest.mark.slow
def test_modules_of_random_choices_are_sound():
    built = [choice for choice in random_choices.run(range(12), 3, inspect=True, hands=1) if choice.how == "built"]
    assert built
    assert [fault for choice in built for fault in choice.faults] == []


def test_a_draw_that_is_in_the_file_is_not_drawn_again(tmp_path, capsys):
    file = tmp_path / "draws.jsonl"
    ended = [random_choices.Ended(index, 1, False, "built", faults=["a gap"] * index) for index in range(2)]
    file.write_text("".join(json.dumps(choice._asdict()) + "\n" for choice in ended))
    assert random_choices.main(["--draws", "2", "--out", str(file)]) == 1
    assert "2 draws: 0 refused by the reader, 0 without" in (printed := capsys.readouterr().out)
    assert "draw 1 of seed 1: a gap" in printed
