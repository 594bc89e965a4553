"""The torsion spring with the leg and the bend it is drawn with: what bends of it, and where its stress is highest.

The wire is clamped where the tang enters the floor. The post inside the coil is taken not to be touched.
"""

from __future__ import annotations

import numpy as np

from tvimdesign.device.table.quantity import Scalar
from tvimdesign.device.table.quantity_group import QuantityGroup
from tvimdesign.physics.springs import drawn_spring as drawn
from tvimdesign.physics.springs import spring

quantities = QuantityGroup("Springs")

quantities.inputs()


@quantities.helper()
def drawn_spring(
    wire_diameter: Scalar,
    coil_diameter: Scalar,
    coil_count: Scalar,
    coil_pitch: Scalar,
    preload_angle: Scalar,
    leg_arm: Scalar,
    tang_bend_radius: Scalar,
) -> drawn.DrawnSpring:
    """Spring in the module at rest, wound up by its preload."""
    wound = 2.0 * np.pi * coil_count + preload_angle
    diameter = spring.loaded_coil_diameter(coil_diameter, coil_count, preload_angle)
    return drawn.DrawnSpring(wire_diameter, diameter, wound, coil_pitch, leg_arm, tang_bend_radius)


@quantities.output("1")
def active_coils(
    coil_count: Scalar,
    coil_diameter: Scalar,
    drawn_spring: drawn.DrawnSpring,
    spring_poissons_ratio: Scalar,
    leg_model: str,
) -> Scalar:
    """Coils without legs that are as soft as the spring: its coils, its leg and the bend of its tang."""
    if leg_model == "ignored":
        return coil_count
    return drawn.bending_length(drawn_spring, spring_poissons_ratio) / (np.pi * coil_diameter)


@quantities.helper()
def coil_stress_per_angle(
    held_spring_rate: Scalar,
    wire_diameter: Scalar,
    spring_index: Scalar,
    drawn_spring: drawn.DrawnSpring,
    stress_factor: str,
    leg_model: str,
) -> Scalar:
    """Largest stress in the coil per radian of winding [Pa], at its inner fibre."""
    curvature = {"shigley": spring.inner_fibre_factor, "en_13906": spring.inner_fibre_factor_en}[stress_factor]
    factor = curvature(spring_index)
    if leg_model != "ignored":
        factor = drawn.coil_stress_factor(drawn_spring, factor)
    return spring.bending_stress(held_spring_rate, wire_diameter, factor)


@quantities.helper()
def tang_stress_per_angle(
    held_spring_rate: Scalar,
    wire_diameter: Scalar,
    drawn_spring: drawn.DrawnSpring,
    coil_stress_per_angle: Scalar,
    leg_model: str,
) -> Scalar:
    """Largest stress in the bend of the tang per radian of winding [Pa]; the coil's where leg and bend are ignored."""
    if leg_model == "ignored":
        return coil_stress_per_angle
    return spring.bending_stress(held_spring_rate, wire_diameter, drawn.bend_stress_factor(drawn_spring))
