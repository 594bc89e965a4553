"""Fixtures: the fork that holds the rotor, the jig that a PCL arc or block is cast in, and pieces that try a printer.

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
TRIAL = "test_pieces"
TRIAL_COUNT = 2  # The pin of one is tried in the holes of the other
MAKING: Mapping[str, Production] = {
    "casting_mould": Production(drawn=True, down="bottom", why="flat: dam and pins grow upwards, no support"),
    "casting_lid": Production(drawn=True, down="top", why="outer face on the bed: pockets open upwards, no support"),
    FORK: Production(drawn=True, down="top", why="the bridge on the bed: legs grow upwards, no support"),
    TRIAL: Production(down="bottom", why="flat, without support: bridges are what is tried"),
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


TRIED: Mapping[str, tuple[str, tuple[float, ...]]] = {
    "walls": ("minimum_wall", (0.5, 0.67, 0.83, 1.0, 1.17, 1.33, 1.67)),
    "pins": ("minimum_feature", (0.5, 0.75, 1.0, 1.25, 1.5)),
    "gaps": ("running_clearance", ()),
    "bridges": ("bridge_span", (0.5, 1.0, 1.5, 2.0)),
}
"""Rows of the test pieces: the input of a process that each tries, and what is tried over its value; gaps in steps."""
GAP_STEP = 0.05
"""Step of the gaps that are tried [mm], from two steps below the slip clearance to half above the running one."""
GAUGE = 6.0  # Diameter of the pin that is tried in holes with a gap around it [mm]
_HIGH, _THICK = 10.0, 5.0  # Height of what stands on the plate, and its thickness [mm]
_PITCH, _ROW = 10.0, 14.0  # Way from one wall, pin or hole to the next, and from row to row [mm]


def tried(dims: Dimensions, row: str) -> list[float]:
    """Return the sizes in a row of the test pieces [mm], the least first."""
    if row == "gaps":
        first = max(dims.slip_clearance - 2.0 * GAP_STEP, GAP_STEP)
        steps = round((1.5 * dims.running_clearance - first) / GAP_STEP)
        return [0.0, *(round(first + GAP_STEP * step, 2) for step in range(steps + 1))]
    name, shares = TRIED[row]
    return [round(share * float(getattr(dims, name)), 2) for share in shares]


def trial(dims: Dimensions) -> cq.Shape:
    """Draw the test pieces on a plate: rows of walls, of pins, of a pin with holes for another's, and of bridges.

    A bridge is the upper edge of a window in a wall.
    """
    walls, pins, gaps, bridges = (tried(dims, row) for row in TRIED)
    post = max(WALL, dims.minimum_wall)
    bridged = sum(bridges) + post * (len(bridges) + 1)
    wide = max(_PITCH * (len(gaps) + 1), bridged)
    places = [_PITCH * (column + 0.5) for column in range(len(gaps) + 1)]
    middles = [_ROW * (row + 0.5) for row in range(len(TRIED))]
    standing = [_box(x, middles[0], (thick, _HIGH), 0.0, _HIGH) for x, thick in zip(places, walls, strict=False)]
    standing += [cylinder(0.5 * thick, 0.0, _HIGH, (x, middles[1])) for x, thick in zip(places, pins, strict=False)]
    standing.append(cylinder(0.5 * GAUGE, 0.0, _HIGH, (places[0], middles[2])))
    holes = [
        cylinder(0.5 * GAUGE + gap, -_THICK, 0.0, (x, middles[2])) for x, gap in zip(places[1:], gaps, strict=True)
    ]
    standing.append(_box(0.5 * bridged, middles[3], (bridged, post), 0.0, _HIGH))
    start = post
    for span in bridges:
        holes.append(_box(start + 0.5 * span, middles[3], (span, 2.0 * post), 0.0, _HIGH - post))
        start += span + post
    plate = _box(0.5 * wide, 0.5 * _ROW * len(TRIED), (wide, _ROW * len(TRIED)), -_THICK, 0.0)
    return join(plate, standing).cut(*holes)


def _box(x: float, y: float, size: tuple[float, float], bottom: float, top: float) -> cq.Solid:
    """Draw an upright box about a place, of this size along x and y."""
    along, across = size
    corner = cq.Vector(x - 0.5 * along, y - 0.5 * across, bottom)
    return cq.Solid.makeBox(along, across, top - bottom, corner)
