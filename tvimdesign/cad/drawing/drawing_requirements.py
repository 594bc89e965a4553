"""Requirements of a drawing beyond shape: fits of the seats by ISO 286-1 (`iso_286.yaml`), surfaces, edges, threads."""

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from itertools import pairwise
from math import degrees, floor, hypot
from typing import Any, NamedTuple

from tvimdesign.base.errors import GeometryError
from tvimdesign.base.record import own_data
from tvimdesign.cad.drawing.drawing_sheet import figure
from tvimdesign.cad.drawing.iso_1101 import Frame
from tvimdesign.cad.geometry.dimensions import Dimensions
from tvimdesign.cad.geometry.features import Cylinder

_DATA = "iso_286.yaml"
standard_data = partial(own_data, __file__, _DATA)
_MICRON = 1e-3
_HAIR = 1e-5  # Length [mm] by which a size may be off the end of a range for rounding


class Limits(NamedTuple):
    """Lower and upper limit deviation [mm]."""

    lower: float
    upper: float


def limit_deviations(fit: str, size: float) -> Limits:
    """Limit deviations [mm] of a tolerance class such as H7 or js5 at a nominal size [mm]; ISO 286-1.

    Raises GeometryError for a class or a size that is not in the table.
    """
    known = re.fullmatch(r"(H|JS|G|h|js|g|k)(\d+)", fit)
    if not known or (known[1] == "k" and known[2] not in "567"):
        raise GeometryError(f"tolerance class {fit!r} is not in {_DATA}: H, JS, G, h, js, g, or k in 5 to 7")
    letter, width = known[1], standard_tolerance(int(known[2]), size)
    if letter in ("JS", "js"):
        return Limits(-0.5 * width, 0.5 * width)
    if letter in ("H", "h"):
        return Limits(0.0, width) if letter == "H" else Limits(-width, 0.0)
    off = _MICRON * _at(standard_data()["deviations"][letter.lower()], size)
    if letter == "k":
        return Limits(off, off + width)
    return Limits(off - width, off) if letter == "g" else Limits(-off, -off + width)


def standard_tolerance(grade: int, size: float) -> float:
    """Return standard tolerance [mm] of a grade at a size [mm]."""
    grades = standard_data()["grades"]
    if grade not in grades:
        raise GeometryError(f"tolerance grade IT{grade} is not in {_DATA}: it has {', '.join(map(str, grades))}")
    return _MICRON * _at(grades[grade], size)


def _at(row: Sequence[int], size: float) -> int:
    """Return the value of a row of the table at a size [mm]."""
    ends = (0.0, *standard_data()["up_to"])
    # What is a hair off a range's end for rounding belongs to the range.
    for value, (over, up_to) in zip(row, pairwise(ends), strict=True):
        if over < size <= up_to + _HAIR:
            return value
    raise GeometryError(f"{size:g} mm is outside the sizes of {_DATA}: above 0 up to {ends[-1]:g} mm")


requirements_data = partial(own_data, __file__, "drawing_requirements.yaml")
TAPPED = "tapped"
_EASED = 3.2  # Roughness Ra [µm] of a printed seat that is reamed, or rubbed down with fine paper
_ZONE = 0.05  # Step [mm] of zones of position
_SAME = 1e-5  # Lengths [mm] that differ by less are one
DATUM = "B"  # Letter of the datum; A is the section's
GROUND = "C"  # Letter of the lowest face
_POINTS = "Depths of blind holes are without the drill's point, {angle:.0f}°."
_FEET = "Fillets at the feet of core and pins R{radius}."
_PROFILE = "Each face within ±{half:g} of its place; sizes between faces by ISO 2768-1 m, too."
_EASED_SEATS = "Check a seat eased to size by its mating part; a hole also by a dial bore gauge."
_BEARINGS = "At bearings: run-out of the shoulder; its fillet R 0.1 at most."
"""0.1 mm is the least chamfer of the rings in the catalogue, with which every bearing comes to its shoulder."""


@dataclass(frozen=True)
class Seat:
    """A cylinder with a fit; lengths in mm."""

    about: str
    size: float  # Diameter that the class is of
    drawn: float  # Diameter in the files
    fit: str  # Tolerance class; nothing where what is drawn lies outside it
    limits: Limits
    roughness: float  # Ra [µm]
    form: str  # Further demands, in words
    frames: tuple[Frame, ...] = ()  # Demands on its form, its place and the shoulder beside it
    letter: str = ""  # Of the datum its axis is
    mates: str = ""  # Kind of the bought part that sits there, if any
    from_axis: float = 0.0  # Distance of its own axis from the part's
    concave: bool = True  # True if material is outside, as around a bore


@dataclass(frozen=True)
class ThreadCallout:
    """Holes for screws; lengths in mm."""

    about: str
    screw: str  # Its size, such as M3
    made: str  # How it is come by
    hole: float
    depth: float
    length: float  # Of the thread, or of the insert
    frames: tuple[Frame, ...] = ()

    @property
    def designation(self) -> str:
        """Thread, its length, its hole and that one's depth, as ISO 6410-1 writes them; of other screws in words."""
        hole = f"⌀{figure(self.hole)} × {figure(self.depth)}"
        if self.made == TAPPED:
            return f"{self.screw}-6H × {figure(self.length)} / {hole}"
        return f"{hole} for {self.screw}, {self.made}"


@dataclass(frozen=True)
class ClearanceHole:
    """Holes that screws pass through; lengths in mm."""

    about: str
    diameter: float
    depth: float  # Of the hole; 0 where any hole of its diameter is meant
    frames: tuple[Frame, ...] = ()


@dataclass(frozen=True)
class DrawingRequirements:
    """Requirements of one part's drawing."""

    tolerances: str
    surface: str
    printed: bool
    notes: Sequence[str] = ()
    seats: Sequence[Seat] = ()
    threads: Sequence[ThreadCallout] = ()
    clearance_holes: Sequence[ClearanceHole] = ()
    general: tuple[Frame, ...] = ()  # Tolerance of every face without one of its own: ISO 22081
    placed: bool = True
    """Whether places from the joint's axis are given: not of what is bought, and put where the assembly's note says."""
    foot_fillet: float = 0.0  # Of its bosses, which begin below it [mm]

    def clearance_hole(self, hole: Cylinder) -> ClearanceHole | None:
        """Return the row of a hole for a screw; None if it is for none."""
        wide, deep = 2.0 * hole.radius, hole.top - hole.bottom
        for row in self.clearance_holes:
            if hole.concave and abs(row.diameter - wide) < _SAME and (not row.depth or abs(row.depth - deep) < _SAME):
                return row
        return None

    def seat(self, face: Cylinder) -> Seat | None:
        """Return the seat that a round face is, if any: of its diameter, at its distance from the axis, a bore or a
        journal."""
        away = hypot(face.x, face.y)
        for seat in self.seats:
            same_size = abs(seat.drawn - 2.0 * face.radius) < _SAME
            if same_size and abs(seat.from_axis - away) < _SAME and seat.concave == face.concave:
                return seat
        return None

    def thread(self, hole: Cylinder) -> ThreadCallout | None:
        """Return the thread cut in a hole, if any: other holes of its diameter have another depth."""
        deep = hole.top - hole.bottom
        for row in self.threads if hole.concave else ():
            if abs(row.hole - 2.0 * hole.radius) < _SAME and abs(row.depth - deep) < _SAME:
                return row
        return None


def drawing_requirements(kind: str, dims: Dimensions, choices: Mapping[str, Any]) -> DrawingRequirements:
    """Return what the drawing of a kind of part asks for, by the module's process."""
    reported, method = requirements_data(), choices["making_method"]
    seats = [
        seat for seat in reported["seats"].get(kind, ())
        if _is_there(seat, dims) and (method == "milled" or seat.get("printed"))
    ]  # fmt: skip
    threads = [thread for thread in reported["threads"].get(kind, ()) if _is_there(thread, dims)]
    holes = [hole for hole in reported["clearance_holes"].get(kind, ()) if _is_there(hole, dims)]
    general = _of_kind(kind, dims) or reported["general"][method]
    is_milled = method == "milled" and kind not in reported["of_kind"]
    return DrawingRequirements(
        tolerances=general["tolerances"],
        surface=general["surface"],
        notes=[
            general["edges"],
            *([_PROFILE.format(half=0.5 * float(general["profile"]))] if is_milled else []),
            *([_BEARINGS] if is_milled and any("bearing" in seat for seat in seats) else []),
            *([_POINTS.format(angle=degrees(dims.drill_point_angle))] if is_milled and threads else []),
            *([_EASED_SEATS] if not is_milled and any(seat["printed"] is not True for seat in seats) else []),
            *([_FEET.format(radius=figure(dims.foot_fillet))] if kind == "rotor" else []),
            *_remarks(kind, dims, choices),
        ],
        printed=method == "printed" and kind not in reported["of_kind"],
        seats=[
            _seat(seat if is_milled else _as_printed(seat), dims, DATUM if index == 0 and "radius" in seat else "")
            for index, seat in enumerate(seats)
        ],
        threads=[_thread(thread, dims, is_milled) for thread in threads],
        clearance_holes=[_clearance_hole(hole, dims, is_milled) for hole in holes],
        general=(Frame("profile", general["profile"], GROUND + DATUM),) if is_milled else (),
        placed=general.get("placed", True),
        foot_fillet=dims.foot_fillet if kind == "rotor" else 0.0,
    )


def _of_kind(kind: str, dims: Dimensions) -> dict[str, Any]:
    """Return the requirements of a part that the module's process does not make, or that is bought as it is."""
    general: dict[str, Any] = requirements_data()["of_kind"].get(kind, {})
    whole = general.get("whole")
    return general | whole if whole and getattr(dims, whole["where"]) else general


def _clearance_hole(reported: Mapping[str, Any], dims: Dimensions, is_milled: bool) -> ClearanceHole:
    """Return a hole for a screw to pass, distinguished by its depth from others of its diameter where it has to be."""
    depth = getattr(dims, reported["depth"]) - getattr(dims, reported["less"]) if "depth" in reported else 0.0
    diameter = getattr(dims, reported["hole"])
    return ClearanceHole(reported["about"], diameter, depth, _place(reported, dims, is_milled))


def _place(reported: Mapping[str, Any], dims: Dimensions, is_milled: bool) -> tuple[Frame, ...]:
    """Return the position of milled screw holes: a screw may be off by half the play of its hole in either part.

    The tapped hole may stand half of its zone off its place, the other hole half of its own the other way: zones as
    wide as half of the play (hole less screw) each use all of it up.
    """
    if not is_milled or "clearance" not in reported:
        return ()
    play = getattr(dims, reported["clearance"]) - getattr(dims, reported["screw"])
    zone = _ZONE * floor(0.5 * play / _ZONE + 1e-6)
    return (Frame("position", f"⌀{figure(zone)}", f"{GROUND}{DATUM}"),) if zone > 0.0 else ()


def _remarks(kind: str, dims: Dimensions, choices: Mapping[str, Any]) -> list[str]:
    """Return further remarks on a kind of part, for the choices of its design."""
    written = requirements_data()["remarks"].get(kind, ())
    sizes = _remarked_sizes(dims) if written else {}
    return [
        remark["text"].format_map(sizes) for remark in written
        if remark.get("mode", dims.mode) == dims.mode and _is_there(remark, dims)
        and all(choices.get(name) == word for name, word in remark.get("choices", {}).items())
    ]  # fmt: skip


def _remarked_sizes(dims: Dimensions) -> dict[str, str]:
    """Return the sizes that remarks name, as figures [mm]."""
    sizes = {"slip": dims.slip_clearance}
    if dims.spigot_depth:
        sizes |= {"wide": dims.spigot_width, "mouth": dims.spigot_width - dims.slip_clearance}
        sizes |= {"deep": dims.spigot_depth, "long": 2.0 * dims.spigot_reach, "angle": degrees(dims.spigot_angle)}
    if dims.spring_count:
        sizes["tang_hole"] = dims.wire_diameter + 2.0 * dims.tang_clearance
        sizes["leg_radius"] = dims.stop_contact_radius
        sizes["leg_width"] = dims.stop_contact_radius * dims.stop_angle - dims.slip_clearance
    words = {"off": f"{0.5 * dims.slip_clearance:.2g}"}
    if dims.mode == "shear" and dims.spreader_depth:
        sizes["fill"] = dims.heater_adhesive_gap_fill
        near, far = dims.slip_clearance, sizes["fill"] - requirements_data()["of_kind"]["spreader"]["less"]
        inner, outer = dims.pcl_inner_radius, dims.pcl_outer_radius
        for side, ends in (("inner", (inner - far, inner - near)), ("outer", (outer + near, outer + far))):
            words[side] = " to ".join(f"R{figure(end)}" for end in ends)
    return {name: figure(size) for name, size in sizes.items()} | words


def _is_there(reported: Mapping[str, Any], dims: Dimensions) -> bool:
    """Return whether the module has a seat or a thread."""
    where, unless = reported.get("where", ()), reported.get("unless", ())
    return all(getattr(dims, row) for row in _rows(where)) and not any(getattr(dims, row) for row in _rows(unless))


def _rows(reported: str | Sequence[str]) -> Sequence[str]:
    return [reported] if isinstance(reported, str) else reported


def _as_printed(reported: Mapping[str, Any]) -> dict[str, Any]:
    """Return what a printed seat asks for: a class of its own about the size as drawn, and no frames of bearings."""
    if reported["printed"] is True:
        return dict(reported)
    left = {name: value for name, value in reported.items() if name not in ("gap", "bearing")}
    tool = "reamed" if reported["printed"][0].isupper() else "turned"  # a hole, or a shaft
    return left | {"class": reported["printed"], "roughness": _EASED, "form": f"{tool} or eased to size"}


def _seat(reported: Mapping[str, Any], dims: Dimensions, letter: str) -> Seat:
    """Return a seat with its fit, or as it is drawn where its study has another gap than the fit."""
    drawn = getattr(dims, reported["diameter"]) if "diameter" in reported else 2.0 * getattr(dims, reported["radius"])
    drawn += 2.0 * getattr(dims, reported["plus"]) if "plus" in reported else 0.0
    inside = reported["class"][0].isupper()
    gap = 2.0 * getattr(dims, reported["gap"]) if "gap" in reported else 0.0
    size, fit = drawn - gap if inside else drawn + gap, reported["class"]
    limits = limit_deviations(fit, size)
    if not limits.lower - _SAME <= drawn - size <= limits.upper + _SAME:
        size, fit, limits = drawn, "", Limits(0.0, 0.0)
    frames = [Frame(*map(str, frame)) for frame in reported.get("frames", ())]
    if "bearing" in reported:
        # Within IT5, as catalogues ask. Both seats lie in one zone as wide (CZ, ISO 5458; assumed): they are coaxial,
        # though cut from two sides.
        grade = standard_tolerance(5, size)
        frames = [
            Frame("cylindrical", f"{0.5 * grade:.4g}"), Frame("run-out", f"{grade:.4g}", DATUM),
            Frame("position", f"⌀{grade:.4g} CZ"),
        ]  # fmt: skip
    play = f"play {figure(2.0 * getattr(dims, reported['play']))}" if "play" in reported else ""
    form = "; ".join(filter(None, (reported.get("form", ""), play)))
    return Seat(
        reported["about"], size, drawn, fit, limits, reported["roughness"], form, tuple(frames), letter,
        reported.get("mates", ""), getattr(dims, reported["circle"]) if "circle" in reported else 0.0, inside,
    )  # fmt: skip


def _thread(reported: Mapping[str, Any], dims: Dimensions, is_milled: bool) -> ThreadCallout:
    """Return a thread: tapped, cut by its screw in plastic, or that of an insert."""
    depth = getattr(dims, reported["depth"])
    length = depth - (getattr(dims, reported["runout"]) if "runout" in reported else 0.0)
    insert = getattr(dims, reported["insert"]) if "insert" in reported else 0.0
    made = "insert melted in" if insert else TAPPED if is_milled else "cut by its screw"
    screw = f"M{getattr(dims, reported['screw']):g}"
    frames = _place(reported, dims, is_milled)
    hole = getattr(dims, reported["hole"])
    return ThreadCallout(reported["about"], screw, made, hole, depth, insert or length, frames)
