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
from tvimdesign.device.table.module import Module
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
def melt_lip_height(m: Module) -> Scalar:
    """Height of the lips below the rotor plate, which leave a running clearance above the floor; zero without."""
    return m.pcl_thickness - m.running_clearance


@places.output("mm", requires=WITH_LIP)
def melt_lip_inner_radius(m: Module) -> Scalar:
    """Inner radius of the inner lip, which is as wide as the plate's rim outside; zero without."""
    return m.pcl_inner_radius - m.rotor_rim


@places.helper()
def plate_lean(m: Module) -> Scalar:
    """Angle at which the leaning rotor's outer lip is down on the floor [rad], its other side held at the hub."""
    if m.melt_lip == NO_LIP:
        return np.inf
    return (m.running_clearance + m.stop_play) / (m.hub_radius + m.rotor_radius)


@weights.helper(requires=WITH_LIP, default=Section(0.0, 0.0))
def melt_lip_moments(m: Module) -> Section:
    """Volume of both lips and its polar moment about the axis."""
    inner, outer = ring(m.melt_lip_inner_radius, m.pcl_inner_radius), ring(m.pcl_outer_radius, m.rotor_radius)
    return inner.plus(outer).times(m.melt_lip_height)


@rules.output("mm", at_least(0.0, "the layer is too thin for lips: a thicker one, less running_clearance, or none"))
def melt_lip_margin(m: Module) -> Scalar:
    """Height of the lips beyond the least that is worth while."""
    return m.melt_lip_height - LEAST_LIP


@rules.output("mm", at_least(0.0, "the lips are thinner than the process can make them: more rotor_rim"))
def melt_lip_wall_margin(m: Module) -> Scalar:
    """Width of the lips beyond the process's least wall."""
    return m.rotor_rim - m.minimum_wall


@rules.output("mm", at_least(0.0, "the inner lip must clear the hub: less rotor_rim, or a larger pcl_inner_radius"))
def melt_lip_hub_gap(m: Module) -> Scalar:
    """Room between inner lip and hub beyond the running clearance."""
    return m.melt_lip_inner_radius - m.hub_radius - m.running_clearance
