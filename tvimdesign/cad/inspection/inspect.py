"""Checks of a part by the way it is made, of the springs, of the casting jig, and of the module as a whole."""

from collections.abc import Iterator, Mapping
from math import atan2, cos, hypot, pi, sin

import cadquery as cq
import numpy as np

from tvimdesign.base.units import from_si
from tvimdesign.cad.assembly.assembly import place
from tvimdesign.cad.assembly.assembly_data import instances
from tvimdesign.cad.cad_report import SolidCheck, at_least, at_most, finding
from tvimdesign.cad.export.mesh import Mesh, solid_mesh
from tvimdesign.cad.export.print_files import with_wider_holes
from tvimdesign.cad.geometry.dimensions import Dimensions
from tvimdesign.cad.geometry.features import boxes_meet, holes, tight_box
from tvimdesign.cad.geometry.kinds import PRODUCTION, kind_of, supported_levels
from tvimdesign.cad.geometry.solids import cylinder, join, polar, turned
from tvimdesign.cad.geometry.spring_solids import Coil, free_coil, installed_coil
from tvimdesign.cad.inspection.milling import corner_checks, hole_check, milling_checks
from tvimdesign.cad.inspection.order import order_checks
from tvimdesign.cad.inspection.printing import bed_check, printing_checks
from tvimdesign.cad.inspection.rays import Triangles, slot_check, wall_checks
from tvimdesign.cad.inspection.size_checks import TOUCHING, interference_checks
from tvimdesign.cad.parts import jigs
from tvimdesign.cad.parts.common_parts import by_feet, link_screws, mounts, reamed_places, stop_azimuths
from tvimdesign.cad.parts.fasteners import insert_length, insert_places
from tvimdesign.cad.parts.fittings import scale
from tvimdesign.device import table_for
from tvimdesign.study import Design

_JIG = "casting_jig"
_NEEDLE = 0.05  # Radius of the upright needle by which the gap between mould and lid is measured [mm]
_EXACT = 1e-6


def casting_checks(dims: Dimensions, kind: str, solids: Mapping[str, cq.Solid]) -> Iterator[SolidCheck]:
    """Compare mould and lid with the part of a kind that is cast in them; all three stand as they are drawn."""
    part, mould, lid = (solids[name] for name in (kind, "casting_mould", "casting_lid"))
    yield from interference_checks(dict(solids), "in the casting jig")
    wanted = dims.pcl_thickness if kind == "pcl_arc" else dims.vane_height - dims.running_clearance
    measured = casting_gap(dims, mould, lid)
    off = abs(measured - wanted)
    text = f"the gap between mould and lid is {measured:.4g} mm, the part's thickness {wanted:.4g} mm"
    yield finding(_JIG, "gap", off, _EXACT, "mm", at_most(off, _EXACT), text)
    room = jigs.dam(dims, part).cut(mould, part).Volume()
    text = f"{room:.3g} mm3 of the dam are open beside the part"
    yield finding(_JIG, "melt", room, TOUCHING, "mm^3", at_most(room, TOUCHING), text)


def setting_checks(dims: Dimensions, solids: Mapping[str, cq.Solid]) -> Iterator[SolidCheck]:
    """Compare the fork with rotor and housing: free at rest, in the way as soon as the rotor turns by a slip."""
    placed = turned(solids[jigs.FORK], stop_azimuths(dims)[0])
    for kind in ("housing", "rotor"):
        shared = placed.intersect(solids[kind]).Volume()
        text = f"the fork and the {kind} share {shared:.3g} mm3 at rest"
        yield finding(jigs.FORK, f"free of the {kind}", shared, TOUCHING, "mm^3", at_most(shared, TOUCHING), text)
    slip = 2.0 * dims.slip_clearance / dims.stop_contact_radius
    for side in (1.0, -1.0):
        stopped = placed.intersect(turned(solids["rotor"], side * slip)).Volume()
        text = f"turned by {side * slip:+.3g} rad the rotor meets the fork"
        yield finding(
            jigs.FORK, f"holds at {side * slip:+.3g} rad", -stopped, 0.0, "mm^3", at_most(-stopped, -1e-6), text
        )


def casting_gap(dims: Dimensions, mould: cq.Solid, lid: cq.Solid) -> float:
    """Return the way from the mould's floor to the lid's face, measured near the part's inner edge, where no key is
    [mm]."""
    inner, outer = dims.pcl_inner_radius, dims.pcl_outer_radius
    needle = cylinder(_NEEDLE, -100.0, 100.0, polar(inner + 0.05 * (outer - inner), 0.0))
    floor, face = mould.intersect(needle).BoundingBox(), lid.intersect(needle).BoundingBox()
    return float(face.zmin - floor.zmax)


TIGHT = 0.04
"""Of its inner diameter, what a coil should leave free around its post; handbook: Shigley, section 10-12, takes 5 %."""


def coil_checks(dims: Dimensions) -> Iterator[SolidCheck]:
    """Compare the springs with their posts and each other, free and at five angles from stop to stop; exact."""
    if not dims.spring_count:
        return
    yield from _checks(dims, free_coil(dims), "as bought")
    for share in (-1.0, -0.5, 0.0, 0.5, 1.0):
        where = "at rest" if share == 0.0 else f"at {share * dims.stop_angle:+.4f} rad"
        yield from _checks(dims, installed_coil(dims, share * dims.stop_angle), where)


def _checks(dims: Dimensions, coil: Coil, where: str) -> Iterator[SolidCheck]:
    """Yield the right-hand spring stands for both: the left-hand one does the same at the opposite angle."""
    d, inside, reach = coil.wire_diameter, 0.5 * (coil.diameter - coil.wire_diameter), spring_reach(coil)
    level = 0.5 * (coil.start_level + coil.end_level)
    half_pitch = pi / dims.count("spring_count")
    between = np.array([*polar(dims.placement_radius * cos(half_pitch), half_pitch), level])
    rooms = (
        ("post", inside - dims.post_radius, TIGHT * 2.0 * inside,
         np.array([dims.placement_radius - inside, 0.0, level]), "between coil and post, all round"),
        ("coils", coil.pitch * cos(coil.rise) - d, 0.0,
         np.array([dims.placement_radius + 0.5 * coil.diameter, 0.0, level]), "between one coil and the next"),
        ("neighbour", 2.0 * (dims.placement_radius * sin(half_pitch) - reach), 0.0, between,
         "between neighbouring springs"),
        ("wall", dims.housing_inner_radius - dims.placement_radius - reach, 0.0,
         np.array([dims.placement_radius + reach, 0.0, level]), "between spring and housing"),
        ("rotor", dims.placement_radius - reach - dims.rotor_radius, 0.0,
         np.array([dims.placement_radius - reach, 0.0, level]), "between spring and rotor plate"),
    )  # fmt: skip
    for what, room, wanted, where_found, words in rooms:
        text = f"{room:.3g} mm {words} {where}"
        if wanted:
            text += f"; {wanted:.3g} mm is a good fit"
        yield finding(
            "spring", f"{what} {where}", room, wanted, "mm", at_least(room, wanted, 0.0), text, place=where_found
        )


def spring_reach(coil: Coil) -> float:
    """Return the radius of the circle around a spring's axis that holds its coils and its tang [mm]."""
    return max(0.5 * coil.diameter, hypot(*coil.tang_position)) + 0.5 * coil.wire_diameter


_IN = {"heater": "housing", "spreader": "housing", "liner": "rotor"}
"""Parts that lie in a pocket, and the part that has it."""
_ROUNDING = 1e-3  # By which a measured gap may be short [mm]: a twentieth of the least clearance of any process


def fit_checks(dims: Dimensions, placed: Mapping[str, cq.Solid]) -> Iterator[SolidCheck]:
    """Compare the first of each kind with its pocket's walls, lifted off what it lies on by twice the clearance."""
    wanted = dims.slip_clearance  # a spreader has it at its ends, and a wider gap along its rims
    for kind, host in _IN.items():
        name = f"{kind}_1"
        if name not in placed:
            continue
        gap = placed[name].moved(cq.Location(_off(dims, kind, placed[name]) * 2.0 * wanted)).distance(placed[host])
        level = at_least(gap, wanted - _ROUNDING)
        text = f"has {gap:.3g} mm to the walls of its pocket in the {host}; {wanted:.3g} are wanted to put it in"
        yield finding(kind, "goes into its pocket", gap, wanted, "mm", level, text)


_WIRES = {
    "heater_lead": ("heater",),
    "thermal_cutout": ("heater", "housing"),  # wrapped in film, it may lie on the floor
    "thermistor": ("heater", "spreader", "pcl_arc", "pcl_block"),
}
"""Bought parts with wires, drawn with these, and what they touch on purpose."""


def bought_checks(dims: Dimensions, placed: Mapping[str, cq.Solid]) -> Iterator[SolidCheck]:
    """Compare the envelope of bought parts, wires included, with the room that all others leave them."""
    wanted = dims.lead_clearance
    boxes = {name: tight_box(solid) for name, solid in placed.items()}
    for kind, touched in _WIRES.items():
        names = [name for name in placed if kind_of(name) == kind]
        gaps = [
            (placed[name].distance(placed[other]), name, other)
            for name in names
            for other in placed
            if other != name and kind_of(other) not in touched and boxes_meet(boxes[name], boxes[other], wanted)
        ]
        if not names:
            continue
        gap, name, other = min(gaps, default=(wanted, names[0], "all others"))
        text = f"{gap:.3g} mm between {name} and {other}, wires as they are bought; {wanted:g} are wanted"
        level = at_least(gap, wanted - _ROUNDING)
        yield finding(kind, "fits_as_bought", gap, wanted, "mm", level, text, place=placed[name].Center().toTuple())


def _off(dims: Dimensions, kind: str, solid: cq.Solid) -> cq.Vector:
    """Return from what a part lies on: off the floor, off the plate, or sideways off its vane and up from the floor."""
    if dims.mode != "compression":
        return cq.Vector(0.0, 0.0, -1.0 if kind == "liner" else 1.0)
    middle = solid.Center()
    around = atan2(middle.y, middle.x)
    pitch = 2.0 * pi / dims.count("vane_count")
    # The middle of a housing's vane is half a pitch beyond a rotor's; a liner leaves its rotor's vane.
    from_vane = (around / pitch) % 1.0 - (0.0 if kind == "liner" else 0.5)
    side = 1.0 if 0.0 < from_vane < 0.5 else -1.0
    return cq.Vector(-side * sin(around), side * cos(around), -1.0 if kind == "liner" else 1.0)


def part_checks(
    design: Design, dims: Dimensions, kind: str, solid: cq.Solid, mesh: Mesh | None = None
) -> list[SolidCheck]:
    """Compare one made part with its process: all it needs is its own solid, and its mesh if that is there."""
    mesh = mesh or solid_mesh(solid)
    triangles, bed = Triangles(mesh), (dims.bed_length, dims.bed_width, dims.bed_height)
    checks = [solid_check(kind, solid), *sliver_checks(dims, kind, solid, triangles)]
    if design.choices.get("making_method") == "milled":
        drilled = holes(solid)
        checks += milling_checks(kind, triangles, drilled, dims.pocket_depth_ratio)
        checks += corner_checks(kind, solid, dims.corner_radius, dims.corner_depth_ratio)
        checks += [hole_check(kind, drilled, dims.hole_depth_ratio)]
        return [*checks, bed_check(kind, triangles.upper - triangles.lower, bed)]
    down, levels = PRODUCTION[kind].down, supported_levels(kind, dims)
    return [*checks, *printing_checks(kind, mesh, down, dims.overhang_angle, dims.bridge_span, bed, levels)]


def sliver_checks(dims: Dimensions, kind: str, solid: cq.Solid, triangles: Triangles) -> list[SolidCheck]:
    """Compare slots and walls of a part with its process, the holes as wide as they are printed."""
    made = with_wider_holes(solid, dims.hole_compensation, reamed_places(dims))
    walls, what = triangles if made is solid else Triangles(solid_mesh(made)), "wall"
    slot = slot_check(kind, walls, dims.minimum_running_clearance)
    if kind == "adjuster":  # what is left between the dots of its scale is lower than it is thick
        plain = join(solid, scale(dims)).Solids()[0]
        walls, what = Triangles(solid_mesh(with_wider_holes(plain, dims.hole_compensation))), "wall beside its scale"
    return [slot, *wall_checks(kind, walls, dims.minimum_wall, dims.thinnest_wall, what)]


def solid_check(kind: str, shape: cq.Shape) -> SolidCheck:
    """Return whether a part is one valid solid."""
    count, sound = len(shape.Solids()), shape.isValid()
    text = f"{count} solid{'' if count == 1 else 's'}, {'valid' if sound else 'not valid'}"
    return finding(kind, "solid", count, 1.0, "", "pass" if count == 1 and sound else "failure", text)


def module_checks(
    design: Design, dims: Dimensions, drawn: Mapping[str, cq.Solid], known: Mapping[str, Mesh] | None = None
) -> Iterator[SolidCheck]:
    """Compare the module with its own rules, its springs as they wind, its screws, and the order of its assembly.

    `known` are meshes of the drawn parts that are made already, by kind.
    """
    yield from rule_checks(design)
    yield from coil_checks(dims)
    yield from thread_checks(dims, drawn)
    placed = place(dims, drawn)
    yield from fit_checks(dims, placed)
    yield from bought_checks(dims, placed)
    yield from order_checks(dims, instances(dims, drawn, placed, known))


def rule_checks(design: Design) -> Iterator[SolidCheck]:
    """Compare the design with the rules of the table that say what can be made and put together; exact."""
    for row in table_for(design.mode).outputs:
        if row.group not in ("Gaps", "Layout") or row.name not in design.values:
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
    """Yield how much of each kind of screw is in its thread, over its diameter; read off the solids."""
    x, y = link_screws(dims)[0]
    bosses = by_feet(dims, dims.housing_inner_radius)
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
    """Return lower and upper ends of what the screws of a joint find thread in: an insert, or their hole in a part."""
    if insert_length(dims, joint):
        box, (_, _, bottom) = drawn[f"{joint}_insert"].BoundingBox(), insert_places(dims, joint)[0]
        return [(bottom + box.zmin, bottom + box.zmax)]
    return [(hole.bottom, hole.top) for hole in holes(drawn[host], at)]
