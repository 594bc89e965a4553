"""What creeps out of the molten layer in a hot hour, and how soon a rotor that hangs on it draws it thicker.

The worst way up is taken: the axis level, so that gravity acts along the layer, across an arc's radial width; and for
the rotor's weight, upside down. To and fro of the joint moves no melt on average, as slow flow can be reversed [1],
and turns it outwards by w^2 r, a thousandth of gravity at 1 Hz; both are left out, and so are normal stresses of fast
shear. The half-width of a meniscus holds the melt only where an edge holds the meniscus: at lips, not between flat
faces. [1] Happel and Brenner, Low Reynolds Number Hydrodynamics, sec. 1-2.
"""

from __future__ import annotations

import numpy as np

from tvimdesign.device.core.molten import GRAVITY, HOUR
from tvimdesign.device.core.shrinkage import quantities as shared
from tvimdesign.device.shear.melt_lip import NO_LIP
from tvimdesign.device.table.module import Module
from tvimdesign.device.table.quantity import Rule, Scalar
from tvimdesign.device.table.quantity_group import QuantityGroup
from tvimdesign.physics.polymers import melt

quantities = QuantityGroup(shared.group)
DRAWN = 1.1
"""Thickness over that at the start up to which the time is told."""


@quantities.output("Pa")
def melt_head(m: Module) -> Scalar:
    """Pressure of the melt over the radial width of an arc that stands upright."""
    return m.pcl_melt_density * GRAVITY * m.arc_width


@quantities.output("Pa")
def melt_hold(m: Module) -> Scalar:
    """Pressure that the melt's surface holds below a lip; zero between flat faces, on which it may creep."""
    if m.melt_lip == NO_LIP:
        return 0.0 * m.pcl_surface_tension
    return melt.meniscus_pressure(m.pcl_surface_tension, m.running_clearance + m.freezing_travel)


_CREEPS = "so much of the molten layer creeps out in an hour with the axis level (assumed, 0.5 to 5 %)"


@quantities.output("%", advice=(Rule(sense="<=", value=0.01, reason=_CREEPS),))
def melt_loss(m: Module) -> Scalar:
    """Share of the layer that gravity moves out past an edge in an hour at the hot point, the axis level."""
    gap, length = m.pcl_thickness + m.freezing_travel, m.arc_width
    if m.melt_lip != NO_LIP:
        length = melt.gaps_in_series(m.arc_width, gap, m.rotor_rim, m.running_clearance + m.freezing_travel)
    head = np.fmax(m.melt_head - m.melt_hold, 0.0)
    return HOUR * melt.gap_speed(head / length, gap, m.pcl_viscosity_at_hot) / m.arc_width


@quantities.output("s")
def layer_drawing_time(m: Module) -> Scalar:
    """Time in which rotor, link and retainer, hanging on the molten layer alone, draw it a tenth thicker."""
    length, weight = m.arc_count * m.arc_span * m.pcl_mean_radius, GRAVITY * m.turning_mass
    ends = (m.pcl_thickness, DRAWN * m.pcl_thickness)
    return melt.squeeze_time(weight, m.pcl_viscosity_at_hot, length, m.arc_width, *ends)
