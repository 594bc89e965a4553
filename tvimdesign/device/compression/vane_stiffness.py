"""Compliance of the vanes of rotor and housing under a block bonded to both, as FE has it, and of liners on them.

Liners in both faces of the rotor's vanes are sheets with the face of a block, which the blocks press on. A recess is
open at both ends and below, where the liner slides in; above it ends with the block. What a pressed liner squeezes to
its sides is free, so the compliance is the highest."""

from tvimdesign.device.components.liner import WITH_LINER
from tvimdesign.device.table.module import Module
from tvimdesign.device.table.quantity import Scalar
from tvimdesign.device.table.quantity_group import QuantityGroup
from tvimdesign.physics.layers import block
from tvimdesign.physics.solids import vane, wedge
from tvimdesign.physics.solids.shapes import NOTHING, Section, mean_square, radial_strip

quantities = QuantityGroup("Impedance")


@quantities.helper()
def vane_webs(m: Module) -> Scalar:
    """Radial width of all that a housing vane has beside its slots [m]."""
    return 2.0 * m.slot_web * m.slot_count


@quantities.helper()
def block_between(m: Module) -> vane.BlockBetween:
    """A frozen block and the pad, or the modules and the spreader, that it presses on."""
    return vane.BlockBetween(
        (m.frozen_shear_modulus, m.peltier_shear_modulus),
        (m.block_depth, m.peltier_thickness, m.spreader_depth),
        (m.block_width, m.block_height),
        m.running_clearance,
    )


@quantities.helper()
def vanes_plate(m: Module) -> wedge.PlateAround:
    """The rotor's plate, from its core to its vanes."""
    return wedge.PlateAround(m.rotor_thickness, m.core_radius, m.pcl_mean_radius, m.vane_count)


@quantities.helper()
def vane_sideways(m: Module) -> wedge.Sideways:
    """Compliance of one vane of the rotor along its width and to a twist, with the plate."""
    moduli = m.structure_youngs_modulus, m.structure_shear_modulus
    return wedge.sideways(moduli, (m.block_width, m.vane_web), m.block_between, vane.ROTOR_SPREAD, m.vanes_plate)


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
    footing = vane.on_floor(
        m.floor_thickness, vane.strip_beside(m.pcl_mean_radius, m.vane_count, m.housing_vane_thickness)
    )
    moduli = m.structure_youngs_modulus, m.structure_shear_modulus
    return vane.on_footing(moduli, (m.vane_webs, m.housing_vane_thickness), m.block_between, footing)


@quantities.helper()
def rotor_vane_stiffness(m: Module) -> Scalar:
    """Stiffness of the rotor's vanes about the axis [N*m/rad], and of the plate under their roots."""
    across = vane.compliance(m.rotor_vane, m.housing_vane, m.block_between)
    each = wedge.compliance(across, m.vane_sideways, m.block_lean_out, m.pcl_mean_radius)
    return m.vane_count * m.pcl_mean_radius**2 / each


@quantities.helper()
def housing_vane_stiffness(m: Module) -> Scalar:
    """Stiffness of the housing's vanes about the axis [N*m/rad], and of the floor under them."""
    return m.vane_count * m.pcl_mean_radius**2 / vane.compliance(m.housing_vane, m.rotor_vane, m.block_between)


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
