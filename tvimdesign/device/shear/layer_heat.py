"""What the heat passes in the shear module: arcs of the rotor plate behind the layer, and the plate beside them."""

from __future__ import annotations

import numpy as np

from tvimdesign.device.core.thermal_stack import quantities as shared
from tvimdesign.device.table.quantity import Scalar
from tvimdesign.device.table.quantity_group import QuantityGroup
from tvimdesign.physics.bodies.shapes import Section
from tvimdesign.physics.heat_flow import heat

quantities = QuantityGroup(shared.group)


@quantities.helper()
def cold_area(window_section: Section) -> Scalar:
    """Open area of the pads' cold sides [m^2]: the windows below them."""
    return window_section.area


@quantities.helper(instant=True)
def moment_now(pcl_moment: Scalar) -> Scalar:
    """The layer's moment at an instant [m^4]: sheared, a molten film is as soft as its thickness says."""
    return pcl_moment


@quantities.helper()
def plate_depth(rotor_thickness: Scalar) -> Scalar:
    """Thickness of what is behind the layer [m]: the rotor plate."""
    return rotor_thickness


@quantities.helper()
def plate_outside(pcl_area: Scalar, rotor_coefficient: Scalar, surface_emissivity: Scalar) -> heat.Surface:
    """The rotor plate's upper face above the arcs."""
    return heat.Surface(pcl_area, rotor_coefficient, surface_emissivity)


@quantities.helper()
def plate_mass(rotor_radius: Scalar, rotor_thickness: Scalar, structure_density: Scalar) -> Scalar:
    """Mass of the rotor plate [kg]: above the arcs, and beside them."""
    return np.pi * rotor_radius**2 * rotor_thickness * structure_density


@quantities.helper()
def rotor_beside(
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
    surface_emissivity: Scalar,
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
        surface=heat.Surface(area, rotor_coefficient, surface_emissivity),
    )
