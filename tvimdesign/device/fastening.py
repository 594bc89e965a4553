"""The rows of a screwed joint: its screw of the catalogue, holes, thread, weight, and whether it holds.

Every joint has them alike, so they are written once, with `its_` for the joint's name: `its_screw_length` is
`link_screw_length` of the joint `link`. The room a joint belongs to says in three rows what differs: `its_clamped`,
what the screws go through before their thread, `its_screw_count`, zero where the module has no such joint, and
`its_screw_circle`, the radius they stand on.

With `thread_insert: heat_set` the thread is in a brass insert where the screw's record names one: a ring at the mouth
of the hole, from the screw's shank to the hole's wall, as long and as heavy as the insert's record says.

A screw is drawn as two cylinders: its shank as thick as the hole its thread is cut in, its head without the socket.
Both leave something out on either side; the mass is right to a tenth of a gram or so for a screw.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from tvimdesign.catalog import Record
from tvimdesign.device.bodies import book as bodies
from tvimdesign.device.book import Book
from tvimdesign.device.gaps import MM
from tvimdesign.device.gaps import book as gaps
from tvimdesign.device.layout import book as layout
from tvimdesign.device.rows import Extra, Rule, Scalar, at_least
from tvimdesign.physics.shapes import Section, disc_at, ring, stacked


class Joint(NamedTuple):
    """What a screwed joint is called, and what it is about."""

    name: str
    screw: str
    """Record it has by default."""
    about: str
    """What its choice of a screw is."""
    words: str
    """Its screws, or its one screw."""
    into: str
    """The part they are screwed into."""
    extras: tuple[Extra, ...] = ()
    """What the module must have to have the joint."""


NO_INSERT = "none"
WITH_INSERTS = (Extra("thread_insert", NO_INSERT),)
_FIELDS = (
    ("diameter", "mm", "nominal_diameter", "Nominal diameter"),
    ("pilot", "mm", "tap_drill", "Hole for the thread"),
    ("clearance", "mm", "clearance_hole", "Clearance hole"),
    ("head", "mm", "head_diameter", "Head diameter"),
    ("head_height", "mm", "head_height", "Head height"),
    ("density", "kg/m^3", "density", "Density"),
)


def screwed_joint(joint: Joint) -> tuple[Book, Book, Book]:
    """Return the rows of a joint: its dimensions, its weights, its rules."""
    places, weights, rules = Book(layout.group), Book(bodies.group), Book(gaps.group)
    name, words = joint.name, joint.words
    melted_in = (*WITH_INSERTS, Extra(f"{name}_insert", NO_INSERT))
    places.record(f"{name}_screw", "screws", joint.screw, f"Screw of the catalogue: {joint.about}")
    for row, unit, field, description in _FIELDS:
        places.property(f"{name}_screw_{row}", unit, (f"{name}_screw", field), f"{description} of the {words}")
    places.record(
        f"{name}_insert", "inserts", (f"{name}_screw", "insert"),
        f"Insert for the {words} where `thread_insert` is heat_set", others=(NO_INSERT,), extras=WITH_INSERTS,
    )  # fmt: skip
    places.alike(name, words, its_thread)
    places.alike(name, words, its_screw_hole, "mm")
    places.alike(name, words, its_hole_wall, "mm")
    places.alike(name, words, its_screw_depth, "mm")
    places.alike(name, words, its_insert_length, "mm", extras=joint.extras)
    weights.alike(name, words, its_screw_moments)
    weights.alike(name, words, its_screw_volume, "mm^3")
    weights.alike(name, words, its_insert_moments)
    weights.alike(name, words, its_insert_volume, "mm^3")
    weights.alike(name, words, its_insert_density, "kg/m^3", extras=melted_in)
    short = at_least(0.0, f"the {words} would not hold in {joint.into}: choose a longer length")
    rules.alike(name, words, its_thread_reserve, "mm", short, extras=joint.extras)
    other = f"the inserts for the {words} have another thread: choose {name}_insert by {name}_screw"
    alike = Rule(sense="<=", value=0.01 * MM, reason=other)
    rules.alike(name, words, its_insert_misfit, "mm", alike, extras=(*joint.extras, *melted_in))
    return places, weights, rules


class Thread(NamedTuple):
    """What the screws' thread is in [m]."""

    hole: Scalar
    """Diameter of its hole."""
    wall: Scalar
    """Least wall around the hole."""
    engagement: Scalar
    """Least length of it that holds."""
    insert: float = 0.0
    """Length of the insert it is in; zero where it is cut in the part itself."""


def its_thread(
    thread_insert: str,
    its_insert: Record | str,
    its_screw_pilot: Scalar,
    its_screw_diameter: Scalar,
    thread_engagement: Scalar,
    minimum_wall: Scalar,
) -> Thread:
    """Thread of the {it}: cut in the part itself, or in an insert, which holds by its whole length."""
    if thread_insert == NO_INSERT or isinstance(its_insert, str):
        return Thread(its_screw_pilot, minimum_wall, thread_engagement * its_screw_diameter)
    value = its_insert.value
    wall = np.fmax(value("minimum_wall"), minimum_wall)
    return Thread(value("hole_diameter"), wall, value("length"), value("length"))


def its_screw_hole(its_thread: Thread) -> Scalar:
    """Diameter of the holes that the thread of the {it} is in."""
    return its_thread.hole


def its_hole_wall(its_thread: Thread) -> Scalar:
    """Least wall around the holes that the thread of the {it} is in."""
    return its_thread.wall


def its_screw_depth(its_screw_length: Scalar, its_clamped: Scalar, screw_tip_room: Scalar) -> Scalar:
    """Depth of the holes that the thread of the {it} is in."""
    return its_screw_length - its_clamped + screw_tip_room


def its_insert_length(its_thread: Thread) -> Scalar:
    """Length of the inserts for the {it}; zero where there are none."""
    return its_thread.insert


def its_screw_moments(
    its_screw_count: Scalar,
    its_screw_circle: Scalar,
    its_screw_pilot: Scalar,
    its_screw_length: Scalar,
    its_screw_head: Scalar,
    its_screw_head_height: Scalar,
) -> Section:
    """Volume of the {it} and its polar moment about the axis."""
    shank = disc_at(0.5 * its_screw_pilot, its_screw_circle)
    head = disc_at(0.5 * its_screw_head, its_screw_circle)
    return stacked((shank, its_screw_count * its_screw_length), (head, its_screw_count * its_screw_head_height))


def its_screw_volume(its_screw_moments: Section) -> Scalar:
    """Volume of the {it}, all together; zero where there are none."""
    return its_screw_moments.area


def its_insert_moments(
    its_screw_count: Scalar, its_screw_circle: Scalar, its_screw_pilot: Scalar, its_thread: Thread
) -> Section:
    """Volume of the inserts for the {it} and its polar moment about the axis."""
    hole, shank = disc_at(0.5 * its_thread.hole, its_screw_circle), disc_at(0.5 * its_screw_pilot, its_screw_circle)
    return (hole - shank).times(its_screw_count * its_thread.insert)


def its_insert_volume(its_insert_moments: Section) -> Scalar:
    """Volume of the inserts for the {it}, all together; zero where there are none."""
    return its_insert_moments.area


def its_insert_density(its_insert: Record, its_screw_pilot: Scalar) -> Scalar:
    """Mass of an insert for the {it} over its volume as a ring that fills its hole; zero without."""
    value = its_insert.value
    section = ring(0.5 * its_screw_pilot, 0.5 * value("hole_diameter"))
    return value("mass") / (section.area * value("length"))


def its_insert_misfit(its_insert: Record, its_screw_diameter: Scalar) -> Scalar:
    """How far the thread of the inserts for the {it} is from that of the screws; zero where there are none."""
    return np.fabs(its_insert.value("nominal_diameter") - its_screw_diameter)


def its_thread_reserve(its_screw_length: Scalar, its_clamped: Scalar, its_thread: Thread) -> Scalar:
    """Thread of the {it} beyond what holds; zero where there are none."""
    return its_screw_length - its_clamped - its_thread.engagement


def length_misfit(length: Scalar, screw: Record) -> Scalar:
    """How far a length is from the nearest one that is sold [m]."""
    nearest: Scalar = np.inf
    for row in screw.table("lengths"):
        nearest = np.fmin(nearest, np.fabs(length - row["length"]))
    return nearest
