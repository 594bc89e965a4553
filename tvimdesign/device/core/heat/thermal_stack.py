"""The thermal stack of the module, and what it is like at each instant of a phase.

Each mode says in its own room what the heat passes: `pcl_area` and `pcl_depth`, the plate behind (`plate_depth`,
`plate_outside`), the rotor beside that (`rotor_beside`, `uneven_sideways`, `plate_mass`, `core_share`), the pads' open
`cold_area` and the way along them to a sink there (`cold_to_sink`); the bodies around the pads (`around_pads`), what
passes heat to, from and between them (`floor_links`, `stack_links`, `side_links`, `loss_links`, and a `lip` of the
plate), and how the plate loses heat in the end
(`plate_losses`); what of the layer's area the pads have (`heated_area`), in how many `heater_strings`, how heat comes
from them to the layer (`pad_contact`, of which `to_spreader` lies before a spreader), and what is heated on the way
(`spreader_capacity`); and by `layer_temperatures`, `column_shares` and `moment_now` what a partly molten layer is to
the joint. `layer_heater.py` has the layer that its own current heats.
"""

from __future__ import annotations

import numpy as np

from tvimdesign.device.core.impedance.joint_impedance import joint_damping, joint_impedance, joint_stiffness
from tvimdesign.device.table.quantity import Phase, Scalar
from tvimdesign.device.table.quantity_group import QuantityGroup
from tvimdesign.physics.bodies.shapes import Section
from tvimdesign.physics.heat_flow import heat, lumps, peltier
from tvimdesign.physics.heat_flow.liner import Liner
from tvimdesign.physics.heat_flow.lip import Lip
from tvimdesign.physics.layers import layer
from tvimdesign.physics.polymers import crystallization, polymer

POWER_ROUNDING = 0.01  # W
"""Width of the corner where the pads stop generating."""

quantities = QuantityGroup("Switch")

quantities.inputs()
quantities.option(
    "cold_side", ("open", "sink"), "What the pads' outer side gives its heat to: the air, or a sink of its own"
)
quantities.option(
    "phase_model",
    ("kinetic", "equilibrium"),
    "How the layer freezes: late and supercooled as it does, or on its melting curve as is often assumed",
    idealized={"equilibrium": "the layer freezes where it melts, where it supercools and needs its time"},
)


@quantities.output("1")
def peltier_scale(heated_area: Scalar, peltier_area: Scalar) -> Scalar:
    """Area of the pads over the area of the catalogue module they are cut from, or the count of modules."""
    return heated_area / peltier_area


@quantities.helper()
def pads(
    peltier_scale: Scalar,
    heater_strings: Scalar,
    peltier_seebeck: Scalar,
    peltier_resistance: Scalar,
    peltier_conductance: Scalar,
) -> peltier.PeltierModule:
    """All pads as one module: S, R and K grow with the count of couples, strings in parallel share the current."""
    one = peltier.PeltierModule(peltier_seebeck, peltier_resistance, peltier_conductance)
    return peltier.wired(one, peltier_scale, heater_strings)


@quantities.helper()
def core_and_link(
    core_radius: Scalar,
    pcl_inner_radius: Scalar,
    rotor_thickness: Scalar,
    plate_mass: Scalar,
    rotor_mass: Scalar,
    link_mass: Scalar,
    retainer_mass: Scalar,
    liner_recess: Section,
    structure_density: Scalar,
    structure_specific_heat: Scalar,
    structure_conductivity: Scalar,
) -> lumps.Lump:
    """Core, link and retainer, which the plate heats through its inner ring: 2 pi k h/ln(r_i/r_c)."""
    plate = plate_mass - liner_recess.area * structure_density
    return lumps.Lump(
        conductance=2.0 * np.pi * structure_conductivity * rotor_thickness / np.log(pcl_inner_radius / core_radius),
        capacity=(rotor_mass - plate + link_mass + retainer_mass) * structure_specific_heat,
        surface=lumps.NOWHERE,
    )


@quantities.helper()
def structure_heat_capacity(structure_density: Scalar, structure_specific_heat: Scalar) -> Scalar:
    """Heat capacity of the printed or milled parts per volume [J/m^3 K]."""
    return structure_density * structure_specific_heat


@quantities.helper()
def floor_in_air(housing_coefficient: Scalar, surface_emissivity: Scalar) -> lumps.Surface:
    """What a square metre of the floor's lower face gives to the air."""
    return lumps.Surface(1.0, housing_coefficient, surface_emissivity)


@quantities.helper()
def housing_rest(
    housing_outer_radius: Scalar,
    rim_level: Scalar,
    foot_height: Scalar,
    floor_thickness: Scalar,
    housing_mass: Scalar,
    structure_specific_heat: Scalar,
    floor_in_air: lumps.Surface,
) -> lumps.Body:
    """The whole housing's heat capacity, and its wall and feet in the air; a mode takes the floor's bodies from it."""
    side = 2.0 * np.pi * housing_outer_radius * (rim_level + floor_thickness + foot_height)
    return lumps.Body(housing_mass * structure_specific_heat, floor_in_air._replace(area=side))


@quantities.helper()
def sink(
    cold_side: str,
    sink_contact: Scalar,
    sink_capacity: Scalar,
    sink_area: Scalar,
    sink_coefficient: Scalar,
    surface_emissivity: Scalar,
    cold_area: Scalar,
    cold_to_sink: Scalar,
) -> lumps.Lump | None:
    """Sink at the pads' cold sides, where those are open: behind its contact, and what leads to it along them."""
    if cold_side == "open":
        return None
    surface = lumps.Surface(sink_area, sink_coefficient, surface_emissivity)
    contact = 1.0 / (1.0 / (sink_contact * cold_area) + cold_to_sink)
    return lumps.Lump(conductance=contact, capacity=sink_capacity, surface=surface)


@quantities.helper()
def heat_links(
    floor_links: tuple[lumps.Link, ...],
    stack_links: tuple[lumps.Link, ...],
    side_links: tuple[lumps.Link, ...],
    loss_links: tuple[lumps.Link, ...],
) -> tuple[lumps.Link, ...]:
    """What passes heat between the stack and the bodies beside and around it, and among these."""
    return (*floor_links, *stack_links, *side_links, *loss_links)


@quantities.helper()
def stack(
    pcl_area: Scalar,
    pcl_depth: Scalar,
    pcl_density: Scalar,
    pcl_conductivity_solid: Scalar,
    pcl_conductivity_melt: Scalar,
    pcl_melting: polymer.Melting,
    pads: peltier.PeltierModule,
    layer_resistance: Scalar,
    peltier_mass: Scalar,
    peltier_specific_heat: Scalar,
    cold_side_coefficient: Scalar,
    surface_emissivity: Scalar,
    cold_area: Scalar,
    pad_contact: Scalar,
    to_spreader: Scalar,
    spreader_capacity: Scalar,
    rotor_contact: Scalar,
    liner_sheet: Liner | None,
    backing_depth: Scalar,
    plate_outside: lumps.Surface,
    structure_conductivity: Scalar,
    structure_density: Scalar,
    structure_specific_heat: Scalar,
    ambient_temperature: Scalar,
    rotor_cells: float,
    rotor_beside: tuple[lumps.Lump, ...],
    uneven_sideways: Scalar | None,
    core_and_link: lumps.Lump,
    core_share: Scalar,
    sink: lumps.Lump | None,
    around_pads: tuple[lumps.Body, ...],
    heat_links: tuple[lumps.Link, ...],
    lip: Lip | None,
) -> heat.Stack:
    """The stack the heat passes, from the cold side's air to the air above the rotor."""
    side, legs = peltier.shared_capacity(peltier_mass * peltier_specific_heat)
    return heat.Stack(
        area=pcl_area,
        thickness=pcl_depth,
        density=pcl_density,
        conductivity_solid=pcl_conductivity_solid,
        conductivity_melt=pcl_conductivity_melt,
        melting=pcl_melting,
        peltier=pads,
        cold_capacity=side,
        hot_capacity=side + spreader_capacity,
        legs_capacity=legs,
        # The pads' cold sides meet the air in the windows; the ledges are plastic.
        cold_surface=lumps.Surface(cold_area, cold_side_coefficient, surface_emissivity),
        hot_contact=pad_contact,
        plate_contact=rotor_contact,
        liner=liner_sheet,
        plate_thickness=backing_depth,
        plate_conductivity=structure_conductivity,
        plate_heat_capacity=structure_density * structure_specific_heat,
        plate_surface=plate_outside,
        ambient=ambient_temperature,
        plate_cells=int(rotor_cells),
        beside=(*rotor_beside, core_and_link._replace(conductance=core_share * core_and_link.conductance)),
        uneven_conductance=uneven_sideways,
        sink=sink,
        around=around_pads,
        links=heat_links,
        lip=lip,
        to_spreader=to_spreader / pcl_area,
        layer_resistance=layer_resistance,
    )


# --- at each instant -------------------------------------------------------------------------------------------------


@quantities.helper(instant=True)
def stack_now(stack: heat.Stack, phase: Phase, phase_model: str, pcl_kinetics: crystallization.Kinetics) -> heat.Stack:
    """The stack as a phase sees it: where the layer freezes, with the kinetics of freezing."""
    return stack._replace(freezing=pcl_kinetics) if phase.history and phase_model == "kinetic" else stack


@quantities.helper(instant=True)
def stack_profile(state: Scalar, stack_now: heat.Stack) -> heat.Profile:
    """Temperatures and solid fractions through the stack."""
    return heat.profile(state, stack_now)


@quantities.helper(instant=True)
def state_rates(state: Scalar, stack_now: heat.Stack, drive_current: Scalar, motion_heat: Scalar) -> Scalar:
    """Time derivative of the thermal state."""
    return heat.rates(state, stack_now._replace(motion_heat=motion_heat), drive_current)


@quantities.output("W", instant=True)
def terminal_power(stack_profile: heat.Profile, stack_now: heat.Stack, drive_current: Scalar) -> Scalar:
    """Electrical power at the pads' terminals, negative where they generate."""
    return heat.electrical_power(stack_profile, stack_now, drive_current)


@quantities.output("W", instant=True)
def electrical_power(terminal_power: Scalar) -> Scalar:
    """Power the supply gives; what the pads generate is not recovered."""
    return polymer.ramp(terminal_power, POWER_ROUNDING)


@quantities.output("V", instant=True)
def supply_voltage(stack_profile: heat.Profile, stack_now: heat.Stack, drive_current: Scalar) -> Scalar:
    """Voltage over all pads as they are wired, in size."""
    return np.fabs(heat.voltage(stack_profile, stack_now, drive_current))


@quantities.output("degC", instant=True)
def mean_temperature(stack_profile: heat.Profile) -> Scalar:
    """Mean temperature of the layer."""
    return np.mean(stack_profile.cells)


@quantities.helper(instant=True)
def frequency_now(phase: Phase, frequency_at_hot: Scalar, frequency_at_cold: Scalar) -> Scalar:
    """Frequency of the operating point where the phase leads [Hz]."""
    return frequency_at_hot if phase.sign > 0.0 else frequency_at_cold


@quantities.helper(instant=True)
def slice_moduli(
    stack_profile: heat.Profile, pcl_rheology: polymer.AnyRheology, frequency_now: Scalar
) -> tuple[Scalar, Scalar]:
    """Storage and loss modulus of the layer's slices [Pa], at the frequency of where the phase leads."""
    return polymer.moduli(stack_profile.cells, stack_profile.fractions, 2.0 * np.pi * frequency_now, pcl_rheology)


@quantities.helper(instant=True)
def column_compliances(
    stack_now: heat.Stack, layer_temperatures: list[Scalar], pcl_rheology: polymer.AnyRheology, frequency_now: Scalar
) -> list[tuple[Scalar, Scalar]]:
    """Compliance of the slices in each column [1/Pa] of a layer that melts; one that freezes has no columns."""
    if stack_now.freezing is not None:
        return []
    omega = 2.0 * np.pi * frequency_now
    return [layer.melting_compliance(one, stack_now.melting, omega, pcl_rheology) for one in layer_temperatures]


@quantities.helper(instant=True)
def layer_moduli(
    stack_now: heat.Stack,
    slice_moduli: tuple[Scalar, Scalar],
    column_compliances: list[tuple[Scalar, Scalar]],
    column_shares: tuple[float, ...],
) -> tuple[Scalar, Scalar]:
    """Storage and loss modulus of the layer [Pa]: its slices in series, and while it melts its columns side by side.

    A layer that freezes has one history at each depth.
    """
    if stack_now.freezing is not None:
        return layer.series_modulus(*slice_moduli)
    return layer.side_by_side(column_compliances, column_shares)


@quantities.helper(instant=True)
def layer_stiffness_now(
    layer_moduli: tuple[Scalar, Scalar], moment_now: Scalar, pcl_depth: Scalar
) -> tuple[Scalar, Scalar]:
    """Real and imaginary stiffness of the layer [N*m/rad]."""
    storage, loss = layer_moduli
    return storage * moment_now / pcl_depth, loss * moment_now / pcl_depth


@quantities.helper(instant=True)
def branch_now(layer_stiffness_now: tuple[Scalar, Scalar], support_now: tuple[Scalar, Scalar]) -> tuple[Scalar, Scalar]:
    """Real and imaginary stiffness of layer and structure in series [N*m/rad]."""
    return layer.series_stiffness(*layer_stiffness_now, *support_now)


@quantities.output("N*m/rad", instant=True)
def impedance_now(spring_stiffness: Scalar, branch_now: tuple[Scalar, Scalar]) -> Scalar:
    """Magnitude of the joint's dynamic stiffness at the frequency of where the phase leads."""
    return joint_impedance(spring_stiffness, branch_now)


@quantities.output("N*m/rad", instant=True)
def stiffness_now(spring_stiffness: Scalar, branch_now: tuple[Scalar, Scalar]) -> Scalar:
    """Stiffness of the joint at the frequency of where the phase leads."""
    return joint_stiffness(spring_stiffness, branch_now)


@quantities.output("N*m*s/rad", instant=True)
def damping_now(branch_now: tuple[Scalar, Scalar], frequency_now: Scalar) -> Scalar:
    """Damping of the joint at the frequency of where the phase leads."""
    return joint_damping(branch_now, frequency_now)
