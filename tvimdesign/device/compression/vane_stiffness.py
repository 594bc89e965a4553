"""How far the vanes of rotor and housing give under a block that stands between them, bonded to both as FE has it."""

from __future__ import annotations

from tvimdesign.device.core.impedance.joint_impedance import quantities as shared
from tvimdesign.device.table.quantity import Scalar
from tvimdesign.device.table.quantity_group import QuantityGroup
from tvimdesign.physics.solids import vane, wedge

quantities = QuantityGroup(shared.group)


@quantities.helper()
def vane_webs(slot_web: Scalar, slot_count: Scalar) -> Scalar:
    """Radial width of all that a housing vane has beside its slots [m]."""
    return 2.0 * slot_web * slot_count


@quantities.helper()
def block_between(
    frozen_shear_modulus: Scalar,
    block_depth: Scalar,
    block_width: Scalar,
    block_height: Scalar,
    peltier_shear_modulus: Scalar,
    peltier_thickness: Scalar,
    spreader_depth: Scalar,
    running_clearance: Scalar,
) -> vane.BlockBetween:
    """A frozen block and the pad, or the modules and the spreader, that it presses on."""
    return vane.BlockBetween(
        (frozen_shear_modulus, peltier_shear_modulus), (block_depth, peltier_thickness, spreader_depth),
        (block_width, block_height), running_clearance,
    )  # fmt: skip


@quantities.helper()
def vanes_plate(
    rotor_thickness: Scalar, core_radius: Scalar, pcl_mean_radius: Scalar, vane_count: Scalar
) -> wedge.PlateAround:
    """The rotor's plate, from its core to its vanes."""
    return wedge.PlateAround(rotor_thickness, core_radius, pcl_mean_radius, vane_count)


@quantities.helper()
def vane_sideways(
    structure_youngs_modulus: Scalar,
    structure_shear_modulus: Scalar,
    block_width: Scalar,
    vane_web: Scalar,
    block_between: vane.BlockBetween,
    vanes_plate: wedge.PlateAround,
) -> wedge.Sideways:
    """How one vane of the rotor gives along its width and to a twist, with the plate."""
    moduli = structure_youngs_modulus, structure_shear_modulus
    return wedge.sideways(moduli, (block_width, vane_web), block_between, vane.ROTOR_SPREAD, vanes_plate)


@quantities.helper()
def block_lean_out(
    block_between: vane.BlockBetween, vane_sideways: wedge.Sideways, vane_thickness: Scalar, pcl_mean_radius: Scalar
) -> Scalar:
    """Angle [rad] at which a block's force leans out of what stands across the rotor's vane."""
    return wedge.lean_out(block_between, vane_sideways, vane_thickness, pcl_mean_radius)


@quantities.helper()
def rotor_vane(
    structure_youngs_modulus: Scalar,
    structure_shear_modulus: Scalar,
    block_width: Scalar,
    vane_thickness: Scalar,
    vane_web: Scalar,
    block_between: vane.BlockBetween,
    rotor_thickness: Scalar,
    rotor_rim: Scalar,
    vane_count: Scalar,
    pcl_mean_radius: Scalar,
) -> vane.Vane:
    """How one vane of the rotor gives, and the plate under its root."""
    footing = vane.on_plate(rotor_thickness, vane.strip_beside(pcl_mean_radius, vane_count, vane_thickness), rotor_rim)
    moduli = structure_youngs_modulus, structure_shear_modulus
    return vane.on_footing(moduli, (block_width, vane_web), block_between, footing)


@quantities.helper()
def housing_vane(
    structure_youngs_modulus: Scalar,
    structure_shear_modulus: Scalar,
    vane_webs: Scalar,
    housing_vane_thickness: Scalar,
    block_between: vane.BlockBetween,
    floor_thickness: Scalar,
    vane_count: Scalar,
    pcl_mean_radius: Scalar,
) -> vane.Vane:
    """How one vane of the housing gives, and the floor under its root: what stands on either side of its slots."""
    footing = vane.on_floor(floor_thickness, vane.strip_beside(pcl_mean_radius, vane_count, housing_vane_thickness))
    moduli = structure_youngs_modulus, structure_shear_modulus
    return vane.on_footing(moduli, (vane_webs, housing_vane_thickness), block_between, footing)


@quantities.helper()
def rotor_vane_stiffness(
    rotor_vane: vane.Vane,
    housing_vane: vane.Vane,
    block_between: vane.BlockBetween,
    vane_sideways: wedge.Sideways,
    block_lean_out: Scalar,
    vane_count: Scalar,
    pcl_mean_radius: Scalar,
) -> Scalar:
    """Stiffness of the rotor's vanes about the axis [N*m/rad], and of the plate under their roots."""
    across = vane.compliance(rotor_vane, housing_vane, block_between)
    each = wedge.compliance(across, vane_sideways, block_lean_out, pcl_mean_radius)
    return vane_count * pcl_mean_radius**2 / each


@quantities.helper()
def housing_vane_stiffness(
    rotor_vane: vane.Vane,
    housing_vane: vane.Vane,
    block_between: vane.BlockBetween,
    vane_count: Scalar,
    pcl_mean_radius: Scalar,
) -> Scalar:
    """Stiffness of the housing's vanes about the axis [N*m/rad], and of the floor under them."""
    return vane_count * pcl_mean_radius**2 / vane.compliance(housing_vane, rotor_vane, block_between)
