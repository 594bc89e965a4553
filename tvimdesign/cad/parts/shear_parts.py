"""The parts of the shear module: arcs of PCL on pads that lie in pockets of the floor, with windows below them."""

from collections.abc import Mapping
from math import pi

import cadquery as cq

from tvimdesign.cad.geometry.dimensions import Dimensions
from tvimdesign.cad.geometry.solids import cylinder, join, polar, ring, rounded, sector, turned
from tvimdesign.cad.parts import heater_parts
from tvimdesign.cad.parts.common_parts import bare_housing, bare_rotor, link, retainer


def housing(dims: Dimensions) -> cq.Shape:
    """Draw the housing with pockets for the pads and windows below them."""
    through = heater_parts.tile_openings(dims) if dims.spreader_depth else [_window(dims)]
    openings = [turned(shape, azimuth) for azimuth in _azimuths(dims) for shape in (_pocket(dims), *through)]
    openings += [turned(seat, _azimuths(dims)[0]) for seat in heater_parts.bead_seats(dims)]
    return bare_housing(dims, (), openings)


def _pocket(dims: Dimensions) -> cq.Solid:
    """Draw the pocket under an arc, for a pad of its outline or for tiles and a spreader, centred on the x axis."""
    sharp = sector(dims.pocket_inner_radius, dims.pocket_outer_radius, dims.pocket_span, -dims.pad_depth, 0)
    return rounded(sharp, dims.corner_radius)


def _pad(dims: Dimensions) -> cq.Solid:
    """Draw a pad of an arc's outline, centred on the x axis, flush with the floor."""
    sharp = sector(dims.pcl_inner_radius, dims.pcl_outer_radius, dims.arc_span, -dims.pad_depth, 0)
    return rounded(sharp, dims.corner_radius)


def _window(dims: Dimensions) -> cq.Solid:
    """Draw the window below a pad of an arc's outline, centred on the x axis."""
    sharp = sector(
        dims.pcl_inner_radius + dims.window_ledge,
        dims.pcl_outer_radius - dims.window_ledge,
        dims.arc_span - 2.0 * dims.window_ledge / dims.pcl_inner_radius,
        -dims.floor_thickness,
        -dims.pad_depth,
    )
    return rounded(sharp, dims.corner_radius)


def rotor(dims: Dimensions) -> cq.Shape:
    """Draw the rotor with pockets in its plate for the keys of the arcs or for liners, and lips beside them."""
    pockets = [*_keys(dims), *heater_parts.recesses_over_arc(dims)]
    return bare_rotor(
        dims, _melt_lips(dims), [turned(pocket, azimuth) for azimuth in _azimuths(dims) for pocket in pockets]
    )


def _melt_lips(dims: Dimensions) -> list[cq.Shape]:
    """Draw the rings below the plate that hold the melt; none where it has none."""
    if not dims.melt_lip_height:
        return []
    ends = (dims.rotor_bottom_level - dims.melt_lip_height, dims.rotor_bottom_level)
    inner = ring(dims.melt_lip_inner_radius, dims.pcl_inner_radius, *ends)
    return [inner, ring(dims.pcl_outer_radius, dims.rotor_radius, *ends)]


def pcl_arc(dims: Dimensions, sheared: float = 0.0) -> cq.Shape:
    """Draw one arc of PCL between floor and rotor, centred on the x axis, its keys turned with the rotor by an angle
    [rad].

    The layer itself is drawn unsheared.
    """
    layer = sector(dims.pcl_inner_radius, dims.pcl_outer_radius, dims.arc_span, 0, dims.pcl_thickness)
    keys = [turned(key, sheared) for key in _keys(dims)]
    return join(layer, keys) if keys else layer


def _keys(dims: Dimensions) -> list[cq.Shape]:
    """Draw the keys of an arc that is centred on the x axis; none where it has none."""
    count, bottom = round(dims.key_count), dims.rotor_bottom_level
    at = [polar(dims.key_circle_radius, dims.arc_span * ((index + 0.5) / count - 0.5)) for index in range(count)]
    return [cylinder(0.5 * dims.key_diameter, bottom, bottom + dims.key_depth, place) for place in at]


def heater(dims: Dimensions) -> cq.Shape:
    """Draw one heater under an arc: a pad of its outline, or a tile, on the x axis."""
    return heater_parts.arc_tile(dims) if dims.spreader_depth else _pad(dims)


DRAWN = {"housing": housing, "rotor": rotor, "link": link, "retainer": retainer, "pcl_arc": pcl_arc, "heater": heater}


def stand(dims: Dimensions, drawn: Mapping[str, cq.Solid], rotor_angle: float) -> dict[str, cq.Shape]:
    """Place heaters, spreaders, arcs and liners, these and keys with the rotor at an angle [rad], by name.

    The arcs are drawn unsheared: the floor holds their lower face, the keys go with the rotor.
    """
    keyed = rotor_angle != 0.0 and dims.key_count > 0.0
    arc = pcl_arc(dims, rotor_angle) if keyed else drawn["pcl_arc"]
    beside = heater_parts.tile_azimuths(dims) if dims.spreader_depth else [0.0]
    pads = [azimuth + of_tile for azimuth in _azimuths(dims) for of_tile in beside]
    sensed = _azimuths(dims)[: dims.count("thermistor_count")] if "thermistor" in drawn else []
    places = {"heater": pads, "pcl_arc": _azimuths(dims), "spreader": _azimuths(dims), "thermistor": sensed}
    places["liner"] = [azimuth + rotor_angle for azimuth in _azimuths(dims)]
    shapes = {kind: drawn[kind] for kind in places if kind in drawn} | {"pcl_arc": arc}
    placed = {
        f"{kind}_{index + 1}": turned(shape, azimuth)
        for kind, shape in shapes.items()
        for index, azimuth in enumerate(places[kind])
    }
    if "heater_lead" in drawn:
        placed |= heater_parts.leads_below_arcs(dims, drawn["heater_lead"], pads)
    return placed | heater_parts.stand_cutout(drawn, _azimuths(dims)[0] + beside[len(beside) // 2])


def _azimuths(dims: Dimensions) -> list[float]:
    """Return the middles of the PCL arcs [rad]: between the springs where there are as many of both."""
    return [azimuth + pi / dims.count("foot_count") for azimuth in dims.azimuths("arc_count")]
