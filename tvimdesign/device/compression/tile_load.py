"""What presses on Peltier modules in the housing's vanes, how far they give, and what they bear.

A block presses on its pad, or on a spreader and the tiles behind it, and these on the vane beside the slot. A module
is strong where it is pressed and weak where it is sheared: it carries the joint's torque in this mode as it is meant
to be mounted.
"""

from __future__ import annotations

from tvimdesign.device.core.heat.heater_form import CUT, WITH_TILES
from tvimdesign.device.core.impedance.joint_impedance import quantities as shared
from tvimdesign.device.table.quantity import Scalar
from tvimdesign.device.table.quantity_group import QuantityGroup
from tvimdesign.physics.layers import block, pressed_pad
from tvimdesign.physics.solids import structure

quantities = QuantityGroup(shared.group)
SHEET = 3.0
"""Modulus of a rigid module pressed through its thickness over its shear modulus, as of a body of Poisson's ratio 1/4
between stiff plates."""


@quantities.helper()
def pad_press_stiffness(
    heater_form: str,
    peltier_shear_modulus: Scalar,
    peltier_bulk_modulus: Scalar,
    peltier_thickness: Scalar,
    block_width: Scalar,
    block_height: Scalar,
    slot_width: Scalar,
    slot_height: Scalar,
    block_area: Scalar,
    tiles_per_block: Scalar,
    peltier_area: Scalar,
    spreader_youngs_modulus: Scalar,
    spreader_thickness: Scalar,
) -> Scalar:
    """Stiffness of what a block presses on before its vane [N/m]: the pad, or its tiles behind the spreader."""
    if heater_form == CUT:
        moduli, sides = (peltier_shear_modulus, peltier_bulk_modulus), (block_width, block_height)
        return pressed_pad.stiffness(moduli, sides, peltier_thickness, (slot_width, slot_height))
    tiles = SHEET * peltier_shear_modulus * tiles_per_block * peltier_area / peltier_thickness
    return structure.series(tiles, spreader_youngs_modulus * block_area / spreader_thickness)


@quantities.helper(requires=WITH_TILES)
def tile_edge_rise(block_height: Scalar, peltier_width: Scalar) -> Scalar:
    """Pressure at a tile's upper edge over its mean [1], 1 + 6 e/w: the block's middle is e above the tile's."""
    return 1.0 + 3.0 * (block_height - peltier_width) / peltier_width


@quantities.output("N*m", requires=WITH_TILES)
def heater_holding_torque(
    heater_pressure_limit: Scalar,
    vane_count: Scalar,
    tiles_per_block: Scalar,
    tile_seat_area: Scalar,
    tile_edge_rise: Scalar,
    pcl_mean_radius: Scalar,
) -> Scalar:
    """Torque at which the blocks press on the rigid Peltier modules as hard as these bear, at their upper edges."""
    seats = tiles_per_block * tile_seat_area / tile_edge_rise
    return block.torque_at_stress(heater_pressure_limit, vane_count, seats, pcl_mean_radius)


@quantities.output("MPa", per_point=True, requires=WITH_TILES)
def heater_pressure(
    block_pressure: Scalar, block_area: Scalar, tiles_per_block: Scalar, tile_seat_area: Scalar, tile_edge_rise: Scalar
) -> Scalar:
    """Highest pressure on rigid Peltier modules in a hold, at their upper edges: when the load has just come on."""
    return block_pressure * block_area * tile_edge_rise / (tiles_per_block * tile_seat_area)
