"""How the preload of each spring is set: not at all, or by a post that turns.

Springs as bought differ in their free angle by more than the stroke. A rotary adjuster is the spring's post with a
flange, let into a round pocket of the floor; the tang stands in the flange. A screw from below clamps it. To set a
spring: loosen that screw by half a turn, turn the post by the slot in its top until the leg lies on its pin as wanted,
and tighten again. Fixed, post and tang's hole are part of the floor.
"""

from __future__ import annotations

import numpy as np

from tvimdesign.device.bodies import book as bodies
from tvimdesign.device.book import Book
from tvimdesign.device.fastening import Joint, screwed_joint
from tvimdesign.device.gaps import book as gaps
from tvimdesign.device.layout import book as layout
from tvimdesign.device.rows import Extra, Scalar, at_least
from tvimdesign.physics.friction import disc_torque
from tvimdesign.physics.shapes import Section, bar_across, disc_at, ring

FIXED = "fixed"
WITH_ADJUSTERS = (Extra("preload_adjuster", FIXED),)
JOINT = Joint("adjuster", "iso_7380_m3", "that of a rotary adjuster", "adjusters' screws", "the posts", WITH_ADJUSTERS)

places, weights, rules = Book(layout.group), Book(bodies.group), Book(gaps.group, WITH_ADJUSTERS)
books = (places, *screwed_joint(JOINT), weights, rules)

places.option(
    "preload_adjuster", (FIXED, "rotary"), "Whether a spring's tang is held by the floor, or by a post that turns"
)


@places.output("deg", extras=WITH_ADJUSTERS)
def preload_adjustment() -> Scalar:
    """Range over which the preload of a spring can be set: none, or all around."""
    return 2.0 * np.pi


@places.output("mm", extras=WITH_ADJUSTERS)
def adjuster_radius(spring_reach: Scalar, tang_clearance: Scalar, minimum_wall: Scalar) -> Scalar:
    """Radius of an adjuster's flange, which has a wall around the tang; zero where the tangs are fixed."""
    return spring_reach + tang_clearance + minimum_wall


@places.output("mm", extras=WITH_ADJUSTERS)
def adjuster_thickness(floor_thickness: Scalar, minimum_wall: Scalar) -> Scalar:
    """Thickness of an adjuster's flange: it leaves the floor the process's least wall; zero where tangs are fixed."""
    return floor_thickness - minimum_wall


@places.output("mm")
def post_height(coil_end_level: Scalar, wire_diameter: Scalar) -> Scalar:
    """Height of the spring posts above the floor: up to the top of the coils."""
    return coil_end_level + 0.5 * wire_diameter


@places.output("mm")
def tang_length(
    preload_adjuster: str, floor_thickness: Scalar, adjuster_thickness: Scalar, tang_end_gap: Scalar
) -> Scalar:
    """Straight length of the tang in floor or flange, short of the lower face."""
    return (floor_thickness if preload_adjuster == FIXED else adjuster_thickness) - tang_end_gap


@places.helper()
def adjuster_clamped(floor_thickness: Scalar, adjuster_thickness: Scalar) -> Scalar:
    """What the adjusters' screws go through [m]: the floor below the flange."""
    return floor_thickness - adjuster_thickness


@places.helper(extras=WITH_ADJUSTERS)
def adjuster_screw_count(spring_count: Scalar) -> Scalar:
    """Screws of the adjusters, one each; none where the tangs are fixed."""
    return spring_count


@places.helper()
def adjuster_screw_circle(placement_radius: Scalar) -> Scalar:
    """Radius of the circle of the adjusters' screws [m]."""
    return placement_radius


# --- weights ---------------------------------------------------------------------------------------------------------


@weights.helper()
def spring_hole_section(
    preload_adjuster: str,
    placement_radius: Scalar,
    wire_diameter: Scalar,
    tang_clearance: Scalar,
    adjuster_radius: Scalar,
    slip_clearance: Scalar,
    adjuster_thickness: Scalar,
    adjuster_screw_clearance: Scalar,
    floor_thickness: Scalar,
) -> Section:
    """What a spring takes of the floor, on average over its thickness: the tang's hole, or pocket and screw's.

    Either counts about the spring's axis, the hole of a tang without an extent of its own.
    """
    if preload_adjuster == FIXED:
        area = ring(0.0, 0.5 * wire_diameter + tang_clearance).area
    else:
        pocket = ring(0.0, adjuster_radius + slip_clearance).area * adjuster_thickness
        hole = ring(0.0, 0.5 * adjuster_screw_clearance).area * (floor_thickness - adjuster_thickness)
        area = (pocket + hole) / floor_thickness
    return Section(area, area * (placement_radius**2 + 0.5 * adjuster_radius**2))


@weights.helper()
def fixed_posts_moments(
    preload_adjuster: str, spring_count: Scalar, post_radius: Scalar, post_height: Scalar, placement_radius: Scalar
) -> Section:
    """Volume and its polar moment about the axis, of the spring posts that are part of the floor."""
    standing = spring_count * post_height if preload_adjuster == FIXED else 0.0
    return disc_at(post_radius, placement_radius).times(standing)


@weights.output("mm^3", extras=WITH_ADJUSTERS)
def adjuster_volume(
    spring_count: Scalar,
    adjuster_radius: Scalar,
    adjuster_thickness: Scalar,
    post_radius: Scalar,
    post_height: Scalar,
    wire_diameter: Scalar,
    tang_clearance: Scalar,
    adjuster_screw_hole: Scalar,
    adjuster_screw_depth: Scalar,
    driver_slot_width: Scalar,
    driver_slot_depth: Scalar,
) -> Scalar:
    """Volume of all adjusters together: flange and post, less the tang's hole, the screw's and the driver's slot."""
    flange = np.pi * (adjuster_radius**2 - (0.5 * wire_diameter + tang_clearance) ** 2) * adjuster_thickness
    post = np.pi * post_radius**2 * post_height
    hole = 0.25 * np.pi * adjuster_screw_hole**2 * adjuster_screw_depth
    slot = bar_across(0.5 * driver_slot_width, post_radius) * driver_slot_depth
    return spring_count * (flange + post - hole - slot)


@weights.output("g")
def adjusters_mass(
    adjuster_volume: Scalar, structure_density: Scalar, adjuster_screw_volume: Scalar, adjuster_screw_density: Scalar
) -> Scalar:
    """Mass of all adjusters with their screws."""
    return adjuster_volume * structure_density + adjuster_screw_volume * adjuster_screw_density


# --- rules -----------------------------------------------------------------------------------------------------------


_NARROW = "a cutter does not come down between posts and wall: more radial_clearance, or springs that are less tall"


@rules.output("mm", at_least(0.0, _NARROW), extras=())
def post_pocket_reserve(
    preload_adjuster: str,
    housing_inner_radius: Scalar,
    placement_radius: Scalar,
    post_radius: Scalar,
    post_height: Scalar,
    pocket_depth_ratio: Scalar,
) -> Scalar:
    """Depth the place between the floor's posts and the wall may have for its width beyond the one it has."""
    deep = post_height if preload_adjuster == FIXED else 0.0
    return pocket_depth_ratio * (housing_inner_radius - placement_radius - post_radius) - deep


@rules.output(
    "mm",
    at_least(0.0, "the adjusters do not go in past the housing's wall: give the springs more radial_clearance"),
)
def adjuster_wall_gap(
    housing_inner_radius: Scalar,
    placement_radius: Scalar,
    adjuster_radius: Scalar,
    slip_clearance: Scalar,
) -> Scalar:
    """Room between the adjusters' pockets and the housing's wall; zero where tangs are fixed."""
    return housing_inner_radius - placement_radius - adjuster_radius - slip_clearance


@rules.output("mm", at_least(0.0, "the floor between the adjusters' pockets and the PCL is thinner than can be made"))
def adjuster_pcl_gap(
    placement_radius: Scalar,
    adjuster_radius: Scalar,
    slip_clearance: Scalar,
    pcl_outer_radius: Scalar,
    minimum_wall: Scalar,
) -> Scalar:
    """Floor between the adjusters' pockets and the PCL beyond the least wall; zero where tangs are fixed."""
    return placement_radius - adjuster_radius - slip_clearance - pcl_outer_radius - minimum_wall


@rules.output(
    "mm",
    at_least(0.0, "the floor between the adjusters' pockets and the mounting holes is thinner than can be made"),
)
def adjuster_mount_gap(
    placement_radius: Scalar,
    spring_count: Scalar,
    adjuster_radius: Scalar,
    slip_clearance: Scalar,
    mount_hole: Scalar,
    minimum_wall: Scalar,
) -> Scalar:
    """Floor between adjusters' pockets and mounting holes beyond the least wall; zero where tangs are fixed."""
    apart = 2.0 * placement_radius * np.sin(0.5 * np.pi / spring_count)
    return apart - adjuster_radius - slip_clearance - 0.5 * mount_hole - minimum_wall


@rules.output(
    "mm",
    at_least(0.0, "an adjuster's post would split around its screw: a thicker post, or a smaller screw"),
)
def adjuster_post_reserve(post_radius: Scalar, adjuster_screw_hole: Scalar, adjuster_hole_wall: Scalar) -> Scalar:
    """Wall of an adjuster's post around its screw's hole beyond the least; zero where tangs are fixed."""
    return post_radius - 0.5 * adjuster_screw_hole - adjuster_hole_wall


@rules.output("mm", at_least(0.0, "the screw's hole would reach the driver's slot: choose a shorter screw"))
def adjuster_top_reserve(
    adjuster_thickness: Scalar,
    post_height: Scalar,
    adjuster_screw_depth: Scalar,
    driver_slot_depth: Scalar,
    minimum_wall: Scalar,
) -> Scalar:
    """Post between screw's hole and driver's slot beyond the process's least wall; zero where tangs are fixed."""
    between = adjuster_thickness + post_height - adjuster_screw_depth - driver_slot_depth
    return between - minimum_wall


@rules.output("N*m", at_least(0.0, "the clamped adjusters would slip under their springs"))
def adjuster_grip_reserve(
    adjuster_friction: Scalar,
    adjuster_clamp_force: Scalar,
    adjuster_screw_clearance: Scalar,
    adjuster_radius: Scalar,
    spring_rate: Scalar,
    spring_winding: Scalar,
) -> Scalar:
    """Torque at which a clamped adjuster slips less the spring's largest; zero where tangs are fixed."""
    grip = disc_torque(adjuster_friction, adjuster_clamp_force, 0.5 * adjuster_screw_clearance, adjuster_radius)
    return grip - spring_rate * spring_winding
