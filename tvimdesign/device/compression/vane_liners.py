"""Liners in both faces of the rotor's vanes: sheets with the face of a block, which the blocks press on.

A recess is open at both ends and below, where the liner slides in; above it ends with the block. What a pressed liner
squeezes to its sides is free, so the compliance told is the highest.
"""

from __future__ import annotations

from tvimdesign.device.core.clearances import quantities as gaps
from tvimdesign.device.core.impedance.joint_impedance import quantities as impedance
from tvimdesign.device.core.mass_properties import quantities as bodies
from tvimdesign.device.fixtures.liner import WITH_LINER
from tvimdesign.device.table.quantity import Scalar
from tvimdesign.device.table.quantity_group import QuantityGroup
from tvimdesign.physics.bodies.shapes import NOTHING, Section, mean_square, radial_strip
from tvimdesign.physics.layers import block

weights, strengths, rules = QuantityGroup(bodies.group), QuantityGroup(impedance.group), QuantityGroup(gaps.group)
groups = (weights, strengths, rules)


@weights.helper(requires=WITH_LINER, default=NOTHING)
def liner_moments(
    pcl_area: Scalar, liner_thickness: Scalar, pcl_inner_radius: Scalar, pcl_outer_radius: Scalar
) -> Section:
    """Volume of all liners, with the faces of the blocks, and its polar moment about the axis."""
    volume = pcl_area * liner_thickness
    return Section(volume, volume * (mean_square(pcl_inner_radius, pcl_outer_radius) + liner_thickness**2 / 3.0))


@weights.helper(requires=WITH_LINER, default=NOTHING)
def liner_recess(
    vane_count: Scalar, liner_depth: Scalar, pcl_inner_radius: Scalar, pcl_outer_radius: Scalar, block_height: Scalar
) -> Section:
    """Volume of the recesses in both faces of the rotor's vanes, as high as the blocks, and its polar moment."""
    strip = radial_strip(liner_depth, pcl_inner_radius, pcl_outer_radius)
    volume = 2.0 * vane_count * strip * block_height
    return Section(volume, volume * mean_square(pcl_inner_radius, pcl_outer_radius))


@strengths.helper()
def vane_web(vane_thickness: Scalar, liner_depth: Scalar) -> Scalar:
    """What liners in both its faces leave of a rotor vane at the mean radius [m]."""
    return vane_thickness - 2.0 * liner_depth


@strengths.helper(requires=WITH_LINER)
def liner_compliance(
    liner_thickness: Scalar,
    liner_youngs_modulus: Scalar,
    vane_count: Scalar,
    block_area: Scalar,
    pcl_mean_radius: Scalar,
) -> Scalar:
    """Compliance of the pressed liners about the axis [rad/(N*m)], free at their sides; zero without."""
    return 1.0 / block.stiffness(liner_youngs_modulus, vane_count, block_area, pcl_mean_radius, liner_thickness)


@rules.output("mm", requires=WITH_LINER)
def liner_web(vane_root: Scalar, liner_depth: Scalar) -> Scalar:
    """Rotor vane between its two liners at the inner end, where it is thinnest; zero without."""
    return vane_root - 2.0 * liner_depth
