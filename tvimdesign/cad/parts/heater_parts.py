"""Parts of the heaters: rectangular ones with spreaders, liners, thermistor, thermal cut-out.

Parts of the shear module are centred on the x axis, as an arc is; those in vanes stand along it.
"""

from collections.abc import Callable, Mapping, Sequence
from math import cos, sin, sqrt

import cadquery as cq

from tvimdesign.cad.geometry.dimensions import Dimensions
from tvimdesign.cad.geometry.solids import block, cylinder, join, polar, rounded, sector, tube, turned, wedge

_SIDES = (1.0, -1.0)  # Of a vane's faces


def drawn(dims: Dimensions) -> dict[str, Callable[[Dimensions], cq.Shape]]:
    """Return how one of each kind is drawn, of what this module has."""
    in_arcs = dims.mode != "compression"
    return {
        **({"spreader": arc_spreader if in_arcs else vane_spreader} if dims.spreader_depth else {}),
        "heater_lead": heater_lead if in_arcs else _straight_lead,
        **({"thermistor": bead_by_arc if in_arcs else bead_by_vane} if dims.thermistor_diameter else {}),
        **({"liner": _liner_on_arc if in_arcs else _liner_on_vane} if dims.liner_depth else {}),
        **({"thermal_cutout": cutout} if dims.cutout_diameter else {}),
    }


# --- rectangular heaters ---


def arc_tile(dims: Dimensions) -> cq.Shape:
    """Draw one tile on the x axis, its length across that: two plates, the lower one without the porch of the leads."""
    half, middle = 0.5 * dims.heater_width, dims.lead_level
    along_x = (dims.tile_radius - half, dims.tile_radius + half)
    if not dims.heater_porch:
        return block(along_x, dims.heater_length, -dims.pad_depth, -dims.spreader_depth)
    upper = block(along_x, dims.heater_length, middle, -dims.spreader_depth)
    lower = turned(block(along_x, dims.cold_plate_length, -dims.pad_depth, middle), 0.0, 0.5 * dims.heater_porch)
    return join(upper, [lower])


def heater_lead(dims: Dimensions) -> cq.Shape:
    """Draw one lead of a heater on the x axis from a tile's end to the ground, or from a pad to below the floor."""
    radius, angle, level = dims.lead_bend_radius, dims.lead_bend_angle, dims.lead_level
    x, end = dims.pcl_mean_radius, 0.5 * dims.lead_way
    if dims.spreader_depth:
        x, end = dims.lead_slot_radius, -0.5 * dims.heater_length
    run, drop = 2.0 * radius * sin(angle), dims.lead_drop
    down = ((x, end, level), (x, end, level - radius), (1.0, 0.0, 0.0), angle)
    ground = (x, end - run, level - drop + radius)
    back = ((x, end - 0.5 * run, level - 0.5 * drop), ground, (-1.0, 0.0, 0.0), angle)
    return tube(0.5 * dims.lead_diameter, [down, back])


def leads_below_arcs(dims: Dimensions, lead: cq.Solid, azimuths: Sequence[float]) -> dict[str, cq.Shape]:
    """Place both leads of the heaters at some azimuths [rad], by name: side by side, or at either end of a window."""
    if dims.spreader_depth:
        apart = 0.25 * dims.lead_slot_width
        pair = [lead.moved(cq.Location(cq.Vector(side * apart, 0.0, 0.0))) for side in _SIDES]
    else:
        back = lead.moved(cq.Location(cq.Vector(2.0 * dims.pcl_mean_radius, 0.0, 0.0), cq.Vector(0, 0, 1), 180.0))
        beside = (dims.lead_start + 0.5 * dims.lead_way) / dims.pcl_mean_radius
        pair = [turned(lead, -beside), turned(back, beside)]
    return _numbered([turned(bent, azimuth) for azimuth in azimuths for bent in pair])


def _numbered(leads: Sequence[cq.Shape]) -> dict[str, cq.Shape]:
    return {f"heater_lead_{index + 1}": lead for index, lead in enumerate(leads)}


def _straight_lead(dims: Dimensions) -> cq.Shape:
    """Draw one lead of a heater in a vane, on the axis, down to the floor's lower face."""
    bottom = -dims.floor_thickness
    return cylinder(0.5 * dims.lead_diameter, bottom, bottom + dims.lead_drop)


def leads_in_vanes(dims: Dimensions, lead: cq.Solid, azimuths: Sequence[float]) -> dict[str, cq.Shape]:
    """Place both leads of the heaters in both faces of the vanes at some azimuths [rad], by name."""
    half, apart = 0.5 * dims.housing_vane_angle, 0.5 * dims.lead_room
    depth = dims.pad_depth + 0.5 * (-dims.heater_thickness if dims.spreader_depth else dims.lead_diameter)
    slots = [0.0, *(index * dims.tile_slot_pitch for index in range(1, round(dims.heater_count / len(azimuths) / 2)))]
    places = [dims.slot_inner_radius + slot + beside * apart for slot in slots for beside in (0.5, 1.5)]
    # Measured from the axis behind a pad, and along the vane's middle below a tile.
    along = [
        (place - depth * sin(half)) / cos(half) if dims.spreader_depth else sqrt(place**2 - depth**2)
        for place in places
    ]
    behind = [
        turned(lead.moved(cq.Location(cq.Vector(x, -side * depth, 0.0))), side * half) for side in _SIDES for x in along
    ]
    return _numbered([turned(solid, azimuth) for azimuth in azimuths for solid in behind])


def arc_spreader(dims: Dimensions) -> cq.Shape:
    """Draw one spreader on the tiles of an arc, centred on the x axis, flush with the floor."""
    sharp = sector(dims.pcl_inner_radius, dims.pcl_outer_radius, dims.arc_span, -dims.spreader_depth, 0)
    return rounded(sharp, dims.corner_radius)


def tile_azimuths(dims: Dimensions) -> list[float]:
    """Return azimuths [rad] of an arc's tiles from its middle."""
    count = dims.count("tiles_per_arc")
    return [dims.tile_pitch * (index - 0.5 * (count - 1)) for index in range(count)]


def tile_openings(dims: Dimensions) -> list[cq.Shape]:
    """Draw what goes through the floor below the pocket of one arc: a window and a slot for leads at each tile, and a
    hole for a thermistor."""
    top, bottom = -dims.pad_depth, -dims.floor_thickness
    window = _opening(dims, dims.tile_radius, dims.heater_width - 2.0 * dims.window_ledge, dims.window_width)
    middle = -0.5 * (dims.heater_length + dims.lead_slot_length)
    slot = _opening(dims, dims.lead_slot_radius, dims.lead_slot_width, dims.lead_slot_length)
    at = polar(dims.tile_radius, 0.5 * (dims.arc_span - dims.lead_angle))
    hole = cylinder(0.5 * dims.lead_hole_diameter, bottom, top, at)
    openings = [turned(window, 0.0, 0.5 * dims.heater_porch), turned(slot, 0.0, middle)]
    return [*(turned(opening, azimuth) for azimuth in tile_azimuths(dims) for opening in openings), hole]


def _opening(dims: Dimensions, radius: float, across: float, along: float) -> cq.Shape:
    """Draw a rectangle through the floor below the pockets, its middle on the x axis."""
    along_x = (radius - 0.5 * across, radius + 0.5 * across)
    return rounded(block(along_x, along, -dims.floor_thickness, -dims.pad_depth), dims.corner_radius)


def vane_tile(dims: Dimensions) -> cq.Shape:
    """Draw one tile, upright, its middle on the axis and its length along x."""
    half, bottom = 0.5 * dims.heater_length, dims.running_clearance
    return block((-half, half), dims.heater_thickness, bottom, bottom + dims.heater_width)


def vane_spreader(dims: Dimensions) -> cq.Shape:
    """Draw one spreader, upright along the x axis: the face of a block."""
    along = (dims.pcl_inner_radius, dims.pcl_outer_radius)
    return block(along, dims.spreader_depth, dims.running_clearance, dims.vane_height)


def tile_row(dims: Dimensions) -> list[float]:
    """Return the distances of a row's tiles from the axis, along the face of their vane."""
    count = dims.count("tiles_per_block")
    return [dims.pcl_inner_radius + dims.tile_spacing * (index + 0.5) for index in range(count)]


def tile_slots(dims: Dimensions) -> list[cq.Shape]:
    """Draw the slots of a vane on the x axis, one behind each tile: wider below the tiles, by their rounded corners."""
    bottom, seat, top = -dims.floor_thickness, dims.running_clearance, dims.slot_top_level
    feet = [rounded(foot, dims.corner_radius) for foot in _wedges(dims, dims.pad_seat, bottom, seat)]
    return [foot.fuse(upper) for foot, upper in zip(feet, _wedges(dims, dims.pad_depth, seat, top), strict=True)]


def _wedges(dims: Dimensions, inset: float, bottom: float, top: float) -> list[cq.Solid]:
    """Draw what a vane has not got behind its tiles between two levels, so far behind its faces."""
    count, half = dims.count("tiles_per_block"), 0.5 * dims.slot_width
    middles = [dims.tile_slot_radius + dims.tile_slot_pitch * (index - 0.5 * (count - 1)) for index in range(count)]
    return [wedge((at - half, at + half), dims.housing_vane_angle, inset, bottom, top) for at in middles]


# --- liners between PCL and rotor, in recesses of the rotor plate or of the faces of its vanes ---


def _liner_on_arc(dims: Dimensions) -> cq.Shape:
    """Draw the liner above an arc that is centred on the x axis, flush with the rotor plate: it goes in between the
    lips."""
    slip = dims.slip_clearance
    radii = (dims.pcl_inner_radius + slip, dims.pcl_outer_radius - slip)
    return _over_arc(dims, radii, dims.liner_span, dims.liner_thickness)


def recesses_over_arc(dims: Dimensions) -> list[cq.Shape]:
    """Draw what the rotor plate lacks above such an arc; nothing without a liner."""
    if not dims.liner_depth:
        return []
    return [_over_arc(dims, (dims.pcl_inner_radius, dims.pcl_outer_radius), dims.arc_span, dims.liner_depth)]


def _over_arc(dims: Dimensions, radii: tuple[float, float], span: float, depth: float) -> cq.Shape:
    """Draw a sector between two radii with the corners of a pad, so deep into the rotor plate."""
    levels = (dims.rotor_bottom_level, dims.rotor_bottom_level + depth)
    return rounded(sector(*radii, span, *levels), dims.corner_radius)


def _liner_on_vane(dims: Dimensions) -> cq.Shape:
    """Draw one liner, upright along the x axis: the face of a block."""
    along = (dims.pcl_inner_radius, dims.pcl_outer_radius)
    return block(along, dims.liner_thickness, dims.running_clearance, dims.running_clearance + dims.block_height)


def recesses_in_vane(dims: Dimensions) -> list[cq.Shape]:
    """Draw what both faces of a rotor vane on the x axis lack, open below and at both ends; nothing without liners."""
    if not dims.liner_depth:
        return []
    more, top = dims.liner_depth, dims.running_clearance + dims.block_height
    along = (dims.pcl_inner_radius - more, dims.pcl_outer_radius + more)
    plate = block(along, dims.liner_depth, 0.0, top)
    return [turned(plate, *_behind_rotor_face(dims, side, dims.liner_depth)) for side in _SIDES]


def liners_on_vane(dims: Dimensions, liner: cq.Solid, azimuth: float) -> list[cq.Shape]:
    """Draw the two liners of a rotor vane at an azimuth [rad], flush with its faces."""
    places = [_behind_rotor_face(dims, side, dims.liner_thickness) for side in _SIDES]
    return [turned(liner, azimuth + at, beside) for at, beside in places]


def _behind_rotor_face(dims: Dimensions, side: float, thickness: float) -> tuple[float, float]:
    """Return the azimuth of a face of a rotor vane, and how far beside it the middle of a sheet behind it lies."""
    return side * 0.5 * dims.rotor_vane_angle, -side * 0.5 * thickness


# --- thermistor: at the end of a pad or below a spreader, over a hole in the floor ---


def bead_by_arc(dims: Dimensions) -> cq.Shape:
    """Draw one bead of an arc that is centred on the x axis: beside the end of its pad, or below its spreader."""
    radius, top = 0.5 * dims.thermistor_diameter, -dims.spreader_depth
    ends = (top - dims.thermistor_length, top)
    if dims.spreader_depth:
        return cylinder(radius, *ends, polar(dims.tile_radius, 0.5 * (dims.arc_span - dims.lead_angle)))
    along, across = polar(1.0, 0.5 * dims.arc_span)
    x, y = polar(dims.thermistor_seat_radius, 0.5 * dims.arc_span)
    return cylinder(radius, *ends, (x - radius * across, y + radius * along))


def bead_seats(dims: Dimensions) -> list[cq.Shape]:
    """Draw the hole through the floor at the end of such an arc; none without a thermistor, and none below tiles."""
    if not dims.thermistor_seat_diameter:
        return []
    at = polar(dims.thermistor_seat_radius, 0.5 * dims.pocket_span)
    return [cylinder(0.5 * dims.thermistor_seat_diameter, -dims.floor_thickness, 0, at)]


def bead_by_vane(dims: Dimensions) -> cq.Shape:
    """Draw the bead at the outer end of what stands behind a vane's face that is the x axis, the vane below that."""
    bottom = dims.running_clearance
    return cylinder(0.5 * dims.thermistor_diameter, bottom, bottom + dims.thermistor_length, _bead_place(dims))


def bead_hole(dims: Dimensions) -> list[cq.Shape]:
    """Draw the hole below such a bead, through the floor and the sill of the vane; none without."""
    if not dims.thermistor_diameter:
        return []
    ends = (-dims.floor_thickness, dims.running_clearance)
    return [cylinder(0.5 * dims.thermistor_seat_diameter, *ends, _bead_place(dims))]


def _bead_place(dims: Dimensions) -> tuple[float, float]:
    half = 0.5 * dims.thermistor_diameter
    return dims.pcl_outer_radius + half, -half


# --- thermal cut-out: below floor and pads' leads, across a window or slot in which a gap pad leads to the heater ---


def cutout(dims: Dimensions) -> cq.Shape:
    """Draw the body and the straight part of its wires, below the floor that is centred on the x axis and across it."""
    half, leg = 0.5 * dims.cutout_length, 0.5 * dims.cutout_leg_diameter
    reach = half + dims.cutout_leg_straight
    upright = join(
        cylinder(0.5 * dims.cutout_diameter, -half, half), [cylinder(leg, -reach, -half), cylinder(leg, half, reach)]
    )
    level = -dims.floor_thickness - dims.cutout_drop - 0.5 * dims.cutout_diameter
    return upright.moved(cq.Location(cq.Vector(dims.cutout_radius, 0.0, level), cq.Vector(1, 0, 0), -90))


def stand_cutout(drawn: Mapping[str, cq.Solid], azimuth: float) -> dict[str, cq.Shape]:
    """Place it below the heater at an azimuth [rad], by name."""
    return {"thermal_cutout": turned(drawn["thermal_cutout"], azimuth)} if "thermal_cutout" in drawn else {}
