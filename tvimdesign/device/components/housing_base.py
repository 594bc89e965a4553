"""The base: skirt and feet in one part of their own below a housing with a flat floor, or in one piece with it.

Printed in one piece, the floor hangs over the room that retainer, leads and cut-out need below it. A separate base
leaves the floor flat on the bed. It is the skirt, its feet joined to it by webs as wide as they are, and a sill below
its notches that keeps it one part; the sill takes its height from the air and the wires in the notches.

The screws that fix the module clamp floor, base and ground together. Stiffness and strength of a foot are those of one
in one piece as long as its upper face neither slips nor parts, which two rules ask with `holding_safety`. A foot bends
no more at the floor than at the ground, so that the ground's end counts; friction is that of the link on the core, and
the ground's no less. The clamp counts in full, as under the link screws. Webs and skirt are not counted to stiffen it.
"""

import numpy as np

from tvimdesign.device.components.screws import LEAST
from tvimdesign.device.core.mass_properties import template_made_mass
from tvimdesign.device.table import Feature, Module, QuantityGroup, Scalar, at_least
from tvimdesign.physics.solids import shapes

WITH_BASE = (Feature("housing_base", "one_piece"),)
places = QuantityGroup("Layout")
weights = QuantityGroup("Size and weight")
rules = QuantityGroup("Gaps", WITH_BASE)
strengths = QuantityGroup("Impedance", WITH_BASE)
places.choices("housing_base")
places.same("base_height", "foot_height", "Height of the base; zero in one piece", "mm", requires=WITH_BASE)
places.same("base_sill", "minimum_wall", "Height of the base below its notches; zero without", "mm", requires=WITH_BASE)


@places.output("mm", requires=WITH_BASE)
def base_corner_radius(m: Module) -> Scalar:
    """Radius of the corners between the base's webs and its ring; zero in one piece."""
    return np.fmax(m.corner_radius, m.foot_height / m.corner_depth_ratio)


@weights.helper(requires=WITH_BASE, default=shapes.NOTHING)
def base_moments(m: Module) -> shapes.Section:
    """Volume of the base and its polar moment about the axis: skirt and feet, webs with their corners, and sill."""
    half, inner = m.mount_boss_radius, m.housing_inner_radius
    corners = 2.0 * shapes.outer_corner(m.base_corner_radius, inner, half)
    web = shapes.Section(corners, corners * inner**2) - shapes.spoke(half, inner, m.placement_radius)
    sill = shapes.notch(0.5 * m.notch_width, inner, m.housing_outer_radius).times(m.base_sill)
    return m.skirt_moments.plus(web.times(m.foot_count * m.foot_height), sill.times(m.foot_count))


weights.field("base_volume", "base_moments", "area", "Volume of the base; zero in one piece", "mm^3")
weights.from_template("base", "the base; zero in one piece", template_made_mass, "g", name="base_mass")


rules.margins("housing_base")


@rules.gap("the corners beside the base's webs would reach past the feet: a larger radial_clearance, or a lower foot")
def base_corner_margin(m: Module) -> Scalar:
    """Length of the base's webs from the feet's middle to their corners; zero in one piece."""
    centre = m.housing_inner_radius - m.base_corner_radius
    return np.sqrt(centre**2 - (m.mount_boss_radius + m.base_corner_radius) ** 2) - m.placement_radius


strengths.after("foot_safety")
_CLAMP = "under the torque the joint holds: more mount_clamp_ratio, or `housing_base: one_piece`"


@strengths.output("1", at_least(1.0, f"the floor would slip on its base {_CLAMP}"), default=1.0)
def base_slip_safety(m: Module) -> Scalar:
    """Friction of floor on base under the mounting screws over `holding_safety` times the shear there; one in one
    piece."""
    borne = m.link_friction * m.foot_clamp_stress
    return borne / (m.holding_safety * np.sqrt(m.foot_shear_stress**2 + LEAST**2))


@strengths.output("1", at_least(1.0, f"a foot would part from what it is clamped to {_CLAMP}"), default=1.0)
def base_parting_safety(m: Module) -> Scalar:
    """Clamp's pressure over `holding_safety` times a foot's bending stress; one in one piece."""
    return m.foot_clamp_stress / (m.holding_safety * np.sqrt(m.foot_bending_stress**2 + LEAST**2))
