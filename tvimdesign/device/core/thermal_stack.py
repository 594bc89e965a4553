"""The thermal stack of the module, and what it is like at each instant of a phase.

Each mode defines what the heat passes: `pcl_area` and `pcl_depth`, the plate behind (`plate_depth`,
`plate_outside`), the rotor beside that (`rotor_beside`, `uneven_sideways`, `plate_mass`, `core_share`), the pads' open
`cold_area` and the way along them to a sink there (`cold_to_sink`); the bodies around the pads (`around_pads`), what
passes heat to, from and between them (`floor_links`, `stack_links`, `side_links`, `loss_links`, and a `lip` of the
plate), and how the plate loses heat in the end (`plate_losses`); what of the layer's area the pads have
(`heated_area`), in how many `heater_strings`, and what spreads their heat (`spreader_resistance`); and by
`layer_temperatures`, `column_shares` and `moment_now` what a partly molten layer is to the joint. `heater_form.py` has
the spreader, and the layer that its own current heats.

The joint's own motion makes heat in the PCL. It is a sine at the frequency of an operating point, by the torque that
turns the hot joint by its stroke: a joint that is still stiff turns less, and heats next to nothing. The damping is
that of small strain, which is the most the melt does (`hot_damping_at_stroke` is less)."""

import numpy as np

from tvimdesign.device.core.impedance.joint_impedance import impedance_beside
from tvimdesign.device.table import Module, QuantityGroup, Scalar
from tvimdesign.physics.heat_flow import heat, lumps, peltier
from tvimdesign.physics.layers import layer
from tvimdesign.physics.polymers import polymer

POWER_ROUNDING = 0.01  # W
"""Width of the corner where the pads stop generating."""

quantities = QuantityGroup("Switch")

quantities.inputs()
quantities.choices("thermal_stack")


@quantities.output("1")
def heater_scale(m: Module) -> Scalar:
    """Area of the pads over the area of the catalogue module they are cut from, or the count of modules."""
    return m.heated_area / m.heater_area


@quantities.helper()
def pads(m: Module) -> peltier.PeltierModule:
    """All pads as one module: S, R and K grow with the count of couples, strings in parallel share the current."""
    pad = peltier.PeltierModule(m.heater_seebeck, m.heater_resistance, m.heater_conductance)
    return peltier.wired(pad, m.heater_scale, m.heater_strings)


@quantities.helper()
def core_and_link(m: Module) -> lumps.Lump:
    """Core, link and retainer, which the plate heats through its inner ring: 2 pi k h/ln(r_i/r_c)."""
    plate = m.plate_mass - m.liner_recess.area * m.structure_density
    sheet = 2.0 * np.pi * m.structure_conductivity * m.rotor_thickness
    return lumps.Lump(
        conductance=sheet / np.log(m.pcl_inner_radius / m.core_radius),
        capacity=(m.rotor_mass - plate + m.link_mass + m.retainer_mass) * m.structure_specific_heat,
        surface=lumps.NOWHERE,
    )


@quantities.helper()
def structure_heat_capacity(m: Module) -> Scalar:
    """Heat capacity of the printed or milled parts per volume [J/m^3 K]."""
    return m.structure_density * m.structure_specific_heat


@quantities.helper()
def floor_in_air(m: Module) -> lumps.Surface:
    """Heat from a square metre of the floor's lower face to the air."""
    return lumps.Surface(1.0, m.housing_coefficient, m.surface_emissivity)


@quantities.helper()
def housing_rest(m: Module) -> lumps.Body:
    """Heat capacity of housing and base, and their wall in the air; a mode takes the floor's bodies from it."""
    side = 2.0 * np.pi * m.housing_outer_radius * (m.rim_level + m.floor_thickness + m.foot_height)
    return lumps.Body((m.housing_mass + m.base_mass) * m.structure_specific_heat, m.floor_in_air._replace(area=side))


@quantities.helper()
def sink(m: Module) -> lumps.Lump | None:
    """Sink at the pads' cold sides, where those are open: behind its contact, and what leads to it along them."""
    if m.cold_side == "open":
        return None
    surface = lumps.Surface(m.sink_area, m.sink_coefficient, m.surface_emissivity)
    contact = 1.0 / (1.0 / (m.sink_contact * m.cold_area) + m.cold_to_sink)
    return lumps.Lump(conductance=contact, capacity=m.sink_capacity, surface=surface)


@quantities.helper()
def stack(m: Module) -> heat.Stack:
    """The stack the heat passes, from the cold side's air to the air above the rotor."""
    side, legs = peltier.shared_capacity(m.heater_mass * m.heater_specific_heat)
    return heat.Stack(
        area=m.pcl_area,
        thickness=m.pcl_depth,
        density=m.pcl_density,
        conductivity_solid=m.pcl_conductivity_solid,
        conductivity_melt=m.pcl_conductivity_melt,
        melting=m.pcl_melting,
        peltier=m.pads,
        cold_capacity=side,
        hot_capacity=side,
        legs_capacity=legs,
        # The pads' cold sides meet the air in the windows; the ledges are plastic.
        cold_surface=lumps.Surface(m.cold_area, m.cold_side_coefficient, m.surface_emissivity),
        hot_contact=m.layer_contact,
        spreader=m.spreader,
        plate_contact=m.rotor_contact,
        liner=m.liner_sheet,
        plate_thickness=m.backing_depth,
        plate_conductivity=m.structure_conductivity,
        plate_heat_capacity=m.structure_density * m.structure_specific_heat,
        plate_surface=m.plate_outside,
        ambient=m.ambient_temperature,
        plate_cells=int(m.rotor_cells),
        beside=(*m.rotor_beside, m.core_and_link._replace(conductance=m.core_share * m.core_and_link.conductance)),
        uneven_conductance=m.uneven_sideways,
        sink=m.sink,
        around=m.around_pads,
        links=(*m.floor_links, *m.stack_links, *m.side_links, *m.loss_links),
        lip=m.lip,
        layer_resistance=m.layer_resistance,
    )


# --- at each instant -------------------------------------------------------------------------------------------------


@quantities.helper(instant=True)
def stack_now(m: Module) -> heat.Stack:
    """The stack as a phase sees it: where the layer freezes, with the kinetics of freezing."""
    return m.stack._replace(freezing=m.pcl_kinetics) if m.phase.history and m.phase_model == "kinetic" else m.stack


@quantities.helper(instant=True)
def stack_profile(m: Module) -> heat.Profile:
    """Temperatures and solid fractions through the stack."""
    return heat.profile(m.state, m.stack_now)


@quantities.helper(instant=True)
def state_rates(m: Module) -> Scalar:
    """Time derivative of the thermal state."""
    return heat.rates(m.state, m.stack_now._replace(motion_heat=m.motion_heat), m.drive_current)


@quantities.output("W", instant=True)
def terminal_power(m: Module) -> Scalar:
    """Electrical power at the pads' terminals, negative where they generate."""
    return heat.electrical_power(m.stack_profile, m.stack_now, m.drive_current)


@quantities.output("W", instant=True)
def electrical_power(m: Module) -> Scalar:
    """Power the supply gives; what the pads generate is not recovered."""
    return polymer.ramp(m.terminal_power, POWER_ROUNDING)


@quantities.output("V", instant=True)
def supply_voltage(m: Module) -> Scalar:
    """Voltage over all pads as they are wired, in size."""
    return np.fabs(heat.voltage(m.stack_profile, m.stack_now, m.drive_current))


@quantities.output("degC", instant=True)
def mean_temperature(m: Module) -> Scalar:
    """Mean temperature of the layer."""
    return np.mean(m.stack_profile.cells)


@quantities.helper(instant=True)
def frequency_now(m: Module) -> Scalar:
    """Frequency of the operating point where the phase leads [Hz]."""
    return m.frequency_at_hot if m.phase.sign > 0.0 else m.frequency_at_cold


@quantities.helper(instant=True)
def rheology_now(m: Module) -> polymer.AnyRheology:
    """Relaxation spectrum of the PCL: a melt that is heated has a memory of its crystals, one that cools has none."""
    return m.pcl_rheology if m.phase.sign > 0.0 else m.pcl_rheology.equilibrated


@quantities.helper(instant=True)
def slice_moduli(m: Module) -> tuple[Scalar, Scalar]:
    """Storage and loss modulus of the layer's slices [Pa], at the frequency of where the phase leads."""
    return polymer.moduli(
        m.stack_profile.cells, m.stack_profile.fractions, 2.0 * np.pi * m.frequency_now, m.rheology_now
    )


@quantities.helper(instant=True)
def column_compliances(m: Module) -> list[tuple[Scalar, Scalar]]:
    """Compliance of the slices in each column [1/Pa] of a layer that melts; one that freezes has no columns."""
    if m.stack_now.freezing is not None:
        return []
    omega = 2.0 * np.pi * m.frequency_now
    return [
        layer.melting_compliance(column, m.stack_now.melting, omega, m.rheology_now) for column in m.layer_temperatures
    ]


@quantities.helper(instant=True)
def layer_moduli(m: Module) -> tuple[Scalar, Scalar]:
    """Storage and loss modulus of the layer [Pa]: its slices in series, and while it melts its columns side by side.

    A layer that freezes has one history at each depth.
    """
    if m.stack_now.freezing is not None:
        return layer.series_modulus(*m.slice_moduli)
    return layer.side_by_side(m.column_compliances, m.column_shares)


@quantities.helper(instant=True)
def layer_stiffness_now(m: Module) -> tuple[Scalar, Scalar]:
    """Real and imaginary stiffness of the layer [N*m/rad]."""
    storage, loss = m.layer_moduli
    return storage * m.moment_now / m.pcl_depth, loss * m.moment_now / m.pcl_depth


@quantities.helper(instant=True)
def branch_now(m: Module) -> tuple[Scalar, Scalar]:
    """Real and imaginary stiffness of layer and structure in series [N*m/rad]."""
    real, imaginary = layer.series_stiffness(*m.layer_stiffness_now, *m.support_now)
    return m.branch_scale * real, m.branch_scale * imaginary


@quantities.output("N*m/rad", instant=True)
def impedance_now(m: Module) -> Scalar:
    """Magnitude of the joint's dynamic stiffness at the frequency of where the phase leads."""
    return impedance_beside(m.spring_stiffness, m.branch_now)


@quantities.output("N*m/rad", instant=True)
def stiffness_now(m: Module) -> Scalar:
    """Stiffness of the joint at the frequency of where the phase leads."""
    return m.spring_stiffness + m.branch_now[0]


@quantities.output("N*m*s/rad", instant=True)
def damping_now(m: Module) -> Scalar:
    """Damping of the joint at the frequency of where the phase leads."""
    return m.branch_now[1] / (2.0 * np.pi * m.frequency_now)


quantities.choices("heat_links")


@quantities.output("W", per_point=True)
def viscous_heating(m: Module) -> Scalar:
    """Heat in the PCL where the joint is turned by the torque that turns the hot joint by its stroke."""
    pcl = (m.pcl_stiffness, layer.loss_stiffness(m.pcl_damping, m.frequency))
    turned = m.stroke * m.joint_impedance_at_hot / m.joint_impedance
    return layer.dissipation(pcl, m.branch_stiffness, turned, m.frequency)


@quantities.helper(instant=True)
def motion_heat(m: Module) -> Scalar:
    """Heat [W] the joint's motion makes in each slice of the PCL, most in those that are molten."""
    if m.motion == "at_rest":
        return 0.0
    turned = m.stroke * m.joint_impedance_at_hot / m.impedance_now
    heat = layer.dissipation(m.layer_stiffness_now, m.branch_now, turned, m.frequency_now)
    return heat * layer.loss_shares(*m.slice_moduli)
