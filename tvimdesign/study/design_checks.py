"""What is wrong with a design that was read: its form, its study by the reader of studies, its numbers and words."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import replace
from itertools import pairwise
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeGuard

from pydantic import ValidationError

from tvimdesign import __version__
from tvimdesign.base.units import format_quantity
from tvimdesign.device import MODES, Choice, Input, Table, table_for
from tvimdesign.study.reader import read_tree
from tvimdesign.study.study import Study
from tvimdesign.study.text.json_places import JsonPlaces
from tvimdesign.study.text.mistakes import At, Mistakes, StudyError, quoted, step
from tvimdesign.study.text.named_file import is_folder
from tvimdesign.study.text.values import below, limits
from tvimdesign.study.tree import tree_of_values
from tvimdesign.study.written_study import written

if TYPE_CHECKING:
    from tvimdesign.study.design import Design

ANEW = "write it anew with `tvimdesign run` from its study"
_NOWHERE = At(0, 0)


def check_form(error: ValidationError, data: Any, problems: Mistakes, path: str = "") -> None:
    """Note what pydantic says, once for each place: a value that may be of several kinds has a fault for each."""
    said: dict[str, str] = {}
    for fault in error.errors(include_url=False):
        if _of_the_other_kind(data, fault["loc"]):
            continue
        where = ".".join(filter(None, [path, *_inside(data, fault["loc"])]))
        message = "unknown name" if fault["type"] == "extra_forbidden" else fault["msg"]
        said[where] = message if where not in said else f"{said[where]}; or: {message}"
    for where, message in said.items():
        problems.add(_NOWHERE, where, message)


def _inside(data: Any, places: Iterable[str | int]) -> Iterator[str]:
    """The steps that lead into the data; pydantic puts the names of the kinds it tried between them."""
    for place in places:
        known = isinstance(data, Mapping) or (isinstance(data, list) and isinstance(place, int) and place < len(data))
        if known and not (isinstance(data, Mapping) and place not in data and place in _KINDS):
            data = data.get(place) if isinstance(data, Mapping) else data[int(place)]
            yield str(place) if len(str(place)) <= 64 and str(place).isprintable() else quoted(str(place))


_KINDS = {"float", "str", "Range", "Options"}


def _of_the_other_kind(data: Any, places: tuple[str | int, ...]) -> bool:
    """Whether a variable was tried as a list though it has the ends of a range, or the other way round."""
    for place in places:
        if place in ("Range", "Options"):
            return isinstance(data, Mapping) and ("lower" in data or "upper" in data) == (place == "Options")
        data = data.get(place) if isinstance(data, Mapping) else None
    return False


def check_design(design: Design, problems: Mistakes) -> None:
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
        problems.add(_NOWHERE, "values", f"has no {lacking[0]}{more}: another version wrote it; {ANEW}")
    _check_currents(design, table, problems)


def _study(design: Design, table: Table, problems: Mistakes) -> Study | None:
    """The design's study, read as one in a file is, where the records it was made with are here."""
    try:
        study = Study.model_validate(design.study)
    except ValidationError as error:
        check_form(error, design.study, problems, "study")
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
        problems.found += [replace(one, path=f"study.{one.path}") for one in error.problems]
    return study


def _check_choices(design: Design, table: Table, problems: Mistakes) -> None:
    for row in table.choices:
        word, path = design.choices.get(row.name), step("choices", row.name)
        if word is None:
            problems.add(_NOWHERE, "choices", f"has no {row.name}: another version wrote it; {ANEW}")
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
                problems.add(_NOWHERE, "values", f"has no {name}: another version wrote it; {ANEW}")
            elif not _within(row, value):
                problems.add(_NOWHERE, path, f"{format_quantity(value, row.unit)} is outside the limits", limits(row))


def _within(row: Input, value: float) -> bool:
    return not (math.isnan(value) or below(value, row.lower) or below(row.upper, value))


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


def stop(problems: Mistakes, data: bytes, version: object) -> None:
    """Raise what was found, if anything, each with its line; and that another version wrote it, where one did."""
    if not problems.found:
        return
    if isinstance(version, str) and version != __version__:
        said = f"another version wrote it: {quoted(version)}, this is {__version__}"
        problems.add(_NOWHERE, "tvimdesign", said, hint=ANEW)
    places = JsonPlaces(data)
    located = ((one, places.at(one.path)) for one in problems.found)
    problems.found = [replace(one, line=at.line, column=at.column) for one, at in located]
    problems.stop()
