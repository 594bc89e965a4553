"""Safety of a torsion spring: its coil and the bend of its tang, against yield and against fatigue.

Which of the two bears more changes with the sizes. Each has quantities of its own, written once as templates, and the
rules and limits are on these: no kink of the lesser is in the optimiser's way.
"""

from __future__ import annotations

import numpy as np

from tvimdesign.device.table.module import Module
from tvimdesign.device.table.quantity import Rule, Scalar, at_least
from tvimdesign.device.table.quantity_group import QuantityGroup
from tvimdesign.physics.springs import spring

quantities = QuantityGroup("Springs")


@quantities.output("MPa")
def spring_stress(m: Module) -> Scalar:
    """Largest stress in the springs at full winding, at the coil's inner fibre or in the bend of the tang."""
    return np.fmax(m.coil_stress_per_angle, m.tang_stress_per_angle) * m.spring_winding


@quantities.helper()
def spring_yield(m: Module) -> Scalar:
    """Stress at which the wire yields in bending [Pa]."""
    return m.spring_yield_ratio * m.spring_tensile_strength


def template_static_safety(m: Module) -> Scalar:
    """Static safety of {it}: bending yield over the largest stress."""
    return m.spring_yield / (m.template_stress_per_angle * m.spring_winding)


def template_assembly_safety(m: Module) -> Scalar:
    """Static safety of {it} while the module is put together: fitting one hand winds the other by twice the preload."""
    return m.spring_yield / (m.template_stress_per_angle * 2.0 * np.fmax(m.preload_angle, 1e-6))


@quantities.helper()
def least_winding(m: Module) -> Scalar:
    """Winding of a spring at the end of the stroke against it [rad]; without preload it lifts off, and has none."""
    return np.fmax(m.preload_margin, 0.0)


def template_fatigue_safety(m: Module) -> Scalar:
    """Fatigue safety of {it} for 1e6 full strokes to both sides, Gerber."""
    amplitude = 0.5 * m.template_stress_per_angle * (m.spring_winding - m.least_winding)
    mean = 0.5 * m.template_stress_per_angle * (m.spring_winding + m.least_winding)
    endurance = spring.endurance_strength(m.spring_tensile_strength, m.spring_fatigue_ratio)
    return spring.gerber_safety(amplitude, mean, endurance, m.spring_tensile_strength)


for _place, _words in (("coil", "the springs' coils"), ("tang", "the springs where the tang is bent")):
    quantities.from_template(_place, _words, template_static_safety, "1", at_least(1.0, "the spring would yield"))
    quantities.from_template(
        _place, _words, template_assembly_safety, "1",
        at_least(1.0, "the spring would yield while the module is put together"),
    )  # fmt: skip
    quantities.from_template(_place, _words, template_fatigue_safety, "1")


@quantities.output("1", headline=True, least_of=("coil_static_safety", "tang_static_safety"))
def spring_static_safety(m: Module) -> Scalar:
    """Static safety of the springs: bending yield over the largest stress."""
    return np.fmin(m.coil_static_safety, m.tang_static_safety)


@quantities.output("1", least_of=("coil_assembly_safety", "tang_assembly_safety"))
def spring_assembly_safety(m: Module) -> Scalar:
    """Static safety of the springs while the module is put together."""
    return np.fmin(m.coil_assembly_safety, m.tang_assembly_safety)


@quantities.output(
    "1",
    advice=(Rule(sense=">=", value=1.0, reason="the spring would break before 1e6 cycles"),),
    headline=True,
    least_of=("coil_fatigue_safety", "tang_fatigue_safety"),
)
def spring_fatigue_safety(m: Module) -> Scalar:
    """Fatigue safety of the springs for 1e6 full strokes to both sides, Gerber."""
    return np.fmin(m.coil_fatigue_safety, m.tang_fatigue_safety)
