"""Creep of the PCL in a hold under load, and its cost in impedance.

The joint is at rest and its PCL free of stress; a load comes on at once, stays for `hold_time`, and goes. Meanwhile the
PCL relaxes, so that it would be free of stress somewhere else: `set_angle`. Each mode defines how much of
it can part from what presses on it, `parting_share`. A block that only pushes leaves a gap as wide as its set; a
layer bonded to both faces cannot part and acts in both senses from where it is, so that a hold takes nothing of its
impedance, however much of its stress has relaxed. The springs turn such a joint back all the same, more slowly.
"""

from __future__ import annotations

from tvimdesign.device.table.module import Module
from tvimdesign.device.table.quantity import Scalar
from tvimdesign.device.table.quantity_group import QuantityGroup
from tvimdesign.physics.layers import block, lasting_load
from tvimdesign.physics.motions import one_sided

quantities = QuantityGroup("Hold")

quantities.inputs()


@quantities.output("N*m")
def hold_torque(m: Module) -> Scalar:
    """Load of the hold; at `hold_share` 1 it turns the springs alone by the stroke."""
    return m.hold_share * m.spring_stiffness * m.stroke


@quantities.helper(per_point=True)
def held(m: Module) -> lasting_load.Held:
    """Joint and PCL at the end of the hold."""
    return lasting_load.held(m.hold_torque, m.hold_time, m.spring_stiffness, m.elastic_support, m.pcl_modes)


@quantities.output("rad", per_point=True)
def hold_angle(m: Module) -> Scalar:
    """Angle to which the load has turned the joint at the end of the hold."""
    return m.held.angle


@quantities.output("1", per_point=True)
def pcl_relaxation(m: Module) -> Scalar:
    """Share of its stress that the PCL loses when it is held at an angle as long; not a share of the impedance."""
    return block.relaxation_loss(m.hold_time, m.pcl_modes)


@quantities.output("rad", per_point=True)
def set_angle(m: Module) -> Scalar:
    """Angle at which the PCL is free of stress right after the hold; before, that was at rest."""
    return m.held.set_angle


@quantities.output("rad", per_point=True, headline=True)
def backlash(m: Module) -> Scalar:
    """Angle over which only the springs act right after the hold; none where the PCL is bonded to both its faces."""
    return m.parting_share * m.set_angle


@quantities.output("1", per_point=True, headline=True)
def relaxation_loss(m: Module) -> Scalar:
    """Share of the impedance lost in the hold: of the torque of a quick turn from rest to where the joint was held.

    A bonded layer that has relaxed takes the whole torque of such a turn: it starts from the stress it has.
    """
    return lasting_load.impedance_loss(m.hold_angle, m.backlash, m.spring_stiffness, m.elastic_support, m.pcl_modes)


@quantities.first_oscillation("1")
def contact_lost(m: Module) -> Scalar:
    """Share of the first swing of a released link, up to its second turn, in which no PCL is in contact."""
    return one_sided.out_of_contact(m.touching)
