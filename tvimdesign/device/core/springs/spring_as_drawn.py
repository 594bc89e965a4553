"""Torsion spring with the leg and the bend it is drawn with, and the spring from stock, bought whole.

The wire is clamped where the tang enters the floor. The post inside the coil is taken not to be touched.

Where a spring's leg lies on its pin, for the drawing: by the kinematics that the quantities of the springs have.

A torsion spring from stock, bought whole: wire, coil and material are its record's, and what else it must have.

Stock springs have two straight tangential legs. One lies on the pin, cut to its length; the other one is bent down into
the floor as the tang.
"""

from __future__ import annotations

import numpy as np

from tvimdesign.device.table.module import Module
from tvimdesign.device.table.quantity import Feature, Scalar, at_least
from tvimdesign.device.table.quantity_group import QuantityGroup
from tvimdesign.physics.springs import drawn_spring as drawn
from tvimdesign.physics.springs import spring, transmission

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


def leg_azimuth(pin_radius: float, placement_radius: float, rotor_angle: float, offset: float) -> float:
    """Return the direction of a right-hand spring's leg in plan view [rad], from its coil to its pin, against the
    outward radius.

    Lengths in one unit, `rotor_angle` [rad]; `offset` is that of the line through the pin from the coil's axis.
    """
    return float(transmission.leg_direction(pin_radius, placement_radius, rotor_angle, offset))


def pin_distance(pin_radius: float, placement_radius: float, rotor_angle: float) -> float:
    """Return the distance of a coil's axis from its pin, which turns with the rotor, in the unit of the radii."""
    return float(transmission.pin_distance(pin_radius, placement_radius, rotor_angle))


FROM_STOCK = (Feature("stock_spring", "none"),)

stock = QuantityGroup("Springs", FROM_STOCK)


@stock.output("mm", at_least(0.0, "the stock spring's leg does not reach the pin"))
def stock_leg_margin(m: Module) -> Scalar:
    """Leg of the stock spring beyond what its pin asks for; what is over is cut off. Zero without."""
    return m.stock_spring.value("leg_length") - m.leg_length


@stock.output("mm", at_least(0.0, "the stock spring's other leg is too short to be bent down into the floor"))
def stock_tang_margin(m: Module) -> Scalar:
    """Other leg of the stock spring beyond its tang and the quarter bend above that. Zero without."""
    return m.stock_spring.value("leg_length") - m.tang_length - 0.5 * np.pi * m.tang_bend_radius


@stock.output("N*m", at_least(0.0, "the springs are wound beyond the torque that their maker gives"))
def stock_torque_margin(m: Module) -> Scalar:
    """Largest torque that the maker of the stock spring gives, less that at full winding. Zero without."""
    return m.stock_spring.value("largest_torque") - m.spring_rate * m.spring_winding
