"""A design: the plain data that a solved study becomes, and from which parts and reports are made."""

from __future__ import annotations

import json
import os
from pathlib import Path
from typing import Any

from pydantic import BaseModel, ConfigDict, Field, ValidationError, model_validator

from tvimdesign.base.atomic_files import atomic_write
from tvimdesign.base.errors import InputError
from tvimdesign.catalog import Catalog
from tvimdesign.study.text.mistakes import At, Mistakes
from tvimdesign.study.text.named_file import ordinary_bytes, printable
from tvimdesign.study.text.renamed import renamed_plain, with_later_choices

MAX_BYTES = 10_000_000


class Design(BaseModel):
    """One module with all its numbers, in SI, by the names of the table."""

    model_config = ConfigDict(frozen=True, extra="forbid", ser_json_inf_nan="strings")

    tvimdesign: str
    """Version that wrote it."""
    name: str
    mode: str
    status: str
    """`evaluated`, `optimal`, `above_rating` (the optimum, beyond a rating that the study does not accept),
    `below_yield` (a design that fewer modules keep than the study asks, as far as the search came), or why not."""
    above_rating: tuple[str, ...] = ()
    """Quantities beyond their rating that the study does not accept."""
    accepting: tuple[str, ...] = ()
    """Quantities beyond their rating that the study accepts."""
    choices: dict[str, str]
    """Chosen records and options by row name."""
    values: dict[str, float]
    """Every input and output by full name (`row` or `row@point`), SI."""
    intervals: dict[str, tuple[float, float]] = Field(default_factory=dict)
    """Least and largest value of what a point in the melting range leaves open; `values` has it as heated, nominal."""
    study: dict[str, Any]
    """The study it answers, resolved."""
    current_profiles: dict[str, Any] = Field(default_factory=dict)
    """Currents that are not constant, by phase: `duration` [s] and `currents` [A] at evenly spaced moments."""
    solution: dict[str, Any] = Field(default_factory=dict)
    """How it was found: starts, iterations, constraints with multipliers. Empty for an evaluation."""

    @model_validator(mode="before")
    @classmethod
    def _with_new_names(cls, data: Any) -> Any:
        """What an earlier release wrote, by the names of today."""
        kept = {"name": data["name"]} if isinstance(data, dict) and "name" in data else {}
        return {**with_later_choices(renamed_plain(data)), **kept} if isinstance(data, dict) else data

    @property
    def rating_notes(self) -> list[str]:
        """What is to be said wherever the design is used: the ratings it is beyond, accepted or not."""
        said = {"not accepted by its study": self.above_rating, "as its study accepts": self.accepting}
        return [f"The design is beyond its rating, {how}: {', '.join(names)}." for how, names in said.items() if names]

    def value(self, name: str) -> float:
        """SI value of a row; raises InputError for a name the design does not have."""
        if name not in self.values:
            raise InputError(f"the design {self.name!r} has no value {name!r}")
        return self.values[name]


def catalog_of(design: Design) -> Catalog:
    """The catalogue a design was found with; raises CatalogError where the folder its study names is not here."""
    folder = design.study.get("catalog_folder")
    return Catalog(Path(folder) if folder else None)


def design_json(design: Design) -> bytes:
    """A design as it is written; what never happens is the word Infinity, which JSON has no number for."""
    return design.model_dump_json(indent=2).encode() + b"\n"


def write_design(design: Design, path: Path) -> Path:
    """Write a design as JSON, whole or not at all; returns the path."""
    atomic_write(path, design_json(design))
    return path


def read_design(path: str | os.PathLike[str]) -> Design:
    """Read a design; raises StudyError with all that is wrong with it, InputError where there is no such file."""
    from tvimdesign.study.design_checks import check_design, check_form, stop

    path = Path(path)
    shown = printable(path)
    try:
        data = ordinary_bytes(path, MAX_BYTES, _WANTED, lambda _: _too_big(shown))
    except FileNotFoundError:
        raise InputError(f"{shown}: no such file; `tvimdesign run` writes a design.json") from None
    problems = Mistakes(shown)
    plain, version = _plain(data, problems), None
    if plain is not None:
        version = plain.get("tvimdesign")
        try:
            check_design(design := Design.model_validate(plain), problems)
        except ValidationError as error:
            check_form(error, plain, problems)
    stop(problems, data, version)
    return design


def _plain(data: bytes, problems: Mistakes) -> dict[str, Any] | None:
    """The JSON object of a file, None (and a problem) where it is none."""
    try:
        plain = json.loads(data)
    except (ValueError, RecursionError) as error:
        problems.add(At(0, 0), "", f"is not {_WANTED}: {error}")
        return None
    if not isinstance(plain, dict):
        problems.add(At(0, 0), "", f"is not {_WANTED}: it holds no JSON object")
        return None
    return plain


_WANTED = "a design.json that `tvimdesign run` wrote"


def _too_big(shown: str) -> InputError:
    return InputError(f"{shown} has more than {MAX_BYTES} bytes; give the path of {_WANTED}, a few tens of kilobytes")
