"""Cooling until the joint is stiff again, with the current reversed; and the two phases together as a cycle."""

import numpy as np

from tvimdesign.device.table.module import Module
from tvimdesign.device.table.quantity import EQUILIBRIUM_STIFFENING, STIFFENING, Scalar, at_least
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
def stiff_threshold(m: Module) -> Scalar:
    """Impedance at and above which the joint counts as stiff: the stiffening band below its target."""
    return (m.stiff_impedance if m.impedance_targets == "stated" else m.joint_impedance_at_cold) / m.stiffening_band


@quantities.output("1", at_least(0.0, "the joint never gets as stiff as `stiff_impedance` asks"))
def stiff_reach(m: Module) -> Scalar:
    """Distance of the cold joint above the stiff threshold, as the logarithm of the ratio."""
    return np.log(m.joint_impedance_at_cold) - np.log(m.stiff_threshold)


@quantities.event(STIFFENING)
def stiffening_time(m: Module) -> Scalar:
    """Time from the end of the switch until the joint's impedance is within the stiffening band of its target.

    The target is the joint's impedance at the cold point unless it is stated.
    """
    return np.log(m.impedance_now) - np.log(m.stiff_threshold)


@quantities.event(EQUILIBRIUM_STIFFENING)
def equilibrium_stiffening_time(m: Module) -> Scalar:
    """Stiffening time if the layer froze where it melts: a claim, not a prediction."""
    return stiffening_time(m)


@quantities.event(STIFFENING)
def frozen_time(m: Module) -> Scalar:
    """Time from the end of the switch until every slice of the layer is half frozen.

    The slices are in series: under a lasting load the joint creeps as its least frozen slice flows. The least is
    taken smoothly, by the mean of exp(-80 X), which is at most 0.03 of X below it.
    """
    return -np.log(np.mean(np.exp(-SHARPNESS * (m.stack_profile.fractions - HALF)))) / SHARPNESS


@quantities.event(STIFFENING, headline=False)
def return_time(m: Module) -> Scalar:
    """Time of the way back, by the criterion the study chose: stiff at its frequency, or frozen."""
    return frozen_time(m) if m.stiffening_criterion == "frozen" else stiffening_time(m)


@quantities.output(
    "1",
    advice=(
        at_least(1.0, "the joint counts as stiff while a slice of its layer is mostly liquid: "
             "it resists at its frequency, and gives way under a lasting load"),
    ),
)  # fmt: skip
def stiffening_over_freezing(m: Module) -> Scalar:
    """Time until the joint counts as stiff over the time until every slice of its layer is half frozen."""
    return m.stiffening_time / m.frozen_time


@quantities.output(
    "1",
    advice=(
        at_least(0.0, "soft and stiff overlap: between the two thresholds the joint counts as "
             "both, and the times of a switch say nothing"),
    ),
)  # fmt: skip
def thresholds_apart(m: Module) -> Scalar:
    """Distance of the stiff threshold above the soft one, as the logarithm of the ratio."""
    return np.log(m.stiff_threshold) - np.log(m.soft_threshold)


@quantities.event(STIFFENING)
def far_face_cooling_time(m: Module) -> Scalar:
    """Time from the end of the switch until the face at the rotor is down to the cold point's temperature."""
    return (m.temperature_at_cold - m.stack_profile.far) / heat.TEMPERATURE_SCALE


@quantities.path(STIFFENING, "J", "integral", headline=True)
def stiffening_energy(m: Module) -> Scalar:
    """Electrical energy of cooling the joint stiff."""
    return m.electrical_power


@quantities.path(STIFFENING, "W", "maximum")
def stiffening_peak_power(m: Module) -> Scalar:
    """Highest electrical power while the joint stiffens."""
    return m.electrical_power


@quantities.path(STIFFENING, "V", "maximum")
def stiffening_peak_voltage(m: Module) -> Scalar:
    """Highest voltage over all pads, as they are wired, while the joint stiffens."""
    return m.supply_voltage


@quantities.path(STIFFENING, "degC", "maximum")
def peak_cold_side_temperature(m: Module) -> Scalar:
    """Highest temperature of the pads' outer side, which heats up while the joint stiffens."""
    return m.stack_profile.cold


@quantities.path(STIFFENING, "A", "maximum")
def stiffening_peak_current(m: Module) -> Scalar:
    """Highest current, in size, while the joint stiffens."""
    return -m.drive_current


@quantities.output("A", ratings=(at_least(0.0, "cooling is above the heater's rated current"),))
def cooling_current_margin(m: Module) -> Scalar:
    """Rated current of the heater less the highest one of them takes while the joint stiffens."""
    return m.peltier_max_current - m.stiffening_peak_current / m.heater_strings


@quantities.output("K", ratings=(at_least(0.0, "the pads' outer side is above the temperature it is rated for"),))
def cold_side_temperature_margin(m: Module) -> Scalar:
    """Rated temperature of the heater less the highest of its outer side."""
    return m.peltier_max_temperature - m.peak_cold_side_temperature


@quantities.output("K", ratings=(at_least(0.0, "the structure is above its service temperature while it stiffens"),))
def stiffening_structure_margin(m: Module) -> Scalar:
    """Service temperature of the structure less the highest of the pads' outer side, which touches it."""
    return m.structure_service_temperature - m.peak_cold_side_temperature


@quantities.output("s", headline=True)
def cycle_time(m: Module) -> Scalar:
    """Time to soften and to stiffen again, each by its criterion."""
    return m.response_time + m.return_time


@quantities.output("J", headline=True)
def cycle_energy(m: Module) -> Scalar:
    """Electrical energy to soften and to stiffen again."""
    return m.switch_energy + m.stiffening_energy
