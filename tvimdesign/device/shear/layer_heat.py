"""Path of the heat in the shear module: arcs of the rotor plate behind the layer; plate and floor beside them.

Pads, layer and plate lose heat at the edges of the arcs, which are taken as a strip with as much edge for its area.
The plate beside it is a strip that this heats; the floor is in `floor_heat`.
"""

from __future__ import annotations

import numpy as np

from tvimdesign.device.core.heat.heater_form import CUT
from tvimdesign.device.table.module import Module
from tvimdesign.device.table.quantity import Scalar
from tvimdesign.device.table.quantity_group import QuantityGroup
from tvimdesign.physics.heat_flow import lumps, shape_factors

quantities = QuantityGroup("Switch")


@quantities.helper()
def cold_area(m: Module) -> Scalar:
    """Open area of the pads' cold sides [m^2]: the windows below them."""
    return m.window_section.area


@quantities.helper(instant=True)
def moment_now(m: Module) -> Scalar:
    """The layer's moment at an instant [m^4]: sheared, a molten film is as soft as its thickness says."""
    return m.pcl_moment


@quantities.helper()
def plate_depth(m: Module) -> Scalar:
    """Thickness of what is behind the layer [m]: the rotor plate."""
    return m.rotor_thickness


@quantities.helper()
def plate_outside(m: Module) -> lumps.Surface:
    """The rotor plate's upper face above the arcs."""
    return lumps.Surface(m.pcl_area, m.rotor_coefficient, m.surface_emissivity)


@quantities.helper()
def plate_mass(m: Module) -> Scalar:
    """Mass of the rotor plate [kg]: above the arcs, and beside them with its lips."""
    return (np.pi * m.rotor_radius**2 * m.rotor_thickness + m.melt_lip_moments.area) * m.structure_density


@quantities.output("mm")
def edge_length(m: Module) -> Scalar:
    """Length of the edges of all arcs together: inner and outer arcs, and their ends."""
    return m.arc_count * (
        2.0 * (m.pcl_outer_radius - m.pcl_inner_radius) + m.arc_span * (m.pcl_inner_radius + m.pcl_outer_radius)
    )


@quantities.helper()
def to_edge(m: Module) -> Scalar:
    """Length of the edges over the way there from where the pads, fed evenly, have their mean temperature [1]."""
    return 3.0 * m.edge_length / (m.pcl_area / m.edge_length)


@quantities.helper()
def plate_slenderness(m: Module) -> Scalar:
    """Of the plate above the arcs as a fin w (h/k t)^(1/2) [1]: the layer heats it, more where it is colder."""
    layer = 0.5 * (m.pcl_conductivity_solid + m.pcl_conductivity_melt) / m.pcl_depth
    return m.pcl_area / m.edge_length * np.sqrt(layer / (m.structure_conductivity * m.backing_depth))


@quantities.helper()
def plate_to_edge(m: Module) -> Scalar:
    """Conductance [W/K] from where the plate above the arcs has its mean temperature to their edges."""
    width, sheet = m.pcl_area / m.edge_length, m.structure_conductivity * m.backing_depth
    return sheet * m.edge_length / (width * shape_factors.way_in_fin(m.plate_slenderness))


@quantities.helper()
def beside_area(m: Module) -> Scalar:
    """Area of the rotor plate beside the arcs [m^2]; the floor below it is taken to be as large."""
    return np.pi * m.rotor_radius**2 - m.pcl_area


@quantities.helper()
def core_share(m: Module) -> Scalar:
    """Share of the conductance to the core that is left from the plate's last body on."""
    across = m.structure_conductivity * m.rotor_thickness * m.edge_length**2 / m.beside_area
    onward = lumps.BEYOND * m.core_and_link.conductance / across
    return 1.0 / (1.0 + onward)


@quantities.helper()
def rotor_beside(m: Module) -> tuple[lumps.Lump, ...]:
    """Rotor plate beside the arcs: a strip along their edges, deeper by its lips where these stand.

    Heat goes along it through plate and lip, beside one another.
    """
    capacity = m.structure_density * m.structure_specific_heat
    chain = lumps.strip_bodies(
        m.beside_area,
        m.rotor_thickness * capacity,
        m.structure_conductivity * m.rotor_thickness * m.edge_length**2 / m.beside_area,
        lumps.Surface(
            1.0, m.rotor_coefficient, m.surface_emissivity, m.rotor_thickness / 3.0 / m.structure_conductivity
        ),
    )
    first, *others = (
        lump._replace(
            conductance=1.0 / (1.0 / lump.conductance + way / (m.structure_conductivity * m.edge_length)),
            capacity=lump.capacity + covered / m.rotor_rim * m.melt_lip_moments.area * capacity,
        )
        for lump, covered, way in zip(chain, m.lip_over, m.lip_ways, strict=True)
    )
    return (first._replace(conductance=lumps.in_series(m.plate_to_edge, first.conductance)), *others)


@quantities.helper()
def uneven_sideways(m: Module) -> Scalar:
    """Conductance sideways for what the plate's temperature differs over its depth from its mean [W/K].

    Its slowest mode, a cosine over the depth, dies down within that over pi beside the arc.
    """
    return lumps.in_series(m.plate_to_edge, m.structure_conductivity * m.edge_length * np.pi)


@quantities.helper()
def heater_along(m: Module) -> Scalar:
    """Conductance [W/K] along half of the pads' thickness, or the spreader, from its mean temperature to its edge."""
    if m.heater_form != CUT:
        return m.spreader_conductivity * m.spreader_depth * m.to_edge
    return m.pad_conductivity * 0.5 * m.peltier_thickness * m.to_edge


@quantities.helper()
def pad_edge(m: Module) -> Scalar:
    """Conductance from one side of the pads to the walls of their pockets [W/K]: along the pads, and into the wall.

    Tiles stand in air there; the spreader on them touches the wall.
    """
    height = 0.5 * m.peltier_thickness if m.heater_form == CUT else m.spreader_depth
    return lumps.in_series(m.heater_along, m.pad_edge_contact * height * m.edge_length)
