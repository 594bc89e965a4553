"""Holds the built parts against the design: sound solids, the sizes the model used, and no part in another."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from itertools import combinations
from math import nan, sqrt

import cadquery as cq
import numpy as np
from manifold3d import Manifold
from OCP.BRepAlgoAPI import BRepAlgoAPI_Common
from OCP.BRepGProp import BRepGProp
from OCP.gp import gp
from OCP.GProp import GProp_GProps
from OCP.TopTools import TopTools_ListOfShape

from tvimdesign.base.errors import GeometryError
from tvimdesign.cad.assembly.assembly import place
from tvimdesign.cad.assembly.assembly_data import instances
from tvimdesign.cad.cad_report import SolidCheck
from tvimdesign.cad.export.mesh import CHORD, Instance, Mesh
from tvimdesign.cad.export.print_files import body_of
from tvimdesign.cad.geometry.dimensions import Dimensions
from tvimdesign.cad.geometry.features import boxes_meet, tight_box
from tvimdesign.cad.geometry.kinds import CHANGING, KINDS, SPRINGS, TURNING, is_of_structure, kind_of
from tvimdesign.cad.geometry.solids import turned
from tvimdesign.cad.geometry.spring_solids import installed_coil
from tvimdesign.device.components.hard_stops import STOPS
from tvimdesign.device.core.spring_as_drawn import pin_distance
from tvimdesign.study import Design

ROOM = 3.0 * CHORD  # Between the meshes of parts that are apart [mm]; each mesh is within CHORD of its part


class PlacedBodies:
    """The meshes of placed parts as closed bodies; copies of a part share one."""

    def __init__(self, placed: Mapping[str, Instance]) -> None:
        """Take placed parts; one whose mesh does not close has no body, and never counts as apart."""
        self._placed = placed
        self._bodies: dict[str, Manifold | None] = {}
        self._in_place: dict[str, Manifold | None] = {}
        self._near: set[tuple[str, str]] = set()

    def apart(self, first: str, second: str) -> bool:
        """Return whether two parts have surely no point in common; the gap of bodies that share any volume is zero.

        Where one of a kind is near another kind its copies will be too, and are not tried.
        """
        kinds = (kind_of(first), kind_of(second))
        if kinds in self._near:
            return False
        body, other = self._body(first), self._body(second)
        apart = body is not None and other is not None and body.min_gap(other, ROOM) >= ROOM
        if not apart:
            self._near.add(kinds)
        return apart

    def _body(self, name: str) -> Manifold | None:
        """Return the body of a part where it stands, made once: a placed body is sorted again for each question."""
        if name not in self._in_place:
            kind = kind_of(name)
            if kind not in self._bodies:
                try:
                    self._bodies[kind] = body_of(kind, self._placed[name].mesh)
                except GeometryError:
                    self._bodies[kind] = None
            body = self._bodies[kind]
            self._in_place[name] = body.transform(self._placed[name].matrix[:3]) if body else None
        return self._in_place[name]


MODEL_TOLERANCE = 1e-5
"""How far volumes, masses and inertias of the solids may be from the quantities of the table, relative: they are the
same to rounding (1e-14), masses to the 3e-7 that springs leave."""
ROUGHER = {"spring_right_volume": 1e-4, "spring_left_volume": 1e-4, "motor_hub_inertia": 5e-4, "housing_inertia": 5e-3}
"""Of what is less exact. The kernel sweeps the wire of a spring to 3e-6 of its volume, to 3e-5 where it has 0.8 mm and
is wound to four times that. The inertias of a motor's hub and of the housing that it turns have the rounded corners,
the housing also its holes, at one radius in the model: up to 6e-5 and 2e-3 over random designs."""
ENVELOPE_TOLERANCE = 1e-6
TOUCHING = 0.01  # Common volume [mm^3] up to which two parts touch rather than cut each other
_MM3, _MM5 = 1e-9, 1e-15
Place = tuple[float, float, float]


POSITIONS = (0.0, -1.0, -0.5, 0.5, 1.0)  # Of the rotor at which parts are compared, as shares of its way to a stop


def rest_checks(design: Design, dims: Dimensions, drawn: Mapping[str, cq.Solid]) -> list[SolidCheck]:
    """Compare the sizes at rest with the quantities, the legs against their pins, and the rotor with its stops."""
    at_rest = place(dims, drawn)
    sizes = [*size_checks(design, at_rest), *envelope_checks(dims, at_rest)]
    return [*sizes, *bearing_checks(dims), *stop_checks(dims, drawn)]


def clearance_checks(
    dims: Dimensions, drawn: Mapping[str, cq.Solid], share: float, known: Mapping[str, Mesh] | None = None,
) -> list[SolidCheck]:  # fmt: skip
    """Compare every part with every other one at rest; on the way to a stop, those that do not move together.

    `known` are meshes of the drawn parts that are made already, by kind.
    """
    where = "at rest" if share == 0.0 else f"at {share * dims.stop_angle:+.4f} rad"
    placed = place(dims, drawn, share * dims.stop_angle)
    if share == 0.0:  # most parts touch: to sort out the others takes as long as to intersect them
        return list(interference_checks(placed, where))
    bodies = PlacedBodies(instances(dims, drawn, placed, known, share * dims.stop_angle))

    def apart(first: str, second: str) -> bool:
        # Two structural parts are dense meshes close to each other: the kernel takes a quarter of the time for these.
        return not all(is_of_structure(kind_of(name)) for name in (first, second)) and bodies.apart(first, second)

    return list(interference_checks(placed, where, lambda a, b: not _together(a, b), apart))


def size_checks(design: Design, placed: Mapping[str, cq.Solid]) -> Iterator[SolidCheck]:
    """Yield volume, mass and inertia of the solids against the quantities of the design."""
    by_kind: dict[str, list[cq.Solid]] = {}
    for name, solid in placed.items():
        by_kind.setdefault(kind_of(name), []).append(solid)
    mass = inertia = 0.0
    for kind, solids in by_kind.items():
        is_single = kind in SPRINGS  # the row is the volume of one spring, of the others that of all of a kind
        volume = sum(solid.Volume() for solid in solids) * _MM3
        density = design.value(KINDS[kind].density)
        mass += volume * density
        yield _against(f"{kind}_volume", volume / (len(solids) if is_single else 1), design.value(KINDS[kind].volume))
        if kind in TURNING or f"{kind}_inertia" in design.values:
            about_axis = density * _MM5 * sum(_polar_moment(solid) for solid in solids)
            inertia += about_axis if kind in TURNING else 0.0
            if f"{kind}_inertia" in design.values:
                yield _against(f"{kind}_inertia", about_axis, design.value(f"{kind}_inertia"))
    yield _against("parts_inertia", inertia, design.value("parts_inertia"))
    yield _against("module_mass", mass, design.value("module_mass"))


def envelope_checks(dims: Dimensions, placed: Mapping[str, cq.Solid]) -> Iterator[SolidCheck]:
    """Yield diameter and height of the whole module at rest against the quantities, to rounding."""
    boxes = [tight_box(solid) for solid in placed.values()]
    height = max(box.zmax for box in boxes) - min(box.zmin for box in boxes)
    width = max(box.ymax for box in boxes) - min(box.ymin for box in boxes)
    yield _against("envelope_height", height, dims.envelope_height, ENVELOPE_TOLERANCE)
    yield _against("envelope_diameter", width, dims.envelope_diameter, ENVELOPE_TOLERANCE)


def bearing_checks(dims: Dimensions) -> Iterator[SolidCheck]:
    """Yield how far the legs reach beyond the pins they bear on, at rest and at either stop [mm]."""
    for angle in (-dims.stop_angle, 0.0, dims.stop_angle) if dims.spring_count else ():
        coil = installed_coil(dims, angle)
        offset = 0.5 * (coil.diameter + coil.wire_diameter + dims.pin_diameter)
        distance = pin_distance(dims.pin_radius, dims.placement_radius, angle)
        beyond = coil.leg_length - float(sqrt(distance**2 - offset**2))
        text = f"the springs' legs reach {beyond:.3g} mm beyond their pins at {angle:+.4f} rad"
        yield SolidCheck(f"leg beyond pin at {angle:+.4f} rad", beyond, 0.0, beyond > 0.0, text)


BEYOND = 1e-3  # Angle [rad] beyond a stop at which the drawn rotor is compared with it
STOP_TOLERANCE = 1e-3  # How far the volume that rotor and posts share there may be from that of flat faces, relative


def stop_checks(dims: Dimensions, drawn: Mapping[str, cq.Solid]) -> Iterator[SolidCheck]:
    """Yield what the drawn rotor shares with its posts 1 mrad beyond either stop, against their whole faces."""
    faces = 0.5 * STOPS * (dims.stop_outer_radius**2 - dims.stop_inner_radius**2) * dims.rotor_thickness
    for side in (-1.0, 1.0):
        angle = side * (dims.stop_angle + BEYOND)
        shared, _ = _common(drawn["housing"], turned(drawn["rotor"], angle))
        off = shared / (BEYOND * faces) - 1.0
        text = f"the rotor meets its stops at {side * dims.stop_angle:+.4f} rad: {shared:.4g} mm3 shared 1 mrad beyond"
        yield SolidCheck(
            f"stops at {side * dims.stop_angle:+.4f} rad", off, STOP_TOLERANCE, abs(off) < STOP_TOLERANCE, text
        )


def interference_checks(
    placed: Mapping[str, cq.Solid], where: str, wanted: Callable[[str, str], bool] = lambda _a, _b: True,
    apart: Callable[[str, str], bool] = lambda _a, _b: False,
) -> Iterator[SolidCheck]:  # fmt: skip
    """Yield common volume of every wanted pair whose boxes overlap; one check that says how many pairs are not.

    Of pairs that are surely `apart` it is nothing, and is not computed.
    """
    boxes = {name: tight_box(solid) for name, solid in placed.items()}
    pairs = [pair for pair in combinations(placed, 2) if wanted(*pair)]
    near = [pair for pair in pairs if boxes_meet(*(boxes[name] for name in pair))]
    shared = _shared(placed, [pair for pair in near if not apart(*pair)])
    for pair in near:
        (first, second), (common, place) = pair, shared.get(pair, (0.0, None))
        text = f"{first} and {second} share {common:.4g} mm3 {where}"
        yield SolidCheck(
            f"{first} | {second} {where}", common, TOUCHING, common < TOUCHING, text,
            part=f"{first}, {second}", place=place or _between(boxes[first], boxes[second]), unit="mm³",
        )  # fmt: skip
    beside = len(pairs) - len(near)
    yield SolidCheck(f"pairs apart {where}", beside, 0.0, True, f"{beside} pairs are apart by their boxes {where}")


def _shared(
    placed: Mapping[str, cq.Solid], pairs: Sequence[tuple[str, str]]
) -> dict[tuple[str, str], tuple[float, Place | None]]:
    """Return what `_common` says of each pair.

    A part is compared with all copies of another at once, as the kernel takes most of its time to go through the part;
    one by one only where they share anything.
    """
    copies: dict[tuple[str, str], list[str]] = {}
    for first, second in pairs:
        copies.setdefault((first, kind_of(second)), []).append(second)
    shared: dict[tuple[str, str], tuple[float, Place | None]] = {}
    for (first, _), others in copies.items():
        none = len(others) > 1 and _common(placed[first], *(placed[other] for other in others))[0] == 0.0
        shared |= {(first, other): (0.0, None) if none else _common(placed[first], placed[other]) for other in others}
    return shared


def _common(first: cq.Solid, *others: cq.Solid) -> tuple[float, Place | None]:
    """Return volume a solid shares with others [mm^3], and its centroid.

    Not a number, which fails, where that is unknown.
    """
    operation, arguments, tools = BRepAlgoAPI_Common(), TopTools_ListOfShape(), TopTools_ListOfShape()
    arguments.Append(first.wrapped)
    for other in others:
        tools.Append(other.wrapped)
    operation.SetArguments(arguments)
    operation.SetTools(tools)
    operation.SetCheckInverted(theCheck=False)  # none is: that volumes are the model's is a check of its own
    operation.Build()
    if not operation.IsDone():
        return nan, None
    common = cq.Shape.cast(operation.Shape())
    volume = float(common.Volume())
    return volume, common.Center().toTuple() if volume > 0.0 else None


def _between(a: cq.BoundBox, b: cq.BoundBox) -> Place:
    """Return the middle of what two boxes share: where two parts would meet."""
    low, high = (
        np.array([[getattr(box, f"{axis}{end}") for axis in "xyz"] for box in (a, b)]) for end in ("min", "max")
    )
    x, y, z = (0.5 * (low.max(axis=0) + high.min(axis=0))).tolist()
    return x, y, z


def _together(first: str, second: str) -> bool:
    """Return whether two parts both stand, or both turn, so that they are to each other as they were at rest."""
    kinds = {kind_of(first), kind_of(second)}
    return not kinds & {*TURNING, *CHANGING} or kinds <= set(TURNING)


def _against(name: str, built: float, model: float, tolerance: float | None = None) -> SolidCheck:
    tolerance = ROUGHER.get(name, MODEL_TOLERANCE) if tolerance is None else tolerance
    deviation = built / model - 1.0
    text = f"{name}: solid {built:.8g}, model {model:.8g}"
    return SolidCheck(name, deviation, tolerance, abs(deviation) <= tolerance, text)


def _polar_moment(solid: cq.Solid) -> float:
    """Return the integral of the squared distance from the rotor's axis over the solid [mm^5]."""
    properties = GProp_GProps()
    BRepGProp.VolumeProperties_s(solid.wrapped, properties)
    return float(properties.MomentOfInertia(gp.OZ_s()))
