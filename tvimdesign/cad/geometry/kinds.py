"""The kinds of part a module has: the colour of each, what it is made of, and the rows that describe it."""

from dataclasses import dataclass
from typing import Any, Literal

from tvimdesign.base.record import own_data
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
_LISTED: Any = own_data(__file__, "kinds.yaml")
_MADE_OF = ("material", "density", "volume")
KINDS = {
    name: Kind(colour=tuple(listed["colour"]), **{key: listed[key] for key in _MADE_OF})
    for name, listed in _LISTED.items()
}
"""Of all modes, by name; a placed part is named after its kind, with a number where there are several."""
TURNING = (
    "rotor", "link", "retainer", "link_screw", "retainer_screw", "link_insert", "retainer_insert", "bearing_inner",
    "link_dowel", "leg_pin", "liner",
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
    name: Production(down=listed["down"], why=listed["why"], drawn=listed.get("drawn", False))
    for name, listed in _LISTED.items()
}
"""By kind of part, of all modes."""


def supported_levels(kind: str, dims: Dimensions) -> tuple[tuple[float, float], ...]:
    """Return levels [mm] between which `PRODUCTION` says that a part stands on support as it is printed, in the open.

    A face is level there, or ends in a fillet.
    """
    if kind == "housing":
        levels = [] if dims.base_height else [-dims.floor_thickness]
        levels += [dims.hub_bottom_level + dims.lower_seat_depth] if dims.bearing_width > 0.0 else []
        return tuple((level, level) for level in levels)
    if kind != "rotor":
        return ()
    top, pins = dims.rotor_top_level, [pin_foot_level(dims)] if dims.spring_count else []
    return (top, top + dims.foot_fillet), *((level, level) for level in pins)


def pin_foot_level(dims: Dimensions) -> float:
    """Return the level [mm] up to which the rotor stands below a leg: its own pin's, or that of a dowel pin's boss."""
    bought = dims.leg_pin_length - dims.leg_pin_depth if dims.leg_pins_fitted else 0.0
    return dims.pin_top_level - bought
