"""How safe a torsion spring is: its coil and the bend of its tang, each against yield, and against fatigue.

Which of the two bears more changes with the sizes. Each has a quantity of its own, so that a limit on the lesser of
them is one on each, and no kink is in the optimiser's way.
"""

from __future__ import annotations

import numpy as np

from tvimdesign.device.table.quantity import Rule, Scalar
from tvimdesign.device.table.quantity_group import QuantityGroup
from tvimdesign.physics.springs import spring

quantities = QuantityGroup("Springs")


@quantities.output("MPa")
def spring_stress(coil_stress_per_angle: Scalar, bend_stress_per_angle: Scalar, spring_winding: Scalar) -> Scalar:
    """Largest stress in the springs at full winding, at the coil's inner fibre or in the bend of the tang."""
    return np.fmax(coil_stress_per_angle, bend_stress_per_angle) * spring_winding


@quantities.helper()
def spring_yield(spring_yield_ratio: Scalar, spring_tensile_strength: Scalar) -> Scalar:
    """Stress at which the wire yields in bending [Pa]."""
    return spring_yield_ratio * spring_tensile_strength


@quantities.output("1")
def coil_static_safety(spring_yield: Scalar, coil_stress_per_angle: Scalar, spring_winding: Scalar) -> Scalar:
    """Static safety of the springs' coils: bending yield over the largest stress."""
    return spring_yield / (coil_stress_per_angle * spring_winding)


@quantities.output("1")
def tang_static_safety(spring_yield: Scalar, bend_stress_per_angle: Scalar, spring_winding: Scalar) -> Scalar:
    """Static safety of the springs where the tang is bent: bending yield over the largest stress."""
    return spring_yield / (bend_stress_per_angle * spring_winding)


@quantities.output(
    "1",
    Rule(sense=">=", value=1.0, reason="the spring would yield"),
    headline=True,
    least_of=("coil_static_safety", "tang_static_safety"),
)
def spring_static_safety(coil_static_safety: Scalar, tang_static_safety: Scalar) -> Scalar:
    """Static safety of the springs: bending yield over the largest stress."""
    return np.fmin(coil_static_safety, tang_static_safety)


@quantities.output("1")
def coil_assembly_safety(spring_yield: Scalar, coil_stress_per_angle: Scalar, preload_angle: Scalar) -> Scalar:
    """Static safety of the springs' coils while the module is put together."""
    return spring_yield / (coil_stress_per_angle * 2.0 * np.fmax(preload_angle, 1e-6))


@quantities.output("1")
def tang_assembly_safety(spring_yield: Scalar, bend_stress_per_angle: Scalar, preload_angle: Scalar) -> Scalar:
    """Static safety of the springs where the tang is bent while the module is put together."""
    return spring_yield / (bend_stress_per_angle * 2.0 * np.fmax(preload_angle, 1e-6))


@quantities.output(
    "1",
    Rule(sense=">=", value=1.0, reason="the spring would yield while the module is put together"),
    least_of=("coil_assembly_safety", "tang_assembly_safety"),
)
def spring_assembly_safety(coil_assembly_safety: Scalar, tang_assembly_safety: Scalar) -> Scalar:
    """Static safety while the module is put together: fitting one hand winds the other by twice the preload."""
    return np.fmin(coil_assembly_safety, tang_assembly_safety)


@quantities.helper()
def least_winding(preload_margin: Scalar) -> Scalar:
    """Winding of a spring at the end of the stroke against it [rad]; without preload it lifts off, and has none."""
    return np.fmax(preload_margin, 0.0)


@quantities.output("1")
def coil_fatigue_safety(
    coil_stress_per_angle: Scalar,
    spring_winding: Scalar,
    least_winding: Scalar,
    spring_tensile_strength: Scalar,
    spring_fatigue_ratio: Scalar,
) -> Scalar:
    """Fatigue safety of the springs' coils for 1e6 full strokes to both sides, Gerber."""
    return _fatigue_safety(
        coil_stress_per_angle, spring_winding, least_winding, spring_tensile_strength, spring_fatigue_ratio
    )


@quantities.output("1")
def tang_fatigue_safety(
    bend_stress_per_angle: Scalar,
    spring_winding: Scalar,
    least_winding: Scalar,
    spring_tensile_strength: Scalar,
    spring_fatigue_ratio: Scalar,
) -> Scalar:
    """Fatigue safety of the springs where the tang is bent, for 1e6 full strokes to both sides, Gerber."""
    return _fatigue_safety(
        bend_stress_per_angle, spring_winding, least_winding, spring_tensile_strength, spring_fatigue_ratio
    )


@quantities.output(
    "1",
    advice=(Rule(sense=">=", value=1.0, reason="the spring would break before 1e6 cycles"),),
    headline=True,
    least_of=("coil_fatigue_safety", "tang_fatigue_safety"),
)
def spring_fatigue_safety(coil_fatigue_safety: Scalar, tang_fatigue_safety: Scalar) -> Scalar:
    """Fatigue safety of the springs for 1e6 full strokes to both sides, Gerber."""
    return np.fmin(coil_fatigue_safety, tang_fatigue_safety)


def _fatigue_safety(
    stress_per_angle: Scalar, largest: Scalar, least: Scalar, strength: Scalar, fatigue_ratio: Scalar
) -> Scalar:
    amplitude = 0.5 * stress_per_angle * (largest - least)
    mean = 0.5 * stress_per_angle * (largest + least)
    return spring.gerber_safety(amplitude, mean, spring.endurance_strength(strength, fatigue_ratio), strength)
