"""The parts of the compression module: vanes on housing and rotor, PCL blocks between them, pads in vanes.

Drawn in words in `device/compression/__init__.py`. Vanes, pads and blocks are drawn on the x axis and turned in place.
"""

from collections.abc import Mapping
from math import pi

import cadquery as cq

from tvimdesign.base.errors import GeometryError
from tvimdesign.cad.geometry.dimensions import Dimensions
from tvimdesign.cad.geometry.solids import block, rounded, sector, turned
from tvimdesign.cad.parts import heater_parts
from tvimdesign.cad.parts.common_parts import bare_housing, bare_rotor, link, retainer

_SIDES = (1.0, -1.0)


def housing(dims: Dimensions) -> cq.Shape:
    """Draw housing with its vanes, which have pockets for two pads and a slot between these, down through the floor."""
    vane = sector(dims.pcl_inner_radius, dims.pcl_outer_radius, dims.housing_vane_angle, 0, dims.vane_height)
    # The pads drop in from above: their pockets are open there, and at both ends.
    end = dims.pad_depth
    pocketed = vane.cut(*_beside_faces(dims, end, end, (dims.running_clearance, dims.vane_height + end)))
    azimuths = _housing_vanes(dims)
    openings = [turned(slot, at) for at in azimuths for slot in _slots(dims)]
    openings += [turned(hole, _first_face(dims)) for hole in heater_parts.bead_hole(dims)]
    return bare_housing(dims, [turned(pocketed, at) for at in azimuths], openings)


def _slots(dims: Dimensions) -> list[cq.Shape]:
    """Draw slots of a housing vane, as a cutter comes by from below; beside the pads they open into their pockets."""
    bottom, top = -dims.floor_thickness, dims.slot_top_level
    if dims.spreader_depth:
        return heater_parts.tile_slots(dims)
    whole = sector(dims.slot_inner_radius, dims.slot_outer_radius, dims.housing_vane_angle, bottom, top)
    return [rounded(whole.cut(*_beside_faces(dims, dims.pad_seat, dims.pad_depth, (bottom, top))), dims.corner_radius)]


def rotor(dims: Dimensions) -> cq.Shape:
    """Draw the rotor with vanes that hang from its plate to a running clearance above the floor."""
    top = dims.rotor_bottom_level
    vane = sector(dims.pcl_inner_radius, dims.pcl_outer_radius, dims.rotor_vane_angle, top - dims.vane_height, top)
    recesses = heater_parts.recesses_in_vane(dims)
    lined = vane.cut(*recesses) if recesses else vane
    return bare_rotor(dims, [turned(lined, azimuth) for azimuth in dims.azimuths("vane_count")])


def pcl_block(dims: Dimensions, squeeze: float = 0.0) -> cq.Shape:
    """Draw one block between two vanes, centred on the x axis, squeezed by an angle [rad].

    Squeezed, it is drawn as what the vanes leave of its place. What bulges at its sides is not drawn: the row
    `squeezed_block_gap` says what room it has.
    """
    if not squeeze < dims.block_angle:
        raise GeometryError(f"pcl_block: of {dims.block_angle:.4g} rad, the rotor's vane takes {squeeze:.4g} rad")
    span = dims.block_angle - squeeze
    return sector(dims.pcl_inner_radius, dims.pcl_outer_radius, span, dims.running_clearance, dims.vane_height)


def heater(dims: Dimensions) -> cq.Shape:
    """Draw one heater, upright along the x axis: a flat pad, or a tile whose middle is on the axis."""
    if dims.spreader_depth:
        return heater_parts.vane_tile(dims)
    along = (dims.pcl_inner_radius, dims.pcl_outer_radius)
    return block(along, dims.heater_thickness, dims.running_clearance, dims.vane_height)


DRAWN = {
    "housing": housing,
    "rotor": rotor,
    "link": link,
    "retainer": retainer,
    "pcl_block": pcl_block,
    "heater": heater,
}


def stand(dims: Dimensions, drawn: Mapping[str, cq.Solid], rotor_angle: float) -> dict[str, cq.Shape]:
    """Place pads, liners, and blocks between the pads and the rotor's vanes at an angle [rad], by name.

    Blocks stay on their pads: of the two beside a vane one is squeezed to what the vane leaves it, the other one parts
    from the vane and keeps its shape.
    """
    placed = heater_parts.stand_cutout(drawn, _housing_vanes(dims)[0])
    if "thermistor" in drawn:
        placed["thermistor_1"] = turned(drawn["thermistor"], _first_face(dims))
    for index, azimuth in enumerate(_housing_vanes(dims)):
        for face, side in enumerate(_SIDES):
            placed |= _heaters(dims, drawn, 2 * index + face, azimuth, side)
    if "heater_lead" in drawn:
        placed |= heater_parts.leads_in_vanes(dims, drawn["heater_lead"], _housing_vanes(dims))
    if "liner" in drawn:
        for index, azimuth in enumerate(dims.azimuths("vane_count")):
            for second, sheet in enumerate(heater_parts.liners_on_vane(dims, drawn["liner"], azimuth + rotor_angle)):
                placed[f"liner_{2 * index + second + 1}"] = sheet
    shapes = {side: max(side * rotor_angle, 0.0) for side in _SIDES}
    pressed = {side: pcl_block(dims, squeeze) if squeeze else drawn["pcl_block"] for side, squeeze in shapes.items()}
    for index, azimuth in enumerate(dims.azimuths("vane_count")):
        for second, side in enumerate(_SIDES):
            # From the middle of the rotor's vane to the pad's face, and back by half of what is left of the block.
            middle = 0.5 * (dims.rotor_vane_angle + dims.block_angle + shapes[side])
            placed[f"pcl_block_{2 * index + second + 1}"] = turned(pressed[side], azimuth + side * middle)
    return placed


def _housing_vanes(dims: Dimensions) -> list[float]:
    """Return the azimuths of the housing's vanes [rad], half a pitch beyond the rotor's."""
    return [azimuth + pi / dims.count("vane_count") for azimuth in dims.azimuths("vane_count")]


def _first_face(dims: Dimensions) -> float:
    """Return the azimuth of the face [rad] in which the first pad stands."""
    return _housing_vanes(dims)[0] + 0.5 * dims.housing_vane_angle


def _heaters(
    dims: Dimensions, drawn: Mapping[str, cq.Solid], face: int, azimuth: float, side: float
) -> dict[str, cq.Shape]:
    """Draw what stands in one face of a housing vane, faces counted around the axis: a pad, or spreader and tiles."""
    if not dims.spreader_depth:
        at, beside = _behind_face(dims, side, dims.heater_thickness)
        return {f"heater_{face + 1}": turned(drawn["heater"], azimuth + at, beside)}
    at, beside = _behind_face(dims, side, dims.spreader_depth)
    placed = {f"spreader_{face + 1}": turned(drawn["spreader"], azimuth + at, beside)}
    at, beside = _behind_face(dims, side, dims.heater_thickness, dims.spreader_depth)
    places = heater_parts.tile_row(dims)
    for index, along in enumerate(places):
        tile = drawn["heater"].moved(cq.Location(cq.Vector(along, 0.0, 0.0)))
        placed[f"heater_{face * len(places) + index + 1}"] = turned(tile, azimuth + at, beside)
    return placed


def _behind_face(dims: Dimensions, side: float, thickness: float, before: float = 0.0) -> tuple[float, float]:
    """Return azimuth of a face of a housing vane, and how far beside it the middle of a plate is that lies behind it.

    `before` is the thickness of what lies between the two.
    """
    return side * 0.5 * dims.housing_vane_angle, -side * (before + 0.5 * thickness)


def _beside_faces(dims: Dimensions, thickness: float, more: float, levels: tuple[float, float]) -> list[cq.Shape]:
    """Draw plates behind both faces of a housing vane on the x axis, longer than it at either end, between two
    levels."""
    longer = (dims.pcl_inner_radius - more, dims.pcl_outer_radius + more)
    plate = block(longer, thickness, *levels)
    return [turned(plate, *_behind_face(dims, side, thickness)) for side in _SIDES]
