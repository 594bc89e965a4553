"""The torsion spring with the leg and the bend it is drawn with: what bends of it, and where its stress is highest.

The wire is clamped where the tang enters the floor. The post inside the coil is taken not to be touched.
"""

from __future__ import annotations

import numpy as np

from tvimdesign.device.table.module import Module
from tvimdesign.device.table.quantity import Scalar
from tvimdesign.device.table.quantity_group import QuantityGroup
from tvimdesign.physics.springs import drawn_spring as drawn
from tvimdesign.physics.springs import spring

quantities = QuantityGroup("Springs")

quantities.inputs()


@quantities.helper()
def drawn_spring(m: Module) -> drawn.DrawnSpring:
    """Spring in the module at rest, wound up by its preload."""
    wound = 2.0 * np.pi * m.coil_count + m.preload_angle
    diameter = spring.loaded_coil_diameter(m.coil_diameter, m.coil_count, m.preload_angle)
    return drawn.DrawnSpring(m.wire_diameter, diameter, wound, m.coil_pitch, m.leg_arm, m.tang_bend_radius)


@quantities.output("1")
def active_coils(m: Module) -> Scalar:
    """Coils without legs that are as soft as the spring: its coils, its leg and the bend of its tang."""
    if m.leg_model == "ignored":
        return m.coil_count
    return drawn.bending_length(m.drawn_spring, m.spring_poissons_ratio) / (np.pi * m.coil_diameter)


@quantities.helper()
def coil_stress_per_angle(m: Module) -> Scalar:
    """Largest stress in the coil per radian of winding [Pa], at its inner fibre."""
    curvature = {"shigley": spring.inner_fibre_factor, "en_13906": spring.inner_fibre_factor_en}[m.stress_factor]
    factor = curvature(m.spring_index)
    if m.leg_model != "ignored":
        factor = drawn.coil_stress_factor(m.drawn_spring, factor)
    return spring.bending_stress(m.held_spring_rate, m.wire_diameter, factor)


@quantities.helper()
def tang_stress_per_angle(m: Module) -> Scalar:
    """Largest stress in the bend of the tang per radian of winding [Pa]; the coil's where leg and bend are ignored."""
    if m.leg_model == "ignored":
        return m.coil_stress_per_angle
    return spring.bending_stress(m.held_spring_rate, m.wire_diameter, drawn.bend_stress_factor(m.drawn_spring))
