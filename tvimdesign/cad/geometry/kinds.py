"""The kinds of part a module has: the colour of each, what it is made of, and the rows that describe it."""

from dataclasses import dataclass
from typing import Literal

from tvimdesign.cad.geometry.dimensions import Dimensions

Rgb = tuple[float, float, float]


@dataclass(frozen=True, kw_only=True)
class Kind:
    """A kind of part."""

    colour: Rgb  # sRGB, 0 to 1
    material: str  # The row of its material
    density: str  # The row of its density
    volume: str  # The row of the volume of all of its kind, or of one spring


STRUCTURE = "structure_material"  # The row of the material that the module's process makes parts of
_STRUCTURE = (STRUCTURE, "structure_density")


def _kind(colour: Rgb, material: str, density: str, volume: str) -> Kind:
    return Kind(colour=colour, material=material, density=density, volume=volume)


_SPRING = ("spring_material", "spring_density", "spring_volume")
_STEEL: Rgb = (0.30, 0.31, 0.33)
_BRASS: Rgb = (0.80, 0.66, 0.25)
_SCREWS = ("link_screw", "retainer_screw", "adjuster_screw", "cover_screw", "motor_screw", "mount_screw")
_INSERTS = {"link_insert": "core", "retainer_insert": "core", "adjuster_insert": "post", "cover_insert": "boss"}
"""What each is melted into."""
KINDS = {
    "housing": _kind((0.62, 0.68, 0.74), *_STRUCTURE, "housing_volume"),
    "rotor": _kind((0.92, 0.62, 0.20), *_STRUCTURE, "rotor_volume"),
    "link": _kind((0.16, 0.36, 0.62), *_STRUCTURE, "link_volume"),
    "retainer": _kind((0.42, 0.28, 0.50), *_STRUCTURE, "retainer_volume"),
    "pcl_arc": _kind((0.95, 0.93, 0.82), "pcl_grade", "pcl_density", "pcl_volume"),
    "pcl_block": _kind((0.95, 0.93, 0.82), "pcl_grade", "pcl_density", "pcl_volume"),
    "heater": _kind((0.72, 0.20, 0.18), "peltier_module", "peltier_density", "peltier_volume"),
    "heater_lead": _kind((0.70, 0.12, 0.12), "peltier_module", "lead_density", "lead_volume"),
    "spreader": _kind((0.80, 0.80, 0.78), "spreader_material", "spreader_density", "spreader_volume"),
    "liner": _kind((0.55, 0.50, 0.40), "liner_material", "liner_density", "liner_volume"),
    "thermistor": _kind((0.10, 0.10, 0.12), "thermistor", "thermistor_density", "thermistor_volume"),
    "thermal_cutout": _kind((0.78, 0.74, 0.62), "heater_fuse", "cutout_density", "cutout_volume"),
    "link_dowel": _kind((0.72, 0.74, 0.78), "link_dowel", "link_dowel_density", "link_dowel_volume"),
    "bearing_inner": _kind((0.80, 0.80, 0.84), "bearing", "bearing_density", "bearing_inner_volume"),
    "bearing_outer": _kind((0.52, 0.54, 0.60), "bearing", "bearing_density", "bearing_outer_volume"),
    "preload_spring": _kind((0.24, 0.42, 0.62), "axial_preload", "preload_spring_density", "preload_spring_volume"),
    "adjuster": _kind((0.78, 0.45, 0.58), *_STRUCTURE, "adjuster_volume"),
    "cover": _kind((0.50, 0.56, 0.62), *_STRUCTURE, "cover_volume"),
    "motor_hub": _kind((0.60, 0.72, 0.42), *_STRUCTURE, "motor_hub_volume"),
    "motor_housing": _kind((0.50, 0.56, 0.64), *_STRUCTURE, "motor_housing_volume"),
    "motor_retainer": _kind((0.42, 0.28, 0.50), *_STRUCTURE, "motor_retainer_volume"),
    "motor_rotor": _kind((0.36, 0.36, 0.40), "motor", "motor_rotor_density", "motor_rotor_volume"),
    "motor_stator": _kind((0.72, 0.45, 0.20), "motor", "motor_stator_density", "motor_stator_volume"),
    "motor_bearing": _kind((0.66, 0.67, 0.72), "motor_bearing", "motor_bearing_density", "motor_bearing_volume"),
    "encoder_magnet": _kind((0.85, 0.75, 0.20), "encoder", "encoder_magnet_density", "encoder_magnet_volume"),
    "encoder_board": _kind((0.10, 0.42, 0.28), "encoder", "encoder_board_density", "encoder_board_volume"),
    **{name: _kind(_STEEL, name, f"{name}_density", f"{name}_volume") for name in _SCREWS},
    **{name: _kind(_BRASS, name, f"{name}_density", f"{name}_volume") for name in _INSERTS},
    "spring_right": _kind((0.15, 0.48, 0.38), *_SPRING),
    "spring_left": _kind((0.45, 0.70, 0.30), *_SPRING),
}
"""Of all modes, by name; a placed part is named after its kind, with a number where there are several."""
TURNING = (
    "rotor", "link", "retainer", "link_screw", "retainer_screw", "link_insert", "retainer_insert", "bearing_inner",
    "link_dowel", "liner",
)  # fmt: skip
"""The kinds that turn together."""
MADE_TURNING = TURNING[:3]  # Those that a module has one of, drawn where it stands
SPRINGS = ("spring_right", "spring_left")
CHANGING = (*SPRINGS, "pcl_block")
"""The kinds that change their shape as the rotor turns: each is compared with all that stands and turns."""


def is_of_structure(kind: str) -> bool:
    """Return whether a kind of part is made by the module's process, and is compared with what that can make."""
    return KINDS[kind].material == STRUCTURE


def kind_of(name: str) -> str:
    """Return the kind of a placed part: `pcl_arc` for `pcl_arc_3`."""
    return name.rstrip("0123456789").rstrip("_")


@dataclass(frozen=True, kw_only=True)
class Production:
    """Way in which a kind of part is made or bought."""

    down: Literal["bottom", "top", "bought"]
    """The side that lies on the print bed, as the part stands in the module; `bought` is not printed at all."""
    why: str  # Why that side, or where it is bought
    drawn: bool = False  # True if a workshop, or whoever cuts bought stock, gets a drawing of it


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
    "heater": Production(
        down="bought", drawn=True,
        why="a heater of the catalogue, made to this outline or of this size as it is sold",
    ),
    "heater_lead": Production(down="bought", why="comes with its heater; drawn as far as the ground"),
    "spreader": Production(down="bought", drawn=True, why="cut from sheet of its material by its drawing"),
    "liner": Production(down="bought", drawn=True, why="cut from sheet of its material by its drawing, or printed"),
    "thermistor": Production(down="bought", why="a thermistor in glass with a bead of this size and insulated wires"),
    "thermal_cutout": Production(down="bought", why="a thermal cut-out of the catalogue, its type by the bill"),
    "adjuster": Production(
        down="bottom", drawn=True, why="flange on the bed: post and slot grow upwards, the screw's hole stands upright",
    ),
    "cover": Production(down="bottom", drawn=True, why="flat: no support"),
    "link_dowel": Production(down="bought", why="a dowel pin of the catalogue"),
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
    "encoder_magnet": Production(down="bought", why="a magnet magnetised across, as the encoder's maker asks"),
    "encoder_board": Production(down="bought", why="the encoder of the catalogue, or a board made to its size"),
    **{name: Production(down="bought", why="a screw of the catalogue") for name in _SCREWS},
    **{name: Production(down="bought", why=f"a brass insert of the catalogue, melted into the {into}")
       for name, into in _INSERTS.items()},
    **dict.fromkeys(SPRINGS, Production(down="bought", why="wound to the spring maker's sheet")),
}  # fmt: skip
"""By kind of part, of all modes."""


def supported_levels(kind: str, dims: Dimensions) -> tuple[tuple[float, float], ...]:
    """Return levels [mm] between which `PRODUCTION` says that a part stands on support as it is printed, in the open.

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
