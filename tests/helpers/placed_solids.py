"""Solids of a module's parts where they stand, for tests of what is between them."""

from collections.abc import Iterable

import cadquery as cq
from cad_designs import broken_rules

from tvimdesign.cad.assembly.assembly import MODULES, drawn_part, drawn_parts, place
from tvimdesign.cad.geometry.dimensions import Dimensions, dimensions
from tvimdesign.cad.inspection.size_checks import interference_checks, size_checks
from tvimdesign.study.design import Design


def build(design: Design, rotor_angle: float = 0.0) -> dict[str, cq.Solid]:
    """Return every part of a module where it stands, the rotor turned by an angle [rad]."""
    dims = dimensions(design)
    return place(dims, drawn_parts(dims), rotor_angle)


def placed_solids(dims: Dimensions, kinds: Iterable[str]) -> dict[str, cq.Solid]:
    """Housing and pads, layer and what goes with them, of kinds of parts that are drawn, by the name of each."""
    drawn = {kind: drawn_part(dims, kind) for kind in kinds}
    standing = MODULES[dims.mode].stand_heaters(dims, drawn, 0.0)
    return {"housing": drawn["housing"], **{name: shape.Solids()[0] for name, shape in standing.items()}}


def assert_sound(design: Design, placed: dict[str, cq.Solid], sizes: Iterable[str]) -> None:
    """Assert that a design satisfies its rules, its solids have their sizes, and none cuts another."""
    assert broken_rules(design) == []
    checks = {check.name: check for check in size_checks(design, placed) if check.name in {*sizes}}
    assert sorted(checks) == sorted(sizes)
    assert [check.text for check in checks.values() if not check.ok] == []
    assert [check.text for check in interference_checks(placed, "here") if not check.ok] == []
