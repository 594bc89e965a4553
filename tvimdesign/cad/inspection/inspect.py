"""Which checks a part gets by the way it is made, and which the module as a whole."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

import cadquery as cq

from tvimdesign.base.units import from_si
from tvimdesign.cad.assembly.assembly import place
from tvimdesign.cad.assembly.product_data import instances
from tvimdesign.cad.cad_report import SolidCheck
from tvimdesign.cad.export.mesh import Mesh, solid_mesh
from tvimdesign.cad.geometry.dimensions import Dimensions
from tvimdesign.cad.geometry.features import holes
from tvimdesign.cad.geometry.production import PRODUCTION, supported_levels
from tvimdesign.cad.inspection.coils import coil_checks
from tvimdesign.cad.inspection.corners import corner_checks, hole_check
from tvimdesign.cad.inspection.finding import at_least, finding
from tvimdesign.cad.inspection.fits import fit_checks
from tvimdesign.cad.inspection.milling import milling_checks
from tvimdesign.cad.inspection.order import order_checks
from tvimdesign.cad.inspection.printing import bed_check, printing_checks
from tvimdesign.cad.inspection.rays import Triangles
from tvimdesign.cad.inspection.walls import wall_checks
from tvimdesign.cad.parts.common_parts import between_springs, link_screws, mounts
from tvimdesign.cad.parts.insert_parts import insert_length
from tvimdesign.cad.parts.insert_parts import places as insert_places
from tvimdesign.device import table_for
from tvimdesign.study.design import Design


def part_checks(
    design: Design, dims: Dimensions, kind: str, solid: cq.Solid, mesh: Mesh | None = None
) -> list[SolidCheck]:  # fmt: skip
    """Hold one made part against its process: all it needs is its own solid, and its mesh if that is there."""
    mesh = mesh or solid_mesh(solid)
    triangles = Triangles(mesh)
    bed = (dims.bed_length, dims.bed_width, dims.bed_height)
    found = [solid_check(kind, solid), *wall_checks(kind, triangles, dims.minimum_wall, dims.thinnest_wall)]
    if design.choices.get("making_method") == "milled":
        drilled = holes(solid)
        found += milling_checks(kind, triangles, drilled, dims.pocket_depth_ratio)
        found += corner_checks(kind, solid, dims.corner_radius, dims.corner_depth_ratio)
        found += [hole_check(kind, drilled, dims.hole_depth_ratio)]
        return [*found, bed_check(kind, triangles.upper - triangles.lower, bed)]
    down, levels = PRODUCTION[kind].down, supported_levels(kind, dims)
    return [*found, *printing_checks(kind, mesh, down, dims.overhang_angle, dims.bridge_span, bed, levels)]


def solid_check(kind: str, shape: cq.Shape) -> SolidCheck:
    """Whether a part is one valid solid."""
    count, sound = len(shape.Solids()), shape.isValid()
    text = f"{count} solid{'' if count == 1 else 's'}, {'valid' if sound else 'not valid'}"
    return finding(kind, "solid", count, 1.0, "", "pass" if count == 1 and sound else "failure", text)


def module_checks(
    design: Design, dims: Dimensions, drawn: Mapping[str, cq.Solid], known: Mapping[str, Mesh] | None = None
) -> Iterator[SolidCheck]:
    """Hold the module against its own rules, its springs as they wind, its screws, and the order of its assembly.

    `known` are meshes of the drawn parts that are made already, by kind.
    """
    yield from rule_checks(design)
    yield from coil_checks(dims)
    yield from thread_checks(dims, drawn)
    placed = place(dims, drawn)
    yield from fit_checks(dims, placed)
    yield from order_checks(dims, instances(dims, drawn, placed, known))


def rule_checks(design: Design) -> Iterator[SolidCheck]:
    """Hold the design against the rules of the table that say what can be made and put together; exact."""
    for row in table_for(design.mode).outputs:
        if row.group != "Gaps" or row.name not in design.values:
            continue
        value = from_si(design.value(row.name), row.unit)
        for rule in row.rules if row.exists(design.choices) else ():
            limit = from_si(rule.value, row.unit)
            room = value - limit if rule.sense == ">=" else limit - value
            level = at_least(room, -1e-6 * max(1.0, abs(limit)), -float("inf"))
            text = f"{row.name} is {value:.4g} {row.unit}, {rule.sense} {limit:.4g}"
            reason = f": {rule.reason}" if level != "pass" else ""
            yield finding("module", f"rule {row.name}", value, limit, row.unit, level, text + reason)


def thread_checks(dims: Dimensions, drawn: Mapping[str, cq.Solid]) -> Iterator[SolidCheck]:
    """How much of each kind of screw is in its thread, over its diameter; read off the solids."""
    x, y = link_screws(dims)[0]
    bosses = between_springs(dims, dims.housing_inner_radius)
    for joint, host, at in (
        ("link", "rotor", (x, y)),
        ("retainer", "rotor", (0.0, 0.0)),
        ("adjuster", "adjuster", (0.0, 0.0)),
        ("cover", "housing", bosses[0]),
        ("motor", "motor_hub", (0.0, 0.0)),
        ("mount", "motor_hub", mounts(dims)[0]),
    ):
        if f"{joint}_screw" not in drawn:
            continue
        screw, diameter = drawn[f"{joint}_screw"].BoundingBox(), dims.of(joint, "screw_diameter")
        engaged = sum(
            max(0.0, min(top, screw.zmax) - max(bottom, screw.zmin))
            for bottom, top in _threads(dims, drawn, joint, host, at)
        )
        length = insert_length(dims, joint)
        wanted, into = (length / diameter, "its insert") if length else (dims.thread_engagement, f"the {host}")
        ratio = engaged / diameter
        text = f"{engaged:.3g} mm of thread in {into}, {ratio:.3g} diameters; {wanted:.3g} are wanted"
        level = at_least(ratio, wanted - 1e-6, 1.0)
        yield finding(f"{joint}_screw", "thread", ratio, wanted, "", level, text)


def _threads(
    dims: Dimensions, drawn: Mapping[str, cq.Solid], joint: str, host: str, at: tuple[float, float]
) -> list[tuple[float, float]]:
    """Lower and upper ends of what the screws of a joint find thread in: an insert, or their hole in a part."""
    if insert_length(dims, joint):
        box, (_, _, bottom) = drawn[f"{joint}_insert"].BoundingBox(), insert_places(dims, joint)[0]
        return [(bottom + box.zmin, bottom + box.zmax)]
    return [(one.bottom, one.top) for one in holes(drawn[host], at)]
