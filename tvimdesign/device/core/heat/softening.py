"""Heating until the joint is soft: response times, energy, power, peaks of temperature, and what it takes to stay."""

from __future__ import annotations

import numpy as np

from tvimdesign.device.table.phases import SOFTENING
from tvimdesign.device.table.quantity import Rule, Scalar
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
def near_face_time(stack_profile: heat.Profile, target_temperature: Scalar) -> Scalar:
    """Time until the layer's face at the Peltier pads is at the target temperature."""
    return (stack_profile.near - target_temperature) / heat.TEMPERATURE_SCALE


@quantities.event(SOFTENING)
def mean_time(mean_temperature: Scalar, target_temperature: Scalar) -> Scalar:
    """Time until the layer's mean is at the target temperature."""
    return (mean_temperature - target_temperature) / heat.TEMPERATURE_SCALE


@quantities.event(SOFTENING)
def far_face_time(stack_profile: heat.Profile, target_temperature: Scalar) -> Scalar:
    """Time until the layer's face at the rotor is at the target temperature."""
    return (stack_profile.far - target_temperature) / heat.TEMPERATURE_SCALE


@quantities.output("N*m/rad")
def soft_threshold(
    impedance_targets: str, soft_impedance: Scalar, joint_impedance_at_hot: Scalar, softening_band: Scalar
) -> Scalar:
    """Impedance at and below which the joint counts as soft: the softening band above its target."""
    return softening_band * (soft_impedance if impedance_targets == "stated" else joint_impedance_at_hot)


@quantities.output("1", Rule(sense=">=", value=0.0, reason="the joint never gets as soft as `soft_impedance` asks"))
def soft_reach(soft_threshold: Scalar, joint_impedance_at_hot: Scalar) -> Scalar:
    """How far below the soft threshold the hot joint is, as the logarithm of the ratio."""
    return np.log(soft_threshold) - np.log(joint_impedance_at_hot)


@quantities.event(SOFTENING)
def softening_time(impedance_now: Scalar, soft_threshold: Scalar) -> Scalar:
    """Time until the joint's impedance is within the softening band of its target.

    The target is the joint's impedance at the hot point unless it is stated.
    """
    return np.log(soft_threshold) - np.log(impedance_now)


@quantities.event(SOFTENING)
def response_time(
    response_criterion: str,
    stack_profile: heat.Profile,
    mean_temperature: Scalar,
    target_temperature: Scalar,
    impedance_now: Scalar,
    soft_threshold: Scalar,
) -> Scalar:
    """Time of one switch, by the criterion the study chose."""
    if response_criterion == "softening":
        return softening_time(impedance_now, soft_threshold)
    if response_criterion == "mean":
        return mean_time(mean_temperature, target_temperature)
    face = near_face_time if response_criterion == "near_face" else far_face_time
    return face(stack_profile, target_temperature)


@quantities.output("s", advice=(Rule(sense=">=", value=0.0, reason="the joint is not yet soft when the switch ends"),))
def softening_margin(response_time: Scalar, softening_time: Scalar) -> Scalar:
    """Time from the joint being soft to the end of the switch."""
    return response_time - softening_time


# --- what the joint is when the switch ends ---------------------------------------------------------------------------


@quantities.path(SOFTENING, "N*m/rad", "end")
def softened_stiffness(stiffness_now: Scalar) -> Scalar:
    """Stiffness of the joint when the switch ends, at the hot point's frequency."""
    return stiffness_now


@quantities.path(SOFTENING, "N*m/rad", "end")
def softened_impedance(impedance_now: Scalar) -> Scalar:
    """Magnitude of the joint's dynamic stiffness when the switch ends, at the hot point's frequency."""
    return impedance_now


@quantities.path(SOFTENING, "degC", "end")
def softened_temperature(stack_profile: heat.Profile) -> Scalar:
    """Temperature of the layer's coldest face, at the rotor, when the switch ends."""
    return stack_profile.far


@quantities.output(
    "K",
    advice=(
        Rule(sense=">=", value=0.0, reason="the layer never is at the hot point's temperature during the cycle, so the "
             "joint is not as soft as it is told to be at `hot`; see softened_stiffness and softened_impedance"),
    ),
)  # fmt: skip
def hot_point_margin(softened_temperature: Scalar, temperature_at_hot: Scalar) -> Scalar:
    """Temperature of the layer's coldest face when the switch ends less that of the hot point."""
    return softened_temperature - temperature_at_hot


# --- over the phase -------------------------------------------------------------------------------------------------


@quantities.path(SOFTENING, "J", "integral", headline=True)
def switch_energy(electrical_power: Scalar) -> Scalar:
    """Electrical energy of one switch."""
    return electrical_power


@quantities.path(SOFTENING, "W", "maximum", headline=True)
def peak_power(electrical_power: Scalar) -> Scalar:
    """Highest electrical power during the switch."""
    return electrical_power


@quantities.path(SOFTENING, "V", "maximum")
def peak_voltage(supply_voltage: Scalar) -> Scalar:
    """Highest voltage over all pads, as they are wired, during the switch."""
    return supply_voltage


@quantities.path(SOFTENING, "A", "maximum")
def peak_current(drive_current: Scalar) -> Scalar:
    """Highest current during the switch."""
    return drive_current


@quantities.output("A", ratings=(Rule(sense=">=", value=0.0, reason="above the Peltier module's rated current"),))
def current_margin(peltier_max_current: Scalar, heater_strings: Scalar, peak_current: Scalar) -> Scalar:
    """Rated current of the Peltier module less the highest one of them takes in the switch."""
    return peltier_max_current - peak_current / heater_strings


@quantities.path(SOFTENING, "degC", "maximum")
def peak_pcl_temperature(hottest_pcl: Scalar) -> Scalar:
    """Highest temperature in the PCL during the switch, at its face to the pads unless it heats itself."""
    return hottest_pcl


@quantities.path(SOFTENING, "degC", "maximum")
def peak_peltier_temperature(stack_profile: heat.Profile) -> Scalar:
    """Highest temperature of the pads' hot side during the switch."""
    return stack_profile.hot


@quantities.path(SOFTENING, "degC", "maximum")
def peak_rotor_temperature(stack_profile: heat.Profile) -> Scalar:
    """Highest temperature of the rotor plate during the switch, at its face to the layer."""
    return stack_profile.plate_face


@quantities.output(
    "K", ratings=(Rule(sense=">=", value=0.0, reason="the Peltier module is above the temperature it is rated for"),)
)
def peltier_temperature_margin(peltier_max_temperature: Scalar, peak_peltier_temperature: Scalar) -> Scalar:
    """Rated temperature of the Peltier module less the highest it sees."""
    return peltier_max_temperature - peak_peltier_temperature


@quantities.output("K", ratings=(Rule(sense=">=", value=0.0, reason="the PCL decomposes"),))
def pcl_temperature_margin(pcl_decomposition_temperature: Scalar, peak_pcl_temperature: Scalar) -> Scalar:
    """Temperature at which the PCL starts to decompose less the highest it sees."""
    return pcl_decomposition_temperature - peak_pcl_temperature


@quantities.output(
    "K", ratings=(Rule(sense=">=", value=0.0, reason="the structure is above its continuous service temperature"),)
)
def structure_temperature_margin(structure_service_temperature: Scalar, peak_peltier_temperature: Scalar) -> Scalar:
    """Service temperature of the structure less the highest temperature of the pads that touch it."""
    return structure_service_temperature - peak_peltier_temperature


# --- to stay soft ----------------------------------------------------------------------------------------------------


@quantities.steady(SOFTENING, "A")
def hold_current(drive_current: Scalar) -> Scalar:
    """Current that keeps the layer for good where the switch ended."""
    return drive_current


@quantities.steady(SOFTENING, "W", headline=True)
def hold_power(electrical_power: Scalar) -> Scalar:
    """Electrical power that keeps the layer for good where the switch ended."""
    return electrical_power
