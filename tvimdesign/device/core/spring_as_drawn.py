"""Torsion spring as drawn, with its leg and bend, or from stock: stress, safety, and place of the leg.

The wire is clamped where the tang enters the floor. The post inside the coil is taken not to be touched.

A spring from stock is bought whole: wire, coil and material are its record's. Stock springs have two straight
tangential legs. One lies on the pin, cut to its length; the other one is bent down into the floor as the tang.

Safety is that of the coil and of the tang's bend, against yield and fatigue. Which is stressed more changes with the
sizes. Each has quantities of its own, written once as templates, and the
rules and limits are on these: no kink of the lesser is in the optimiser's way.

What holds a spring, the pin of its leg and the floor about its tang, gives and creeps. Both are as cold as the air
here; the adhesive of a bonded tang counts as stiff as the structure. The coil bears the torque of `held_spring_rate`,
which every force and stress in the module comes from.

The preload falls as the plastic that holds it creeps, over months and hot hours. The pin is as warm as the plate beside
the PCL, the floor as the air.
"""

import numpy as np

from tvimdesign.device.table import Feature, Module, QuantityGroup, Scalar, at_least
from tvimdesign.physics import spring
from tvimdesign.physics import spring as drawn
from tvimdesign.physics.polymers import plastics

quantities = QuantityGroup("Springs", sprung=True)

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
    return float(spring.leg_direction(pin_radius, placement_radius, rotor_angle, offset))


def pin_distance(pin_radius: float, placement_radius: float, rotor_angle: float) -> float:
    """Return the distance of a coil's axis from its pin, which turns with the rotor, in the unit of the radii."""
    return float(spring.pin_distance(pin_radius, placement_radius, rotor_angle))


FROM_STOCK = (Feature("stock_spring", "none"),)

stock = QuantityGroup("Springs", FROM_STOCK, sprung=True)


@stock.gap("the stock spring's leg does not reach the pin")
def stock_leg_margin(m: Module) -> Scalar:
    """Leg of the stock spring beyond what its pin asks for; what is over is cut off. Zero without."""
    return m.stock_spring.value("leg_length") - m.leg_length


@stock.gap("the stock spring's other leg is too short to be bent down into the floor")
def stock_tang_margin(m: Module) -> Scalar:
    """Other leg of the stock spring beyond its tang and the quarter bend above that. Zero without."""
    return m.stock_spring.value("leg_length") - m.tang_length - 0.5 * np.pi * m.tang_bend_radius


@stock.output("N*m", at_least(0.0, "the springs are wound beyond the torque that their maker gives"))
def stock_torque_margin(m: Module) -> Scalar:
    """Largest torque that the maker of the stock spring gives, less that at full winding. Zero without."""
    return m.stock_spring.value("largest_torque") - m.spring_rate * m.spring_winding


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


def template_fatigue_safety(m: Module) -> Scalar:
    """Fatigue safety of {it} for 1e6 full strokes to both sides, Gerber."""
    most, least = m.stroke_windings
    amplitude = 0.5 * m.template_stress_per_angle * (most - least)
    mean = 0.5 * m.template_stress_per_angle * (most + least)
    endurance = spring.endurance_strength(m.spring_tensile_strength, m.spring_fatigue_ratio)
    return spring.gerber_safety(amplitude, mean, endurance, m.spring_tensile_strength)


for _place, _words in (("coil", "the springs' coils"), ("tang", "the springs where the tang is bent")):
    quantities.from_template(_place, _words, template_static_safety, "1", at_least(1.0, "the spring would yield"))
    quantities.from_template(_place, _words, template_fatigue_safety, "1")


@quantities.output("1", headline=True, least_of=("coil_static_safety", "tang_static_safety"))
def spring_static_safety(m: Module) -> Scalar:
    """Static safety of the springs: bending yield over the largest stress."""
    return np.fmin(m.coil_static_safety, m.tang_static_safety)


@quantities.output(
    "1",
    advice=(at_least(1.0, "the spring would break before 1e6 cycles"),),
    headline=True,
    least_of=("coil_fatigue_safety", "tang_fatigue_safety"),
)
def spring_fatigue_safety(m: Module) -> Scalar:
    """Fatigue safety of the springs for 1e6 full strokes to both sides, Gerber."""
    return np.fmin(m.coil_fatigue_safety, m.tang_fatigue_safety)


@quantities.helper()
def pin_give(m: Module) -> Scalar:
    """Winding that a spring loses for each moment on its coil as its pin gives [rad/(N*m)].

    A boss with a dowel pin counts as a pin of its own material up to the leg. FE of both glued is 1.0 to 1.6 times as
    stiff (`validation/fe_spring_holds`), at most half a percent of a spring's rate.
    """
    give = plastics.peg_give(m.structure_youngs_modulus, m.structure_poissons_ratio, m.pin_foot_diameter, m.pin_lever)
    return give / m.leg_arm**2


@quantities.helper()
def tang_give(m: Module) -> Scalar:
    """Winding that a spring loses for each moment on its coil as its tang turns in the floor [rad/(N*m)].

    The force on the pin acts at the leg's arm and the tang's lever, at most.
    """
    lever = 1.0 + m.tang_lever / m.leg_arm
    return plastics.twisted_hole_give(m.structure_shear_modulus, m.wire_diameter, m.tang_length) * lever**2


@quantities.output("N*m/rad")
def held_spring_rate(m: Module) -> Scalar:
    """Torque of a spring per winding of spring, pin and floor in series; `leg_model: ignored` holds it rigidly."""
    if m.leg_model == "ignored":
        return m.spring_rate
    return m.spring_rate * plastics.winding_left(m.spring_rate, (m.pin_give, 0.0), (m.tang_give, 0.0))


def _structure_creep(m: Module) -> plastics.Creep:
    """Return the creep of the structure."""
    return plastics.Creep(m.structure_creep_share, m.structure_creep_exponent, m.structure_creep_energy)


Holds = tuple[tuple[Scalar, Scalar], tuple[Scalar, Scalar]]
"""Elastic compliance [rad/(N*m)] of pin and tang, and the creep of each, of that [1]."""


def _spring_holds(m: Module) -> Holds:
    """Return the supports of a spring after `rest_time` in the air and `hot_time` at the hot point."""
    rested = plastics.aged(m.rest_time, m.ambient_temperature, _structure_creep(m))
    warm = (m.part_temperatures_at_hot.beside, m.part_temperatures_at_hot.floor)
    times = (rested + plastics.aged(m.hot_time, temperature, _structure_creep(m)) for temperature in warm)
    on_pin, in_floor = (plastics.growth(time, _structure_creep(m)) for time in times)
    return (m.pin_give, on_pin), (m.tang_give, in_floor)


@quantities.output("rad")
def preload_loss(m: Module) -> Scalar:
    """Winding that a spring loses at rest by creep of pin and floor, after `rest_time` and `hot_time`."""
    at_once = plastics.winding_left(m.spring_rate, *((compliance, 0.0) for compliance, _ in _spring_holds(m)))
    return m.preload_angle * (at_once - plastics.winding_left(m.spring_rate, *_spring_holds(m)))


quantities.margins("spring_as_drawn")
