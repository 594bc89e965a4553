"""Puts the parts together: every part built once, named, and placed with the rotor at an angle."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import lru_cache, partial
from math import pi

import cadquery as cq

from tvimdesign.base.errors import GeometryError
from tvimdesign.cad.assembly.module_parts import MODULES
from tvimdesign.cad.geometry.dimensions import Dimensions, dimensions
from tvimdesign.cad.geometry.solids import polar
from tvimdesign.cad.geometry.spring_solids import Coil, free_coil, installed_coil, spring_solid
from tvimdesign.cad.parts.common_parts import hand_of
from tvimdesign.study.design import Design

Progress = Callable[[str], None]


def build(design: Design, rotor_angle: float = 0.0, progress: Progress | None = None) -> dict[str, cq.Solid]:
    """Build and place every part of the module, the rotor turned by `rotor_angle` [rad].

    Returns the solids by name: `rotor`, `pcl_arc_1`, `spring_right_3` ... `progress` gets the part being built.
    Copies of one part share their geometry. Raises GeometryError where a part cannot be built.
    """
    dims = dimensions(design)
    return place(dims, drawn_parts(dims, progress), rotor_angle, progress)


def drawn_parts(dims: Dimensions, progress: Progress | None = None) -> dict[str, cq.Solid]:
    """Build one of every part but the springs, in the module's coordinates, by kind."""
    return {kind: drawn_part(dims, kind, progress) for kind in MODULES[dims.mode].drawn(dims)}


def drawn_part(dims: Dimensions, kind: str, progress: Progress | None = None) -> cq.Solid:
    """Build one part that is no spring, in the module's coordinates."""
    if dims.count("spring_count") % 2:
        raise GeometryError(f"spring_count is {dims.spring_count:g}; half of them are left-hand, so it must be even")
    return _built(kind, partial(MODULES[dims.mode].drawn(dims)[kind], dims), progress)


def free_spring(dims: Dimensions, kind: str) -> cq.Solid:
    """Build the spring as its maker delivers it, of the hand its kind says."""
    drawn = _swept if kind == "spring_right" else _mirrored
    return _built(kind, lambda: drawn(free_coil(dims)), None)


def installed_coils(dims: Dimensions, rotor_angle: float = 0.0) -> dict[str, Coil]:
    """Return shape of the springs on their pins, by kind; the left-hand one is the mirror image of what is returned."""
    return {"spring_right": installed_coil(dims, rotor_angle), "spring_left": installed_coil(dims, -rotor_angle)}


def spring_locations(dims: Dimensions) -> dict[str, cq.Location]:
    """Return where the springs stand, by name."""
    locations = {}
    for index, azimuth in enumerate(dims.azimuths("spring_count")):
        x, y = polar(dims.placement_radius, azimuth)
        name = f"spring_{hand_of(index)}_{index + 1}"
        locations[name] = cq.Location(cq.Vector(x, y, 0), cq.Vector(0, 0, 1), azimuth * 180.0 / pi)
    return locations


def installed_springs(
    dims: Dimensions, rotor_angle: float = 0.0, progress: Progress | None = None
) -> dict[str, cq.Solid]:
    """Build and place the springs on their pins, by name."""
    coils = installed_coils(dims, rotor_angle)
    solids = {
        "right": _built("spring_right", lambda: _swept(coils["spring_right"]), progress),
        "left": _built("spring_left", lambda: _mirrored(coils["spring_left"]), progress),
    }
    return {name: solids[name.split("_")[1]].moved(location) for name, location in spring_locations(dims).items()}


def place(
    dims: Dimensions, drawn: Mapping[str, cq.Solid], rotor_angle: float = 0.0, progress: Progress | None = None
) -> dict[str, cq.Solid]:
    """Place the drawn parts, and the springs built for the rotor's angle, by name."""
    return MODULES[dims.mode].stand(dims, drawn, rotor_angle) | installed_springs(dims, rotor_angle, progress)


# Six pieces of work ask for the springs at rest; at either end of the stroke one hand is the other's mirror.
_swept = lru_cache(maxsize=8)(spring_solid)


@lru_cache(maxsize=8)
def _mirrored(coil: Coil) -> cq.Shape:
    return _swept(coil).mirror("XZ")


def _built(name: str, draw: Callable[[], cq.Shape], progress: Progress | None) -> cq.Solid:
    if progress:
        progress(name)
    return one_solid(name, draw)


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
