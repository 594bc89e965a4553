"""Heating until the joint is soft: response times, energy, power, peaks of temperature, and what it takes to stay."""

import numpy as np

from tvimdesign.device.table.module import Module
from tvimdesign.device.table.quantity import SOFTENING, Scalar, at_least
from tvimdesign.device.table.quantity_group import QuantityGroup
from tvimdesign.physics.heat_flow import heat

quantities = QuantityGroup("Softening")

quantities.inputs()
quantities.option(
    "response_criterion",
    ("far_face", "mean", "near_face", "softening"),
    "What ends the switch: a face or the mean of the layer at the target temperature, or the joint's impedance",
)

quantities.option(
    "impedance_targets",
    ("operating_points", "stated"),
    "What soft and stiff mean: the joint at its hot and cold points, or `soft_impedance` and `stiff_impedance`",
)

# --- response times --------------------------------------------------------------------------------------------------


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
    """Time of one switch, by the criterion the study chose."""
    if m.response_criterion == "softening":
        return softening_time(m)
    if m.response_criterion == "mean":
        return mean_time(m)
    return near_face_time(m) if m.response_criterion == "near_face" else far_face_time(m)


@quantities.output("s", advice=(at_least(0.0, "the joint is not yet soft when the switch ends"),))
def softening_margin(m: Module) -> Scalar:
    """Time from the joint being soft to the end of the switch."""
    return m.response_time - m.softening_time


# --- what the joint is when the switch ends ---------------------------------------------------------------------------


@quantities.path(SOFTENING, "N*m/rad", "end", headline=True)
def softened_stiffness(m: Module) -> Scalar:
    """Stiffness of the joint when the switch ends, at the hot point's frequency."""
    return m.stiffness_now


@quantities.path(SOFTENING, "N*m*s/rad", "end", headline=True)
def softened_damping(m: Module) -> Scalar:
    """Damping of the joint when the switch ends, at the hot point's frequency."""
    return m.damping_now


@quantities.path(SOFTENING, "N*m/rad", "end")
def softened_impedance(m: Module) -> Scalar:
    """Magnitude of the joint's dynamic stiffness when the switch ends, at the hot point's frequency."""
    return m.impedance_now


@quantities.output("1", headline=True)
def softened_range(m: Module) -> Scalar:
    """Stiffness of the joint cold over that when the switch ends."""
    return m.joint_stiffness_at_cold / m.softened_stiffness


@quantities.path(SOFTENING, "degC", "end", headline=True)
def softened_temperature(m: Module) -> Scalar:
    """Temperature of the layer's coldest face, at the rotor, when the switch ends."""
    return m.stack_profile.far


@quantities.path(SOFTENING, "degC", "end")
def sensed_temperature(m: Module) -> Scalar:
    """Temperature at the thermistor when the switch ends: the layer's face, or the pads' outer side without a bead."""
    return np.where(m.thermistor_diameter > 0.0, m.stack_profile.near, m.stack_profile.cold)


@quantities.output(
    "K",
    advice=(
        at_least(0.0, "the layer never is at the hot point's temperature during the cycle, so the "
             "joint is not as soft as its values at `hot` say; see softened_stiffness and softened_impedance"),
    ),
)  # fmt: skip
def hot_point_margin(m: Module) -> Scalar:
    """Temperature of the layer's coldest face when the switch ends less that of the hot point."""
    return m.softened_temperature - m.temperature_at_hot


# --- over the phase -------------------------------------------------------------------------------------------------


@quantities.path(SOFTENING, "J", "integral", headline=True)
def switch_energy(m: Module) -> Scalar:
    """Electrical energy of one switch."""
    return m.electrical_power


@quantities.path(SOFTENING, "W", "maximum", headline=True)
def peak_power(m: Module) -> Scalar:
    """Highest electrical power during the switch."""
    return m.electrical_power


@quantities.path(SOFTENING, "V", "maximum")
def peak_voltage(m: Module) -> Scalar:
    """Highest voltage over all pads, as they are wired, during the switch."""
    return m.supply_voltage


@quantities.path(SOFTENING, "A", "maximum")
def peak_current(m: Module) -> Scalar:
    """Highest current during the switch."""
    return m.drive_current


@quantities.output("A", ratings=(at_least(0.0, "above the heater's rated current"),))
def current_margin(m: Module) -> Scalar:
    """Rated current of the heater less the highest one of them takes in the switch."""
    return m.peltier_max_current - m.peak_current / m.heater_strings


@quantities.path(SOFTENING, "degC", "maximum")
def peak_pcl_temperature(m: Module) -> Scalar:
    """Highest temperature in the PCL during the switch, at its face to the pads unless it heats itself."""
    return m.hottest_pcl


@quantities.path(SOFTENING, "degC", "maximum")
def peak_peltier_temperature(m: Module) -> Scalar:
    """Highest temperature of the pads' hot side during the switch."""
    return m.stack_profile.hot


@quantities.path(SOFTENING, "degC", "maximum")
def peak_rotor_temperature(m: Module) -> Scalar:
    """Highest temperature of the rotor plate during the switch, at its face to the layer."""
    return m.stack_profile.plate_face


@quantities.output("K", ratings=(at_least(0.0, "the heater is above the temperature it is rated for"),))
def peltier_temperature_margin(m: Module) -> Scalar:
    """Rated temperature of the heater less the highest it sees."""
    return m.peltier_max_temperature - m.peak_peltier_temperature


@quantities.output("K", ratings=(at_least(0.0, "the PCL decomposes"),))
def pcl_temperature_margin(m: Module) -> Scalar:
    """Temperature at which the PCL starts to decompose less the highest it sees."""
    return m.pcl_decomposition_temperature - m.peak_pcl_temperature


@quantities.output("K", ratings=(at_least(0.0, "the structure is above its continuous service temperature"),))
def structure_temperature_margin(m: Module) -> Scalar:
    """Service temperature of the structure less the highest temperature of the pads that touch it."""
    return m.structure_service_temperature - m.peak_peltier_temperature


# --- to stay soft ----------------------------------------------------------------------------------------------------


@quantities.steady(SOFTENING, "A")
def hold_current(m: Module) -> Scalar:
    """Current that keeps the layer for good where the switch ended."""
    return m.drive_current


@quantities.steady(SOFTENING, "W", headline=True)
def hold_power(m: Module) -> Scalar:
    """Electrical power that keeps the layer for good where the switch ended."""
    return m.electrical_power
