"""The flange for a torque sensor, on which the joint stands: threads, bore and pin hole of a standard pattern.

Without a motor it is a ring under the floor, between hub and the openings of the floor, down to the ground, so the
sensor bears the module in place of its feet and measures what the joint hands on, without a gram more on the link. The
retainer goes in and its screw is turned through the flange's bore, which centres the sensor's spigot.

With a motor below the feet the pattern is in the base of the motor's housing (`drive.py`), which is then the joint's
lower end, in place of the base's own holes; the sensor reads what the motor turns against. Bearings, retainer and the
encoder's board go in through the bore. Screws come from below, out of the sensor.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from tvimdesign.catalog import Record
from tvimdesign.device.adjuster import FIXED
from tvimdesign.device.bodies import book as bodies
from tvimdesign.device.book import Book
from tvimdesign.device.gaps import book as gaps
from tvimdesign.device.impedance import book as impedance
from tvimdesign.device.layout import book as layout
from tvimdesign.device.motor import WITH_ENCODER, WITH_MOTOR, Motor
from tvimdesign.device.rows import Extra, Scalar, at_least
from tvimdesign.physics.shapes import NOTHING, Section, ring

WITHOUT = "none"
WITH_FLANGE = (Extra("sensor_flange", WITHOUT),)
ON_SENSOR = (*WITH_FLANGE, *WITH_MOTOR)
"""A motor that a sensor bears."""

places, weights = Book(layout.group, WITH_FLANGE), Book(bodies.group, WITH_FLANGE)
rules, supports = Book(gaps.group, WITH_FLANGE), Book(impedance.group)
books = (places, weights, rules, supports)

places.record(
    "sensor_flange",
    "sensor_flanges",
    WITHOUT,
    "Pattern for a torque sensor that the joint stands on, or none",
    others=(WITHOUT,),
)


class Pattern(NamedTuple):
    """What a flange has by its record, lengths [m]; without one all is zero."""

    screws: float = 0.0
    pitch_radius: float = 0.0
    thread: float = 0.0
    tap_drill: float = 0.0
    centring_radius: float = 0.0
    centring_depth: float = 0.0
    pin: float = 0.0
    pin_depth: float = 0.0


@places.helper(otherwise=Pattern())
def sensor_pattern(sensor_flange: Record) -> Pattern:
    """What the chosen pattern asks of the flange."""
    value = sensor_flange.value
    return Pattern(
        screws=value("screw_count"),
        pitch_radius=0.5 * value("pitch_diameter"),
        thread=value("thread_diameter"),
        tap_drill=value("tap_drill"),
        centring_radius=0.5 * value("centring_diameter"),
        centring_depth=value("centring_depth"),
        pin=value("pin_diameter"),
        pin_depth=value("pin_depth"),
    )


@places.output("1")
def sensor_screw_count(sensor_pattern: Pattern) -> Scalar:
    """Screws that hold a torque sensor; zero without a flange for one."""
    return sensor_pattern.screws


@places.output("mm")
def sensor_pitch_radius(sensor_pattern: Pattern) -> Scalar:
    """Radius of the circle of those screws and of the pin; zero without a flange."""
    return sensor_pattern.pitch_radius


@places.output("mm")
def sensor_screw_pilot(sensor_pattern: Pattern) -> Scalar:
    """Holes for the threads of those screws; zero without a flange."""
    return sensor_pattern.tap_drill


@places.output("mm")
def sensor_screw_diameter(sensor_pattern: Pattern) -> Scalar:
    """Nominal diameter of those screws; zero without a flange."""
    return sensor_pattern.thread


@places.output("mm")
def sensor_pin_diameter(sensor_pattern: Pattern) -> Scalar:
    """Hole for the sensor's locating pin, midway between two screws; zero without a flange."""
    return sensor_pattern.pin


@places.output("mm")
def sensor_pin_depth(sensor_pattern: Pattern) -> Scalar:
    """Depth of that hole; zero without a flange."""
    return sensor_pattern.pin_depth


@places.output("mm")
def flange_bore_radius(sensor_pattern: Pattern, seat_clearance: Scalar) -> Scalar:
    """Radius of the flange's bore, into which the sensor's spigot fits; zero without a flange."""
    return sensor_pattern.centring_radius + seat_clearance


@places.helper(otherwise=Pattern())
def floor_pattern(sensor_pattern: Pattern, drive: Motor | None) -> Pattern:
    """What the flange under the floor has: nothing where a motor stands there, whose base has the pattern."""
    return sensor_pattern if drive is None else Pattern()


@places.helper(extras=ON_SENSOR, otherwise=Pattern())
def base_pattern(sensor_pattern: Pattern) -> Pattern:
    """What the base of the motor's housing has of the pattern; nothing without a motor."""
    return sensor_pattern


@places.output("mm", extras=ON_SENSOR)
def sensor_recess_depth(base_pattern: Pattern, running_clearance: Scalar) -> Scalar:
    """Recess for the sensor's spigot in the base of the motor's housing; zero without motor or sensor."""
    return base_pattern.centring_depth + running_clearance


@places.output("mm")
def flange_outer_radius(floor_pattern: Pattern, flange_wall: Scalar) -> Scalar:
    """Outer radius of the flange: a wall beyond the wider of its holes; zero without a flange, or with a motor."""
    return floor_pattern.pitch_radius + _half_hole(floor_pattern) + flange_wall if floor_pattern.screws else 0.0


@places.output("mm")
def flange_screw_depth(flange_screw_reach: Scalar, screw_tip_room: Scalar) -> Scalar:
    """Depth of the holes for the sensor's screws; zero without a flange."""
    return flange_screw_reach + screw_tip_room


def _half_hole(pattern: Pattern) -> float:
    """Radius of the wider of screw holes and pin hole [m]."""
    return 0.5 * max(pattern.tap_drill, pattern.pin)


@supports.helper()
def floor_span(
    floor_pattern: Pattern, flange_outer_radius: Scalar, pcl_mean_radius: Scalar, placement_radius: Scalar
) -> tuple[Scalar, Scalar]:
    """Radii between which the floor hands the PCL's torque on [m]: out to the feet, or in to the flange."""
    if not floor_pattern.screws:
        return pcl_mean_radius, placement_radius
    return flange_outer_radius, pcl_mean_radius


@weights.output("mm^3")
def flange_volume(
    floor_pattern: Pattern,
    flange_bore_radius: Scalar,
    flange_outer_radius: Scalar,
    flange_screw_depth: Scalar,
    foot_height: Scalar,
    hub_radius: Scalar,
    hub_depth: Scalar,
) -> Scalar:
    """Volume the flange adds to the housing: its ring less its holes and less what of it is hub already."""
    if not floor_pattern.screws:
        return 0.0
    in_hub = np.fmin(np.fmax(hub_radius, flange_bore_radius), flange_outer_radius)
    whole = ring(flange_bore_radius, flange_outer_radius).area * foot_height
    shared = ring(flange_bore_radius, in_hub).area * hub_depth
    return whole - shared - pattern_holes(floor_pattern, flange_screw_depth)


def pattern_holes(pattern: Pattern, screw_depth: Scalar) -> Scalar:
    """Volume of a pattern's holes for screws and pin [m^3]."""
    return 0.25 * np.pi * (pattern.screws * pattern.tap_drill**2 * screw_depth + pattern.pin**2 * pattern.pin_depth)


@weights.helper(otherwise=NOTHING)
def flange_moments(flange_volume: Scalar, flange_bore_radius: Scalar, flange_outer_radius: Scalar) -> Section:
    """Volume and its polar moment about the axis, of the flange, its volume spread over its ring."""
    return Section(flange_volume, flange_volume * 0.5 * (flange_bore_radius**2 + flange_outer_radius**2))


# --- rules -----------------------------------------------------------------------------------------------------------


@rules.output(
    "mm", at_least(0.0, "what is put in through the bore for the sensor's spigot does not go: a larger pattern")
)
def flange_bore_gap(
    drive: Motor | None,
    flange_bore_radius: Scalar,
    retainer_radius: Scalar,
    seat_radius: Scalar,
    motor_seat_radius: Scalar,
    encoder_recess_radius: Scalar,
    slip_clearance: Scalar,
) -> Scalar:
    """Room in that bore around retainer and hub's bore, or the motor's bearings and board; zero without a flange."""
    if drive is not None:
        return flange_bore_radius - np.fmax(motor_seat_radius, encoder_recess_radius)
    return flange_bore_radius - np.fmax(retainer_radius, seat_radius) - slip_clearance


@rules.output("mm", at_least(0.0, "the sensor flange would close the pads' way out for wires and cold side's air"))
def flange_channel_gap(floor_pattern: Pattern, floor_opening_radius: Scalar, flange_outer_radius: Scalar) -> Scalar:
    """Room between the sensor flange and the openings below the pads; zero without a flange, or with a motor."""
    return floor_opening_radius - flange_outer_radius if floor_pattern.screws else 0.0


@rules.output("mm", at_least(0.0, "the sensor flange would cover the springs' tang holes or their adjusters"))
def flange_spring_gap(
    floor_pattern: Pattern,
    preload_adjuster: str,
    placement_radius: Scalar,
    spring_reach: Scalar,
    tang_clearance: Scalar,
    adjuster_radius: Scalar,
    slip_clearance: Scalar,
    flange_outer_radius: Scalar,
) -> Scalar:
    """Room between the sensor flange and what springs take of the floor; zero without a flange, or with a motor."""
    if not floor_pattern.screws:
        return 0.0
    taken = spring_reach + tang_clearance if preload_adjuster == FIXED else adjuster_radius + slip_clearance
    return placement_radius - taken - flange_outer_radius


_OPENS = (
    "a hole for the sensor would open into a pad's seat (more foot_height, or less reach), or into the motor (more "
    "motor_base_thickness)"
)


@rules.output("mm", at_least(0.0, _OPENS))
def flange_seat_reserve(
    sensor_pattern: Pattern,
    drive: Motor | None,
    foot_height: Scalar,
    solid_floor: Scalar,
    motor_base_thickness: Scalar,
    flange_screw_depth: Scalar,
    minimum_wall: Scalar,
) -> Scalar:
    """Floor, or motor's base, left above the holes for a sensor beyond the least wall; zero without a flange."""
    high = foot_height + solid_floor if drive is None else motor_base_thickness
    return high - np.fmax(flange_screw_depth, sensor_pattern.pin_depth) - minimum_wall


@rules.output("mm", at_least(0.0, "the sensor's screws do not reach far enough into the flange to hold"))
def flange_thread_reserve(sensor_pattern: Pattern, flange_screw_reach: Scalar, thread_engagement: Scalar) -> Scalar:
    """Thread of the sensor's screws in the flange beyond what the process wants; zero without a flange."""
    return flange_screw_reach - thread_engagement * sensor_pattern.thread


@rules.output("mm", at_least(0.0, "the sensor flange would split outside its holes"))
def flange_wall_reserve(
    sensor_pattern: Pattern,
    drive: Motor | None,
    motor_outer_radius: Scalar,
    flange_wall: Scalar,
    minimum_wall: Scalar,
) -> Scalar:
    """Wall outside the holes for a sensor beyond the least, in a motor's base beyond `flange_wall`; zero without."""
    if drive is None:
        return flange_wall - minimum_wall
    outside = motor_outer_radius - sensor_pattern.pitch_radius - _half_hole(sensor_pattern)
    return outside - np.fmax(flange_wall, minimum_wall)


@rules.output("mm", at_least(0.0, "the sensor flange would split between its holes and its bore"))
def flange_bore_wall_reserve(sensor_pattern: Pattern, flange_bore_radius: Scalar, minimum_wall: Scalar) -> Scalar:
    """Sensor flange between bore and holes beyond the process's least wall; zero without a flange."""
    return sensor_pattern.pitch_radius - _half_hole(sensor_pattern) - flange_bore_radius - minimum_wall


@rules.output("mm", at_least(0.0, "the sensor flange would split between a screw's hole and the pin's"))
def flange_pin_wall_reserve(sensor_pattern: Pattern, minimum_wall: Scalar) -> Scalar:
    """Sensor flange between screw holes and pin hole beyond the process's least wall; zero without a flange."""
    apart = 2.0 * sensor_pattern.pitch_radius * np.sin(0.5 * np.pi / sensor_pattern.screws)
    return apart - 0.5 * (sensor_pattern.tap_drill + sensor_pattern.pin) - minimum_wall


@rules.output("mm", at_least(0.0, "the sensor's spigot would meet the retainer's screw: more foot_height"))
def flange_spigot_reserve(floor_pattern: Pattern, retainer_gap: Scalar) -> Scalar:
    """Room between the sensor's spigot and the retainer's screw; zero without a flange, or with a motor."""
    return retainer_gap - floor_pattern.centring_depth if floor_pattern.screws else 0.0


@rules.output(
    "mm",
    at_least(0.0, "the groove for the encoder's wires would meet a hole for the sensor: turn flange_azimuth"),
    extras=(*WITH_FLANGE, *WITH_ENCODER),
)
def flange_groove_gap(
    base_pattern: Pattern, flange_azimuth: Scalar, motor_wire_width: Scalar, minimum_wall: Scalar
) -> Scalar:
    """Base between its holes for a sensor and the groove along x beyond the least wall; zero without that groove."""
    pitch = 2.0 * np.pi / base_pattern.screws
    holes = [(index * pitch, base_pattern.tap_drill) for index in range(round(base_pattern.screws))]
    apart: Scalar = np.inf
    for azimuth, width in [*holes, (0.5 * pitch, base_pattern.pin)]:
        along = base_pattern.pitch_radius * np.cos(flange_azimuth + azimuth)
        beside = base_pattern.pitch_radius * np.sin(flange_azimuth + azimuth)
        # The groove runs from the axis outwards: what stands behind the axis is as far from it as from the axis.
        away = np.sqrt(np.fmin(along, 0.0) ** 2 + beside**2)
        apart = np.fmin(apart, away - 0.5 * width)
    return apart - 0.5 * motor_wire_width - minimum_wall
