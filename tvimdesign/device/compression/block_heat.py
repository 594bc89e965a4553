"""What the heat passes in the compression module: along the blocks into half of a rotor vane, and up into the plate.

By symmetry no heat passes the middle of a rotor vane, which a block heats from either side. What takes heat from the
free sides of blocks, pads and vanes is in `ring_heat`.
"""

from __future__ import annotations

import numpy as np

from tvimdesign.device.compression.block_impedance import blocks_moment
from tvimdesign.device.compression.ring_heat import ABOVE, FLOOR
from tvimdesign.device.core.heat.thermal_stack import quantities as shared
from tvimdesign.device.table.quantity import Scalar
from tvimdesign.device.table.quantity_group import QuantityGroup
from tvimdesign.physics.bodies.shapes import Section
from tvimdesign.physics.heat_flow import columns, heat, lumps, rows, strip
from tvimdesign.physics.layers import film

quantities = QuantityGroup(shared.group)


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
def column_shares() -> tuple[float, ...]:
    """What of a block's height each row stands for [1]."""
    return columns.EVEN.shares


@quantities.helper(instant=True)
def layer_temperatures(
    stack_profile: heat.Profile,
    stack: heat.Stack,
    block_height: Scalar,
    block_depth: Scalar,
    ring_width: Scalar,
    pcl_conductivity_melt: Scalar,
) -> list[Scalar]:
    """Temperatures of a block's slices [K], in rows from its lower face to its upper one."""
    count, places = len(stack_profile.cells), stack_profile._asdict()
    lost = []
    for faced in (("around", FLOOR[0]), ("beside", ABOVE[0])):
        (link,) = (one for one in stack.links if (one.first, one.second) == (("layer", 0), faced))
        face = places[faced[0]][faced[1]]
        if link.slope is not None:
            face = face + lumps.risen(link.slope, places, count)
        lost.append(link.conductance / (ring_width * block_depth) * (stack_profile.cells - face))
    depths = (np.arange(count) + 0.5) / count
    across = 0.5 * block_height / pcl_conductivity_melt
    return [
        stack_profile.cells
        - across * rows.below_mean(2.0 * place - 1.0, depths, 2.0 * block_depth / block_height, lost)
        for place in columns.EVEN.places
    ]


@quantities.helper()
def plate_depth(vane_thickness: Scalar) -> Scalar:
    """Thickness of what is behind a block [m]: half a rotor vane."""
    return 0.5 * vane_thickness


@quantities.helper()
def plate_outside(pcl_area: Scalar) -> lumps.Surface:
    """The middle of the rotor's vanes, which no heat passes; their rims face the chamber (`side_links`)."""
    return lumps.Surface(pcl_area, 0.0)


@quantities.helper()
def plate_mass(
    rotor_radius: Scalar, rotor_thickness: Scalar, rotor_vanes: Section, vane_height: Scalar, structure_density: Scalar
) -> Scalar:
    """Mass of the rotor plate with its vanes [kg]."""
    return (np.pi * rotor_radius**2 * rotor_thickness + rotor_vanes.area * vane_height) * structure_density


@quantities.helper()
def faced_area(
    block_width: Scalar, vane_count: Scalar, plate_depth: Scalar, block_depth: Scalar, pad_depth: Scalar
) -> Scalar:
    """Plan area of rotor's vanes, blocks and pads [m^2]: what of floor and rotor plate they heat."""
    return 2.0 * vane_count * block_width * (plate_depth + block_depth + pad_depth)


@quantities.helper()
def heated_length(faced_area: Scalar, ring_width: Scalar, plate_depth: Scalar) -> Scalar:
    """Depth of a block and its pad [m], along the ring."""
    return faced_area / ring_width - plate_depth


@quantities.helper()
def ways_along(heated_length: Scalar, plate_depth: Scalar, wall_depth: Scalar) -> tuple[Scalar, ...]:
    """Ways along the ring in floor and rotor plate [1/m]: from below or above a block and its pad to a rotor vane and
    to a housing vane.

    A strip that is heated evenly has its mean temperature a sixth of its length away from either end where both take
    as much, and a third where one takes all: a quarter. What is heated at its end has it a third of its length away.
    """
    return tuple(1.0 / (0.25 * heated_length + end / 3.0) for end in (plate_depth, wall_depth))


@quantities.helper()
def rotor_beside(
    ring_width: Scalar,
    heated_length: Scalar,
    pads_share: Scalar,
    ways_along: tuple[Scalar, ...],
    plate_depth: Scalar,
    rotor_thickness: Scalar,
    pcl_area: Scalar,
    rotor_vanes: Section,
    vane_height: Scalar,
    vane_ways: tuple[Scalar, Scalar, Scalar],
    structure_conductivity: Scalar,
    structure_density: Scalar,
    structure_specific_heat: Scalar,
    rotor_coefficient: Scalar,
    surface_emissivity: Scalar,
) -> tuple[lumps.Lump, ...]:
    """Rotor plate above the vanes, heated by their roots; beside that above blocks and pads, three bodies in depth."""
    k, capacity = structure_conductivity, rotor_thickness * structure_density * structure_specific_heat
    above_vanes, heated = ring_width * plate_depth, ring_width * heated_length
    outside = lumps.Surface(1.0, rotor_coefficient, surface_emissivity, rotor_thickness / 3.0 / k)
    # What of a vane stands beside the clearance above the blocks counts as plate.
    upper = (rotor_vanes.area * vane_height - pcl_area * plate_depth) * structure_density * structure_specific_heat
    vanes = lumps.Lump(vane_ways[0], above_vanes * capacity + upper, outside._replace(area=above_vanes))
    first, *others = strip.bodies(heated, capacity, k * heated / rotor_thickness, lumps.Surface(1.0, 0.0))
    along = k * rotor_thickness * ring_width * ways_along[0]
    others[-1] = others[-1]._replace(surface=outside._replace(area=heated, behind=strip.BEYOND * rotor_thickness / k))
    # The lower tenth is divided in what is above blocks and above pads.
    blocks = 1.0 - pads_share
    first = first._replace(conductance=strip.STRIP[0] * along, capacity=blocks * first.capacity)
    others[0] = others[0]._replace(conductance=blocks * others[0].conductance)
    return (vanes, first, *others)


@quantities.helper()
def uneven_sideways() -> None:
    """A vane's cells give heat to the plate above by one conductance, their mean and what they differ from it."""
