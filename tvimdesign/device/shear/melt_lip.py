"""Lips of the rotor plate along the molten layer's edges, and the melt that creeps out past them in a hot hour.

They turn in their own track, so nothing rubs on them. The melt's surface is held between a lip's edge and the floor,
and what leaves must go through the narrow gap below it. The plate is printed with that face up, so the lips need no
support.

Melt creeps out in a hot hour, and a rotor that hangs on it draws it thicker. The worst way up is taken: the axis level,
so that gravity acts along the layer, across an arc's radial width; and for the rotor's weight, upside down. To and fro
of the joint moves no melt on average, as slow flow can be reversed [1], and turns it outwards by w^2 r, a thousandth of
gravity at 1 Hz; both are left out, and so are normal stresses of fast shear. The half-width of a meniscus holds the
melt only where an edge holds the meniscus: at lips, not between flat faces. [1] Happel and Brenner, Low Reynolds Number
Hydrodynamics, sec. 1-2."""

from __future__ import annotations

import numpy as np

from tvimdesign.device.core.clearances import MM
from tvimdesign.device.core.shrinkage import GRAVITY, HOUR
from tvimdesign.device.table.module import Module
from tvimdesign.device.table.quantity import Feature, Rule, Scalar, at_least
from tvimdesign.device.table.quantity_group import QuantityGroup
from tvimdesign.physics.polymers import melt
from tvimdesign.physics.solids.shapes import Section, ring

NO_LIP = "none"
WITH_LIP = (Feature("melt_lip", NO_LIP),)
LEAST_LIP = 0.1 * MM
"""Least height of a lip; assumed, 0.1 to 0.2 mm: a layer of a print."""
places, weights, rules = QuantityGroup("Layout"), QuantityGroup("Size and weight"), QuantityGroup("Gaps", WITH_LIP)
places.option(
    "melt_lip", (NO_LIP, "rings"), "Whether rings of the rotor plate hold the melt at its inner and outer edge"
)


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


retention = QuantityGroup("Axial play")
DRAWN = 1.1
"""Thickness over that at the start up to which the time is told."""


@retention.output("Pa")
def melt_head(m: Module) -> Scalar:
    """Pressure of the melt over the radial width of an arc that stands upright."""
    return m.pcl_melt_density * GRAVITY * m.arc_width


@retention.output("Pa")
def melt_hold(m: Module) -> Scalar:
    """Pressure that the melt's surface holds below a lip; zero between flat faces, on which it may creep."""
    if m.melt_lip == NO_LIP:
        return 0.0 * m.pcl_surface_tension
    return melt.meniscus_pressure(m.pcl_surface_tension, m.running_clearance + m.freezing_travel)


_CREEPS = "so much of the molten layer creeps out in an hour with the axis level (assumed, 0.5 to 5 %)"


@retention.output("%", advice=(Rule(sense="<=", value=0.01, reason=_CREEPS),))
def melt_loss(m: Module) -> Scalar:
    """Share of the layer that gravity moves out past an edge in an hour at the hot point, the axis level."""
    gap, length = m.pcl_thickness + m.freezing_travel, m.arc_width
    if m.melt_lip != NO_LIP:
        length = melt.gaps_in_series(m.arc_width, gap, m.rotor_rim, m.running_clearance + m.freezing_travel)
    head = np.fmax(m.melt_head - m.melt_hold, 0.0)
    return HOUR * melt.gap_speed(head / length, gap, m.pcl_viscosity_at_hot) / m.arc_width


@retention.output("s")
def layer_drawing_time(m: Module) -> Scalar:
    """Time in which rotor, link and retainer, hanging on the molten layer alone, draw it a tenth thicker."""
    length, weight = m.arc_count * m.arc_span * m.pcl_mean_radius, GRAVITY * m.turning_mass
    ends = (m.pcl_thickness, DRAWN * m.pcl_thickness)
    return melt.squeeze_time(weight, m.pcl_viscosity_at_hot, length, m.arc_width, *ends)
