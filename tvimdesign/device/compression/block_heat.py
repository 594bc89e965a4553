"""Path of the heat in the compression module: along the blocks into half of a rotor vane, and up into the plate.

By symmetry no heat passes the middle of a rotor vane, which a block heats from either side. What takes heat from the
free sides of blocks, pads and vanes is in `ring_heat`.
"""

import numpy as np

from tvimdesign.device.compression.block_impedance import blocks_moment
from tvimdesign.device.compression.ring_heat import ABOVE, FLOOR
from tvimdesign.device.table.module import Module
from tvimdesign.device.table.quantity import Scalar
from tvimdesign.device.table.quantity_group import QuantityGroup
from tvimdesign.physics.heat_flow import columns, lumps
from tvimdesign.physics.layers import block

quantities = QuantityGroup("Switch")


@quantities.helper(instant=True)
def moment_now(m: Module) -> Scalar:
    """The blocks' moment at an instant [m^4], 3 (1 + 2 (S/p)^2) N A r^2, p the share of them that is soft."""
    share = block.soft_share(*m.slice_moduli)
    return blocks_moment(m.shape_factor / share, m.vane_count, m.block_area, m.pcl_mean_radius)


@quantities.helper()
def column_shares(_: Module) -> tuple[float, ...]:
    """Share of a block's height that each row stands for [1]."""
    return columns.EVEN.shares


@quantities.helper(instant=True)
def layer_temperatures(m: Module) -> list[Scalar]:
    """Temperatures of a block's slices [K], in rows from its lower face to its upper one."""
    count, places = len(m.stack_profile.cells), m.stack_profile._asdict()
    lost = []
    for faced in (("around", FLOOR[0]), ("beside", ABOVE[0])):
        (link,) = (link for link in m.stack.links if (link.first, link.second) == (("layer", 0), faced))
        face = places[faced[0]][faced[1]]
        if link.slope is not None:
            face = face + lumps.risen(link.slope, places, count)
        lost.append(link.conductance / (m.ring_width * m.block_depth) * (m.stack_profile.cells - face))
    depths = (np.arange(count) + 0.5) / count
    across = 0.5 * m.block_height / m.pcl_conductivity_melt
    return [
        m.stack_profile.cells
        - across * columns.row_below_mean(2.0 * place - 1.0, depths, 2.0 * m.block_depth / m.block_height, lost)
        for place in columns.EVEN.places
    ]


@quantities.helper()
def plate_depth(m: Module) -> Scalar:
    """Thickness of what is behind a block [m]: half a rotor vane."""
    return 0.5 * m.vane_thickness


@quantities.helper()
def plate_outside(m: Module) -> lumps.Surface:
    """The middle of the rotor's vanes, which no heat passes; their rims face the chamber (`side_links`)."""
    return lumps.Surface(m.pcl_area, 0.0)


@quantities.helper()
def plate_mass(m: Module) -> Scalar:
    """Mass of the rotor plate with its vanes [kg]."""
    return (np.pi * m.rotor_radius**2 * m.rotor_thickness + m.rotor_vanes.area * m.vane_height) * m.structure_density


@quantities.helper()
def faced_area(m: Module) -> Scalar:
    """Plan area of rotor's vanes, blocks and pads [m^2]: what of floor and rotor plate they heat."""
    return 2.0 * m.vane_count * m.block_width * (m.plate_depth + m.block_depth + m.pad_depth)


@quantities.helper()
def heated_length(m: Module) -> Scalar:
    """Depth of a block and its pad [m], along the ring."""
    return m.faced_area / m.ring_width - m.plate_depth


@quantities.helper()
def ways_along(m: Module) -> tuple[Scalar, ...]:
    """Ways along the ring in floor and rotor plate [1/m]: from below or above a block and its pad to a rotor vane and
    to a housing vane.

    A strip that is heated evenly has its mean temperature a sixth of its length away from either end where both take
    as much, and a third where one takes all: a quarter. What is heated at its end has it a third of its length away.
    """
    return tuple(1.0 / (0.25 * m.heated_length + end / 3.0) for end in (m.plate_depth, m.wall_depth))


@quantities.helper()
def rotor_beside(m: Module) -> tuple[lumps.Lump, ...]:
    """Rotor plate above the vanes, heated by their roots; beside that above blocks and pads, three bodies in depth."""
    k, capacity = m.structure_conductivity, m.rotor_thickness * m.structure_density * m.structure_specific_heat
    above_vanes, heated = m.ring_width * m.plate_depth, m.ring_width * m.heated_length
    outside = lumps.Surface(1.0, m.rotor_coefficient, m.surface_emissivity, m.rotor_thickness / 3.0 / k)
    # What of a vane stands beside the clearance above the blocks counts as plate.
    upper = (
        (m.rotor_vanes.area * m.vane_height - m.pcl_area * m.plate_depth)
        * m.structure_density
        * m.structure_specific_heat
    )
    vanes = lumps.Lump(m.vane_ways[0], above_vanes * capacity + upper, outside._replace(area=above_vanes))
    first, *others = lumps.strip_bodies(heated, capacity, k * heated / m.rotor_thickness, lumps.Surface(1.0, 0.0))
    along = k * m.rotor_thickness * m.ring_width * m.ways_along[0]
    others[-1] = others[-1]._replace(surface=outside._replace(area=heated, behind=lumps.BEYOND * m.rotor_thickness / k))
    # The lower tenth is divided in what is above blocks and above pads.
    blocks = 1.0 - m.pads_share
    first = first._replace(conductance=lumps.STRIP[0] * along, capacity=blocks * first.capacity)
    others[0] = others[0]._replace(conductance=blocks * others[0].conductance)
    return (vanes, first, *others)


@quantities.helper()
def uneven_sideways(_: Module) -> None:
    """A vane's cells give heat to the plate above by one conductance, their mean and what they differ from it."""
