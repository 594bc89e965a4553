"""A design: the plain data that a solved study becomes, from which parts and reports are made, and its file."""

import json
import math
import os
from collections.abc import Iterable, Iterator, Mapping
from contextlib import suppress
from dataclasses import replace
from itertools import pairwise
from pathlib import Path
from typing import Any, TypeGuard

import yaml
from pydantic import BaseModel, ConfigDict, Field, ValidationError

from tvimdesign import __version__
from tvimdesign.base.atomic_files import atomic_write
from tvimdesign.base.errors import InputError
from tvimdesign.base.units import format_quantity
from tvimdesign.catalog import Catalog
from tvimdesign.device import MODES, Choice, Input, Table, table_for
from tvimdesign.study.reader import read_tree
from tvimdesign.study.sections import written
from tvimdesign.study.study import Study
from tvimdesign.study.text.mistakes import At, Mistakes, StudyError, is_folder, ordinary_bytes, printable, quoted, step
from tvimdesign.study.text.values import below, limits
from tvimdesign.study.text.yaml_text import LOADER, place_of
from tvimdesign.study.tree import tree_of_values

MAX_BYTES = 10_000_000
_AGAIN = "write it anew with `tvimdesign run` from its study"
_NOWHERE = At(0, 0)


_NEAR = 0.9  # Share of the supply's voltage from which a heater needs no other voltage


class Design(BaseModel):
    """One module with all its numbers, in SI, by the names of the table."""

    model_config = ConfigDict(frozen=True, extra="forbid", ser_json_inf_nan="strings")

    tvimdesign: str  # Version that wrote it
    name: str
    mode: str
    status: str
    """`evaluated`, `optimal`, `above_rating` (the optimum, beyond a rating that the study does not accept),
    `below_yield` (a design that fewer modules keep than the study asks, as far as the search came), or why not."""
    above_rating: tuple[str, ...] = ()  # Quantities beyond their rating that the study does not accept
    accepting: tuple[str, ...] = ()  # Quantities beyond their rating that the study accepts
    choices: dict[str, str]  # Chosen records and options by row name
    values: dict[str, float]  # Every input and output by full name (`row` or `row@point`), SI
    intervals: dict[str, tuple[float, float]] = Field(default_factory=dict)
    """Least and largest value of what a point in the melting range leaves open; `values` has it as heated, nominal."""
    study: dict[str, Any]  # The study it answers, resolved
    current_profiles: dict[str, Any] = Field(default_factory=dict)
    """Currents that are not constant, by phase: `duration` [s] and `currents` [A] at evenly spaced moments."""
    solution: dict[str, Any] = Field(default_factory=dict)
    """How it was found: starts, iterations, constraints with multipliers. Empty for an evaluation."""

    @property
    def table(self) -> Table:
        """The quantities of the design's mode."""
        return table_for(self.mode)

    @property
    def rating_notes(self) -> list[str]:
        """Sentences on the ratings that the design exceeds, accepted or not."""
        groups = {"not accepted by its study": self.above_rating, "as its study accepts": self.accepting}
        return [
            f"The design is beyond its rating, {how}: {', '.join(names)}." for how, names in groups.items() if names
        ]

    @property
    def supply_voltage(self) -> float | None:
        """Voltage [V] that the study gives the heaters at most, where a driver must step it down; else None."""
        limits = [limit["limit"] for limit in self.study.get("require", ()) if limit["output"] == "peak_voltage"]
        peak = self.values.get("peak_voltage", math.inf)
        return min(limits) if limits and peak < _NEAR * min(limits) else None

    def value(self, name: str) -> float:
        """SI value of a row; raises InputError for a name the design does not have."""
        if name not in self.values:
            raise InputError(f"the design {self.name!r} has no value {name!r}")
        return self.values[name]


def catalog_of(design: Design) -> Catalog:
    """Return the catalogue of a design; raises CatalogError if the folder that its study names is missing."""
    folder = design.study.get("catalog_folder")
    return Catalog(Path(folder) if folder else None)


def design_json(design: Design) -> bytes:
    """Return a design as JSON; infinity, for which JSON has no number, is the text Infinity."""
    return design.model_dump_json(indent=2).encode() + b"\n"


def write_design(design: Design, path: Path) -> Path:
    """Write a design as JSON, whole or not at all; returns the path."""
    atomic_write(path, design_json(design))
    return path


def read_design(path: str | os.PathLike[str]) -> Design:
    """Read a design from its file.

    Parameters
    ----------
    path
        A `design.json` that `tvimdesign run` wrote.

    Returns
    -------
    Design
        The design, whose study, choices and values have been checked.

    Raises
    ------
    StudyError
        With every mistake in the file and its line.
    InputError
        If there is no such file, or it cannot be read.
    """
    path = Path(path)
    shown = printable(path)
    too_big = f"{shown} has more than {MAX_BYTES} bytes; give the path of {_WANTED}, a few tens of kilobytes"
    try:
        data = ordinary_bytes(path, MAX_BYTES, _WANTED, lambda _: InputError(too_big))
    except FileNotFoundError:
        raise InputError(f"{shown}: no such file; `tvimdesign run` writes a design.json") from None
    problems = Mistakes(shown)
    plain, version = _plain(data, problems), None
    if plain is not None:
        version = plain.get("tvimdesign")
        try:
            _check_design(design := Design.model_validate(plain), problems)
        except ValidationError as error:
            _check_form(error, plain, problems)
    _stop(problems, data, version)
    return design


def _plain(data: bytes, problems: Mistakes) -> dict[str, Any] | None:
    """Return the JSON object of a file, or None with a problem noted."""
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


def _check_form(error: ValidationError, data: Any, problems: Mistakes, path: str = "") -> None:
    """Note what pydantic says, once for each place: a value that may be of several kinds has a fault for each."""
    messages: dict[str, str] = {}
    for fault in error.errors(include_url=False):
        where = ".".join(filter(None, [path, *_inside(data, fault["loc"])]))
        message = "unknown name" if fault["type"] == "extra_forbidden" else fault["msg"]
        messages[where] = message if where not in messages else f"{messages[where]}; or: {message}"
    for where, message in messages.items():
        problems.add(_NOWHERE, where, message)


def _inside(data: Any, places: Iterable[str | int]) -> Iterator[str]:
    """Yield the steps that lead into the data, without the type names that pydantic puts between them."""
    for place in places:
        known = isinstance(data, Mapping) or (isinstance(data, list) and isinstance(place, int) and place < len(data))
        if known and not (isinstance(data, Mapping) and place not in data and place in _KINDS):
            data = data.get(place) if isinstance(data, Mapping) else data[int(place)]
            yield str(place) if len(str(place)) <= 64 and str(place).isprintable() else quoted(str(place))


_KINDS = {"float", "str", "Range", "Options"}


def _check_design(design: Design, problems: Mistakes) -> None:
    """Note everything that keeps a design from being tested, toleranced or made into parts."""
    if design.mode not in MODES:
        problems.unknown(_NOWHERE, "mode", f"mode: {quoted(design.mode)}", design.mode, MODES)
        return
    table = table_for(design.mode)
    study = _study(design, table, problems)
    _check_choices(design, table, problems)
    points = tuple(study.operating_points) if study else ()
    _check_inputs(design, table, points, problems)
    lacking = [name for name in table.names(points) if name not in design.values]
    if lacking:
        more = f" and {len(lacking) - 1} more" if len(lacking) > 1 else ""
        problems.add(_NOWHERE, "values", f"has no {lacking[0]}{more}: another version wrote it; {_AGAIN}")
    _check_currents(design, table, problems)


def _study(design: Design, table: Table, problems: Mistakes) -> Study | None:
    """Read the design's study as a file is read, if its records are here."""
    try:
        study = Study.model_validate(design.study)
    except ValidationError as error:
        _check_form(error, design.study, problems, "study")
        return None
    if study.mode != design.mode:
        problems.add(_NOWHERE, "study.mode", f"is {quoted(study.mode)}, the design's mode is {design.mode}")
        return None
    for name, value in study.module.items():
        if isinstance(value, str) and isinstance(table.by_name.get(name), Input):
            problems.add(_NOWHERE, step("study.module", name), f"is the text {quoted(value)}", "a number, in SI")
    unknown = [name for name in (*study.module, *study.vary) if name not in table.by_name]
    unknown += [limit.output for limit in study.require if limit.output.partition("@")[0] not in table.by_name]
    unknown += [name for point in study.operating_points.values() for name in point if name not in table.by_name]
    unknown += [name for name in study.tolerances if name.partition("@")[0] not in table.by_name]
    for name in unknown:
        problems.unknown(_NOWHERE, "study", f"name: {quoted(name)}", name, table.by_name)
    if unknown or (study.catalog_folder and not is_folder(Path(study.catalog_folder))):
        return study
    try:
        read_tree(tree_of_values(written(study), problems.file, Path()))
    except StudyError as error:
        problems.items += [replace(mistake, path=f"study.{mistake.path}") for mistake in error.problems]
    return study


def _check_choices(design: Design, table: Table, problems: Mistakes) -> None:
    for row in table.choices:
        word, path = design.choices.get(row.name), step("choices", row.name)
        if word is None:
            problems.add(_NOWHERE, "choices", f"has no {row.name}: another version wrote it; {_AGAIN}")
        elif not row.category and word not in row.options:
            problems.unknown(_NOWHERE, path, f"option: {quoted(word)}", word, row.options)
    for name in design.choices:
        if not isinstance(table.by_name.get(name), Choice):
            known = [row.name for row in table.choices]
            problems.unknown(_NOWHERE, "choices", f"choice: {quoted(name)}", name, known)


def _check_inputs(design: Design, table: Table, points: Iterable[str], problems: Mistakes) -> None:
    """Note the inputs of the design that are missing, or not within the limits of their rows."""
    for row in table.inputs:
        for name in [f"{row.name}@{point}" for point in points] if row.per_point else [row.name]:
            value, path = design.values.get(name), step("values", name)
            if value is None:
                problems.add(_NOWHERE, "values", f"has no {name}: another version wrote it; {_AGAIN}")
            elif math.isnan(value) or below(value, row.lower) or below(row.upper, value):
                problems.add(_NOWHERE, path, f"{format_quantity(value, row.unit)} is outside the limits", limits(row))


def _check_currents(design: Design, table: Table, problems: Mistakes) -> None:
    """Note current profiles that are of no phase, or no series of rising moments [s] with a current [A] at each."""
    phases = [phase.name for phase in table.phases]
    for name, plain in design.current_profiles.items():
        path = step("current_profiles", name)
        if name not in phases:
            problems.unknown(_NOWHERE, "current_profiles", f"phase: {quoted(name)}", name, phases)
            continue
        moments, currents = (plain.get(key) if isinstance(plain, dict) else None for key in ("moments", "currents"))
        if not (_numbers(moments) and _numbers(currents)):
            problems.add(_NOWHERE, path, "is no profile", "lists of numbers: moments [s] and currents [A]")
        elif not (len(moments) == len(currents) > 1 and all(a <= b for a, b in pairwise(moments))):
            problems.add(_NOWHERE, path, "is no profile", "as many currents as moments, and moments that rise")


def _numbers(data: Any) -> TypeGuard[list[float]]:
    return isinstance(data, list) and all(isinstance(number, int | float) for number in data)


def _stop(problems: Mistakes, data: bytes, version: object) -> None:
    """Raise what was found, if anything, each with its line; and that another version wrote it, where one did."""
    if not problems.items:
        return
    if isinstance(version, str) and version != __version__:
        message = f"another version wrote it: {quoted(version)}, this is {__version__}"
        problems.add(_NOWHERE, "tvimdesign", message, hint=_AGAIN)
    root = json_root(data)
    located = ((mistake, place_of(root, mistake.path)) for mistake in problems.items)
    problems.items = [replace(mistake, line=at.line, column=at.column) for mistake, at in located]
    problems.stop()


def json_root(data: bytes) -> Any:
    """Return the YAML node of a JSON file, which knows its lines; None of a broken file."""
    with suppress(ValueError, RecursionError, yaml.YAMLError):
        text = data.decode(json.detect_encoding(data), "surrogatepass")
        json.loads(text)
        return yaml.compose(text, Loader=LOADER)
    return None
