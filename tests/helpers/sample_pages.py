"""A run's page for tests: a study of this repository evaluated, a front written by hand, parts that are boxes."""

import csv
import io
import json
from collections.abc import Mapping
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import trimesh
from PIL import Image
from support import study_path

from tvimdesign.base.atomic_files import atomic_write
from tvimdesign.base.results_folder import ResultsFolder
from tvimdesign.report.page.page_file import FILE
from tvimdesign.report.run.answered_study import AnsweredStudy, answer_study
from tvimdesign.report.run.run_page import finish
from tvimdesign.study.tree import tree_of_file

STUDY = study_path("paper_reconstructed")
REQUIREMENTS = (
    "joint_stiffness@hot=['>= 1.25 N.m/rad', '<= 20.5 N.m/rad']", "holding_torque=>= 1 N.m",
    "envelope_diameter=<= 160 mm",
    "envelope_height=<= 40 mm", "response_time=<= 100 s", "peak_voltage=<= 24 V", "peak_current=<= 3 A",
    "module_mass=<= 300 g", "stiffening_time=<= 400 s", "spring_stiffness=>= 2 N.m/rad",
)  # fmt: skip
"""Requirements that are added, as many as a study to order has."""
RING = 4
"""Points around the wire of the spring."""
LEG_MOVED = 2.5
"""How far the last ring of the spring moves at full stroke [mm]."""
_BOXES = {
    "housing": ((60.0, 60.0, 20.0), (0.0, 0.0, 0.0)), "heater": ((20.0, 20.0, 1.0), (0.0, 0.0, 12.0)),
    "pcl_arc_1": ((20.0, 20.0, 2.0), (0.0, 0.0, 13.5)), "rotor": ((40.0, 40.0, 6.0), (0.0, 0.0, 18.0)),
    "link": ((50.0, 12.0, 4.0), (15.0, 0.0, 23.0)),
}  # fmt: skip
"""Size and middle of each part [mm]."""
_TO_GLTF = np.array([[1e-3, 0, 0, 0], [0, 0, 1e-3, 0], [0, -1e-3, 0, 0], [0, 0, 0, 1.0]])


@cache
def answered_study() -> AnsweredStudy:
    """Return the study answered with requirements, and a front whose numbers are easy to follow."""
    answered = answer_study(tree_of_file(STUDY, [f"require.{limit}" for limit in REQUIREMENTS]), lambda _: None)
    names = {"response_time": "s", "module_mass": "g", "pcl_thickness": "mm"}
    points = [(100.0, 60.0, 2.0), (80.0, 70.0, 1.6), (60.0, 90.0, 1.2), (50.0, 120.0, 0.9), (45.0, 160.0, 0.6)]
    answered.reported["front"] = {
        "of": ["response_time", "module_mass"], "units_of_values": names,
        "points": [
            {"number": i, "status": "knee" if i == 3 else "between", "design": f"front/{i:02d}.design.json",
             "values": dict(zip(names, values, strict=True)), "si": {}}
            for i, values in enumerate(points, start=1)
        ],
        "knee": 3, "in_words": ["The knee is point 3."], "spread": 1.0, "sought": 5, "dominated": 0, "failures": [],
        "notes": [],
    }  # fmt: skip
    return answered


def run_page(folder: Path, *, parts: bool = True, more: Mapping[str, bytes] | None = None) -> Path:
    """Write the page into a folder, with parts or without, and with `more` files of parts; returns its path."""
    answered = answered_study()
    with ResultsFolder(folder) as results:
        if parts:
            write_parts(results.path / "cad")
            for name, data in (more or {}).items():
                atomic_write(results.path / "cad" / name, data)
        finish(results, answered)
    return folder / FILE


def write_parts(cad: Path) -> None:
    """Boxes and a bent wire with the files that CAD writes of a module."""
    for name in ("springs", "views", "step", "print"):
        (cad / name).mkdir(parents=True)
    for name in _BOXES:
        atomic_write(cad / f"step/{name}.step", f"ISO-10303-21; /* {name} */\n".encode())
    atomic_write(cad / "print/housing.3mf", b"PK of the housing")
    for name, size in (("preview.png", (1800, 800)), ("views/exploded.png", (1000, 1300))):
        picture = io.BytesIO()
        Image.new("RGB", size, "white").save(picture, "png")
        atomic_write(cad / name, picture.getvalue())
    scene = trimesh.Scene()
    for name, (size, middle) in _BOXES.items():
        place = np.eye(4)
        place[:3, 3] = middle
        scene.add_geometry(trimesh.creation.box(size), node_name=name, geom_name=name, transform=_TO_GLTF @ place)
    scene.add_geometry(_wire(), node_name="spring_right_1", geom_name="spring_right", transform=_TO_GLTF)
    atomic_write(cad / "assembly.glb", scene.export(file_type="glb", include_normals=True))
    atomic_write(cad / "assembly.json", json.dumps(_model_data()).encode())
    atomic_write(cad / "checks.json", json.dumps({"checks": [_check("pass"), _check("warning")]}).encode())
    _table(cad / "bom.csv", {
        "item": 1, "part": "housing", "quantity": 1, "made_or_bought": "made", "title": "PETG", "fit": "",
        "mass_each_g": "45.571", "mass_all_g": "45.571", "number": "", "price": "made",
        "files": "step/housing.step print/housing.3mf",
    })  # fmt: skip
    _table(
        cad / "springs/spring.csv", {"name": "rate", "value": 24.474, "unit": "N.mm/deg", "tolerance": "", "note": ""}
    )


def _wire() -> trimesh.Trimesh:
    """Three rings of a wire along x, then the copies of the first and the last one that close it."""
    around = np.arange(RING) * 2.0 * np.pi / RING
    rings = [np.column_stack([np.full(RING, 10.0 * i), 30.0 + np.cos(around), 15.0 + np.sin(around)]) for i in range(3)]
    faces = [(RING * k + i, RING * k + (i + 1) % RING, RING * (k + 1) + i) for k in range(2) for i in range(RING)]
    ends = [(3 * RING + i, 3 * RING + i + 1, 3 * RING + i + 2) for i in (0, 1)]
    ends += [(4 * RING + i, 4 * RING + i + 1, 4 * RING + i + 2) for i in (0, 1)]
    return trimesh.Trimesh(np.vstack([*rings, rings[0], rings[2]]), [*faces, *ends], process=False)


def _model_data() -> dict[str, Any]:
    """Return assembly.json for the boxes."""
    names = [*_BOXES, "spring_right_1"]
    moved = [[0.0] * 6 + [0.0, share * LEG_MOVED, 0.0] for share in (-1.0, -0.5, 0.5, 1.0)]
    return {
        "mode": "shear", "stroke": 0.1,
        "parts": [
            {"name": name, "kind": name.rstrip("_1"), "title": f"material of {name}", "made": True, "mass": 1.5,
             "turns": name in {"rotor", "link"}, "files": [f"step/{name}.step"], "lift": 30.0 * i}
            for i, name in enumerate(names)
        ],
        "steps": [
            {"text": "Deburr all parts.", "parts": ["housing"], "from": "above"},
            {"text": "Lay the pad and the arc into it.", "parts": ["heater", "pcl_arc_1"], "from": "above"},
            {"text": "Set the rotor, spring and link.", "parts": ["rotor", "spring_right_1", "link"], "from": "below"},
        ],
        "wires": {"ring": RING, "shares": [-1.0, -0.5, 0.5, 1.0], "moved": {"spring_right": moved}},
    }  # fmt: skip


def _check(level: str) -> dict[str, Any]:
    return {"level": level, "text": f"a {level}", "value": 1.0, "limit": 2.0, "unit": "mm", "basis": "exact"}


def _table(path: Path, row: dict[str, Any]) -> None:
    text = io.StringIO(newline="")
    writer = csv.DictWriter(text, list(row))
    writer.writeheader()
    writer.writerow(row)
    atomic_write(path, text.getvalue().encode("utf-8-sig"))
