"""Cooling until the joint is stiff again, with the current reversed; and the two phases together as a cycle."""

from __future__ import annotations

import numpy as np

from tvimdesign.device.table.phases import EQUILIBRIUM_STIFFENING, STIFFENING
from tvimdesign.device.table.quantity import Rule, Scalar
from tvimdesign.device.table.quantity_group import QuantityGroup
from tvimdesign.physics.heat_flow import heat

quantities = QuantityGroup("Stiffening")

HALF = 0.5
SHARPNESS = 80.0

quantities.inputs()
quantities.option(
    "stiffening_criterion",
    ("impedance", "frozen"),
    "What ends the way back: the joint's impedance, or every slice of the layer half frozen, so that it bears for good",
)


@quantities.output("N*m/rad")
def stiff_threshold(
    impedance_targets: str, stiff_impedance: Scalar, joint_impedance_at_cold: Scalar, stiffening_band: Scalar
) -> Scalar:
    """Impedance at and above which the joint counts as stiff: the stiffening band below its target."""
    return (stiff_impedance if impedance_targets == "stated" else joint_impedance_at_cold) / stiffening_band


@quantities.output("1", Rule(sense=">=", value=0.0, reason="the joint never gets as stiff as `stiff_impedance` asks"))
def stiff_reach(stiff_threshold: Scalar, joint_impedance_at_cold: Scalar) -> Scalar:
    """How far above the stiff threshold the cold joint is, as the logarithm of the ratio."""
    return np.log(joint_impedance_at_cold) - np.log(stiff_threshold)


@quantities.event(STIFFENING)
def stiffening_time(impedance_now: Scalar, stiff_threshold: Scalar) -> Scalar:
    """Time from the end of the switch until the joint's impedance is within the stiffening band of its target.

    The target is the joint's impedance at the cold point unless it is stated.
    """
    return np.log(impedance_now) - np.log(stiff_threshold)


@quantities.event(EQUILIBRIUM_STIFFENING)
def equilibrium_stiffening_time(impedance_now: Scalar, stiff_threshold: Scalar) -> Scalar:
    """What stiffening would take if the layer froze where it melts: a claim, not a prediction."""
    return stiffening_time(impedance_now, stiff_threshold)


@quantities.event(STIFFENING)
def frozen_time(stack_profile: heat.Profile) -> Scalar:
    """Time from the end of the switch until every slice of the layer is half frozen.

    The slices are in series: under a lasting load the joint gives way as its least frozen slice flows. The least is
    taken smoothly, by the mean of exp(-80 X), which is at most 0.03 of X below it.
    """
    return -np.log(np.mean(np.exp(-SHARPNESS * (stack_profile.fractions - HALF)))) / SHARPNESS


@quantities.event(STIFFENING, headline=False)
def return_time(
    stiffening_criterion: str, impedance_now: Scalar, stiff_threshold: Scalar, stack_profile: heat.Profile
) -> Scalar:
    """Time of the way back, by the criterion the study chose: stiff at its frequency, or frozen."""
    if stiffening_criterion == "frozen":
        return frozen_time(stack_profile)
    return stiffening_time(impedance_now, stiff_threshold)


@quantities.output(
    "1",
    advice=(
        Rule(sense=">=", value=1.0, reason="the joint counts as stiff while a slice of its layer is mostly liquid: "
             "it resists at its frequency, and gives way under a lasting load"),
    ),
)  # fmt: skip
def stiffening_over_freezing(stiffening_time: Scalar, frozen_time: Scalar) -> Scalar:
    """Time until the joint counts as stiff over the time until every slice of its layer is half frozen."""
    return stiffening_time / frozen_time


@quantities.output(
    "1",
    advice=(
        Rule(sense=">=", value=0.0, reason="soft and stiff overlap: between the two thresholds the joint counts as "
             "both, and the times of a switch say nothing"),
    ),
)  # fmt: skip
def thresholds_apart(stiff_threshold: Scalar, soft_threshold: Scalar) -> Scalar:
    """How far the stiff threshold is above the soft one, as the logarithm of the ratio."""
    return np.log(stiff_threshold) - np.log(soft_threshold)


@quantities.event(STIFFENING, headline=False)
def near_face_cooling_time(stack_profile: heat.Profile, temperature_at_cold: Scalar) -> Scalar:
    """Time from the end of the switch until the face at the pads is down to the cold point's temperature."""
    return (temperature_at_cold - stack_profile.near) / heat.TEMPERATURE_SCALE


@quantities.event(STIFFENING, headline=False)
def mean_cooling_time(mean_temperature: Scalar, temperature_at_cold: Scalar) -> Scalar:
    """Time from the end of the switch until the layer's mean is down to the cold point's temperature."""
    return (temperature_at_cold - mean_temperature) / heat.TEMPERATURE_SCALE


@quantities.event(STIFFENING)
def far_face_cooling_time(stack_profile: heat.Profile, temperature_at_cold: Scalar) -> Scalar:
    """Time from the end of the switch until the face at the rotor is down to the cold point's temperature."""
    return (temperature_at_cold - stack_profile.far) / heat.TEMPERATURE_SCALE


@quantities.path(STIFFENING, "J", "integral", headline=True)
def stiffening_energy(electrical_power: Scalar) -> Scalar:
    """Electrical energy of cooling the joint stiff."""
    return electrical_power


@quantities.path(STIFFENING, "W", "maximum")
def stiffening_peak_power(electrical_power: Scalar) -> Scalar:
    """Highest electrical power while the joint stiffens."""
    return electrical_power


@quantities.path(STIFFENING, "V", "maximum")
def stiffening_peak_voltage(supply_voltage: Scalar) -> Scalar:
    """Highest voltage over all pads, as they are wired, while the joint stiffens."""
    return supply_voltage


@quantities.path(STIFFENING, "degC", "maximum")
def peak_cold_side_temperature(stack_profile: heat.Profile) -> Scalar:
    """Highest temperature of the pads' outer side, which heats up while the joint stiffens."""
    return stack_profile.cold


@quantities.path(STIFFENING, "A", "maximum")
def stiffening_peak_current(drive_current: Scalar) -> Scalar:
    """Highest current, in size, while the joint stiffens."""
    return -drive_current


@quantities.output(
    "A", ratings=(Rule(sense=">=", value=0.0, reason="cooling is above the Peltier module's rated current"),)
)
def cooling_current_margin(
    peltier_max_current: Scalar, heater_strings: Scalar, stiffening_peak_current: Scalar
) -> Scalar:
    """Rated current of the Peltier module less the highest one of them takes while the joint stiffens."""
    return peltier_max_current - stiffening_peak_current / heater_strings


@quantities.output(
    "K", ratings=(Rule(sense=">=", value=0.0, reason="the pads' outer side is above the temperature it is rated for"),)
)
def cold_side_temperature_margin(peltier_max_temperature: Scalar, peak_cold_side_temperature: Scalar) -> Scalar:
    """Rated temperature of the Peltier module less the highest of its outer side."""
    return peltier_max_temperature - peak_cold_side_temperature


@quantities.output(
    "K",
    ratings=(Rule(sense=">=", value=0.0, reason="the structure is above its service temperature while it stiffens"),),
)
def stiffening_structure_margin(structure_service_temperature: Scalar, peak_cold_side_temperature: Scalar) -> Scalar:
    """Service temperature of the structure less the highest of the pads' outer side, which touches it."""
    return structure_service_temperature - peak_cold_side_temperature


@quantities.output("s", headline=True)
def cycle_time(response_time: Scalar, return_time: Scalar) -> Scalar:
    """Time to soften and to stiffen again, each by its criterion."""
    return response_time + return_time


@quantities.output("J", headline=True)
def cycle_energy(switch_energy: Scalar, stiffening_energy: Scalar) -> Scalar:
    """Electrical energy to soften and to stiffen again."""
    return switch_energy + stiffening_energy
