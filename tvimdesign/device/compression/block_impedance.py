"""The PCL blocks of the compression module and what they press on: stiffness, damping, strain, torque they hold.

Of the 2 N blocks only the N that are pressed count. Small motions about rest keep every block touching, so no contact
is lost here; how a gap opens in large ones is a matter of time and history
(`device/core/impedance/joint_impedance.py`).

Liners in both faces of the rotor's vanes are sheets with the face of a block, which the blocks press on. A recess is
open at both ends and below, where the liner slides in; above it ends with the block. What a pressed liner squeezes to
its sides is free, so the compliance is the highest.
"""

import numpy as np

from tvimdesign.device.components.bearing import with_bearings
from tvimdesign.device.components.dowels import LINK_PARTS
from tvimdesign.device.components.liner_and_adhesive import WITH_LINER, traction_with_liner
from tvimdesign.device.core.heater_form import CUT
from tvimdesign.device.core.impedance.structure_stiffness import CORE_PARTS
from tvimdesign.device.core.impedance.warm_structure import Compliances
from tvimdesign.device.table import Module, QuantityGroup, Scalar, at_most
from tvimdesign.physics.layers import block, lasting_load, layer, shear_lag
from tvimdesign.physics.solids import structure, vane, wedge
from tvimdesign.physics.solids.shapes import NOTHING, Section, mean_square, radial_strip

quantities = QuantityGroup("Impedance")


@quantities.output("1")
def shape_factor(m: Module) -> Scalar:
    """Loaded face of a block over its force-free sides, S."""
    return block.shape_factor(m.block_width, m.block_height, m.block_depth)


def blocks_moment(shape_factor: Scalar, vane_count: Scalar, block_area: Scalar, pcl_mean_radius: Scalar) -> Scalar:
    """Return the stiffness of the pressed blocks over shear modulus, times depth [m^4]: 3 (1 + 2 S^2) N A r^2."""
    return block.stiffness(3.0 * block.shape_stiffening(shape_factor), vane_count, block_area, pcl_mean_radius, 1.0)


@quantities.helper()
def pcl_moment(m: Module) -> Scalar:
    """Factor of the PCL's shear modulus over its depth in its stiffness [m^4]."""
    return blocks_moment(m.shape_factor, m.vane_count, m.block_area, m.pcl_mean_radius)


@quantities.helper()
def volume_stiffness(m: Module) -> Scalar:
    """Stiffness of the blocks against a change of volume, in series with their shear modes [N*m/rad]."""
    bulk = block.bulk_modulus(m.pcl_flexural_modulus, m.pcl_poissons_ratio)
    modulus = block.volumetric_modulus(bulk, m.shape_factor)
    return block.stiffness(modulus, m.vane_count, m.block_area, m.pcl_mean_radius, m.block_depth)


@quantities.helper(per_point=True)
def pcl_dynamic_stiffness(m: Module) -> tuple[Scalar, Scalar]:
    """Real and imaginary stiffness of the blocks [N*m/rad]."""
    storage, loss = (modulus * m.pcl_moment / m.block_depth for modulus in m.pcl_moduli)
    return layer.series_stiffness(storage, loss, m.volume_stiffness)


@quantities.output("N*m/rad", per_point=True, headline=True)
def pcl_stiffness(m: Module) -> Scalar:
    """Stiffness of the PCL blocks alone, those of one sense, K_PCL."""
    return m.pcl_dynamic_stiffness[0]


@quantities.output("N*m*s/rad", per_point=True, headline=True)
def pcl_damping(m: Module) -> Scalar:
    """Damping of the PCL blocks alone, those of one sense, b_PCL."""
    return m.pcl_dynamic_stiffness[1] / (2.0 * np.pi * m.frequency)


@quantities.output("mm")
def housing_vane_thickness(m: Module) -> Scalar:
    """Thickness of the housing's vanes between their pads, at the mean radius."""
    return m.slot_angle * m.pcl_mean_radius


@quantities.helper()
def block_against_rotor(m: Module) -> tuple[Scalar, Scalar]:
    """Stiffness of one frozen block with its pad at 23 degC, pressed and sheared along the vane [N/m]."""
    blocks = m.frozen_shear_modulus * m.pcl_moment / m.block_depth
    pressed = structure.series(blocks / (m.vane_count * m.pcl_mean_radius**2), m.pad_press_stiffness)
    halves = 0.5 * m.slot_width, m.slot_height  # a slot is open below
    free = [1.0 - shear_lag.held_over_window(m.heater_thickness, half) for half in halves]
    held = m.block_area - free[0] * free[1] * m.slot_width * m.slot_height
    pad = m.heater_shear_modulus * held / m.heater_thickness
    return pressed, structure.series(m.frozen_shear_modulus * m.block_area / m.block_depth, pad)


@quantities.helper()
def layer_against_leaning(m: Module) -> Scalar:
    """Stiffness of all pressed blocks and pads as the rotor leans over the floor [N*m/rad].

    It turns the vanes' faces of the height h, and pulls the blocks along the axis, which leans the vanes that these
    stand off from: N (r^2/c + (p + s) h^2/12)/2.
    """
    pressed, sheared = m.block_against_rotor
    faces = (pressed + sheared) * m.block_height**2 / 12.0
    along = vane.along_axis(m.rotor_vane, m.housing_vane, m.block_between, (m.vane_thickness, m.housing_vane_thickness))
    return 0.5 * m.vane_count * (m.pcl_mean_radius**2 / (1.0 / sheared + along) + faces)


@quantities.helper()
def layer_sideways(m: Module) -> Scalar:
    """Sideways compliance of all pressed blocks and pads [m/N]: N (p + s)/2 of stiffness."""
    return 2.0 / (m.vane_count * sum(m.block_against_rotor))


@quantities.helper()
def core_foot_rise(m: Module) -> Scalar:
    """Rise of the core's stress at its foot [1]: among the vanes that hang from its plate and cup it, with the link's
    holes."""
    length = m.link_bottom_level - m.rotor_top_level
    holes = m.core_screw_bores, m.core_dowel_bores
    turned = structure.foot_rise_among_vanes(m.core_radius, length, m.rotor_thickness, *holes, fillet=m.foot_fillet)
    cupped = wedge.foot_bending(m.block_lean_out, m.block_between.arm, m.core_radius, m.vanes_plate)
    return np.sqrt(turned**2 + cupped**2)


@quantities.helper()
def over_arcs_compliance(m: Module) -> Scalar:
    """Compliance of the rotor plate from the PCL's inner edge to its vanes' middle [rad/(N*m)]."""
    ring = structure.ring_stiffness(m.structure_shear_modulus, m.rotor_thickness, m.pcl_inner_radius, m.pcl_mean_radius)
    return 1.0 / ring


@quantities.helper()
def under_arcs_compliance(m: Module) -> Scalar:
    """Compliance of the floor from its vanes' middle to the PCL's outer edge [rad/(N*m)]."""
    ring = structure.ring_stiffness(m.structure_shear_modulus, m.floor_thickness, m.pcl_mean_radius, m.pcl_outer_radius)
    return 1.0 / ring


@quantities.helper()
def structure_compliances(m: Module) -> Compliances:
    """Compliances in series with the blocks: core, plate, vanes, floor up to its feet, pads with what
    leaning vanes do to block and pad, and liners."""
    pads = m.vane_count * m.pad_press_stiffness * m.pcl_mean_radius**2
    return Compliances(
        1.0 / m.core_stiffness, 1.0 / m.plate_stiffness, 1.0 / m.rotor_vane_stiffness, 1.0 / m.housing_vane_stiffness,
        1.0 / m.floor_stiffness, 1.0 / pads + m.leaned_on_compliance + m.liner_compliance,
    )  # fmt: skip


@quantities.helper()
def lossless_compliance(m: Module) -> Scalar:
    """Compliance without loss in series with the PCL's shear modes [rad/(N*m)]: the blocks' volume."""
    return 1.0 / m.volume_stiffness


_SQUEEZED = (
    "squeezed by more than half its depth, the molten block is pressed out of its place (assumed, 0.3 to 0.6; a study "
    "may require its own)"
)


@quantities.output("1", at_most(0.5, _SQUEEZED), headline=True)
def block_strain(m: Module) -> Scalar:
    """Compression of the molten block at full stroke, of its depth.

    Its volume stays, so a block squeezed by half has twice the face (textbook), which the running clearances beside it
    do not leave it. Where it is pressed out depends on how it is held, which is unmeasured: the limit is assumed.
    """
    return block.strain(m.pcl_mean_radius, m.stroke, m.block_depth)


@quantities.helper()
def largest_melt_strain(m: Module) -> Scalar:
    """Shear strain [1] that costs the molten block as much as its squeeze at full stroke."""
    return block.equivalent_shear_strain(m.block_strain, m.shape_factor)


@quantities.helper()
def stroke_strains(m: Module) -> list[tuple[Scalar, Scalar]]:
    """Shear strain of the blocks at full stroke, and the share of the small-motion torque it bears: all [1]."""
    return [(m.largest_melt_strain, 1.0)]


@quantities.output("N*m")
def block_holding_torque(m: Module) -> Scalar:
    """Torque at which the frozen blocks, or the liners they press on, yield."""
    stress = traction_with_liner(m.liner_material, m.pcl_tensile_yield, m.liner_strength)
    return block.torque_at_stress(stress, m.vane_count, m.block_area, m.pcl_mean_radius)


@quantities.output("N*m")
def rotor_vane_holding_torque(m: Module) -> Scalar:
    """Torque at which the roots of the rotor's vanes yield, bent, sheared and twisted, cold, over `holding_safety`."""
    section = m.block_width, m.vane_web
    force = wedge.force_at_yield(
        m.cold_layer_strength, section, m.block_between.arm, m.block_lean_out, m.pcl_mean_radius
    )
    return m.vane_count * force * m.pcl_mean_radius / m.holding_safety


@quantities.output("N*m")
def housing_vane_holding_torque(m: Module) -> Scalar:
    """Torque at which the roots of the housing's vanes yield in bending and shear, cold, over `holding_safety`."""
    force = wedge.force_at_yield(m.cold_layer_strength, (m.vane_webs, m.housing_vane_thickness), m.block_between.arm)
    return m.vane_count * force * m.pcl_mean_radius / m.holding_safety


_PARTS = (
    "block_holding_torque", "heater_holding_torque", "heater_shear_holding_torque", "lower_seat_holding_torque",
    "rotor_vane_holding_torque", "housing_vane_holding_torque", *CORE_PARTS, *LINK_PARTS, "bearing_holding_torque",
)  # fmt: skip


@quantities.output("N*m", headline=True, least_of=_PARTS)
def holding_torque(m: Module) -> Scalar:
    """Torque the frozen joint holds: the least of what blocks, heaters, vanes, core, link and bearings bear."""
    vanes = np.fmin(m.rotor_vane_holding_torque, m.housing_vane_holding_torque)
    if m.heater_form == CUT:
        heaters = m.heater_shear_holding_torque
    else:
        heaters = np.fmin(m.heater_holding_torque, m.lower_seat_holding_torque)
    pressed = np.fmin(m.block_holding_torque, heaters)
    held = np.fmin(np.fmin(pressed, vanes), np.fmin(m.core_holding_torque, m.link_holding_torque))
    return with_bearings(m.bearing, held, m.bearing_holding_torque)


@quantities.output("1", headline=True)
def parting_share(_: Module) -> Scalar:
    """Share of the PCL that can part from what presses on it: all, a block pushes and never pulls.

    It is bonded to one vane at most, and what a hold has crept of its depth is a gap when the load is gone.
    """
    return 1.0


@quantities.output("MPa", per_point=True)
def block_pressure(m: Module) -> Scalar:
    """Highest mean pressure on the blocks' faces in a hold: when the load has just come on."""
    borne = lasting_load.first_torque(m.hold_torque, m.spring_stiffness, m.elastic_support, m.pcl_modes)
    return block.stress(borne, m.vane_count, m.block_area, m.pcl_mean_radius)


@quantities.helper()
def vane_webs(m: Module) -> Scalar:
    """Radial width of all that a housing vane has beside its slots [m]."""
    return 2.0 * m.slot_web * m.slot_count


@quantities.helper()
def block_between(m: Module) -> vane.BlockBetween:
    """A frozen block and the pad, or the modules and the spreader, that it presses on."""
    return vane.BlockBetween(
        (m.frozen_shear_modulus, m.heater_shear_modulus),
        (m.block_depth, m.heater_thickness, m.spreader_depth),
        (m.block_width, m.block_height),
        m.running_clearance,
        m.pad_press_stiffness,
    )


@quantities.helper()
def vanes_plate(m: Module) -> wedge.PlateAround:
    """The rotor's plate, from its core to its vanes."""
    return wedge.PlateAround(m.rotor_thickness, m.core_radius, m.pcl_mean_radius, m.vane_count)


@quantities.helper()
def vane_sideways(m: Module) -> wedge.Sideways:
    """Compliance of one vane of the rotor along its width and to a twist, with the plate."""
    moduli = m.structure_youngs_modulus, m.structure_shear_modulus
    return wedge.sideways(moduli, (m.block_width, m.vane_web), m.block_between, m.vanes_plate)


@quantities.helper()
def block_lean_out(m: Module) -> Scalar:
    """Angle [rad] at which a block's force leans out of what stands across the rotor's vane."""
    return wedge.lean_out(m.block_between, m.vane_sideways, m.vane_thickness, m.pcl_mean_radius)


@quantities.helper()
def rotor_vane(m: Module) -> vane.Vane:
    """Compliance of one vane of the rotor, and of the plate under its root."""
    footing = vane.on_plate(
        m.rotor_thickness, vane.strip_beside(m.pcl_mean_radius, m.vane_count, m.vane_thickness), m.rotor_rim
    )
    moduli = m.structure_youngs_modulus, m.structure_shear_modulus
    return vane.on_footing(moduli, (m.block_width, m.vane_web), m.block_between, footing)


@quantities.helper()
def housing_vane(m: Module) -> vane.Vane:
    """Compliance of one vane of the housing beside its slots, and of the floor under its root."""
    footing = vane.on_floor(m.floor_thickness)
    moduli = m.structure_youngs_modulus, m.structure_shear_modulus
    return vane.on_footing(moduli, (m.vane_webs, m.housing_vane_thickness), m.block_between, footing)


@quantities.helper()
def leaning_vanes(m: Module) -> vane.Shares:
    """Compliance of a rotor's vane, a housing's vane and the block between them as the vanes lean [m/N]."""
    return vane.compliances(m.rotor_vane, m.housing_vane, m.block_between)


@quantities.helper()
def rotor_vane_stiffness(m: Module) -> Scalar:
    """Stiffness of the rotor's vanes about the axis [N*m/rad], and of the plate under their roots."""
    each = wedge.compliance(m.leaning_vanes.vane, m.vane_sideways, m.block_lean_out, m.pcl_mean_radius)
    return m.vane_count * m.pcl_mean_radius**2 / each


@quantities.helper()
def housing_vane_stiffness(m: Module) -> Scalar:
    """Stiffness of the housing's vanes about the axis [N*m/rad], and of the floor under them."""
    return m.vane_count * m.pcl_mean_radius**2 / m.leaning_vanes.other


@quantities.helper()
def leaned_on_compliance(m: Module) -> Scalar:
    """Compliance of blocks and pads as they resist the vanes' leaning [rad/(N*m)]."""
    return m.leaning_vanes.block / (m.vane_count * m.pcl_mean_radius**2)


weights = QuantityGroup("Size and weight")
strengths = QuantityGroup("Impedance")
rules = QuantityGroup("Gaps")


@weights.helper(requires=WITH_LINER, default=NOTHING)
def liner_moments(m: Module) -> Section:
    """Volume of all liners, with the faces of the blocks, and its polar moment about the axis."""
    volume = m.pcl_area * m.liner_thickness
    return Section(volume, volume * (mean_square(m.pcl_inner_radius, m.pcl_outer_radius) + m.liner_thickness**2 / 3.0))


@weights.helper(requires=WITH_LINER, default=NOTHING)
def liner_recess(m: Module) -> Section:
    """Volume of the recesses in both faces of the rotor's vanes, as high as the blocks, and its polar moment."""
    strip = radial_strip(m.liner_depth, m.pcl_inner_radius, m.pcl_outer_radius)
    volume = 2.0 * m.vane_count * strip * m.block_height
    return Section(volume, volume * mean_square(m.pcl_inner_radius, m.pcl_outer_radius))


@strengths.helper()
def vane_web(m: Module) -> Scalar:
    """Thickness of a rotor vane between the liners in both its faces, at the mean radius [m]."""
    return m.vane_thickness - 2.0 * m.liner_depth


@strengths.helper(requires=WITH_LINER)
def liner_compliance(m: Module) -> Scalar:
    """Compliance of the pressed liners about the axis [rad/(N*m)], free at their sides; zero without."""
    return 1.0 / block.stiffness(
        m.liner_youngs_modulus, m.vane_count, m.block_area, m.pcl_mean_radius, m.liner_thickness
    )


@rules.output("mm", requires=WITH_LINER)
def liner_web(m: Module) -> Scalar:
    """Rotor vane between its two liners at the inner end, where it is thinnest; zero without."""
    return m.vane_root - 2.0 * m.liner_depth


@quantities.helper()
def layer_proportions(m: Module) -> dict[str, Scalar]:
    """Ratios of the vanes' and blocks' sizes that the vanes' stiffness hangs on [1]."""
    return {
        "vane_thickness/block_height": m.vane_thickness / m.block_height,
        "vane_thickness/rotor_thickness": m.vane_thickness / m.rotor_thickness,
        "housing_vane_thickness/floor_thickness": m.housing_vane_thickness / m.floor_thickness,
        "block_depth/block_height": m.block_depth / m.block_height,
        "block_width/block_height": m.block_width / m.block_height,
    }
