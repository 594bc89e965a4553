"""What a drawing asks of a workshop beyond shape: fits of the seats by ISO 286, surfaces, edges and threads."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

import yaml

from tvimdesign.cad.drawing.iso_286 import Limits, limit_deviations, standard_tolerance
from tvimdesign.cad.geometry.dimensions import Dimensions
from tvimdesign.cad.geometry.features import Cylinder

_DATA = Path(__file__).with_name("drawing_requirements.yaml")
_SAME = 1e-5
"""Lengths [mm] that differ by less are one."""
DATUM = "B"
"""Letter of the datum; A is the section's."""
_BEARINGS = "At bearings: /○/ of the seat, ↗ of the shoulder; its fillet R 0.1 at most."
"""0.1 mm is the least chamfer of the rings in the catalogue, with which every bearing comes to its shoulder."""


@dataclass(frozen=True)
class Seat:
    """A cylinder with a fit; lengths in mm."""

    about: str
    size: float
    """Diameter that the class is of."""
    drawn: float
    """Diameter in the files."""
    fit: str
    """Tolerance class; nothing where what is drawn lies outside it."""
    limits: Limits
    roughness: float
    """Ra [µm]."""
    form: str
    """What is asked of its form and of the shoulder beside it, in words."""
    letter: str = ""
    """Of the datum its axis is."""


@dataclass(frozen=True)
class ThreadCallout:
    """Holes for screws; lengths in mm."""

    about: str
    screw: str
    """Its size, such as M3."""
    made: str
    """How it is come by."""
    hole: float
    depth: float
    length: float
    """Of the thread, or of the insert."""


@dataclass(frozen=True)
class DrawingRequirements:
    """What one part's drawing asks for."""

    tolerances: str
    surface: str
    printed: bool
    notes: Sequence[str] = ()
    seats: Sequence[Seat] = ()
    threads: Sequence[ThreadCallout] = ()

    def seat(self, diameter: float) -> Seat | None:
        """The seat that is drawn with a diameter, if any."""
        return next((one for one in self.seats if abs(one.drawn - diameter) < _SAME), None)

    def thread(self, hole: Cylinder) -> ThreadCallout | None:
        """What is cut in a hole, if anything: other holes of its diameter have another depth."""
        deep = hole.top - hole.bottom
        from_template = [
            one for one in self.threads if abs(one.hole - 2.0 * hole.radius) < _SAME and abs(one.depth - deep) < _SAME
        ]
        return from_template[0] if from_template and hole.concave else None


def drawing_requirements(kind: str, dims: Dimensions, choices: Mapping[str, Any]) -> DrawingRequirements:
    """What the drawing of a kind of part asks for, by the module's process."""
    reported, method = _told(), choices["making_method"]
    seats = [
        one for one in reported["seats"].get(kind, ())
        if _is_there(one, dims) and (method == "milled" or one.get("printed"))
    ]  # fmt: skip
    threads = [one for one in reported["threads"].get(kind, ()) if _is_there(one, dims)]
    general = reported["general"][method]
    return DrawingRequirements(
        tolerances=general["tolerances"],
        surface=general["surface"],
        notes=[
            general["edges"],
            *([_BEARINGS] if any("bearing" in one for one in seats) else []),
            *_remarks(kind, dims, choices),
        ],
        printed=method == "printed",
        seats=[_seat(one, dims, DATUM if index == 0 and "radius" in one else "") for index, one in enumerate(seats)],
        threads=[_thread(one, dims, method) for one in threads],
    )


def _remarks(kind: str, dims: Dimensions, choices: Mapping[str, Any]) -> list[str]:
    """What else is said of a kind of part, for the choices of its design."""
    tang_hole = dims.wire_diameter + 2.0 * dims.tang_clearance
    written = _told()["remarks"].get(kind, ())
    return [
        one["text"].format(tang_hole=tang_hole) for one in written
        if all(choices.get(name) == word for name, word in one["choices"].items())
    ]  # fmt: skip


def _is_there(reported: Mapping[str, Any], dims: Dimensions) -> bool:
    """Whether the module has a seat or a thread."""
    return not ("where" in reported and not getattr(dims, reported["where"])) and not (
        "unless" in reported and getattr(dims, reported["unless"])
    )


def _seat(reported: Mapping[str, Any], dims: Dimensions, letter: str) -> Seat:
    """A seat with its fit, or as it is drawn where its study has another gap than the fit."""
    drawn = getattr(dims, reported["diameter"]) if "diameter" in reported else 2.0 * getattr(dims, reported["radius"])
    inside = reported["class"][0].isupper()
    gap = 2.0 * getattr(dims, reported["gap"]) if "gap" in reported else 0.0
    size, fit = drawn - gap if inside else drawn + gap, reported["class"]
    limits = limit_deviations(fit, size)
    if not limits.lower - _SAME <= drawn - size <= limits.upper + _SAME:
        size, fit, limits = drawn, "", Limits(0.0, 0.0)
    form = _bearing_form(size) if "bearing" in reported else reported.get("form", "")
    return Seat(reported["about"], size, drawn, fit, limits, reported["roughness"], form, letter)


def _bearing_form(size: float) -> str:
    """Form of a bearing's seat: cylindrical within half of IT5, run-out of the shoulder IT5, as catalogues ask."""
    grade = standard_tolerance(5, size)
    return f"/○/ {0.5 * grade:.4g}  ↗ {grade:.4g} {DATUM}"


def _thread(reported: Mapping[str, Any], dims: Dimensions, method: str) -> ThreadCallout:
    """A thread: tapped, cut by its screw in plastic, or that of an insert."""
    depth = getattr(dims, reported["depth"])
    length = depth - (getattr(dims, reported["runout"]) if "runout" in reported else 0.0)
    insert = getattr(dims, reported["insert"]) if "insert" in reported else 0.0
    made = "insert melted in" if insert else "tapped 6H" if method == "milled" else "cut by its screw"
    screw = f"M{getattr(dims, reported['screw']):g}"
    return ThreadCallout(reported["about"], screw, made, getattr(dims, reported["hole"]), depth, insert or length)


@cache
def _told() -> dict[str, Any]:
    reported: dict[str, Any] = yaml.safe_load(_DATA.read_text(encoding="utf-8"))
    return reported
