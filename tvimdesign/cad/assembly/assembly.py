"""Parts put together: each built once, named, placed with the rotor at an angle, and lifted to be seen apart."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import lru_cache, partial
from math import pi

import cadquery as cq
import numpy as np

from tvimdesign.base.errors import GeometryError
from tvimdesign.cad.export.mesh import Instance
from tvimdesign.cad.geometry.dimensions import Dimensions
from tvimdesign.cad.geometry.kinds import MADE_TURNING, SPRINGS, kind_of
from tvimdesign.cad.geometry.solids import polar, turned
from tvimdesign.cad.geometry.spring_solids import Coil, free_coil, installed_coil, spring_solid
from tvimdesign.cad.parts import compression_parts, fasteners, fittings, heater_parts, motor_parts, shear_parts
from tvimdesign.cad.parts.common_parts import hand_of


def drawn_parts(dims: Dimensions) -> dict[str, cq.Solid]:
    """Build one of every part but the springs, in the module's coordinates, by kind."""
    return {kind: drawn_part(dims, kind) for kind in MODULES[dims.mode].drawn(dims)}


def drawn_part(dims: Dimensions, kind: str) -> cq.Solid:
    """Build one part that is no spring, in the module's coordinates."""
    if dims.spring_count % 2:
        raise GeometryError(f"spring_count is {dims.spring_count:g}; half of them are left-hand, so it must be even")
    return one_solid(kind, partial(MODULES[dims.mode].drawn(dims)[kind], dims))


def free_spring(dims: Dimensions, kind: str) -> cq.Solid:
    """Build the spring as its maker delivers it, of the hand its kind says."""
    drawn = _swept if kind == "spring_right" else _mirrored
    return one_solid(kind, lambda: drawn(free_coil(dims)))


def installed_coils(dims: Dimensions, rotor_angle: float = 0.0) -> dict[str, Coil]:
    """Return shape of the springs on their pins, by kind; the left-hand one is the mirror image of what is returned."""
    angles = {"spring_right": rotor_angle, "spring_left": -rotor_angle} if dims.spring_count else {}
    return {kind: installed_coil(dims, angle) for kind, angle in angles.items()}


def spring_locations(dims: Dimensions) -> dict[str, cq.Location]:
    """Return where the springs stand, by name."""
    locations = {}
    for index, azimuth in enumerate(dims.azimuths("spring_count")):
        x, y = polar(dims.placement_radius, azimuth)
        name = f"spring_{hand_of(index)}_{index + 1}"
        locations[name] = cq.Location(cq.Vector(x, y, 0), cq.Vector(0, 0, 1), azimuth * 180.0 / pi)
    return locations


def installed_springs(dims: Dimensions, rotor_angle: float = 0.0) -> dict[str, cq.Solid]:
    """Build and place the springs on their pins, by name."""
    if not (coils := installed_coils(dims, rotor_angle)):
        return {}
    solids = {
        "right": one_solid("spring_right", lambda: _swept(coils["spring_right"])),
        "left": one_solid("spring_left", lambda: _mirrored(coils["spring_left"])),
    }
    return {name: solids[name.split("_")[1]].moved(location) for name, location in spring_locations(dims).items()}


def place(dims: Dimensions, drawn: Mapping[str, cq.Solid], rotor_angle: float = 0.0) -> dict[str, cq.Solid]:
    """Place the drawn parts, and the springs built for the rotor's angle, by name."""
    return MODULES[dims.mode].stand(dims, drawn, rotor_angle) | installed_springs(dims, rotor_angle)


# Six pieces of work ask for the springs at rest; at either end of the stroke one hand is the other's mirror.
_swept = lru_cache(maxsize=8)(spring_solid)


@lru_cache(maxsize=8)
def _mirrored(coil: Coil) -> cq.Shape:
    return _swept(coil).mirror("XZ")


def one_solid(name: str, draw: Callable[[], cq.Shape]) -> cq.Solid:
    """Draw a part and return its one solid; raises GeometryError that names the part."""
    try:
        shape = draw()
    except GeometryError as error:
        text = str(error)
        raise GeometryError(text if text.startswith((f"{name}: ", "spring: ")) else f"{name}: {text}") from error
    except Exception as error:  # OCC raises a dozen classes, and none of them names the part
        raise GeometryError(f"{name}: the CAD kernel cannot build it ({type(error).__name__}: {error})") from error
    solids = shape.Solids()
    if len(solids) != 1 or not shape.isValid():
        raise GeometryError(f"{name}: came out as {len(solids)} solids, {'' if shape.isValid() else 'not '}valid")
    return solids[0]


_IN_ALL_MODES = (fittings, fasteners, motor_parts)
"""Each says which of its parts a design has and how they are drawn (`drawn`), and places them (`stand`)."""


@dataclass(frozen=True, kw_only=True)
class ModuleParts:
    """The parts of a mode."""

    made: Mapping[str, Callable[[Dimensions], cq.Shape]]
    """How one of each kind is drawn, by kind: those that every module of the mode has, without screws and springs."""
    stand_heaters: Callable[[Dimensions, Mapping[str, cq.Solid], float], dict[str, cq.Shape]]
    """Places pads, PCL and what belongs to them, the rotor at an angle [rad], by name."""

    def drawn(self, dims: Dimensions) -> dict[str, Callable[[Dimensions], cq.Shape]]:
        """Return how one of each kind is drawn but the springs, of what a design has."""
        kinds = {**self.made, **heater_parts.drawn(dims)}
        for parts in _IN_ALL_MODES:
            kinds |= parts.drawn(dims)
        return kinds

    def kinds(self, dims: Dimensions) -> tuple[str, ...]:
        """Return all kinds of part a design has, springs and all."""
        return (*self.drawn(dims), *(SPRINGS if dims.spring_count else ()))

    def stand(self, dims: Dimensions, drawn: Mapping[str, cq.Solid], rotor_angle: float = 0.0) -> dict[str, cq.Solid]:
        """Place the drawn parts, all but the springs, by name."""
        placed = {"housing": turned(drawn["housing"], 0.0)}
        placed |= {name: turned(drawn[name], rotor_angle) for name in MADE_TURNING}
        for parts in _IN_ALL_MODES:
            placed |= parts.stand(dims, drawn, rotor_angle)
        return placed | self.stand_heaters(dims, drawn, rotor_angle)


MODULES = {
    "shear": ModuleParts(made=shear_parts.DRAWN, stand_heaters=shear_parts.stand),
    "lock": ModuleParts(made=shear_parts.DRAWN, stand_heaters=shear_parts.stand),
    "compression": ModuleParts(made=compression_parts.DRAWN, stand_heaters=compression_parts.stand),
}
"""By mode."""


_ORDER = (
    "encoder_board", "encoder_magnet", "motor_screw", "motor_retainer", "motor_housing", "motor_stator",
    "motor_bearing", "motor_rotor", "motor_hub", "base", "retainer_screw", "retainer", "retainer_insert",
    "adjuster_screw",
    "thermal_cutout", "thermistor", "heater_lead", "housing", "cover_insert", "preload_spring", "bearing_outer",
    "bearing_inner", "adjuster_insert", "adjuster",
    "heater", "spreader", "pcl_arc", "pcl_block", "liner", "rotor", "leg_pin", "link_insert", "spring_right",
    "spring_left",
    "mount_screw", "cover", "cover_screw", "link", "link_screw", "link_dowel",
)  # fmt: skip
"""Along the axis from below; kinds that are not named come last."""
_LIDS = ("cover",)  # Closed plates, which are lifted until all of what lies below them is seen
_TOGETHER = ({"spring_right", "spring_left"},)
VIEWED_FROM = (1.0, -1.35, 0.75)  # Direction of the camera that looks down on the parts
_DOWN = VIEWED_FROM[2] / float(np.hypot(VIEWED_FROM[0], VIEWED_FROM[1]))
_APART = 0.12  # Gap between kinds over the module's width


def lifts(placed: Mapping[str, Instance]) -> dict[str, float]:
    """Return how far each part is lifted along the axis [mm], so that no kind reaches into the one below it."""
    names = sorted(placed, key=lambda name: (_rank(kind_of(name)), name))
    points = {name: placed[name].points() for name in names}
    width = max(float(np.ptp(at[:, 0])) for at in points.values())
    floor, below, lifted = 0.0, 0.0, dict[str, float]()
    for rank in dict.fromkeys(_rank(kind_of(name)) for name in names):
        group = [name for name in names if _rank(kind_of(name)) == rank]
        low = min(float(points[name][:, 2].min()) for name in group)
        high = max(float(points[name][:, 2].max()) for name in group)
        reach = max(float(np.hypot(points[name][:, 0], points[name][:, 1]).max()) for name in group)
        # What is wider than the kind below it would hide it from a camera that looks down.
        hidden = reach + below if kind_of(group[0]) in _LIDS else max(reach - below, 0.0)
        floor += hidden * _DOWN if below else 0.0
        lifted |= dict.fromkeys(group, floor - low)
        floor += high - low + _APART * width
        below = reach
    return lifted


def _rank(kind: str) -> int:
    """Place of a kind along the axis; both hands of spring have one."""
    first = next((min(_ORDER.index(member) for member in group) for group in _TOGETHER if kind in group), None)
    return first if first is not None else _ORDER.index(kind) if kind in _ORDER else len(_ORDER)
