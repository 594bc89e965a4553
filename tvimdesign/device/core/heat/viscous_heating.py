"""Heat that the joint's own motion makes in the PCL.

The motion is a sine at the frequency of an operating point, by the torque that turns the hot joint by its stroke: a
joint that is still stiff turns less, and heats next to nothing. The damping is that of small strain, which is the most
the melt does (`hot_damping_at_stroke` is less).
"""

from __future__ import annotations

from tvimdesign.device.core.heat.thermal_stack import quantities as shared
from tvimdesign.device.table.quantity import Scalar
from tvimdesign.device.table.quantity_group import QuantityGroup
from tvimdesign.physics.layers import layer

quantities = QuantityGroup(shared.group)

quantities.option(
    "motion",
    ("at_rest", "moving"),
    "Whether the joint is left alone while it softens, is held soft and stiffens, or turned, which heats the PCL",
)


@quantities.output("W", per_point=True)
def viscous_heating(
    pcl_stiffness: Scalar,
    pcl_damping: Scalar,
    branch_stiffness: tuple[Scalar, Scalar],
    joint_impedance: Scalar,
    joint_impedance_at_hot: Scalar,
    stroke: Scalar,
    frequency: Scalar,
) -> Scalar:
    """Heat in the PCL where the joint is turned by the torque that turns the hot joint by its stroke."""
    pcl = (pcl_stiffness, layer.loss_stiffness(pcl_damping, frequency))
    turned = stroke * joint_impedance_at_hot / joint_impedance
    return layer.dissipation(pcl, branch_stiffness, turned, frequency)


@quantities.helper(instant=True)
def motion_heat(
    motion: str,
    slice_moduli: tuple[Scalar, Scalar],
    layer_stiffness_now: tuple[Scalar, Scalar],
    branch_now: tuple[Scalar, Scalar],
    impedance_now: Scalar,
    joint_impedance_at_hot: Scalar,
    stroke: Scalar,
    frequency_now: Scalar,
) -> Scalar:
    """Heat [W] the joint's motion makes in each slice of the PCL, most in those that are molten."""
    if motion == "at_rest":
        return 0.0
    turned = stroke * joint_impedance_at_hot / impedance_now
    heat = layer.dissipation(layer_stiffness_now, branch_now, turned, frequency_now)
    return heat * layer.loss_shares(*slice_moduli)
