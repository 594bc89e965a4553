"""A joint without springs, as a clutch, a brake or a locking hinge: what it has in place of the shear module's.

Quantities here are in place of those of the same name. Feet take the room of the springs, posts of the stops take the
circle between their teeth, and the rotor may turn far. Molten, nothing but the melt and friction resists: the drag is
that of a steady turn, after the melt has flowed for longer than it remembers. Shear thinning is left out, so that it is
an upper bound. What counts for tearing is not the angle, which only moves melt along itself, but what the melt
remembers of it: the shear rate times its mean relaxation time, sum G tau^2 / sum G tau (Ferry, Viscoelastic Properties
of Polymers, 3rd ed., ch. 3: the recoverable strain of slow steady flow).

The melt goes with both of its faces, so that an arc leans after a turn. Frozen so, it bears where its faces still lie
over one another: the torque held is the least over the stroke.
"""

import numpy as np

from tvimdesign.device.components.hard_stops import SLIVER, STOPS
from tvimdesign.device.core.layout import LEAST_FILLET, evened_least
from tvimdesign.device.table import Module, QuantityGroup, Scalar, at_least
from tvimdesign.physics.layers import layer
from tvimdesign.physics.motions.contacts import journal_torque
from tvimdesign.physics.polymers.viscoelasticity import zero_shear_viscosity

places = QuantityGroup("Layout")
places.inputs("stroke", value=0.8, to=1.4, status="chosen", source="a finger's joint turns by 90 deg")
places.inputs(
    "axial_clearance", value=5, about="Axial gap between rotor plate, wall and link",
    source="what link screws of 12 mm want of the core, which no legs keep long",
)  # fmt: skip


places.formulas("lock.places")


@places.output("mm")
def foot_fillet(m: Module) -> Scalar:
    """Radius of the fillet at the core's foot on the rotor plate: as large as is asked for, within rim and plate."""
    room = evened_least(
        m.rim_level - m.rotor_top_level - m.running_clearance, m.rotor_radius - m.core_radius - LEAST_FILLET
    )
    return np.fmax(evened_least(m.largest_foot_fillet, room), LEAST_FILLET)


@places.output("deg")
def stop_post_span(m: Module) -> Scalar:
    """Angle that a post covers: `stop_length`, or half of what the teeth leave up to the other tooth's post."""
    room = np.pi / STOPS - m.stop_angle - 0.5 * (m.stop_tooth_span + m.minimum_wall / m.stop_contact_radius)
    length = evened_least(m.stop_length, room * m.stop_contact_radius)
    return np.fmax(length, SLIVER) / m.stop_contact_radius


rules = QuantityGroup("Gaps")


rules.margins("lock")


holds = QuantityGroup("Hold")
holds.inputs(
    "hold_share", value=0.5, about="Load of the hold over the torque that the frozen joint holds",
    source="half of what it bears, 0.1 to 1",
)  # fmt: skip


@holds.output("N*m")
def hold_torque(m: Module) -> Scalar:
    """Load of the hold."""
    return m.hold_share * m.holding_torque


turns = QuantityGroup("Impedance")


@turns.output(
    "1", at_least(0.0, "an arc's melt has left it at the end of the stroke: longer arcs, or less stroke", 0.0)
)
def turned_overlap(m: Module) -> Scalar:
    """Share of the layer whose faces lie over one another at the end of the stroke."""
    return 1.0 - m.stroke / m.arc_span


@turns.output("N*m", headline=True)
def layer_drag_torque(m: Module) -> Scalar:
    """Torque of the molten layer against a steady turn, at the hot point."""
    return zero_shear_viscosity(m.pcl_modes_at_hot) * m.turn_speed


@turns.helper()
def bearing_friction_share(m: Module) -> Scalar:
    """Friction torque of bearings or bore over the torque of a force at the link's end [1]."""
    friction = m.bore_friction if isinstance(m.bearing, str) else m.bearing_friction
    return journal_torque(friction, 2.0 * m.bearing_load_per_torque - 1.0 / m.link_length, 2.0 * m.journal_radius)


turns.formulas("lock.turns")


@turns.output("kPa", headline=True)
def melt_stress(m: Module) -> Scalar:
    """Shear stress in the melt at its outer radius while the joint turns."""
    return layer.traction(m.layer_drag_torque, m.layer_polar_moment, m.pcl_outer_radius)


@turns.output("1", at_least(1.0, "the molten layer would tear or slip: a slower turn_speed"))
def layer_strain_safety(m: Module) -> Scalar:
    """Strain the molten layer bears over what it remembers of the turn at its outer radius."""
    weighted = sum(stiffness * tau**2 for tau, stiffness in m.pcl_modes_at_hot)
    rate = layer.shear_strain(m.pcl_outer_radius, m.turn_speed, m.pcl_thickness)
    return m.pcl_melt_strain_limit / (rate * weighted / zero_shear_viscosity(m.pcl_modes_at_hot))
