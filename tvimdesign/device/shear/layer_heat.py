"""What the heat passes in the shear module: arcs of the rotor plate behind the layer; plate and floor beside them.

Pads, layer and plate lose heat at the edges of the arcs, which are taken as a strip with as much edge for its area.
The plate beside it is a strip that this heats; the floor is in `floor_heat`.
"""

from __future__ import annotations

import numpy as np

from tvimdesign.device.core.heat.heater_form import CUT
from tvimdesign.device.core.heat.thermal_stack import quantities as shared
from tvimdesign.device.table.quantity import Scalar
from tvimdesign.device.table.quantity_group import QuantityGroup
from tvimdesign.physics.bodies.shapes import Section
from tvimdesign.physics.heat_flow import lumps, shape_factors, strip

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
def plate_outside(pcl_area: Scalar, rotor_coefficient: Scalar, surface_emissivity: Scalar) -> lumps.Surface:
    """The rotor plate's upper face above the arcs."""
    return lumps.Surface(pcl_area, rotor_coefficient, surface_emissivity)


@quantities.helper()
def plate_mass(
    rotor_radius: Scalar, rotor_thickness: Scalar, melt_lip_moments: Section, structure_density: Scalar
) -> Scalar:
    """Mass of the rotor plate [kg]: above the arcs, and beside them with its lips."""
    return (np.pi * rotor_radius**2 * rotor_thickness + melt_lip_moments.area) * structure_density


@quantities.output("mm")
def edge_length(arc_count: Scalar, arc_span: Scalar, pcl_inner_radius: Scalar, pcl_outer_radius: Scalar) -> Scalar:
    """Length of the edges of all arcs together: inner and outer arcs, and their ends."""
    return arc_count * (2.0 * (pcl_outer_radius - pcl_inner_radius) + arc_span * (pcl_inner_radius + pcl_outer_radius))


@quantities.helper()
def to_edge(pcl_area: Scalar, edge_length: Scalar) -> Scalar:
    """Length of the edges over the way there from where the pads, fed evenly, have their mean temperature [1]."""
    return 3.0 * edge_length / (pcl_area / edge_length)


@quantities.helper()
def plate_slenderness(
    pcl_area: Scalar,
    edge_length: Scalar,
    pcl_depth: Scalar,
    pcl_conductivity_solid: Scalar,
    pcl_conductivity_melt: Scalar,
    backing_depth: Scalar,
    structure_conductivity: Scalar,
) -> Scalar:
    """Of the plate above the arcs as a fin w (h/k t)^(1/2) [1]: the layer heats it, more where it is colder."""
    layer = 0.5 * (pcl_conductivity_solid + pcl_conductivity_melt) / pcl_depth
    return pcl_area / edge_length * np.sqrt(layer / (structure_conductivity * backing_depth))


@quantities.helper()
def plate_to_edge(
    pcl_area: Scalar,
    edge_length: Scalar,
    plate_slenderness: Scalar,
    backing_depth: Scalar,
    structure_conductivity: Scalar,
) -> Scalar:
    """Conductance [W/K] from where the plate above the arcs has its mean temperature to their edges."""
    width, sheet = pcl_area / edge_length, structure_conductivity * backing_depth
    return sheet * edge_length / (width * shape_factors.way_in_fin(plate_slenderness))


@quantities.helper()
def beside_area(rotor_radius: Scalar, pcl_area: Scalar) -> Scalar:
    """Area of the rotor plate beside the arcs [m^2]; the floor below it is taken to be as large."""
    return np.pi * rotor_radius**2 - pcl_area


@quantities.helper()
def core_share(
    core_and_link: lumps.Lump,
    beside_area: Scalar,
    edge_length: Scalar,
    rotor_thickness: Scalar,
    structure_conductivity: Scalar,
) -> Scalar:
    """What of the conductance to the core is left from the plate's last body on."""
    across = structure_conductivity * rotor_thickness * edge_length**2 / beside_area
    onward = strip.BEYOND * core_and_link.conductance / across
    return 1.0 / (1.0 + onward)


@quantities.helper()
def rotor_beside(
    beside_area: Scalar,
    edge_length: Scalar,
    plate_to_edge: Scalar,
    rotor_thickness: Scalar,
    melt_lip_moments: Section,
    rotor_rim: Scalar,
    lip_over: tuple[Scalar, ...],
    lip_ways: tuple[Scalar, ...],
    structure_conductivity: Scalar,
    structure_density: Scalar,
    structure_specific_heat: Scalar,
    rotor_coefficient: Scalar,
    surface_emissivity: Scalar,
) -> tuple[lumps.Lump, ...]:
    """Rotor plate beside the arcs: a strip along their edges, deeper by its lips where these stand.

    Heat goes along it through plate and lip, beside one another.
    """
    capacity = structure_density * structure_specific_heat
    chain = strip.bodies(
        beside_area,
        rotor_thickness * capacity,
        structure_conductivity * rotor_thickness * edge_length**2 / beside_area,
        lumps.Surface(1.0, rotor_coefficient, surface_emissivity, rotor_thickness / 3.0 / structure_conductivity),
    )
    first, *others = (
        lump._replace(
            conductance=1.0 / (1.0 / lump.conductance + way / (structure_conductivity * edge_length)),
            capacity=lump.capacity + covered / rotor_rim * melt_lip_moments.area * capacity,
        )
        for lump, covered, way in zip(chain, lip_over, lip_ways, strict=True)
    )
    return (first._replace(conductance=lumps.in_series(plate_to_edge, first.conductance)), *others)


@quantities.helper()
def uneven_sideways(plate_to_edge: Scalar, edge_length: Scalar, structure_conductivity: Scalar) -> Scalar:
    """Conductance sideways for what the plate's temperature differs over its depth from its mean [W/K].

    Its slowest mode, a cosine over the depth, dies down within that over pi beside the arc.
    """
    return lumps.in_series(plate_to_edge, structure_conductivity * edge_length * np.pi)


@quantities.helper()
def heater_along(
    heater_form: str,
    pad_conductivity: Scalar,
    peltier_thickness: Scalar,
    spreader_conductivity: Scalar,
    spreader_depth: Scalar,
    to_edge: Scalar,
) -> Scalar:
    """Conductance [W/K] along half of the pads' thickness, or the spreader, from its mean temperature to its edge."""
    if heater_form != CUT:
        return spreader_conductivity * spreader_depth * to_edge
    return pad_conductivity * 0.5 * peltier_thickness * to_edge


@quantities.helper()
def pad_edge(
    heater_form: str,
    pad_edge_contact: Scalar,
    peltier_thickness: Scalar,
    spreader_depth: Scalar,
    edge_length: Scalar,
    heater_along: Scalar,
) -> Scalar:
    """Conductance from one side of the pads to the walls of their pockets [W/K]: along the pads, and into the wall.

    Tiles stand in air there; the spreader on them touches the wall.
    """
    height = 0.5 * peltier_thickness if heater_form == CUT else spreader_depth
    return lumps.in_series(heater_along, pad_edge_contact * height * edge_length)
