"""How the rotor turns in the housing: in a plain bore, or in two ball bearings on either side of a lip in the hub.

With bearings the hub has a seat at its upper and one at its lower end, and between the two a lip that both outer rings
stand against. The core ends in a journal. The collar above it stands on the upper inner ring, the retainer below
presses on the lower one, so one screw holds the rotor both ways and takes the play out. The hub may reach below the
floor (`hub_depth`) where two bearings and the lip need more height than floor and layer have.
"""

from __future__ import annotations

from typing import NamedTuple

from tvimdesign.catalog import Record
from tvimdesign.device.bodies import book as bodies
from tvimdesign.device.book import Book
from tvimdesign.device.gaps import book as gaps
from tvimdesign.device.layout import book as layout
from tvimdesign.device.rows import Extra, Rule, Scalar, at_least
from tvimdesign.physics import structure
from tvimdesign.physics.shapes import Section, ring

BEARINGS = 2
PLAIN = "none"
WITH_BEARINGS = (Extra("bearing", PLAIN),)

places, weights, rules = Book(layout.group), Book(bodies.group), Book(gaps.group)
books = (places, weights, rules)

places.record(
    "bearing",
    "bearings",
    PLAIN,
    "Ball bearings between hub and core, two of a kind, or none: a plain bore",
    others=(PLAIN,),
)
places.property("seat_clearance", "mm", ("process", "seat_clearance"), "Gap to each side of a bearing in its seat")


class Fit(NamedTuple):
    """What stands between hub and core, radii and lengths [m]; without bearings their width is zero."""

    journal: Scalar
    collar: Scalar
    seat: Scalar
    lip: Scalar
    width: float
    bore: float
    outer: float


@places.helper()
def bearing_fit(bearing: Record | str, core_radius: Scalar, running_clearance: Scalar, seat_clearance: Scalar) -> Fit:
    """Radii of journal, collar, seats and lip."""
    if isinstance(bearing, str):
        bore = core_radius + running_clearance
        return Fit(core_radius, core_radius, bore, bore, 0.0, 0.0, 0.0)
    value = bearing.value
    return Fit(
        journal=0.5 * value("bore") - seat_clearance,
        collar=0.5 * value("inner_shoulder"),
        seat=0.5 * value("outer_diameter") + seat_clearance,
        lip=0.5 * value("outer_shoulder"),
        width=value("width"),
        bore=0.5 * value("bore"),
        outer=0.5 * value("outer_diameter"),
    )


@places.output("mm")
def journal_radius(bearing_fit: Fit) -> Scalar:
    """Radius of the core inside the hub."""
    return bearing_fit.journal


@places.output("mm")
def collar_radius(bearing_fit: Fit) -> Scalar:
    """Radius of the collar between rotor plate and upper bearing; that of the core where there is none."""
    return bearing_fit.collar


@places.output("mm")
def seat_radius(bearing_fit: Fit) -> Scalar:
    """Inner radius of the hub at its ends: bearing seats, or the plain bore."""
    return bearing_fit.seat


@places.output("mm")
def lip_radius(bearing_fit: Fit) -> Scalar:
    """Inner radius of the hub between the bearings, or of the plain bore."""
    return bearing_fit.lip


@places.output("mm")
def bearing_width(bearing_fit: Fit) -> Scalar:
    """Width of one bearing; zero without."""
    return bearing_fit.width


@places.output("mm")
def bearing_bore_radius(bearing_fit: Fit) -> Scalar:
    """Inner radius of the bearings; zero without."""
    return bearing_fit.bore


@places.output("mm")
def bearing_outer_radius(bearing_fit: Fit) -> Scalar:
    """Outer radius of the bearings; zero without."""
    return bearing_fit.outer


@places.output("mm")
def hub_radius(seat_radius: Scalar, hub_wall: Scalar) -> Scalar:
    """Outer radius of the hub that carries the rotor."""
    return seat_radius + hub_wall


@places.output("mm")
def hub_top_level(bearing: Record | str, rotor_bottom_level: Scalar, running_clearance: Scalar) -> Scalar:
    """Upper end of the hub: the plain one carries the rotor plate, one with bearings keeps clear of it."""
    return rotor_bottom_level if isinstance(bearing, str) else rotor_bottom_level - running_clearance


@places.output("mm")
def hub_bottom_level(floor_thickness: Scalar, hub_depth: Scalar) -> Scalar:
    """Lower end of the hub."""
    return -floor_thickness - hub_depth


@places.output("mm")
def core_bottom_level(bearing: Record | str, hub_bottom_level: Scalar, running_clearance: Scalar) -> Scalar:
    """Lower end of the core: beyond the plain bore, or short of the lower bearing, which the retainer presses on."""
    play = -running_clearance if isinstance(bearing, str) else running_clearance
    return hub_bottom_level + play


@places.output("mm")
def retainer_top_level(bearing: Record | str, hub_bottom_level: Scalar, running_clearance: Scalar) -> Scalar:
    """Upper face of the retainer: it clears the hub, or bears on the lower bearing's inner ring."""
    return hub_bottom_level - running_clearance if isinstance(bearing, str) else hub_bottom_level


@places.output("mm")
def retainer_radius(bearing: Record | str, core_radius: Scalar, retainer_lip: Scalar, collar_radius: Scalar) -> Scalar:
    """Radius of the retainer: it reaches under the hub, or no further than the lower bearing's inner ring."""
    return core_radius + retainer_lip if isinstance(bearing, str) else collar_radius


# --- weights ---------------------------------------------------------------------------------------------------------


@weights.helper()
def bearing_inner_section(bearing_bore_radius: Scalar, bearing_outer_radius: Scalar) -> Section:
    """Plan view of what turns of a bearing: up to the middle of its balls."""
    return ring(bearing_bore_radius, 0.5 * (bearing_bore_radius + bearing_outer_radius))


@weights.helper()
def bearing_outer_section(bearing_bore_radius: Scalar, bearing_outer_radius: Scalar) -> Section:
    """Plan view of what stands of a bearing: from the middle of its balls."""
    return ring(0.5 * (bearing_bore_radius + bearing_outer_radius), bearing_outer_radius)


@weights.output("mm^3")
def bearing_inner_volume(bearing_inner_section: Section, bearing_width: Scalar) -> Scalar:
    """Volume of the turning halves of both bearings, as rings without gaps."""
    return BEARINGS * bearing_width * bearing_inner_section.area


@weights.output("mm^3")
def bearing_outer_volume(bearing_outer_section: Section, bearing_width: Scalar) -> Scalar:
    """Volume of the standing halves of both bearings, as rings without gaps."""
    return BEARINGS * bearing_width * bearing_outer_section.area


@weights.output("kg/m^3", extras=WITH_BEARINGS)
def bearing_density(bearing: Record) -> Scalar:
    """Mass of a bearing over its volume as a ring without gaps; zero without bearings."""
    section = ring(0.5 * bearing.value("bore"), 0.5 * bearing.value("outer_diameter"))
    return bearing.value("mass") / (section.area * bearing.value("width"))


@weights.output("g")
def bearings_mass(bearing_inner_volume: Scalar, bearing_outer_volume: Scalar, bearing_density: Scalar) -> Scalar:
    """Mass of both bearings together."""
    return (bearing_inner_volume + bearing_outer_volume) * bearing_density


@weights.output("kg*mm^2")
def bearings_inertia(bearing_inner_section: Section, bearing_width: Scalar, bearing_density: Scalar) -> Scalar:
    """Moment of inertia of what turns of both bearings."""
    return BEARINGS * bearing_width * bearing_inner_section.polar * bearing_density


# --- rules -----------------------------------------------------------------------------------------------------------


@rules.output(
    "mm",
    at_least(0.0, "the hub is too low for two bearings and a lip between them: more hub_depth, or a thicker floor"),
)
def bearing_lip_reserve(
    hub_top_level: Scalar, hub_bottom_level: Scalar, bearing_width: Scalar, minimum_wall: Scalar
) -> Scalar:
    """Lip of the hub between the bearings beyond the process's least wall."""
    return hub_top_level - hub_bottom_level - BEARINGS * bearing_width - minimum_wall


@rules.output("mm", at_least(0.0, "the core would split around the retainer's screw"))
def journal_wall_reserve(journal_radius: Scalar, retainer_screw_hole: Scalar, retainer_hole_wall: Scalar) -> Scalar:
    """Wall of the core around the hole of the retainer's screw beyond the least."""
    return journal_radius - 0.5 * retainer_screw_hole - retainer_hole_wall


@rules.output("N")
def bearing_load(
    holding_torque: Scalar,
    link_length: Scalar,
    link_bottom_level: Scalar,
    link_thickness: Scalar,
    hub_top_level: Scalar,
    hub_bottom_level: Scalar,
    bearing_width: Scalar,
) -> Scalar:
    """Force on the upper bearing, or the upper end of the bore, of a force at the link's end that the joint just holds.

    The force acts at half the link's thickness.
    """
    spread = hub_top_level - hub_bottom_level - bearing_width
    height = link_bottom_level + 0.5 * link_thickness - (hub_top_level - 0.5 * bearing_width)
    return structure.overhung_load(holding_torque / link_length, height, spread)


_DENTS = "a force at the link's end that the joint just holds would dent the bearings' races"


@rules.output("N", advice=(Rule(sense=">=", value=0.0, reason=_DENTS),), extras=WITH_BEARINGS)
def bearing_load_reserve(bearing: Record, bearing_load: Scalar) -> Scalar:
    """Static rating of a bearing less the force on it; zero for a plain bore."""
    return bearing.value("static_load_rating") - bearing_load
