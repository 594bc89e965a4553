"""One switch from frozen to molten at constant current: temperatures, response times, power and energy."""

from __future__ import annotations

import numpy as np

from tvimdesign.device.book import Book
from tvimdesign.device.rows import Rule, Scalar
from tvimdesign.physics import heat, layer, peltier, polymer
from tvimdesign.physics.shapes import Section

book = Book("Switch")

book.inputs()
book.option(
    "response_criterion",
    ("far_face", "mean", "near_face", "softening"),
    "What ends the switch: a face or the mean of the layer at the target temperature, or the joint's impedance",
)


@book.output("1")
def peltier_scale(pcl_area: Scalar, peltier_area: Scalar) -> Scalar:
    """Area of the pads over the area of the catalogue module they are cut from."""
    return pcl_area / peltier_area


@book.helper()
def pads(
    peltier_scale: Scalar, peltier_seebeck: Scalar, peltier_resistance: Scalar, peltier_conductance: Scalar
) -> peltier.Module:
    """All pads in series; Seebeck coefficient, resistance and conductance grow with the count of couples."""
    return peltier.Module(
        peltier_scale * peltier_seebeck, peltier_scale * peltier_resistance, peltier_scale * peltier_conductance
    )


@book.output("A", advice=(Rule(sense=">=", value=0.0, reason="above the Peltier module's rated current"),))
def current_reserve(peltier_max_current: Scalar, current: Scalar) -> Scalar:
    """Rated current of the Peltier module less the current of the switch."""
    return peltier_max_current - current


@book.helper()
def plate_beside_arcs(
    rotor_radius: Scalar,
    pcl_area: Scalar,
    arc_count: Scalar,
    arc_span: Scalar,
    pcl_inner_radius: Scalar,
    pcl_outer_radius: Scalar,
    rotor_thickness: Scalar,
    structure_conductivity: Scalar,
    structure_density: Scalar,
    structure_specific_heat: Scalar,
    rotor_coefficient: Scalar,
) -> heat.Lump:
    """Rotor plate beside the arcs.

    A strip heated at its edge: its mean temperature is a third of its width away (Incropera, Fundamentals of Heat and
    Mass Transfer, ch. 5, quasi-steady).
    """
    area = np.pi * rotor_radius**2 - pcl_area
    edge = arc_count * (2.0 * (pcl_outer_radius - pcl_inner_radius) + arc_span * (pcl_inner_radius + pcl_outer_radius))
    return heat.Lump(
        conductance=3.0 * structure_conductivity * rotor_thickness * edge**2 / area,
        capacity=area * rotor_thickness * structure_density * structure_specific_heat,
        loss=rotor_coefficient * area,
    )


@book.helper()
def core_and_link(
    core_radius: Scalar,
    pcl_inner_radius: Scalar,
    rotor_thickness: Scalar,
    rotor_radius: Scalar,
    rotor_mass: Scalar,
    link_mass: Scalar,
    retainer_mass: Scalar,
    structure_density: Scalar,
    structure_specific_heat: Scalar,
    structure_conductivity: Scalar,
) -> heat.Lump:
    """Core, link and retainer, which the plate heats through its inner ring: 2 pi k h/ln(r_i/r_c)."""
    plate_mass = np.pi * rotor_radius**2 * rotor_thickness * structure_density
    return heat.Lump(
        conductance=2.0 * np.pi * structure_conductivity * rotor_thickness / np.log(pcl_inner_radius / core_radius),
        capacity=(rotor_mass - plate_mass + link_mass + retainer_mass) * structure_specific_heat,
        loss=0.0,
    )


@book.helper()
def stack(
    pcl_area: Scalar,
    pcl_thickness: Scalar,
    pcl_density: Scalar,
    pcl_conductivity_solid: Scalar,
    pcl_conductivity_melt: Scalar,
    pcl_melting: polymer.Melting,
    pads: peltier.Module,
    current: Scalar,
    peltier_mass: Scalar,
    peltier_specific_heat: Scalar,
    sink_capacity: Scalar,
    cold_side_coefficient: Scalar,
    window_section: Section,
    hot_contact: Scalar,
    rotor_contact: Scalar,
    rotor_thickness: Scalar,
    structure_conductivity: Scalar,
    structure_density: Scalar,
    structure_specific_heat: Scalar,
    rotor_coefficient: Scalar,
    ambient_temperature: Scalar,
    rotor_cells: float,
    plate_beside_arcs: heat.Lump,
    core_and_link: heat.Lump,
) -> heat.Stack:
    """The stack the heat passes, from the cold side's air to the air above the rotor."""
    half = 0.5 * peltier_mass * peltier_specific_heat
    return heat.Stack(
        area=pcl_area,
        thickness=pcl_thickness,
        density=pcl_density,
        conductivity_solid=pcl_conductivity_solid,
        conductivity_melt=pcl_conductivity_melt,
        melting=pcl_melting,
        peltier=pads,
        current=current,
        cold_capacity=half + sink_capacity,
        hot_capacity=half,
        # The pads' cold sides meet the air in the windows; the ledges are plastic.
        cold_conductance=cold_side_coefficient * window_section.area,
        hot_contact=hot_contact,
        plate_contact=rotor_contact,
        plate_thickness=rotor_thickness,
        plate_conductivity=structure_conductivity,
        plate_heat_capacity=structure_density * structure_specific_heat,
        plate_coefficient=rotor_coefficient,
        ambient=ambient_temperature,
        plate_cells=int(rotor_cells),
        beside=(plate_beside_arcs, core_and_link),
    )


# --- at each instant -------------------------------------------------------------------------------------------------


@book.helper(instant=True)
def stack_profile(state: list[Scalar], stack: heat.Stack) -> heat.Profile:
    """Temperatures and solid fractions through the stack."""
    return heat.profile(state, stack)


@book.helper(instant=True)
def state_rates(state: list[Scalar], stack: heat.Stack) -> list[Scalar]:
    """Time derivative of the thermal state."""
    return heat.rates(state, stack)


@book.output("W", instant=True)
def electrical_power(stack_profile: heat.Profile, stack: heat.Stack) -> Scalar:
    """Power the supply gives."""
    return heat.electrical_power(stack_profile, stack)


@book.output("V", instant=True)
def supply_voltage(electrical_power: Scalar, current: Scalar) -> Scalar:
    """Voltage over all pads in series."""
    return electrical_power / current


@book.output("degC", instant=True)
def mean_temperature(stack_profile: heat.Profile) -> Scalar:
    """Mean temperature of the layer."""
    return sum(stack_profile.cells) / len(stack_profile.cells)


@book.helper(instant=True)
def layer_moduli(
    stack_profile: heat.Profile, pcl_rheology: polymer.Rheology, frequency_at_hot: Scalar
) -> tuple[Scalar, Scalar]:
    """Storage and loss modulus of the layer, its slices in series [Pa]."""
    slices = [
        polymer.moduli(t, x, 2.0 * np.pi * frequency_at_hot, pcl_rheology)
        for t, x in zip(stack_profile.cells, stack_profile.fractions, strict=True)
    ]
    return layer.series_modulus(slices)


@book.output("N*m/rad", instant=True)
def impedance_now(
    layer_moduli: tuple[Scalar, Scalar],
    layer_polar_moment: Scalar,
    pcl_thickness: Scalar,
    structure_stiffness: Scalar,
    spring_stiffness: Scalar,
) -> Scalar:
    """Magnitude of the joint's dynamic stiffness at the hot point's frequency."""
    storage, loss = (modulus * layer_polar_moment / pcl_thickness for modulus in layer_moduli)
    real, imaginary = layer.series_stiffness(storage, loss, structure_stiffness)
    return np.sqrt((spring_stiffness + real) ** 2 + imaginary**2)


# --- response times --------------------------------------------------------------------------------------------------


@book.event
def near_face_time(stack_profile: heat.Profile, target_temperature: Scalar) -> Scalar:
    """Time until the layer's face at the Peltier pads is at the target temperature."""
    return (stack_profile.near - target_temperature) / heat.TEMPERATURE_SCALE


@book.event
def mean_time(mean_temperature: Scalar, target_temperature: Scalar) -> Scalar:
    """Time until the layer's mean is at the target temperature."""
    return (mean_temperature - target_temperature) / heat.TEMPERATURE_SCALE


@book.event
def far_face_time(stack_profile: heat.Profile, target_temperature: Scalar) -> Scalar:
    """Time until the layer's face at the rotor is at the target temperature."""
    return (stack_profile.far - target_temperature) / heat.TEMPERATURE_SCALE


@book.event
def softening_time(impedance_now: Scalar, joint_impedance_at_hot: Scalar, softening_band: Scalar) -> Scalar:
    """Time until the joint's impedance is within the softening band of its hot value."""
    return np.log(softening_band * joint_impedance_at_hot) - np.log(impedance_now)


@book.event
def response_time(
    response_criterion: str,
    stack_profile: heat.Profile,
    mean_temperature: Scalar,
    target_temperature: Scalar,
    impedance_now: Scalar,
    joint_impedance_at_hot: Scalar,
    softening_band: Scalar,
) -> Scalar:
    """Time of one switch, by the criterion the study chose."""
    if response_criterion == "softening":
        return softening_time(impedance_now, joint_impedance_at_hot, softening_band)
    if response_criterion == "mean":
        return mean_time(mean_temperature, target_temperature)
    face = near_face_time if response_criterion == "near_face" else far_face_time
    return face(stack_profile, target_temperature)


@book.output("s", advice=(Rule(sense=">=", value=0.0, reason="the joint is not yet soft when the switch ends"),))
def softening_reserve(response_time: Scalar, softening_time: Scalar) -> Scalar:
    """Time from the joint being soft to the end of the switch."""
    return response_time - softening_time


# --- over the switch -------------------------------------------------------------------------------------------------


@book.path("J", "integral", headline=True)
def switch_energy(electrical_power: Scalar) -> Scalar:
    """Electrical energy of one switch."""
    return electrical_power


@book.path("W", "maximum", headline=True)
def peak_power(electrical_power: Scalar) -> Scalar:
    """Highest electrical power during the switch."""
    return electrical_power


@book.path("V", "maximum")
def peak_voltage(supply_voltage: Scalar) -> Scalar:
    """Highest voltage over all pads in series during the switch."""
    return supply_voltage


@book.path("degC", "maximum")
def peak_pcl_temperature(stack_profile: heat.Profile) -> Scalar:
    """Highest temperature in the PCL during the switch, at its face to the pads."""
    return stack_profile.near


@book.path("degC", "maximum")
def peak_peltier_temperature(stack_profile: heat.Profile) -> Scalar:
    """Highest temperature of the pads' hot side during the switch."""
    return stack_profile.hot


@book.path("degC", "maximum")
def peak_rotor_temperature(stack_profile: heat.Profile) -> Scalar:
    """Highest temperature of the rotor plate during the switch, at its face to the layer."""
    return stack_profile.plate_face


@book.output(
    "K", advice=(Rule(sense=">=", value=0.0, reason="the Peltier module is above the temperature it is rated for"),)
)
def peltier_temperature_reserve(peltier_max_temperature: Scalar, peak_peltier_temperature: Scalar) -> Scalar:
    """Rated temperature of the Peltier module less the highest it sees."""
    return peltier_max_temperature - peak_peltier_temperature


@book.output(
    "K", advice=(Rule(sense=">=", value=0.0, reason="the structure is above its continuous service temperature"),)
)
def structure_temperature_reserve(structure_service_temperature: Scalar, peak_peltier_temperature: Scalar) -> Scalar:
    """Service temperature of the structure less the highest temperature of the pads that touch it."""
    return structure_service_temperature - peak_peltier_temperature
