"""Rigid heaters in the housing's vanes, as they are bought: rectangular tiles in a row behind a spreader.

Behind the face of each block stands a spreader of the block's face, flush with the vane, and behind that a row of
`tiles_per_block` tiles, upright: their length along the radius, evenly spread over the block's width, their width along
the axis. Spreader and tiles stand on the floor of the pocket, which is open above and at both ends as a pad's is. The
vane has a slot behind each tile, with flat ends across the vane's middle, as wide as `slot_share` of the tile; the two
tiles of a vane share it. A `window_ledge` below a tile's upper edge the slot ends, so a tile bears on both its sides
and above. Below the tiles the slot reaches under their middle, for the leads, which go straight down at its inner
end.

A block presses on its pad, or on a spreader and the tiles behind it, and these on the vane beside the slot. A module
is strong where it is pressed and weak where it is sheared: it carries the joint's torque in this mode as it is meant
to be mounted. As a block is a wedge, its force leans along the pocket. Adhesive between the spreader's lower edge and
what it stands on takes that part, and the tiles slide on grease; a pad takes it in shear, up to what its record allows.

The pockets in the faces of a vane are open at its outer end. There the bead of the thermistor stands upright on the
floor's level, as far behind the face as it is thick by half, and touches the end of the pad, or of the spreader. Its
wires go down through a hole of the floor, through which it is put in.
"""

import numpy as np

from tvimdesign.device.core.heater_form import CUT, LEADS, WITH_TILES
from tvimdesign.device.table import Module, QuantityGroup, Scalar
from tvimdesign.physics.layers import block
from tvimdesign.physics.solids import structure
from tvimdesign.physics.solids.shapes import NOTHING, Section, disc_at

kinds = QuantityGroup("Materials")
tile_places = QuantityGroup("Layout", WITH_TILES)
tile_weights = QuantityGroup("Size and weight", WITH_TILES)
tile_rules = QuantityGroup("Gaps", WITH_TILES)

kinds.choices("vane_tiles")


tile_places.same("tiles_per_pocket", "tiles_per_block", "Rectangular heaters in each pocket [1]", requires=())
tile_places.same(
    "slot_count", "tiles_per_block", "Slots of a housing vane [1]: one behind each tile; one behind pads", default=1.0
)


tile_places.formulas("vane_tiles")


@tile_places.output("mm")
def tile_slot_radius(m: Module) -> Scalar:
    """Distance from the axis, along a vane's middle, of what lies behind the middle of its rows of tiles."""
    half = 0.5 * m.housing_vane_angle
    return m.pcl_mean_radius * np.cos(half) + m.pad_depth * np.sin(half)


@tile_places.output("mm")
def tile_slot_pitch(m: Module) -> Scalar:
    """Distance of a vane's slots along its middle."""
    return m.tile_spacing * np.cos(0.5 * m.housing_vane_angle)


tile_rules.margins("vane_tiles.tile_rules")


@tile_rules.gap("a heater reaches beyond the outer end of its vane: a wider block")
def tile_end_margin(m: Module) -> Scalar:
    """Vane beyond the back corner of its outermost tiles, which bear on it up to there."""
    end = m.pcl_outer_radius - 0.5 * (m.tile_spacing - m.heater_length)
    return m.pcl_outer_radius - np.sqrt(end**2 + m.pad_depth**2)


loads = QuantityGroup("Impedance")
SHEET = 3.0
"""Modulus of a rigid module pressed through its thickness over its shear modulus, as of a body of Poisson's ratio 1/4
between stiff plates."""


@loads.helper()
def pad_press_stiffness(m: Module) -> Scalar:
    """Stiffness of what a block presses on before its vane [N/m]: the pad, or its tiles behind the spreader."""
    if m.heater_form == CUT:
        moduli, sides = (m.heater_shear_modulus, m.heater_bulk_modulus), (m.block_width, m.block_height)
        return block.pad_stiffness(moduli, sides, m.heater_thickness, (m.slot_width, m.slot_height))
    tiles = SHEET * m.heater_shear_modulus * m.tiles_per_block * m.heater_area / m.heater_thickness
    return structure.series(tiles, m.spreader_youngs_modulus * m.block_area / m.spreader_thickness)


loads.formulas("vane_tiles.loads")


@loads.output("N*m", requires=WITH_TILES)
def heater_holding_torque(m: Module) -> Scalar:
    """Torque at which the blocks press on the rigid heaters as hard as these bear, at their upper edges."""
    seats = m.tiles_per_block * m.tile_seat_area / m.tile_edge_rise
    return block.torque_at_stress(m.heater_pressure_limit, m.vane_count, seats, m.pcl_mean_radius)


@loads.helper()
def heater_shear_share(m: Module) -> Scalar:
    """Part of a block's force along the face of its heater over the whole [1]: sin of the angle between them."""
    return np.sin(0.5 * m.rotor_vane_angle + m.block_angle - m.block_lean_out)


@loads.output("N*m", requires=WITH_TILES)
def lower_seat_holding_torque(m: Module) -> Scalar:
    """Torque that the adhesive below the spreaders bears along them, by `holding_safety` below its strength."""
    each = m.seat_strength * m.block_width * m.spreader_depth / m.heater_shear_share
    return m.vane_count * each * m.pcl_mean_radius


places = QuantityGroup("Layout")
weights = QuantityGroup("Size and weight")
rules = QuantityGroup("Gaps")


places.formulas("vane_tiles.places")


@places.output("mm", hidden=True)
def lead_room(m: Module) -> Scalar:
    """Width of a slot, from its inner end, in which both leads of a heater go down side by side."""
    return LEADS * (m.lead_diameter + 2.0 * m.lead_clearance)


@places.output("mm", hidden=True)
def lead_drop(m: Module) -> Scalar:
    """Height of the leads above the floor's lower face: they begin below a tile, or half as high as a pad's slot."""
    return m.floor_thickness + m.running_clearance + (0.5 * m.slot_height if m.heater_form == CUT else 0.0)


@weights.output("mm^3")
def lead_volume(m: Module) -> Scalar:
    """Volume of all leads of heaters as far as they are in vanes and floor, where they go straight down."""
    return LEADS * m.heater_count * 0.25 * np.pi * m.lead_diameter**2 * m.lead_drop


@places.output("mm")
def thermistor_seat_radius(m: Module) -> Scalar:
    """Distance of the bead's axis from the module's: half a bead beyond the end of the pad, and behind its face."""
    half = 0.5 * m.thermistor_diameter
    return np.sqrt((m.pcl_outer_radius + half) ** 2 + half**2)


@weights.helper(default=NOTHING)
def thermistor_seat_section(m: Module) -> Section:
    """Plan view of the thermistor's hole in the floor."""
    return disc_at(0.5 * m.thermistor_seat_diameter, m.thermistor_seat_radius)


@weights.output("mm^3")
def thermistor_volume(m: Module) -> Scalar:
    """Volume of the thermistor's bead; zero without."""
    return 0.25 * np.pi * m.thermistor_diameter**2 * m.thermistor_length


@rules.gap("the thermistor would be taller than the block: a shorter bead")
def thermistor_height_gap(m: Module) -> Scalar:
    """Height of the block beyond the bead's, where there is one."""
    length = np.fmin(m.thermistor_length, 1e3 * m.thermistor_diameter)
    return np.fmax(m.vane_height - m.running_clearance, 0.0) - length


@rules.gap("the thermistor does not reach the pad's end: a smaller bead")
def thermistor_end_gap(m: Module) -> Scalar:
    """Thickness of the pad, or the spreader, beyond half of the bead's, which touches it there."""
    return (m.heater_thickness if m.heater_form == CUT else m.spreader_depth) - 0.5 * m.thermistor_diameter


rules.margins("vane_tiles.rules")


def _thermistor_azimuth(m: Module) -> Scalar:
    """Return the azimuth of the bead's axis [rad]: half a bead behind the face of the first vane that the first pad
    stands in."""
    half = 0.5 * m.thermistor_diameter
    return np.pi / m.vane_count + 0.5 * m.housing_vane_angle - np.arctan2(half, m.pcl_outer_radius + half)


@rules.gap("the floor between the thermistor's hole and what is beside it is too thin")
def thermistor_hole_gap(m: Module) -> Scalar:
    """Floor between the hole and the nearest spring's tang or adjuster's pocket, beyond the least wall where it is.

    Springs stand at azimuth 0 and evenly around, so the nearest is arccos(cos(n a))/n beside.
    """
    taken = np.fmax(m.spring_reach + m.tang_clearance, m.adjuster_radius + m.slip_clearance)
    beside = np.arccos(np.fmin(np.cos(m.spring_count * _thermistor_azimuth(m)), 1.0 - 1e-12)) / m.spring_count
    across = m.placement_radius * np.sin(beside)
    away = np.sqrt((m.placement_radius * np.cos(beside) - m.thermistor_seat_radius) ** 2 + across**2)
    room = np.fmax(away - taken - 0.5 * m.hole_compensation, 0.0)  # a print file widens both holes
    return room - np.fmin(m.hole_wall + 0.5 * m.thermistor_seat_diameter, room + 1e3 * m.thermistor_seat_diameter)
