"""Which checks a part gets by the way it is made, and which the module as a whole."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

import cadquery as cq

from tvimdesign.cad.assembly import place
from tvimdesign.cad.dimensions import Dimensions
from tvimdesign.cad.export import instances
from tvimdesign.cad.features import holes
from tvimdesign.cad.inspection.coils import coil_checks
from tvimdesign.cad.inspection.corners import corner_checks, hole_check
from tvimdesign.cad.inspection.finding import at_least, finding
from tvimdesign.cad.inspection.milling import milling_checks
from tvimdesign.cad.inspection.order import order_checks
from tvimdesign.cad.inspection.printing import bed_check, printing_checks
from tvimdesign.cad.inspection.rays import Triangles
from tvimdesign.cad.inspection.walls import wall_checks
from tvimdesign.cad.making import MAKING
from tvimdesign.cad.mesh import solid_mesh
from tvimdesign.cad.outcome import Check
from tvimdesign.cad.parts import link_screws, mounts
from tvimdesign.device import table_for
from tvimdesign.study.design import Design
from tvimdesign.units import from_si


def part_checks(design: Design, dims: Dimensions, kind: str, solid: cq.Solid) -> list[Check]:
    """Hold one made part against its process: all it needs is its own solid."""
    mesh = solid_mesh(solid)
    triangles = Triangles(mesh)
    bed = (dims.bed_length, dims.bed_width, dims.bed_height)
    found = [solid_check(kind, solid), *wall_checks(kind, triangles, dims.minimum_wall, dims.thinnest_wall)]
    if design.choices.get("making_method") == "milled":
        drilled = holes(solid)
        found += milling_checks(kind, triangles, drilled, dims.pocket_depth_ratio)
        found += corner_checks(kind, solid, dims.corner_radius, dims.corner_depth_ratio)
        found += [hole_check(kind, drilled, dims.hole_depth_ratio)]
        return [*found, bed_check(kind, triangles.upper - triangles.lower, bed)]
    down = MAKING[kind].down
    return [*found, *printing_checks(kind, mesh, down, dims.overhang_angle, dims.bridge_span, bed)]


def solid_check(kind: str, shape: cq.Shape) -> Check:
    """Whether a part is one valid solid."""
    count, sound = len(shape.Solids()), shape.isValid()
    text = f"{count} solid{'' if count == 1 else 's'}, {'valid' if sound else 'not valid'}"
    return finding(kind, "solid", count, 1.0, "", "pass" if count == 1 and sound else "failure", text)


def module_checks(design: Design, dims: Dimensions, drawn: Mapping[str, cq.Solid]) -> Iterator[Check]:
    """Hold the module against its own rules, its springs as they wind, its screws, and the order of its assembly."""
    yield from rule_checks(design)
    yield from coil_checks(dims)
    yield from thread_checks(dims, drawn)
    yield from order_checks(dims, instances(dims, drawn, place(dims, drawn)))


def rule_checks(design: Design) -> Iterator[Check]:
    """Hold the design against the rules of the table that say what can be made and put together; exact."""
    for row in table_for(design.mode).outputs:
        if row.group != "Gaps" or row.name not in design.values:
            continue
        value = from_si(design.value(row.name), row.unit)
        for rule in (rule for rule in row.rules if rule.applies(design.choices)):
            limit = from_si(rule.value, row.unit)
            room = value - limit if rule.sense == ">=" else limit - value
            level = at_least(room, -1e-6 * max(1.0, abs(limit)), -float("inf"))
            text = f"{row.name} is {value:.4g} {row.unit}, {rule.sense} {limit:.4g}"
            reason = f": {rule.reason}" if level != "pass" else ""
            yield finding("module", f"rule {row.name}", value, limit, row.unit, level, text + reason)


def thread_checks(dims: Dimensions, drawn: Mapping[str, cq.Solid]) -> Iterator[Check]:
    """How much of each kind of screw is in its hole in core or motor hub, over its diameter; read off both solids."""
    screws = [
        ("link_screw", "rotor", link_screws(dims)[0], dims.link_screw_diameter),
        ("retainer_screw", "rotor", (0.0, 0.0), dims.retainer_screw_diameter),
        ("motor_screw", "motor_hub", (0.0, 0.0), dims.motor_screw_diameter),
        ("mount_screw", "motor_hub", mounts(dims)[0], dims.mount_screw_diameter),
    ]
    for kind, into, at, diameter in screws:
        if kind not in drawn:
            continue
        screw = drawn[kind].BoundingBox()
        pilots = [
            hole for hole in holes(drawn[into])
            if abs(hole.x - at[0]) < 1e-4 and abs(hole.y - at[1]) < 1e-4
        ]  # fmt: skip
        engaged = sum(max(0.0, min(hole.top, screw.zmax) - max(hole.bottom, screw.zmin)) for hole in pilots)
        ratio = engaged / diameter
        where = "the core" if into == "rotor" else "the motor's hub"
        text = f"{engaged:.3g} mm of thread in {where}, {ratio:.3g} diameters; {dims.thread_engagement:.3g} are wanted"
        level = at_least(ratio, dims.thread_engagement - 1e-6, 1.0)
        yield finding(kind, "thread", ratio, dims.thread_engagement, "", level, text)
