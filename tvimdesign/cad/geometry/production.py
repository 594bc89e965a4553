"""How each kind of part is come by: printed lying on which side and why, drawn for a workshop, or bought."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from tvimdesign.cad.geometry.dimensions import Dimensions


@dataclass(frozen=True, kw_only=True)
class Production:
    """How one kind of part is come by."""

    down: Literal["bottom", "top", "bought"]
    """The side that lies on the print bed, as the part stands in the module; `bought` is not printed at all."""
    why: str
    """Why that side, or where it is bought."""
    drawn: bool = False
    """Whether a workshop gets a drawing of it, or who cuts what is bought."""


PRODUCTION = {
    "housing": Production(
        down="bottom", drawn=True,
        why="feet and skirt on the bed: posts, hub and seats grow upwards and come out round; only the floor, and "
        "where there are bearings the lip between them, stand on support, in the open space under them",
    ),
    "rotor": Production(
        down="top", drawn=True,
        why="link end of the core on the bed: the face the PCL bonds to, or the vanes, come out on top without marks "
        "of supports, which stand between plate and bed, and under the pins, whose ends hang free whichever way the "
        "rotor lies: set supports from the bed, everywhere, a layer short of the part; the legs bear on the pins' "
        "sides, which no support touches, so that only ends and fillets are trimmed",
    ),
    "link": Production(down="bottom", drawn=True, why="flat: no support, and the layers lie in the plane of bending"),
    "retainer": Production(down="bottom", drawn=True, why="flat: no support"),
    "pcl_arc": Production(
        down="bottom", drawn=True,
        why="flat, keys upwards; cast it, print it of PCL, or without keys cut it from sheet",
    ),
    "pcl_block": Production(
        down="bottom", drawn=True, why="flat; cast it, print it of PCL, or cut it from sheet",
    ),
    "peltier_pad": Production(
        down="bought", drawn=True,
        why="a Peltier module of the catalogue, cut to this outline or of this size as it is sold",
    ),
    "spreader": Production(down="bought", drawn=True, why="cut from sheet of its material by its drawing"),
    "liner": Production(down="bought", drawn=True, why="cut from sheet of its material by its drawing, or printed"),
    "thermistor": Production(down="bought", why="a thermistor in glass with a bead of this size and insulated wires"),
    "thermal_cutout": Production(down="bought", why="a thermal cut-out of the catalogue, its type by the bill"),
    "adjuster": Production(
        down="bottom", drawn=True, why="flange on the bed: post and slot grow upwards, the screw's hole stands upright",
    ),
    "cover": Production(down="bottom", drawn=True, why="flat: no support"),
    "link_screw": Production(down="bought", why="a screw of the catalogue"),
    "link_insert": Production(down="bought", why="a brass insert of the catalogue, melted into the core"),
    "link_dowel": Production(down="bought", why="a dowel pin of the catalogue"),
    "retainer_screw": Production(down="bought", why="a screw of the catalogue"),
    "retainer_insert": Production(down="bought", why="a brass insert of the catalogue, melted into the core"),
    "adjuster_screw": Production(down="bought", why="a screw of the catalogue"),
    "adjuster_insert": Production(down="bought", why="a brass insert of the catalogue, melted into the post"),
    "cover_screw": Production(down="bought", why="a screw of the catalogue"),
    "cover_insert": Production(down="bought", why="a brass insert of the catalogue, melted into the boss"),
    "bearing_inner": Production(down="bought", why="the half of a ball bearing of the catalogue that turns"),
    "bearing_outer": Production(down="bought", why="the half of a ball bearing of the catalogue that stands"),
    "preload_spring": Production(down="bought", why="a wave spring of the catalogue, wound of flat wire to its sizes"),
    "motor_hub": Production(
        down="top", drawn=True, why="disc and spokes on the bed: barrel and journal grow upwards, no support",
    ),
    "motor_housing": Production(
        down="bottom", drawn=True,
        why="base on the bed: wall and tube grow upwards; only the board's recess and the bearings' lip need support",
    ),
    "motor_retainer": Production(down="top", drawn=True, why="the face to the bearing on the bed: no support"),
    "motor_rotor": Production(down="bought", why="the rotor of a frameless motor of the catalogue"),
    "motor_stator": Production(down="bought", why="the stator of a frameless motor of the catalogue"),
    "motor_bearing": Production(down="bought", why="a ball bearing of the catalogue"),
    "motor_screw": Production(down="bought", why="a screw of the catalogue"),
    "mount_screw": Production(down="bought", why="a screw of the catalogue"),
    "encoder_magnet": Production(down="bought", why="a magnet magnetised across, as the encoder's maker asks"),
    "encoder_board": Production(down="bought", why="the encoder of the catalogue, or a board made to its size"),
    "spring_right": Production(down="bought", why="wound to the spring maker's sheet"),
    "spring_left": Production(down="bought", why="wound to the spring maker's sheet"),
}  # fmt: skip
"""By kind of part, of all modes."""


def supported_levels(kind: str, dims: Dimensions) -> tuple[tuple[float, float], ...]:
    """Levels [mm] between which `PRODUCTION` says that a part stands on support as it is printed, in the open.

    A face is level there, or ends in a fillet.
    """
    if kind == "housing":
        levels = [-dims.floor_thickness]
        levels += [dims.hub_bottom_level + dims.lower_seat_depth] if dims.bearing_width > 0.0 else []
        return tuple((level, level) for level in levels)
    if kind != "rotor":
        return ()
    top, pins = dims.rotor_top_level, dims.pin_top_level
    return (top, top + dims.foot_fillet), (pins, pins)
