"""The flange for a torque sensor: a ring under the floor with the threads, bore and pin hole of a standard pattern.

It stands between hub and the openings of the floor, from the floor down to the ground, so the sensor bears the module
in place of its feet and measures what the joint hands on, without a gram more on the link. The retainer goes in and its
screw is turned through the flange's bore, which centres the sensor's spigot. Screws come from below, out of the sensor.
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
from tvimdesign.device.rows import Extra, Scalar, at_least
from tvimdesign.physics.shapes import NOTHING, Section, ring

WITHOUT = "none"
WITH_FLANGE = (Extra("sensor_flange", WITHOUT),)

places, weights = Book(layout.group, WITH_FLANGE), Book(bodies.group, WITH_FLANGE)
rules, supports = Book(gaps.group, WITH_FLANGE), Book(impedance.group)
books = (places, weights, rules, supports)

places.record(
    "sensor_flange",
    "sensor_flanges",
    WITHOUT,
    "Pattern for a torque sensor on the housing's underside, or none",
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


@places.output("mm")
def flange_outer_radius(sensor_pattern: Pattern, flange_wall: Scalar) -> Scalar:
    """Outer radius of the flange: a wall beyond the wider of its holes; zero without a flange."""
    return sensor_pattern.pitch_radius + _half_hole(sensor_pattern) + flange_wall


@places.output("mm")
def flange_screw_depth(flange_screw_reach: Scalar, screw_tip_room: Scalar) -> Scalar:
    """Depth of the holes for the sensor's screws; zero without a flange."""
    return flange_screw_reach + screw_tip_room


def _half_hole(pattern: Pattern) -> float:
    """Radius of the wider of screw holes and pin hole [m]."""
    return 0.5 * max(pattern.tap_drill, pattern.pin)


@supports.helper()
def floor_span(
    sensor_flange: Record | str, flange_outer_radius: Scalar, pcl_mean_radius: Scalar, placement_radius: Scalar
) -> tuple[Scalar, Scalar]:
    """Radii between which the floor hands the PCL's torque on [m]: out to the feet, or in to the flange."""
    if isinstance(sensor_flange, str):
        return pcl_mean_radius, placement_radius
    return flange_outer_radius, pcl_mean_radius


@weights.output("mm^3")
def flange_volume(
    sensor_pattern: Pattern,
    flange_bore_radius: Scalar,
    flange_outer_radius: Scalar,
    flange_screw_depth: Scalar,
    foot_height: Scalar,
    hub_radius: Scalar,
    hub_depth: Scalar,
) -> Scalar:
    """Volume the flange adds to the housing: its ring less its holes and less what of it is hub already."""
    in_hub = np.fmin(np.fmax(hub_radius, flange_bore_radius), flange_outer_radius)
    whole = ring(flange_bore_radius, flange_outer_radius).area * foot_height
    shared = ring(flange_bore_radius, in_hub).area * hub_depth
    screws = sensor_pattern.screws * sensor_pattern.tap_drill**2 * flange_screw_depth
    return whole - shared - 0.25 * np.pi * (screws + sensor_pattern.pin**2 * sensor_pattern.pin_depth)


@weights.helper(otherwise=NOTHING)
def flange_moments(flange_volume: Scalar, flange_bore_radius: Scalar, flange_outer_radius: Scalar) -> Section:
    """Volume and its polar moment about the axis, of the flange, its volume spread over its ring."""
    return Section(flange_volume, flange_volume * 0.5 * (flange_bore_radius**2 + flange_outer_radius**2))


# --- rules -----------------------------------------------------------------------------------------------------------


@rules.output("mm", at_least(0.0, "retainer and bearing do not go in through the sensor flange's bore"))
def flange_bore_gap(
    flange_bore_radius: Scalar,
    retainer_radius: Scalar,
    seat_radius: Scalar,
    slip_clearance: Scalar,
) -> Scalar:
    """Room for retainer and hub's bore inside the sensor flange's bore; zero without a flange."""
    return flange_bore_radius - np.fmax(retainer_radius, seat_radius) - slip_clearance


@rules.output("mm", at_least(0.0, "the sensor flange would close the pads' way out for wires and cold side's air"))
def flange_channel_gap(floor_opening_radius: Scalar, flange_outer_radius: Scalar) -> Scalar:
    """Room between the sensor flange and the openings below the pads; zero without a flange."""
    return floor_opening_radius - flange_outer_radius


@rules.output("mm", at_least(0.0, "the sensor flange would cover the springs' tang holes or their adjusters"))
def flange_spring_gap(
    preload_adjuster: str,
    placement_radius: Scalar,
    spring_reach: Scalar,
    tang_clearance: Scalar,
    adjuster_radius: Scalar,
    slip_clearance: Scalar,
    flange_outer_radius: Scalar,
) -> Scalar:
    """Room between the sensor flange and what springs take of the floor; zero without a flange."""
    taken = spring_reach + tang_clearance if preload_adjuster == FIXED else adjuster_radius + slip_clearance
    return placement_radius - taken - flange_outer_radius


@rules.output(
    "mm",
    at_least(0.0, "a hole of the sensor flange would open into a pad's seat: more foot_height, or less reach"),
)
def flange_seat_reserve(
    sensor_pattern: Pattern,
    foot_height: Scalar,
    solid_floor: Scalar,
    flange_screw_depth: Scalar,
    minimum_wall: Scalar,
) -> Scalar:
    """Floor left above the sensor flange's holes beyond the process's least wall; zero without a flange."""
    return foot_height + solid_floor - np.fmax(flange_screw_depth, sensor_pattern.pin_depth) - minimum_wall


@rules.output("mm", at_least(0.0, "the sensor's screws do not reach far enough into the flange to hold"))
def flange_thread_reserve(sensor_pattern: Pattern, flange_screw_reach: Scalar, thread_engagement: Scalar) -> Scalar:
    """Thread of the sensor's screws in the flange beyond what the process wants; zero without a flange."""
    return flange_screw_reach - thread_engagement * sensor_pattern.thread


@rules.output("mm", at_least(0.0, "the sensor flange would split outside its holes"))
def flange_wall_reserve(flange_wall: Scalar, minimum_wall: Scalar) -> Scalar:
    """Sensor flange outside its holes beyond the process's least wall; zero without a flange."""
    return flange_wall - minimum_wall


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
def flange_spigot_reserve(sensor_pattern: Pattern, retainer_gap: Scalar) -> Scalar:
    """Room between the sensor's spigot and the retainer's screw; zero without a flange."""
    return retainer_gap - sensor_pattern.centring_depth
