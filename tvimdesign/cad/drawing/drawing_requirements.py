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

_TOLD = Path(__file__).with_name("drawing_requirements.yaml")
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
class Thread:
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
class Workmanship:
    """What one part's drawing asks for."""

    tolerances: str
    surface: str
    printed: bool
    notes: Sequence[str] = ()
    seats: Sequence[Seat] = ()
    threads: Sequence[Thread] = ()

    def seat(self, diameter: float) -> Seat | None:
        """The seat that is drawn with a diameter, if any."""
        return next((one for one in self.seats if abs(one.drawn - diameter) < _SAME), None)

    def thread(self, hole: Cylinder) -> Thread | None:
        """What is cut in a hole, if anything: other holes of its diameter have another depth."""
        deep = hole.top - hole.bottom
        alike = [
            one for one in self.threads if abs(one.hole - 2.0 * hole.radius) < _SAME and abs(one.depth - deep) < _SAME
        ]
        return alike[0] if alike and hole.concave else None


def workmanship(kind: str, dims: Dimensions, choices: Mapping[str, Any]) -> Workmanship:
    """What the drawing of a kind of part asks for, by the module's process."""
    told, method = _told(), choices["making_method"]
    seats = [one for one in told["seats"].get(kind, ()) if _is_there(one, dims)] if method == "milled" else []
    threads = [one for one in told["threads"].get(kind, ()) if _is_there(one, dims)]
    general = told["general"][method]
    return Workmanship(
        tolerances=general["tolerances"],
        surface=general["surface"],
        notes=[general["edges"], *([_BEARINGS] if any("bearing" in one for one in seats) else [])],
        printed=method == "printed",
        seats=[_seat(one, dims, "" if index else DATUM) for index, one in enumerate(seats)],
        threads=[_thread(one, dims, method) for one in threads],
    )


def _is_there(told: Mapping[str, Any], dims: Dimensions) -> bool:
    """Whether the module has a seat or a thread."""
    return not ("where" in told and not getattr(dims, told["where"])) and not (
        "unless" in told and getattr(dims, told["unless"])
    )


def _seat(told: Mapping[str, Any], dims: Dimensions, letter: str) -> Seat:
    """A seat with its fit, or as it is drawn where its study has another gap than the fit."""
    drawn = getattr(dims, told["diameter"]) if "diameter" in told else 2.0 * getattr(dims, told["radius"])
    inside = told["class"][0].isupper()
    gap = 2.0 * getattr(dims, told["gap"]) if "gap" in told else 0.0
    size, fit = drawn - gap if inside else drawn + gap, told["class"]
    limits = limit_deviations(fit, size)
    if not limits.lower - _SAME <= drawn - size <= limits.upper + _SAME:
        size, fit, limits = drawn, "", Limits(0.0, 0.0)
    form = _bearing_form(size) if "bearing" in told else told.get("form", "")
    return Seat(told["about"], size, drawn, fit, limits, told["roughness"], form, letter)


def _bearing_form(size: float) -> str:
    """Form of a bearing's seat: cylindrical within half of IT5, run-out of the shoulder IT5, as catalogues ask."""
    grade = standard_tolerance(5, size)
    return f"/○/ {0.5 * grade:.4g}  ↗ {grade:.4g} {DATUM}"


def _thread(told: Mapping[str, Any], dims: Dimensions, method: str) -> Thread:
    """A thread: tapped, cut by its screw in plastic, or that of an insert."""
    depth = getattr(dims, told["depth"])
    length = depth - (getattr(dims, told["runout"]) if "runout" in told else 0.0)
    insert = getattr(dims, told["insert"]) if "insert" in told else 0.0
    made = "insert melted in" if insert else "tapped 6H" if method == "milled" else "cut by its screw"
    screw = f"M{getattr(dims, told['screw']):g}"
    return Thread(told["about"], screw, made, getattr(dims, told["hole"]), depth, insert or length)


@cache
def _told() -> dict[str, Any]:
    told: dict[str, Any] = yaml.safe_load(_TOLD.read_text(encoding="utf-8"))
    return told
