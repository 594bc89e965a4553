"""The motor below the module: hub, housing and retainer, and what is bought, drawn where they stand."""

from collections.abc import Callable, Mapping
from math import pi

import cadquery as cq

from tvimdesign.cad.geometry.dimensions import Dimensions
from tvimdesign.cad.geometry.solids import blind_hole, block, cylinder, join, polar, ring, spoked_disc, turned
from tvimdesign.cad.parts.common_parts import foot_azimuths, mounts
from tvimdesign.device.motor.motor_layout import BASE_SCREWS

Draw = Callable[[Dimensions], cq.Shape]


def hub(dims: Dimensions) -> cq.Shape:
    """Draw the disc with a spoke to each of the housing's feet, barrel for the rotor, collar and journal.

    Less screw holes.
    """
    bottom = dims.motor_plate_level
    top = bottom + dims.motor_plate_thickness
    azimuths = foot_azimuths(dims)
    plate = spoked_disc(
        dims.motor_disc_radius, dims.mount_boss_radius, dims.placement_radius, dims.motor_corner_radius, azimuths,
        (bottom, top),
    )  # fmt: skip
    barrel = ring(dims.motor_barrel_radius, dims.motor_disc_radius, dims.motor_rotor_bottom_level, bottom)
    collar = cylinder(dims.motor_collar_radius, dims.stator_top_level, bottom)
    end = dims.motor_journal_level
    journal = cylinder(dims.motor_journal_radius, end, dims.stator_top_level)
    pilots = [cylinder(0.5 * dims.mount_screw_pilot, bottom, top, at) for at in mounts(dims)]
    pilot = blind_hole(dims.motor_screw_pilot, end, end + dims.motor_screw_depth, dims.drill_point_ratio)
    body = join(plate, [barrel, collar, journal])
    return body.cut(*pilot, *pilots)


def housing(dims: Dimensions) -> cq.Shape:
    """Draw base, wall around the stator, tube for two bearings; less bore and seats, screw holes and ways for wires."""
    bottom, category, top = dims.motor_bottom_level, dims.stator_bottom_level, dims.stator_top_level
    base = cylinder(dims.motor_outer_radius, bottom, category)
    wall = ring(dims.stator_seat_radius, dims.motor_outer_radius, category, top)
    tube = cylinder(dims.motor_tube_radius, category, top)
    across = (0.0, dims.motor_outer_radius + 1.0)
    # The wires' opening ends at the wall: what it is cut from is the wall alone.
    wall = wall.cut(block(across, dims.motor_wire_width, top - dims.motor_wire_depth, top))
    seats = [
        cylinder(dims.motor_lip_radius, bottom, top),
        cylinder(dims.motor_seat_radius, bottom, dims.motor_retainer_level + dims.motor_bearing_width),
        cylinder(dims.motor_seat_radius, top - dims.motor_bearing_width, top),
    ]
    holes = base_holes(dims)
    if not dims.encoder_recess_radius:
        return join(base, [wall, tube]).cut(*seats, *holes)
    ceiling = dims.encoder_board_level + dims.encoder_board_height
    recess = cylinder(dims.encoder_recess_radius, bottom, ceiling)
    groove = block(across, dims.motor_wire_width, bottom, ceiling)
    return join(base, [wall, tube]).cut(*seats, *holes, recess, groove)


def base_holes(dims: Dimensions) -> list[cq.Shape]:
    """Draw what fixes the base from below: four holes."""
    bottom = dims.motor_bottom_level
    azimuths = [(index + 0.5) * 2.0 * pi / BASE_SCREWS for index in range(BASE_SCREWS)]
    top, point = bottom + dims.motor_base_hole_depth, dims.drill_point_ratio
    return [
        hole
        for at in (polar(dims.motor_base_hole_radius, azimuth) for azimuth in azimuths)
        for hole in blind_hole(dims.mount_screw_pilot, bottom, top, point, at)
    ]


def retainer(dims: Dimensions) -> cq.Shape:
    """Draw the disc that presses on the lower inner ring, with a counterbore for its screw's head and the magnet below
    it."""
    top = dims.motor_retainer_level
    bottom, floor = top - dims.motor_retainer_thickness, top - dims.motor_retainer_floor
    return cylinder(dims.motor_collar_radius, bottom, top).cut(
        cylinder(0.5 * dims.motor_screw_clearance, bottom, top), cylinder(dims.motor_sink_radius, bottom, floor)
    )


def rotor(dims: Dimensions) -> cq.Shape:
    """Draw the motor's rotor as a ring."""
    bottom = dims.motor_rotor_bottom_level
    return ring(dims.motor_rotor_bore_radius, dims.motor_rotor_radius, bottom, bottom + dims.motor_rotor_length)


def stator(dims: Dimensions) -> cq.Shape:
    """Draw the motor's stator with its windings as a ring."""
    return ring(dims.stator_bore_radius, dims.stator_radius, dims.stator_bottom_level, dims.stator_top_level)


def bearing(dims: Dimensions) -> cq.Shape:
    """Draw the upper one of the motor's bearings."""
    top = dims.stator_top_level
    return ring(dims.motor_bearing_bore_radius, dims.motor_bearing_radius, top - dims.motor_bearing_width, top)


def magnet(dims: Dimensions) -> cq.Shape:
    """Draw the encoder's magnet, flush with the retainer below."""
    bottom = dims.motor_retainer_level - dims.motor_retainer_thickness
    return cylinder(dims.encoder_magnet_radius, bottom, bottom + dims.encoder_magnet_height)


def board(dims: Dimensions) -> cq.Shape:
    """Draw the encoder's board with its chip as a disc, flush with the base below."""
    bottom = dims.encoder_board_level
    return cylinder(dims.encoder_board_radius, bottom, bottom + dims.encoder_board_height)


_MOTOR: dict[str, Draw] = {
    "motor_hub": hub, "motor_housing": housing, "motor_retainer": retainer, "motor_rotor": rotor,
    "motor_stator": stator, "motor_bearing": bearing,
}  # fmt: skip
_ENCODER: dict[str, Draw] = {"encoder_magnet": magnet, "encoder_board": board}


def drawn(dims: Dimensions) -> dict[str, Draw]:
    """Return how one of each kind is drawn, of what this module has."""
    if not dims.drive_height:
        return {}
    return {**_MOTOR, **(_ENCODER if dims.encoder_recess_radius else {})}


def stand(dims: Dimensions, solids: Mapping[str, cq.Solid], _rotor_angle: float) -> dict[str, cq.Shape]:
    """Place the motor's parts, by name: it holds its place while the link turns. All are drawn where they stand."""
    placed: dict[str, cq.Shape] = {kind: turned(solids[kind], 0.0) for kind in drawn(dims) if kind != "motor_bearing"}
    if placed:
        down = dims.motor_retainer_level + dims.motor_bearing_width - dims.stator_top_level
        placed["motor_bearing_1"] = turned(solids["motor_bearing"], 0.0)
        placed["motor_bearing_2"] = solids["motor_bearing"].moved(cq.Location(cq.Vector(0, 0, down)))
    return placed
