"""Heating until the joint is soft, cooling until it is stiff again, and both as a cycle."""

import numpy as np

from tvimdesign.device.table import Module, QuantityGroup, Scalar, at_least
from tvimdesign.device.table.quantity import EQUILIBRIUM_STIFFENING, SOFTENING, STIFFENING
from tvimdesign.physics.heat_flow import heat

quantities = QuantityGroup("Softening")

quantities.inputs()
quantities.choices("softening")


@quantities.event(SOFTENING)
def near_face_time(m: Module) -> Scalar:
    """Time until the layer's face at the heaters is at the target temperature."""
    return (m.stack_profile.near - m.target_temperature) / heat.TEMPERATURE_SCALE


@quantities.event(SOFTENING)
def mean_time(m: Module) -> Scalar:
    """Time until the layer's mean is at the target temperature."""
    return (m.mean_temperature - m.target_temperature) / heat.TEMPERATURE_SCALE


@quantities.event(SOFTENING)
def far_face_time(m: Module) -> Scalar:
    """Time until the layer's face at the rotor is at the target temperature."""
    return (m.stack_profile.far - m.target_temperature) / heat.TEMPERATURE_SCALE


@quantities.output("N*m/rad")
def soft_threshold(m: Module) -> Scalar:
    """Impedance at and below which the joint counts as soft: the softening band above its target."""
    return m.softening_band * (m.soft_impedance if m.impedance_targets == "stated" else m.joint_impedance_at_hot)


@quantities.output("1", at_least(0.0, "the joint never gets as soft as `soft_impedance` asks"))
def soft_reach(m: Module) -> Scalar:
    """Distance of the hot joint below the soft threshold, as the logarithm of the ratio."""
    return np.log(m.soft_threshold) - np.log(m.joint_impedance_at_hot)


@quantities.event(SOFTENING)
def softening_time(m: Module) -> Scalar:
    """Time until the joint's impedance is within the softening band of its target.

    The target is the joint's impedance at the hot point unless it is stated.
    """
    return np.log(m.soft_threshold) - np.log(m.impedance_now)


@quantities.event(SOFTENING)
def response_time(m: Module) -> Scalar:
    """Softening time, from the start of heating to its end, by the criterion the study chose."""
    if m.response_criterion == "softening":
        return softening_time(m)
    if m.response_criterion == "mean":
        return mean_time(m)
    return near_face_time(m) if m.response_criterion == "near_face" else far_face_time(m)


quantities.margins("softening.quantities")
quantities.phase_values("softening.quantities")


@quantities.output("1", headline=True)
def softened_range(m: Module) -> Scalar:
    """Stiffness of the joint cold over that when heating stops."""
    return m.joint_stiffness_at_cold / m.softened_stiffness


@quantities.path(SOFTENING, "degC", "end")
def sensed_temperature(m: Module) -> Scalar:
    """Temperature at the thermistor when heating stops: the layer's face, or the pads' outer side without a bead."""
    return np.where(m.thermistor_diameter > 0.0, m.stack_profile.near, m.stack_profile.cold)


stiffenings = QuantityGroup("Stiffening")

HALF = 0.5
SHARPNESS = 80.0

stiffenings.inputs()
stiffenings.choices("stiffening")


@stiffenings.output("N*m/rad")
def stiff_threshold(m: Module) -> Scalar:
    """Impedance at and above which the joint counts as stiff: the stiffening band below its target."""
    return (m.stiff_impedance if m.impedance_targets == "stated" else m.joint_impedance_at_cold) / m.stiffening_band


@stiffenings.output("1", at_least(0.0, "the joint never gets as stiff as `stiff_impedance` asks"))
def stiff_reach(m: Module) -> Scalar:
    """Distance of the cold joint above the stiff threshold, as the logarithm of the ratio."""
    return np.log(m.joint_impedance_at_cold) - np.log(m.stiff_threshold)


@stiffenings.event(STIFFENING)
def stiffening_time(m: Module) -> Scalar:
    """Time from when heating stops until the joint's impedance is within the stiffening band of its target.

    The target is the joint's impedance at the cold point unless it is stated.
    """
    return np.log(m.impedance_now) - np.log(m.stiff_threshold)


@stiffenings.event(EQUILIBRIUM_STIFFENING)
def equilibrium_stiffening_time(m: Module) -> Scalar:
    """Stiffening time if the layer froze where it melts, without supercooling; for comparison only."""
    return stiffening_time(m)


@stiffenings.event(STIFFENING)
def frozen_time(m: Module) -> Scalar:
    """Time from when heating stops until every slice of the layer is half frozen.

    The slices are in series: under a lasting load the joint creeps as its least frozen slice flows. The least is
    taken smoothly, by the mean of exp(-80 X), which is at most 0.03 of X below it.
    """
    return -np.log(np.mean(np.exp(-SHARPNESS * (m.stack_profile.fractions - HALF)))) / SHARPNESS


@stiffenings.event(STIFFENING, headline=False)
def return_time(m: Module) -> Scalar:
    """Time of the way back, by the criterion the study chose: stiff at its frequency, or frozen."""
    return frozen_time(m) if m.stiffening_criterion == "frozen" else stiffening_time(m)


stiffenings.margins("softening.stiffenings")


@stiffenings.output(
    "1",
    advice=(
        at_least(0.0, "soft and stiff overlap: between the two thresholds the joint counts as "
             "both, and the times of a switch say nothing"),
    ),
)  # fmt: skip
def thresholds_apart(m: Module) -> Scalar:
    """Distance of the stiff threshold above the soft one, as the logarithm of the ratio."""
    return np.log(m.stiff_threshold) - np.log(m.soft_threshold)


@stiffenings.event(STIFFENING)
def far_face_cooling_time(m: Module) -> Scalar:
    """Time from when heating stops until the face at the rotor is down to the cold point's temperature."""
    return (m.temperature_at_cold - m.stack_profile.far) / heat.TEMPERATURE_SCALE


stiffenings.phase_values("softening.stiffenings")


@stiffenings.output("s", headline=True)
def cycle_time(m: Module) -> Scalar:
    """Time to soften and to stiffen again, each by its criterion."""
    return m.response_time + m.return_time


@stiffenings.output("J", headline=True)
def cycle_energy(m: Module) -> Scalar:
    """Electrical energy to soften and to stiffen again."""
    return m.switch_energy + m.stiffening_energy


# --- in repeated use and under its controller, which a study may require by `name@state` ---


DUTY, CONTROL = "duty", "control"
quantities.simulated(
    "highest_switch_rate", "1/h", DUTY, "Most switches an hour, each to soft and back, that exceed no rating"
)
quantities.simulated(
    "overshoot", "K", CONTROL, "Hot face of the layer above its controller's highest set-point, in 95 % of modules"
)
quantities.simulated(
    "slowdown", "1", CONTROL, "Time until soft, controlled, over that by the switch's current, in 95 % of modules"
)
quantities.simulated(
    "controlled_share", "1", CONTROL, "Share of modules that overshoot by less than 3 K and are soft within 1.1 of "
    "their own time"
)  # fmt: skip
