"""Lips of the rotor plate along the molten layer's inner and outer edge: rings that reach down to a running clearance
above the floor, or none.

They turn in their own track, so nothing rubs on them. The melt's surface is held between a lip's edge and the floor,
and what leaves must go through the narrow gap below it. The plate is printed with that face up, so the lips need no
support.
"""

from __future__ import annotations

import numpy as np

from tvimdesign.device.core.clearances import MM
from tvimdesign.device.core.clearances import quantities as gaps
from tvimdesign.device.core.layout import quantities as layout
from tvimdesign.device.core.mass_properties import quantities as bodies
from tvimdesign.device.table.quantity import Feature, Scalar, at_least
from tvimdesign.device.table.quantity_group import QuantityGroup
from tvimdesign.physics.bodies.shapes import Section, ring

NO_LIP = "none"
WITH_LIP = (Feature("melt_lip", NO_LIP),)
LEAST_LIP = 0.1 * MM
"""Least height of a lip; assumed, 0.1 to 0.2 mm: a layer of a print."""
places, weights, rules = QuantityGroup(layout.group), QuantityGroup(bodies.group), QuantityGroup(gaps.group, WITH_LIP)
places.option(
    "melt_lip", (NO_LIP, "rings"), "Whether rings of the rotor plate hold the melt at its inner and outer edge"
)
groups = (places, weights, rules)


@places.output("mm", requires=WITH_LIP)
def melt_lip_height(pcl_thickness: Scalar, running_clearance: Scalar) -> Scalar:
    """Height of the lips below the rotor plate, which leave a running clearance above the floor; zero without."""
    return pcl_thickness - running_clearance


@places.output("mm", requires=WITH_LIP)
def melt_lip_inner_radius(pcl_inner_radius: Scalar, rotor_rim: Scalar) -> Scalar:
    """Inner radius of the inner lip, which is as wide as the plate's rim outside; zero without."""
    return pcl_inner_radius - rotor_rim


@places.helper()
def plate_lean(
    melt_lip: str, running_clearance: Scalar, stop_play: Scalar, hub_radius: Scalar, rotor_radius: Scalar
) -> Scalar:
    """Angle at which the leaning rotor's outer lip is down on the floor [rad], its other side held at the hub."""
    if melt_lip == NO_LIP:
        return np.inf
    return (running_clearance + stop_play) / (hub_radius + rotor_radius)


@weights.helper(requires=WITH_LIP, default=Section(0.0, 0.0))
def melt_lip_moments(
    melt_lip_inner_radius: Scalar,
    pcl_inner_radius: Scalar,
    pcl_outer_radius: Scalar,
    rotor_radius: Scalar,
    melt_lip_height: Scalar,
) -> Section:
    """Volume of both lips and its polar moment about the axis."""
    inner, outer = ring(melt_lip_inner_radius, pcl_inner_radius), ring(pcl_outer_radius, rotor_radius)
    return inner.plus(outer).times(melt_lip_height)


@rules.output("mm", at_least(0.0, "the layer is too thin for lips: a thicker one, less running_clearance, or none"))
def melt_lip_margin(melt_lip_height: Scalar) -> Scalar:
    """Height of the lips beyond the least that is worth while."""
    return melt_lip_height - LEAST_LIP


@rules.output("mm", at_least(0.0, "the lips are thinner than the process can make them: more rotor_rim"))
def melt_lip_wall_margin(rotor_rim: Scalar, minimum_wall: Scalar) -> Scalar:
    """Width of the lips beyond the process's least wall."""
    return rotor_rim - minimum_wall


@rules.output("mm", at_least(0.0, "the inner lip must clear the hub: less rotor_rim, or a larger pcl_inner_radius"))
def melt_lip_hub_gap(melt_lip_inner_radius: Scalar, hub_radius: Scalar, running_clearance: Scalar) -> Scalar:
    """Room between inner lip and hub beyond the running clearance."""
    return melt_lip_inner_radius - hub_radius - running_clearance
