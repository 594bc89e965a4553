"""The gap a freezing block opens beside its vane, and the angle over which none touches because of it.

A block has free sides, so it shrinks alike in each direction. It stays on its pad and leaves the
rotor's vane; what the springs press into the gap while it is soft is not taken off, so the gap is an upper bound. The
rotor need not come down with the blocks: a running clearance is below and above them.
"""

from __future__ import annotations

from tvimdesign.device.core.layout import quantities as layout
from tvimdesign.device.core.shrinkage import quantities as shared
from tvimdesign.device.table.module import Module
from tvimdesign.device.table.quantity import Scalar
from tvimdesign.device.table.quantity_group import QuantityGroup
from tvimdesign.physics.polymers import shrinkage

places, quantities = QuantityGroup(layout.group), QuantityGroup(shared.group)
groups = (places, quantities)


@places.output("mm")
def freezing_travel(m: Module) -> Scalar:
    """How far the rotor comes down as the PCL freezes: not at all, blocks have clearance above and below."""
    return 0.0 * m.melting_growth


@quantities.output("mm")
def freezing_gap(m: Module) -> Scalar:
    """What a freezing block loses of its depth, and leaves beside its vane."""
    return m.block_depth * shrinkage.linear_share(m.freezing_shrinkage)


@quantities.output("deg")
def freezing_backlash(m: Module) -> Scalar:
    """Angle between a block's touch on either side of a rotor vane, after freezing at rest without load."""
    return 2.0 * m.freezing_gap / m.pcl_mean_radius
