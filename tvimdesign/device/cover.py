"""The cover: a plate on the housing's rim that closes the module around the core, or none.

It is screwed to bosses that stand inside the housing's wall between the springs, where the feet are below. Above each
foot it has a hole as wide as the foot, so that a driver comes to the screws that fix the housing. The corners beside
the bosses are as round as a cutter of the process needs to be to reach the floor. With a cover the rim
is a running clearance higher than the pins, and the link goes on top of it. What air between layer and cover does to
the heat is not in the model.
"""

from __future__ import annotations

import numpy as np

from tvimdesign.device.bodies import book as bodies
from tvimdesign.device.book import Book
from tvimdesign.device.fastening import Joint, screwed_joint
from tvimdesign.device.gaps import book as gaps
from tvimdesign.device.layout import book as layout
from tvimdesign.device.rows import Extra, Scalar, at_least
from tvimdesign.physics.shapes import Section, disc_at, lens, lens_corner, ring

OPEN = "none"
WITH_COVER = (Extra("cover", OPEN),)
JOINT = Joint("cover", "iso_4762_m2", "the cover's screws", "cover's screws", "the housing", WITH_COVER)

places, weights, rules = Book(layout.group), Book(bodies.group), Book(gaps.group, WITH_COVER)
places.option("cover", (OPEN, "plate"), "Whether a plate on the housing's rim closes the module around the core")
books = (places, *screwed_joint(JOINT), weights, rules)


@places.helper(extras=WITH_COVER)
def cover_screw_count(spring_count: Scalar) -> Scalar:
    """Screws of the cover: one between each two springs; none without a cover."""
    return spring_count


@places.helper()
def cover_screw_circle(housing_inner_radius: Scalar) -> Scalar:
    """Radius of the circle of the cover's screws [m]."""
    return housing_inner_radius


@places.helper()
def cover_clamped(cover_thickness: Scalar) -> Scalar:
    """What the cover's screws go through [m]."""
    return cover_thickness


@places.output("mm")
def rim_level(cover: str, pin_top_level: Scalar, running_clearance: Scalar) -> Scalar:
    """Upper end of the housing's wall: that of the pins, and a running clearance more under a cover."""
    return pin_top_level if cover == OPEN else pin_top_level + running_clearance


@places.output("mm", extras=WITH_COVER)
def cover_height(cover_thickness: Scalar) -> Scalar:
    """Thickness that the cover adds to the height of the module; zero without."""
    return cover_thickness


@places.output("mm")
def cover_hole_radius(core_radius: Scalar, running_clearance: Scalar) -> Scalar:
    """Radius of the cover's hole for the core, which turns in it."""
    return core_radius + running_clearance


@places.output("mm")
def cover_boss_radius(cover_screw_hole: Scalar, cover_screw_clearance: Scalar, cover_hole_wall: Scalar) -> Scalar:
    """Radius of the bosses for the cover's screws: a wall around the wider of the holes of boss and cover."""
    return 0.5 * np.fmax(cover_screw_hole, cover_screw_clearance) + cover_hole_wall


@places.output("mm", extras=WITH_COVER)
def cover_corner_radius(corner_radius: Scalar, corner_depth_ratio: Scalar, rim_level: Scalar) -> Scalar:
    """Radius of the corners beside the cover's bosses, which are as deep as the wall is high; zero without a cover."""
    return np.fmax(corner_radius, rim_level / corner_depth_ratio)


# --- weights ---------------------------------------------------------------------------------------------------------


@weights.helper()
def cover_bosses_moments(
    cover_screw_count: Scalar,
    cover_boss_radius: Scalar,
    cover_corner_radius: Scalar,
    housing_inner_radius: Scalar,
    rim_level: Scalar,
    cover_screw_hole: Scalar,
    cover_screw_depth: Scalar,
) -> Section:
    """What the housing gains by the cover's bosses: what stands inside its wall, less the screws' holes.

    Volume and its polar moment about the axis, as if all stood on the wall's inner radius.
    """
    corners = 2.0 * lens_corner(cover_boss_radius, housing_inner_radius, cover_corner_radius)
    inside = (lens(cover_boss_radius, housing_inner_radius) + corners) * rim_level
    volume = cover_screw_count * (inside - 0.25 * np.pi * cover_screw_hole**2 * cover_screw_depth)
    return Section(volume, volume * housing_inner_radius**2)


@weights.helper()
def cover_section(
    cover_hole_radius: Scalar,
    housing_outer_radius: Scalar,
    spring_count: Scalar,
    cover_screw_clearance: Scalar,
    cover_screw_circle: Scalar,
    mount_boss_radius: Scalar,
    placement_radius: Scalar,
) -> Section:
    """Plan view of the cover: a ring around the core, less the holes of its screws and those above the feet."""
    screws = disc_at(0.5 * cover_screw_clearance, cover_screw_circle).times(spring_count)
    feet = disc_at(mount_boss_radius, placement_radius).times(spring_count)
    return ring(cover_hole_radius, housing_outer_radius) - screws - feet


@weights.output("mm^3")
def cover_volume(cover_section: Section, cover_height: Scalar) -> Scalar:
    """Volume of the cover; zero without."""
    return cover_section.area * cover_height


@weights.output("g")
def cover_mass(cover_volume: Scalar, structure_density: Scalar) -> Scalar:
    """Mass of the cover, without its screws."""
    return cover_volume * structure_density


# --- rules -----------------------------------------------------------------------------------------------------------


@rules.output("mm", at_least(0.0, "the cover is thinner than the process can make it"))
def cover_reserve(cover_thickness: Scalar, minimum_wall: Scalar) -> Scalar:
    """Cover beyond the process's least wall; zero without a cover."""
    return cover_thickness - minimum_wall


@rules.output(
    "mm", at_least(0.0, "the cover's screws would break out of the housing: a thicker wall, or smaller screws")
)
def cover_wall_reserve(wall_thickness: Scalar, cover_boss_radius: Scalar) -> Scalar:
    """Housing wall beyond the cover's bosses, which stand on its inner face; zero without a cover."""
    return wall_thickness - cover_boss_radius


@rules.output("mm", at_least(0.0, "the holes of the cover's screws would go through the floor: choose shorter screws"))
def cover_depth_reserve(rim_level: Scalar, cover_screw_depth: Scalar) -> Scalar:
    """Bosses below the holes of the cover's screws; zero without a cover."""
    return rim_level - cover_screw_depth


@rules.output("mm", at_least(0.0, "the cover's bosses must clear the springs, and their adjusters"))
def cover_spring_gap(
    placement_radius: Scalar,
    housing_inner_radius: Scalar,
    spring_count: Scalar,
    cover_boss_radius: Scalar,
    spring_reach: Scalar,
    radial_clearance: Scalar,
    adjuster_radius: Scalar,
    slip_clearance: Scalar,
) -> Scalar:
    """Room between the cover's bosses and springs or adjusters, beyond the clearance; zero without a cover."""
    half_pitch = np.pi / spring_count
    ahead = housing_inner_radius - placement_radius * np.cos(half_pitch)
    apart = np.sqrt(ahead**2 + (placement_radius * np.sin(half_pitch)) ** 2)
    taken = np.fmax(spring_reach + radial_clearance, adjuster_radius + slip_clearance)
    return apart - cover_boss_radius - taken


@rules.output(
    "mm", at_least(0.0, "the corners beside the cover's bosses, as round as a cutter needs, would reach the springs")
)
def cover_corner_reserve(spring_reach: Scalar, radial_clearance: Scalar, cover_corner_radius: Scalar) -> Scalar:
    """Radius of springs with their clearance beyond that of those corners: what clears wall and boss clears them."""
    return spring_reach + radial_clearance - cover_corner_radius


@rules.output("mm", at_least(0.0, "the cover's bosses stand in the way to the screws that fix the housing"))
def cover_mount_gap(
    housing_inner_radius: Scalar,
    cover_boss_radius: Scalar,
    placement_radius: Scalar,
    mount_boss_radius: Scalar,
) -> Scalar:
    """Room between the cover's bosses and the holes above the feet; zero without a cover."""
    return housing_inner_radius - cover_boss_radius - placement_radius - mount_boss_radius


@rules.output("mm", at_least(0.0, "the link would meet the heads of the cover's screws within the stroke"))
def cover_link_gap(
    housing_inner_radius: Scalar,
    spring_count: Scalar,
    stroke: Scalar,
    cover_screw_head: Scalar,
    link_half_width: Scalar,
    radial_clearance: Scalar,
) -> Scalar:
    """Room between the link at full stroke and the screws' heads, beyond the clearance; zero without a cover."""
    beside = housing_inner_radius * np.sin(np.pi / spring_count - stroke)
    return beside - 0.5 * cover_screw_head - link_half_width - radial_clearance
