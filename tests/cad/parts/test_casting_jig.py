"""The casting jig around the parts that are cast in it: closed, as thick as the layer, and a fixture of its own."""

from __future__ import annotations

import cadquery as cq
import pytest
from cad_designs import BLOCKS, design_of

from tvimdesign.cad.assembly.assembly import drawn_part
from tvimdesign.cad.geometry.dimensions import Dimensions, dimensions
from tvimdesign.cad.inspection.inspect import casting_checks, casting_gap
from tvimdesign.cad.parts import casting_jig

CASES = {"keyed arc": ("shear", {}), "plain arc": ("shear", {"key_count": 0.0}), "block": ("compression", BLOCKS)}


def jig(name: str) -> tuple[Dimensions, str, dict[str, cq.Solid]]:
    mode, changes = CASES[name]
    dims = dimensions(design_of(name, changes, mode))
    kind = "pcl_arc" if mode == "shear" else "pcl_block"
    part = drawn_part(dims, kind)
    return dims, kind, {kind: part} | {piece: draw(dims, part).Solids()[0] for piece, draw in casting_jig.DRAWN.items()}


@pytest.mark.parametrize("name", CASES)
def test_the_jig_goes_together_and_its_gap_is_the_layer_s_thickness(name: str) -> None:
    dims, kind, solids = jig(name)
    checks = {check.name: check for check in casting_checks(dims, kind, solids)}
    assert [check.text for check in checks.values() if not check.ok] == []
    assert all(solids[piece].isValid() for piece in casting_jig.DRAWN)
    # 1 mm of the default layer; 3.5 mm of the default block above a clearance of 0.4.
    wanted = dims.pcl_thickness if kind == "pcl_arc" else dims.vane_height - dims.running_clearance
    assert casting_gap(dims, solids["casting_mould"], solids["casting_lid"]) == pytest.approx(wanted, abs=1e-9)


@pytest.mark.parametrize("name", CASES)
def test_the_closed_jig_holds_a_room_of_the_part_s_volume(name: str) -> None:
    _, kind, solids = jig(name)
    pieces = [solids[piece] for piece in casting_jig.DRAWN]
    around = cq.Compound.makeCompound(pieces).BoundingBox()
    block = cq.Solid.makeBox(around.xlen, around.ylen, around.zlen, cq.Vector(around.xmin, around.ymin, around.zmin))
    rooms = [room.Volume() for room in block.cut(*pieces).Solids()]
    assert any(room == pytest.approx(solids[kind].Volume(), rel=1e-6) for room in rooms), rooms


def test_a_lid_that_stands_too_high_fails_its_check() -> None:
    dims, kind, solids = jig("keyed arc")
    solids["casting_lid"] = solids["casting_lid"].translate(cq.Vector(0, 0, 0.05)).Solids()[0]
    failed = [check.name for check in casting_checks(dims, kind, solids) if not check.ok]
    assert failed == ["casting_jig: gap"]


def test_a_gap_in_the_dam_fails_its_check() -> None:
    dims, kind, solids = jig("plain arc")
    box = solids[kind].BoundingBox()
    slot = cq.Solid.makeBox(20.0, 1.0, 2.0, cq.Vector(box.xmax - 1.0, -0.5, 0.0))
    solids["casting_mould"] = solids["casting_mould"].cut(slot).Solids()[0]
    failed = [check.name for check in casting_checks(dims, kind, solids) if not check.ok]
    assert failed == ["casting_jig: melt"]
