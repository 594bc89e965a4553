"""What presses on Peltier modules in the housing's vanes, how far they give, and what they bear.

A block presses on its pad, or on a spreader and the tiles behind it, and these on the vane beside the slot. A module
is strong where it is pressed and weak where it is sheared: it carries the joint's torque in this mode as it is meant
to be mounted.
"""

from __future__ import annotations

from tvimdesign.device.core.heat.heater_form import CUT, WITH_TILES
from tvimdesign.device.core.impedance.joint_impedance import quantities as shared
from tvimdesign.device.table.module import Module
from tvimdesign.device.table.quantity import Scalar
from tvimdesign.device.table.quantity_group import QuantityGroup
from tvimdesign.physics.layers import block
from tvimdesign.physics.solids import structure

quantities = QuantityGroup(shared.group)
SHEET = 3.0
"""Modulus of a rigid module pressed through its thickness over its shear modulus, as of a body of Poisson's ratio 1/4
between stiff plates."""


@quantities.helper()
def pad_press_stiffness(m: Module) -> Scalar:
    """Stiffness of what a block presses on before its vane [N/m]: the pad, or its tiles behind the spreader."""
    if m.heater_form == CUT:
        moduli, sides = (m.peltier_shear_modulus, m.peltier_bulk_modulus), (m.block_width, m.block_height)
        return block.pad_stiffness(moduli, sides, m.peltier_thickness, (m.slot_width, m.slot_height))
    tiles = SHEET * m.peltier_shear_modulus * m.tiles_per_block * m.peltier_area / m.peltier_thickness
    return structure.series(tiles, m.spreader_youngs_modulus * m.block_area / m.spreader_thickness)


@quantities.helper(requires=WITH_TILES)
def tile_edge_rise(m: Module) -> Scalar:
    """Pressure at a tile's upper edge over its mean [1], 1 + 6 e/w: the block's middle is e above the tile's."""
    return 1.0 + 3.0 * (m.block_height - m.peltier_width) / m.peltier_width


@quantities.output("N*m", requires=WITH_TILES)
def heater_holding_torque(m: Module) -> Scalar:
    """Torque at which the blocks press on the rigid Peltier modules as hard as these bear, at their upper edges."""
    seats = m.tiles_per_block * m.tile_seat_area / m.tile_edge_rise
    return block.torque_at_stress(m.heater_pressure_limit, m.vane_count, seats, m.pcl_mean_radius)


@quantities.output("MPa", per_point=True, requires=WITH_TILES)
def heater_pressure(m: Module) -> Scalar:
    """Highest pressure on rigid Peltier modules in a hold, at their upper edges: when the load has just come on."""
    return m.block_pressure * m.block_area * m.tile_edge_rise / (m.tiles_per_block * m.tile_seat_area)
