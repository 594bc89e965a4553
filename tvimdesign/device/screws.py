"""The screws that every module has: those of the link and that of the retainer; what all screws weigh together."""

from __future__ import annotations

import numpy as np

from tvimdesign.catalog import Record
from tvimdesign.device.bodies import LINK_SCREWS
from tvimdesign.device.bodies import book as bodies
from tvimdesign.device.book import Book
from tvimdesign.device.fastening import WITH_INSERTS, Joint, length_misfit, screwed_joint
from tvimdesign.device.gaps import MM
from tvimdesign.device.gaps import book as gaps
from tvimdesign.device.layout import book as layout
from tvimdesign.device.rows import Rule, Scalar, at_least
from tvimdesign.physics.shapes import Section

LINK = Joint("link", "iso_7380_m3", "the link screws", "link screws", "the core")
RETAINER = Joint("retainer", "iso_7380_m4", "the retainer's screw", "retainer's screw", "the core")

lengths, weights, rules = Book(layout.group), Book(bodies.group), Book(gaps.group)
lengths.record("mount_screw", "screws", "iso_4762_m3", "Screw that fixes the housing; not one of the module's")
lengths.property("mount_hole", "mm", ("mount_screw", "clearance_hole"), "Holes that fix the housing")
books = (*screwed_joint(LINK), *screwed_joint(RETAINER), lengths, weights, rules)


@lengths.helper()
def link_clamped(link_thickness: Scalar) -> Scalar:
    """What the link screws go through [m]."""
    return link_thickness


@lengths.helper()
def link_screw_count() -> Scalar:
    """Screws of the link."""
    return LINK_SCREWS


@lengths.helper()
def link_screw_circle(link_bolt_circle_radius: Scalar) -> Scalar:
    """Radius of the circle of the link screws [m]."""
    return link_bolt_circle_radius


@lengths.helper()
def retainer_clamped(retainer_thickness: Scalar) -> Scalar:
    """What the retainer's screw goes through [m]."""
    return retainer_thickness


@lengths.helper()
def retainer_screw_count() -> Scalar:
    """Screws of the retainer."""
    return 1


@lengths.helper()
def retainer_screw_circle() -> Scalar:
    """Distance of the retainer's screw from the axis [m]."""
    return 0.0


@weights.output("g")
def screws_mass(
    link_screw_volume: Scalar,
    link_screw_density: Scalar,
    retainer_screw_volume: Scalar,
    retainer_screw_density: Scalar,
    cover_screw_volume: Scalar,
    cover_screw_density: Scalar,
) -> Scalar:
    """Mass of the screws of link, retainer and cover; those that fix the housing are not the module's."""
    turning = link_screw_volume * link_screw_density + retainer_screw_volume * retainer_screw_density
    return turning + cover_screw_volume * cover_screw_density


@weights.output("kg*mm^2")
def screws_inertia(
    link_screw_moments: Section,
    link_screw_density: Scalar,
    retainer_screw_moments: Section,
    retainer_screw_density: Scalar,
) -> Scalar:
    """Moment of inertia of the screws that turn about the axis: those of link and retainer."""
    return link_screw_moments.polar * link_screw_density + retainer_screw_moments.polar * retainer_screw_density


@weights.output("g")
def inserts_mass(
    link_insert_volume: Scalar,
    link_insert_density: Scalar,
    retainer_insert_volume: Scalar,
    retainer_insert_density: Scalar,
    adjuster_insert_volume: Scalar,
    adjuster_insert_density: Scalar,
    cover_insert_volume: Scalar,
    cover_insert_density: Scalar,
) -> Scalar:
    """Mass of all heat-set inserts; zero without."""
    core = link_insert_volume * link_insert_density + retainer_insert_volume * retainer_insert_density
    posts = adjuster_insert_volume * adjuster_insert_density
    return core + posts + cover_insert_volume * cover_insert_density


@weights.output("kg*mm^2")
def inserts_inertia(
    link_insert_moments: Section,
    link_insert_density: Scalar,
    retainer_insert_moments: Section,
    retainer_insert_density: Scalar,
) -> Scalar:
    """Moment of inertia of the inserts that turn about the axis: those in the core."""
    return link_insert_moments.polar * link_insert_density + retainer_insert_moments.polar * retainer_insert_density


_MELT = "heat-set inserts are melted into plastic, and this process mills: `thread_insert: none`, or print it"


@rules.output("1", at_least(1.0, _MELT), extras=WITH_INSERTS, otherwise=1.0)
def insert_ground(making_method: str) -> Scalar:
    """One where there are no inserts, or the process prints the plastic they are melted into; else zero."""
    return 1.0 if making_method == "printed" else 0.0


@rules.output(
    "mm", advice=(Rule(sense="<=", value=0.01 * MM, reason="no screw of that length is on the list of the catalogue"),)
)
def screw_length_misfit(
    link_screw_length: Scalar,
    link_screw: Record,
    retainer_screw_length: Scalar,
    retainer_screw: Record,
    adjuster_screw_count: Scalar,
    adjuster_screw_length: Scalar,
    adjuster_screw: Record,
    cover_screw_count: Scalar,
    cover_screw_length: Scalar,
    cover_screw: Record,
) -> Scalar:
    """How far the screws' lengths are from the nearest ones that are sold, all that the module has together."""
    adjusters = np.fmin(adjuster_screw_count, 1.0) * length_misfit(adjuster_screw_length, adjuster_screw)
    cover = np.fmin(cover_screw_count, 1.0) * length_misfit(cover_screw_length, cover_screw)
    always = length_misfit(link_screw_length, link_screw) + length_misfit(retainer_screw_length, retainer_screw)
    return always + adjusters + cover
