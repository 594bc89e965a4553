"""What the heat passes in the compression module: along the blocks into half of a rotor vane, and up into the plate.

By symmetry no heat passes the middle of a rotor vane, which a block heats from either side. What the blocks lose
through their free sides, which face still air in the chamber, is left out, and what the pads give to their vane.
"""

from __future__ import annotations

import numpy as np

from tvimdesign.device.compression.block_impedance import blocks_moment
from tvimdesign.device.core.thermal_stack import quantities as shared
from tvimdesign.device.table.quantity import Scalar
from tvimdesign.device.table.quantity_group import QuantityGroup
from tvimdesign.physics.bodies.shapes import Section
from tvimdesign.physics.heat_flow import heat
from tvimdesign.physics.layers import film

quantities = QuantityGroup(shared.group)


@quantities.helper()
def cold_area(vane_count: Scalar, slot_width: Scalar, slot_height: Scalar) -> Scalar:
    """Open area of the pads' cold sides [m^2]: what of them the slots show."""
    return 2.0 * vane_count * slot_width * slot_height


@quantities.helper(instant=True)
def moment_now(
    slice_moduli: tuple[Scalar, Scalar],
    shape_factor: Scalar,
    vane_count: Scalar,
    block_area: Scalar,
    pcl_mean_radius: Scalar,
) -> Scalar:
    """The blocks' moment at an instant [m^4], 3 (1 + 2 (S/p)^2) N A r^2, p the share of them that is soft."""
    share = film.soft_share(*slice_moduli)
    return blocks_moment(shape_factor / share, vane_count, block_area, pcl_mean_radius)


@quantities.helper()
def plate_depth(vane_thickness: Scalar) -> Scalar:
    """Thickness of what is behind a block [m]: half a rotor vane."""
    return 0.5 * vane_thickness


@quantities.helper()
def plate_outside(
    pcl_area: Scalar,
    block_area: Scalar,
    block_width: Scalar,
    block_height: Scalar,
    plate_depth: Scalar,
    rotor_coefficient: Scalar,
    surface_emissivity: Scalar,
) -> heat.Surface:
    """Rims of the rotor's vanes, inner, outer and lower, which lose heat; as a share of the blocks' faces."""
    share = (2.0 * block_height + block_width) * plate_depth / block_area
    return heat.Surface(pcl_area, share * rotor_coefficient, share * surface_emissivity)


@quantities.helper()
def plate_mass(
    rotor_radius: Scalar, rotor_thickness: Scalar, rotor_vanes: Section, vane_height: Scalar, structure_density: Scalar
) -> Scalar:
    """Mass of the rotor plate with its vanes [kg]."""
    return (np.pi * rotor_radius**2 * rotor_thickness + rotor_vanes.area * vane_height) * structure_density


@quantities.helper()
def rotor_beside(
    plate_mass: Scalar,
    pcl_area: Scalar,
    plate_depth: Scalar,
    rotor_radius: Scalar,
    rotor_vanes: Section,
    vane_height: Scalar,
    structure_conductivity: Scalar,
    structure_density: Scalar,
    structure_specific_heat: Scalar,
    rotor_coefficient: Scalar,
    surface_emissivity: Scalar,
) -> heat.Lump:
    """Rotor plate above the vanes, heated through their roots.

    A fin heated evenly over its faces: its mean temperature is a third of its height away from the root (Incropera,
    Fundamentals of Heat and Mass Transfer, ch. 3, even generation).
    """
    return heat.Lump(
        conductance=3.0 * structure_conductivity * rotor_vanes.area / vane_height,
        capacity=(plate_mass - pcl_area * plate_depth * structure_density) * structure_specific_heat,
        surface=heat.Surface(np.pi * rotor_radius**2, rotor_coefficient, surface_emissivity),
    )
