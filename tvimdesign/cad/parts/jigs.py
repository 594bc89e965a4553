"""Fixtures: the fork that holds the rotor, and the jig that a PCL arc or block is cast in.

The jig is a mould with a dam as high as the part, and a lid that lies on the dam. Both are drawn around the part where
it stands in the module, so that the jig is closed by construction: the dam's height is the layer's thickness, pockets
of the lid are the part's keys. Surplus flows over the dam. Fixtures have no place in the module and its mass.
"""

from collections.abc import Mapping

import cadquery as cq

from tvimdesign.base.errors import GeometryError
from tvimdesign.cad.geometry.dimensions import Dimensions
from tvimdesign.cad.geometry.features import tight_box
from tvimdesign.cad.geometry.kinds import Production
from tvimdesign.cad.geometry.solids import cylinder, join, sector, turned
from tvimdesign.device.components.hard_stops import STOPS

LAND = 2.0
"""Width of the dam around the part [mm]; assumed, 1 to 4: the lid lies on it, and what runs over it breaks off."""
PLATE = 3.0  # Thickness of mould and lid [mm]; assumed, 2 to 10: they are pressed flat between two boards
PINS = (1.5, 2.5)
"""Radii of the two guide pins [mm], before and behind the part; assumed, 1 to 4: unlike, so the lid lies one way."""
WALL = 2.0  # Least way from dam to pin, and from pin to edge [mm]; assumed, 1 to 4
CAST_AT = 80.0  # Temperature of mould and lid while the PCL is cast [degC]; it melts at about 60
COLOUR = (0.55, 0.62, 0.50)
FORK = "setting_fork"
FORK_COUNT = STOPS
MAKING: Mapping[str, Production] = {
    "casting_mould": Production(drawn=True, down="bottom", why="flat: dam and pins grow upwards, no support"),
    "casting_lid": Production(drawn=True, down="top", why="outer face on the bed: pockets open upwards, no support"),
    FORK: Production(drawn=True, down="top", why="the bridge on the bed: legs grow upwards, no support"),
}
"""How fixtures are printed, by name."""


def part_of(kinds: tuple[str, ...]) -> str:
    """Return the kind of part that is cast, of those a module has."""
    return next(kind for kind in kinds if kind.startswith("pcl_"))


def levels(dims: Dimensions) -> tuple[float, float]:
    """Return lower and upper face of the part in the module, its keys left out [mm]."""
    if dims.mode != "compression":
        return 0.0, dims.pcl_thickness
    return dims.running_clearance, dims.vane_height


def mould(dims: Dimensions, part: cq.Solid) -> cq.Shape:
    """Draw lower piece: a plate with the dam around the part, and two guide pins."""
    bottom, top = levels(dims)
    pins = [cylinder(radius, bottom, top + PLATE, at) for radius, at in _pins(dims, part)]
    return join(_plate(dims, part, bottom - PLATE, bottom), [dam(dims, part), *pins]).cut(part)


def lid(dims: Dimensions, part: cq.Solid) -> cq.Shape:
    """Draw upper piece: a plate with pockets for the part's keys, and holes that slip over the pins."""
    _, top = levels(dims)
    upper = max(tight_box(part).zmax, top) + PLATE
    holes = [cylinder(radius + dims.slip_clearance, top, upper, at) for radius, at in _pins(dims, part)]
    return _plate(dims, part, top, upper).cut(part, *holes)


DRAWN = {"casting_mould": mould, "casting_lid": lid}


def dam(dims: Dimensions, part: cq.Solid) -> cq.Solid:
    """Draw the dam and all inside it: the layer's outline, wider by the land, as high as the layer."""
    bottom, top = levels(dims)
    floor = next(face for face in part.Faces() if face.geomType() == "PLANE" and face.normalAt().z < -0.5)
    outlines = floor.outerWire().offset2D(LAND, "arc")
    if len(outlines) != 1:
        raise GeometryError(f"casting jig: no dam of {LAND:g} mm fits around the part; is its inner radius that small?")
    return cq.Solid.extrudeLinear(outlines[0], [], cq.Vector(0, 0, top - bottom))


def _pins(dims: Dimensions, part: cq.Solid) -> list[tuple[float, tuple[float, float]]]:
    """Return radius and place of the guide pins: on the x axis, before and behind the dam."""
    box = dam(dims, part).BoundingBox()
    inner, outer = PINS
    return [(inner, (box.xmin - WALL - inner, 0.0)), (outer, (box.xmax + WALL + outer, 0.0))]


def _plate(dims: Dimensions, part: cq.Solid, bottom: float, top: float) -> cq.Solid:
    """Draw a plate under, or over, dam and pins between two levels."""
    box = dam(dims, part).BoundingBox()
    (first, (start, _)), (last, (end, _)) = _pins(dims, part)
    low, high = start - first - WALL, end + last + WALL
    half = max(abs(box.ymin), abs(box.ymax)) + WALL
    return cq.Solid.makeBox(high - low, 2.0 * half, top - bottom, cq.Vector(low, -half, bottom))


BRIDGE = 3.0  # Thickness of the bridge [mm], by which fingers lift it; assumed, 2 to 6


def fork(dims: Dimensions) -> cq.Shape:
    """Draw what holds the rotor at rest while its springs are set, over a tooth on the x axis; a module needs two.

    Its legs fill the ways between a tooth of the rotor and its two stops, and a bridge over the tooth joins them. It
    goes in from above, so that both hands and the lower side are free for the springs' screws.
    """
    inner, outer, top = dims.stop_inner_radius, dims.stop_outer_radius, dims.rotor_top_level
    play = dims.slip_clearance / dims.stop_contact_radius
    leg = sector(inner, outer, dims.stop_angle - play, dims.slip_clearance, top)
    beside = 0.5 * (dims.stop_tooth_span + dims.stop_angle)
    bridge = sector(inner, outer, dims.stop_tooth_span + 2.0 * dims.stop_angle - play, top, top + BRIDGE)
    return join(bridge, [turned(leg, side * beside) for side in (1.0, -1.0)])
