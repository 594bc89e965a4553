"""Data and script of an assembly, compared with its GLB, its note and the CAD kernel's own solids."""

from __future__ import annotations

import json
import re
from typing import Any

import cadquery as cq
import numpy as np
import pytest
from cad_designs import CASES, design_of

from tvimdesign.cad.assembly.assembly import MODULES, drawn_parts, installed_coils, spring_locations
from tvimdesign.cad.assembly.assembly_data import SHARES, assembly_data, brought
from tvimdesign.cad.assembly.assembly_note import WrittenStep
from tvimdesign.cad.assembly.bill_of_materials import Item
from tvimdesign.cad.assembly.module_script import module_script
from tvimdesign.cad.export.mesh import CHORD, RING, Instance, Mesh, spring_mesh
from tvimdesign.cad.geometry.dimensions import Dimensions, dimensions
from tvimdesign.cad.geometry.kinds import SPRINGS
from tvimdesign.cad.geometry.spring_solids import wire_edges


@pytest.fixture(scope="module")
def dims() -> Dimensions:
    return dimensions(design_of("paper", {}))


@pytest.fixture(scope="module")
def data(dims: Dimensions) -> dict[str, Any]:
    """Return the data of the paper's module; springs and a housing stand for all its parts."""
    meshes = {kind: spring_mesh(coil) for kind, coil in installed_coils(dims).items()}
    placed = {name: Instance(meshes[name.rpartition("_")[0]], np.eye(4)) for name in spring_locations(dims)}
    box = cq.Workplane().box(60, 60, 20).val().tessellate(0.1)
    placed["housing"] = Instance(Mesh(np.array([v.toTuple() for v in box[0]]), np.array(box[1])), np.eye(4))
    kinds = {"housing": 1, **dict.fromkeys(SPRINGS, 2)}
    items = [Item(kind, count, kind == "housing", "", f"what {kind} is of", 10.0, ()) for kind, count in kinds.items()]
    page_data: dict[str, Any] = json.loads(assembly_data(design_of("paper", {}), dims, items, placed))
    return page_data


def test_parts_have_their_kind_and_steps_come_from_their_side(data):
    parts = {part["name"]: part for part in data["parts"]}
    assert {part["kind"] for part in parts.values()} == {"housing", *SPRINGS}
    assert not any(part["turns"] for part in parts.values())  # neither housing nor springs turn with the rotor
    assert parts["spring_right_1"]["lift"] > parts["housing"]["lift"]
    place = ({"part": "pcl_arc", "from": "above"}, {"part": "rotor", "from": "above"}, {"part": "nut", "from": "below"})
    step = brought(WrittenStep("Set the rotor.", [], place), ["rotor", "pcl_arc_1", "pcl_arc_2", "link"])
    assert step == {"text": "Set the rotor.", "parts": ["pcl_arc_1", "pcl_arc_2", "rotor"], "from": "above"}
    assert brought(WrittenStep("Look."), ["rotor"]) == {"text": "Look.", "parts": [], "from": ""}


@pytest.mark.parametrize("kind", SPRINGS)
def test_a_wound_spring_lies_on_the_wire_that_the_kernel_sweeps(data, dims, kind):
    mirror = np.array([1.0, 1.0 if kind == "spring_right" else -1.0, 1.0])
    mesh = spring_mesh(installed_coils(dims)[kind]).vertices * mirror
    for share, flat in zip(SHARES, data["wires"]["moved"][kind], strict=True):
        moved = np.array(flat).reshape(-1, 3)
        rings = mesh[: RING * len(moved)].reshape(-1, RING, 3).mean(axis=1) + moved
        wire = cq.Wire.assembleEdges(wire_edges(installed_coils(dims, share * dims.stroke)[kind]))
        away = [cq.Vertex.makeVertex(*point).distance(wire) for point in rings * mirror]
        assert max(away) < CHORD
        assert np.abs(moved[-1]).max() > 0.5  # mm: the leg's end goes along with its pin
        assert np.abs(moved[0]).max() < 0.25  # the tang stays in its hole, but for what the coil's diameter changes


EXACT = 1e-9


def script_of(name: str) -> tuple[Dimensions, str]:
    mode, changes = CASES[name]
    design = design_of(name, changes, mode)
    return dimensions(design), module_script(design, dimensions(design)).decode()


def drawn_by(script: str) -> dict[str, Any]:
    assert "tvimdesign" not in script.partition('"""\n')[2]
    names: dict[str, Any] = {"__name__": "script"}
    exec(compile(script, "module.py", "exec"), names)
    return names


@pytest.mark.parametrize(
    "name",
    [
        "paper",
        pytest.param("tiles", marks=pytest.mark.gate),
        pytest.param("driven", marks=pytest.mark.gate),
        pytest.param("odd blocks", marks=pytest.mark.gate),
        pytest.param("tiles in vanes", marks=pytest.mark.gate),
    ],
)
def test_its_solids_and_their_places_are_those_of_the_module(name):
    dims, script = script_of(name)
    names, solids = drawn_by(script), drawn_parts(dims)
    assert names["PARTS"].keys() == solids.keys()
    for kind, draw in names["PARTS"].items():
        assert draw().Volume() == pytest.approx(solids[kind].Volume(), rel=EXACT), kind
    stand = MODULES[dims.mode].stand(dims, solids)
    assert names["PLACES"].keys() == stand.keys()
    for part, (kind, location) in names["PLACES"].items():
        off = stand[part].Center() - solids[kind].moved(location).Center()
        assert off.Length < 1e-6, part


def test_a_part_follows_a_number_that_is_changed():
    dims, script = script_of("paper")
    thicker = re.sub(r"^link_thickness = .*$", f"link_thickness = {2.0 * dims.link_thickness}", script, flags=re.M)
    before, after = (drawn_by(text)["PARTS"]["link"]().Volume() for text in (script, thicker))
    assert after == pytest.approx(2.0 * before, rel=EXACT)
