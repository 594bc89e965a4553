"""The screws of the module: which they are, their holes, what they weigh, and whether they hold.

A screw is drawn as two cylinders: its shank as thick as the hole its thread is cut in, its head without the socket.
Both leave something out on either side; the mass is right to a tenth of a gram or so for a screw.
"""

from __future__ import annotations

import numpy as np

from tvimdesign.catalog import Record
from tvimdesign.device.bodies import LINK_SCREWS
from tvimdesign.device.bodies import book as bodies
from tvimdesign.device.book import Book
from tvimdesign.device.gaps import MM
from tvimdesign.device.gaps import book as gaps
from tvimdesign.device.layout import book as layout
from tvimdesign.device.rows import Rule, Scalar, at_least
from tvimdesign.physics.shapes import Section, disc_at, ring

lengths, weights, rules = Book(layout.group), Book(bodies.group), Book(gaps.group)
books = (lengths, weights, rules)

for screw, default, words in (
    ("link_screw", "iso_7380_m3", "link screws"),
    ("retainer_screw", "iso_7380_m4", "retainer's screw"),
):
    lengths.record(screw, "screws", default, f"Screw of the catalogue: the {words}")
    for name, unit, field, description in (
        ("diameter", "mm", "nominal_diameter", "Nominal diameter"),
        ("pilot", "mm", "tap_drill", "Hole for the thread"),
        ("clearance", "mm", "clearance_hole", "Clearance hole"),
        ("head", "mm", "head_diameter", "Head diameter"),
        ("head_height", "mm", "head_height", "Head height"),
        ("density", "kg/m^3", "density", "Density"),
    ):
        lengths.property(f"{screw}_{name}", unit, (screw, field), f"{description} of the {words}")
lengths.record("mount_screw", "screws", "iso_4762_m3", "Screw of the catalogue that fixes the housing; not the module's")
lengths.property("mount_hole", "mm", ("mount_screw", "clearance_hole"), "Holes that fix the housing between the springs")


@lengths.output("mm")
def link_screw_depth(link_screw_length: Scalar, link_thickness: Scalar, screw_tip_room: Scalar) -> Scalar:
    """Depth of the link screws' holes in the core."""
    return link_screw_length - link_thickness + screw_tip_room


@lengths.output("mm")
def retainer_screw_depth(retainer_screw_length: Scalar, retainer_thickness: Scalar, screw_tip_room: Scalar) -> Scalar:
    """Depth of the retainer screw's hole in the core."""
    return retainer_screw_length - retainer_thickness + screw_tip_room


@weights.helper()
def link_screw_moments(
    link_screw_pilot: Scalar,
    link_screw_length: Scalar,
    link_screw_head: Scalar,
    link_screw_head_height: Scalar,
    link_bolt_circle_radius: Scalar,
) -> Section:
    """Volume of the four link screws and its polar moment about the axis."""
    shank = disc_at(0.5 * link_screw_pilot, link_bolt_circle_radius).times(LINK_SCREWS * link_screw_length)
    head = disc_at(0.5 * link_screw_head, link_bolt_circle_radius).times(LINK_SCREWS * link_screw_head_height)
    return Section(shank.area + head.area, shank.polar + head.polar)


@weights.helper()
def retainer_screw_moments(
    retainer_screw_pilot: Scalar,
    retainer_screw_length: Scalar,
    retainer_screw_head: Scalar,
    retainer_screw_head_height: Scalar,
) -> Section:
    """Volume of the retainer's screw and its polar moment about the axis."""
    shank = ring(0.0, 0.5 * retainer_screw_pilot).times(retainer_screw_length)
    head = ring(0.0, 0.5 * retainer_screw_head).times(retainer_screw_head_height)
    return Section(shank.area + head.area, shank.polar + head.polar)


@weights.output("mm^3")
def link_screw_volume(link_screw_moments: Section) -> Scalar:
    """Volume of the four link screws together."""
    return link_screw_moments.area


@weights.output("mm^3")
def retainer_screw_volume(retainer_screw_moments: Section) -> Scalar:
    """Volume of the retainer's screw."""
    return retainer_screw_moments.area


@weights.output("g")
def screws_mass(
    link_screw_volume: Scalar, link_screw_density: Scalar, retainer_screw_volume: Scalar, retainer_screw_density: Scalar
) -> Scalar:
    """Mass of the module's own screws; those that fix its housing are not among them."""
    return link_screw_volume * link_screw_density + retainer_screw_volume * retainer_screw_density


@weights.output("kg*mm^2")
def screws_inertia(
    link_screw_moments: Section,
    link_screw_density: Scalar,
    retainer_screw_moments: Section,
    retainer_screw_density: Scalar,
) -> Scalar:
    """Moment of inertia of the module's own screws about the axis."""
    return link_screw_moments.polar * link_screw_density + retainer_screw_moments.polar * retainer_screw_density


@rules.output("mm", at_least(0.0, "the link screws are too short to hold in the core"))
def link_thread_reserve(
    link_screw_length: Scalar, link_thickness: Scalar, thread_engagement: Scalar, link_screw_diameter: Scalar
) -> Scalar:
    """Thread of the link screws in the core beyond what the process wants."""
    return link_screw_length - link_thickness - thread_engagement * link_screw_diameter


@rules.output("mm", at_least(0.0, "the retainer's screw is too short to hold in the core"))
def retainer_thread_reserve(
    retainer_screw_length: Scalar,
    retainer_thickness: Scalar,
    thread_engagement: Scalar,
    retainer_screw_diameter: Scalar,
) -> Scalar:
    """Thread of the retainer's screw in the core beyond what the process wants."""
    return retainer_screw_length - retainer_thickness - thread_engagement * retainer_screw_diameter


@rules.output(
    "mm", advice=(Rule(sense="<=", value=0.01 * MM, reason="no screw of that length is on the list of the catalogue"),)
)
def screw_length_misfit(
    link_screw_length: Scalar, link_screw: Record, retainer_screw_length: Scalar, retainer_screw: Record
) -> Scalar:
    """How far the screws' lengths are from the nearest ones that are sold, both together."""
    return _misfit(link_screw_length, link_screw) + _misfit(retainer_screw_length, retainer_screw)


def _misfit(length: Scalar, screw: Record) -> Scalar:
    nearest: Scalar = np.inf
    for row in screw.table("lengths"):
        nearest = np.fmin(nearest, np.fabs(length - row["length"]))
    return nearest
