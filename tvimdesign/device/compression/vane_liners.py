"""Liners in both faces of the rotor's vanes: sheets with the face of a block, which the blocks press on.

A recess is open at both ends and below, where the liner slides in; above it ends with the block. What a pressed liner
squeezes to its sides is free, so the compliance told is the highest.
"""

from __future__ import annotations

from tvimdesign.device.components.liner import WITH_LINER
from tvimdesign.device.core.clearances import quantities as gaps
from tvimdesign.device.core.impedance.joint_impedance import quantities as impedance
from tvimdesign.device.core.mass_properties import quantities as bodies
from tvimdesign.device.table.module import Module
from tvimdesign.device.table.quantity import Scalar
from tvimdesign.device.table.quantity_group import QuantityGroup
from tvimdesign.physics.bodies.shapes import NOTHING, Section, mean_square, radial_strip
from tvimdesign.physics.layers import block

weights, strengths, rules = QuantityGroup(bodies.group), QuantityGroup(impedance.group), QuantityGroup(gaps.group)
groups = (weights, strengths, rules)


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
    """What liners in both its faces leave of a rotor vane at the mean radius [m]."""
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
