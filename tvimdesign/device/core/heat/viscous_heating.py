"""Heat that the joint's own motion makes in the PCL.

The motion is a sine at the frequency of an operating point, by the torque that turns the hot joint by its stroke: a
joint that is still stiff turns less, and heats next to nothing. The damping is that of small strain, which is the most
the melt does (`hot_damping_at_stroke` is less).
"""

from __future__ import annotations

from tvimdesign.device.table.module import Module
from tvimdesign.device.table.quantity import Scalar
from tvimdesign.device.table.quantity_group import QuantityGroup
from tvimdesign.physics.layers import layer

quantities = QuantityGroup("Switch")

quantities.option(
    "motion",
    ("at_rest", "moving"),
    "Whether the joint is left alone while it softens, is held soft and stiffens, or turned, which heats the PCL",
)


@quantities.output("W", per_point=True)
def viscous_heating(m: Module) -> Scalar:
    """Heat in the PCL where the joint is turned by the torque that turns the hot joint by its stroke."""
    pcl = (m.pcl_stiffness, layer.loss_stiffness(m.pcl_damping, m.frequency))
    turned = m.stroke * m.joint_impedance_at_hot / m.joint_impedance
    return layer.dissipation(pcl, m.branch_stiffness, turned, m.frequency)


@quantities.helper(instant=True)
def motion_heat(m: Module) -> Scalar:
    """Heat [W] the joint's motion makes in each slice of the PCL, most in those that are molten."""
    if m.motion == "at_rest":
        return 0.0
    turned = m.stroke * m.joint_impedance_at_hot / m.impedance_now
    heat = layer.dissipation(m.layer_stiffness_now, m.branch_now, turned, m.frequency_now)
    return heat * layer.loss_shares(*m.slice_moduli)
