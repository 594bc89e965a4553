"""State of an explorer: changes to a study, values of the controls, pinned designs, and the history for undo."""

import hashlib
import json
import math
import os
from collections import Counter
from collections.abc import Mapping
from contextlib import suppress
from pathlib import Path
from typing import Any

from pydantic import BaseModel, ConfigDict, ValidationError

from tvimdesign.base.atomic_files import atomic_write, digest_of, free_name, is_as_written
from tvimdesign.base.errors import InputError, UnitError
from tvimdesign.base.record import plain_data
from tvimdesign.base.units import from_si, parse_quantity, pretty
from tvimdesign.device import Choice, Input
from tvimdesign.explore.messages import Change, SetLimits, SetRange, SetValue, Way
from tvimdesign.report.output.numbers import label
from tvimdesign.study import (
    Options,
    Range,
    Study,
    StudyTree,
    given,
    node_of,
    read_tree,
    tree_of_text,
    tree_yaml,
    with_value,
    words_of,
)
from tvimdesign.study.text.mistakes import Mistakes
from tvimdesign.study.text.values import exactly
from tvimdesign.study.text.yaml_text import Text

SOURCE = "explore"  # Name in messages of the place of a change
DIGITS = 12  # Digits of a text to edit, in which an angle in degrees is the same angle again
_OF_SEARCHES = ("robust", "profile")
_OF_FILES = ("tvimdesign", "mode", "catalog")  # left as they are by a sized study


class _Part(BaseModel):
    model_config = ConfigDict(frozen=True, extra="forbid")


class State(_Part):
    """All that undo goes back over."""

    way: Way
    changes: dict[str, Any] = {}  # Values as a study has them, by their path in it
    at: dict[str, str] = {}  # The variables of the module under the hand, by name, as text


class Pinned(_Part):
    """A design kept to be held beside others: its state, and what was shown of it."""

    name: str
    state: State
    values: dict[str, str]  # Texts with units, by the quantity's full name


def tree_of(base: StudyTree, state: State, way: Way | None = None) -> StudyTree:
    """Return the study of a state: with free variables, or (to evaluate) with the controls' values."""
    tree = set_values(base, state.changes)
    if (way or state.way) == "optimize":
        return tree
    tree = set_values(tree, {name: None for name in _OF_SEARCHES if tree.section(name) is not None})
    return set_values(tree, state.at)


def set_values(tree: StudyTree, values: Mapping[str, Any]) -> StudyTree:
    """Return a tree with values set, by their path; None removes one."""
    for path, value in values.items():
        problems = Mistakes(SOURCE)
        tree = with_value(tree, path, node_of(value, SOURCE, problems), SOURCE, tuple(problems.items))
    return tree


def changed(base: StudyTree, state: State, change: Change, study: Study) -> State:
    """Return the state after a change, which the reader of studies checks. Raises StudyError and InputError.

    `study` is the one of the state, with what varies free.
    """
    if isinstance(change, SetValue) and not change.text.strip():
        raise InputError(f"{change.name}: no value; type one with its unit")
    ways: tuple[Way, ...] = ("evaluate", "optimize")
    if isinstance(change, SetValue) and change.name in study.vary:
        after = state.model_copy(update={"at": {**state.at, change.name: change.text}})
        ways = ("evaluate",)  # what is free to move is not in the other's study
    else:
        path, value = _path_and_value(change, study)
        after = state.model_copy(update={"changes": {**state.changes, path: value}})
    for way in ways:
        read_tree(tree_of(base, after, way), lambda _: study.table, lambda _: study.catalog)
    return after


def _path_and_value(change: Change, study: Study) -> tuple[str, Any]:
    """Return path and value of a change in a study. Raises InputError for a name without a control."""
    if isinstance(change, SetLimits):
        return f"require.{change.name}", list(change.texts) or None
    if isinstance(change, SetRange):
        if change.name not in study.vary:
            raise InputError(f"{change.name}: the study does not vary it; name one of: {', '.join(study.vary)}")
        return f"vary.{change.name}", {"from": change.low, "to": change.high, **_start_within(change, study)}
    if isinstance(change, SetValue):
        base, _, point = change.name.partition("@")
        return (f"operating_points.{point}.{base}" if point else _in_module(base, study)), change.text
    return f"minimize.{change.name}", change.text


def _start_within(change: SetRange, study: Study) -> dict[str, str]:
    """Return the start of a search as the study has it, if the new range includes it."""
    vary, unit = study.vary[change.name], study.table.unit(change.name)
    if not isinstance(vary, Range) or vary.start is None:
        return {}
    try:
        low, high = (parse_quantity(text, unit) for text in (change.low, change.high))
    except UnitError:
        return {}  # the study's reader says what is wrong with them
    return {"start": exactly(vary.start, unit)} if low <= vary.start <= high else {}


def _in_module(name: str, study: Study) -> str:
    """Inputs and choices alone; sections, such as the folder of records, stay as the file has them."""
    known = {row.name for row in study.table.inputs} | {row.name for row in study.table.choices}
    if name not in known:
        raise InputError(f"{name}: no input or choice of this module; `tvimdesign rows --mode {study.mode}` lists them")
    return name


def beginning(study: Study, chosen: Mapping[str, Any] | None = None) -> dict[str, str]:
    """Texts of what a study varies: of a design that was found, or else the study's start."""
    values = {**given(study), **(chosen or {})}
    return {name: text_of(study, name, values[name]) for name in study.vary}


def sized_state(base: StudyTree, text: str) -> State:
    """Return the state that has the sections of a sized study in place of the base's own."""
    written = tree_of_text(text, SOURCE, SOURCE, base.folder)
    sections = {name: value for name, value in plain_data(text).items() if name not in _OF_FILES}
    gone = {name: None for name in base.root.entries if name not in {*_OF_FILES, *sections}}
    return State(way="optimize", changes={**gone, **sections}, at=beginning(read_tree(written)))


def text_of(study: Study, name: str, value: Any) -> str:
    """Write a value for a study, with all its digits."""
    if isinstance(value, int | float):
        return exactly(float(value), study.table.unit(name))
    return str(getattr(value, "name", value))


def saved_text(base: StudyTree, state: State, folder: Path) -> str:
    """Return the YAML of a state's study, with its folder of records as seen from the folder of the new file."""
    tree = tree_of(base, state)
    records = tree.section("catalog")
    if isinstance(records, Text) and records.value.strip():
        path = (base.folder / records.value.strip()).resolve()
        tree = set_values(tree, {"catalog": os.path.relpath(path, folder.resolve())})
    return tree_yaml(tree)


def refuse_other_folders(tree: StudyTree, study: Study) -> None:
    """Raise InputError where a study's records lie outside its own folder: an explorer reads no other files."""
    if study.catalog_folder is None:
        return
    folder, own = Path(study.catalog_folder).resolve(), tree.folder.resolve()
    if not folder.is_relative_to(own):
        raise InputError(
            f"catalog: {study.catalog_folder} lies outside the study's folder {own}, and the explorer reads no files "
            "there; copy the records beside the study"
        )


Shown = dict[str, Any]


def controls_shown(free: Study, fixed: Study, state: State) -> Shown:
    """Return every control; `free` is the study with free variables, `fixed` that of the module as set."""
    values = given(fixed)
    return {
        "variables": [_variable(name, free, state) for name in free.vary],
        "requirements": _requirements(free),
        "weights": [{"name": name, "label": label(name), "value": weight, "means": _means(free, name)}
                    for name, weight in free.minimize.items()],
        "choices": [_choice(row, fixed, values[row.name]) for row in free.table.choices if row.name not in free.vary],
        "inputs": _inputs(free, fixed, values),
    }  # fmt: skip


def _variable(name: str, free: Study, state: State) -> Shown:
    row, vary = free.table.quantity(name), free.vary[name]
    shown: Shown = {"name": name, "label": label(name), "means": row.description, "text": state.at[name]}
    if isinstance(vary, Options):
        return {**shown, "options": [text_of(free, name, value) for value in vary.values]}
    unit = free.table.unit(name)
    low, high = (from_si(end, unit) for end in (vary.lower, vary.upper))
    with suppress(UnitError):  # a text that cannot be read is refused elsewhere, and shown as it is
        shown |= _number(parse_quantity(state.at[name], unit), unit)
    return {**shown, "unit": pretty(unit), "low": low, "high": high, "low_text": exactly(vary.lower, unit),
            "high_text": exactly(vary.upper, unit)}  # fmt: skip


def _number(value: float, unit: str) -> Shown:
    """Return a value in its quantity's own unit, whichever unit it was written in: a number, and a text to edit."""
    number = from_si(value, unit)
    return {"value": number, "text": f"{number:.{DIGITS}g} {unit}".removesuffix(" 1")}


def _requirements(free: Study) -> list[Shown]:
    """Return a control for each limit; those of one output know their place in its list."""
    places: Counter[str] = Counter()
    controls = []
    for limit in free.require:
        name, unit = limit.output, free.table.unit(limit.output)
        controls.append({"name": name, "label": label(name), "place": places[name], "sense": limit.sense,
                         "value": from_si(limit.limit, unit), "unit": pretty(unit), "text": exactly(limit.limit, unit),
                         "means": _means(free, name)})  # fmt: skip
        places[name] += 1
    return controls


def _choice(row: Choice, fixed: Study, value: Any) -> Shown:
    options = list(dict.fromkeys([*words_of(row), *(fixed.catalog.names(row.category) if row.category else [])]))
    return {"name": row.name, "label": label(row.name), "means": row.description, "group": row.group,
            "text": str(getattr(value, "name", value)), "options": options}  # fmt: skip


def _inputs(free: Study, fixed: Study, values: Mapping[str, Any]) -> list[Shown]:
    """Numbers that are not varied; those the study sets first. A temperature of a point is `temperature@hot`."""
    controls = []
    for row in free.table.inputs:
        if row.name in free.vary:
            continue
        names = [f"{row.name}@{point}" for point in free.operating_points] if row.per_point else [row.name]
        controls += [_input(row, name, values[name], fixed) for name in names]
    return sorted(controls, key=lambda control: not control["said"])


def _input(row: Input, name: str, value: float, fixed: Study) -> Shown:
    """Return an input's control; its slider goes from half to twice the value, within the limits of the table."""
    unit = fixed.table.unit(row.name)
    low, high = max(row.lower, min(0.5 * value, 2.0 * value)), min(row.upper, max(0.5 * value, 2.0 * value))
    if unit == "degC":
        low, high = max(row.lower, value - 30.0), min(row.upper, value + 30.0)
    slides = math.isfinite(low) and math.isfinite(high) and low < high and not row.integer
    ends = {"low": from_si(low, unit), "high": from_si(high, unit)} if slides else {}
    return {"name": name, "label": label(name), "means": row.description, "group": row.group, "unit": pretty(unit),
            **ends, **_number(value, unit), "said": row.name in fixed.module or "@" in name}  # fmt: skip


def _means(study: Study, name: str) -> str:
    return study.table.output(name.partition("@")[0]).description


FILE = "explore.json"
PARTS = "parts"  # Folder of the designs whose CAD was made, each by its own name
MOST_STEPS = 200
MOST_PINS = 12


class History(BaseModel):
    """All that an explorer goes on from when it is opened again."""

    model_config = ConfigDict(extra="forbid")

    study: str  # Hash of the study's file
    state: State
    past: list[State] = []
    future: list[State] = []
    pins: list[Pinned] = []
    saved: dict[str, str] = {}  # Digest of each study that was saved from the page, by its file's name

    def advance(self, after: State, since: State) -> None:
        """Go on to a state from the one that `since` an undo would bring back."""
        if after != since:
            self.past = [*self.past, since][-MOST_STEPS:]
            self.future = []
        self.state = after

    def undo(self) -> None:
        """Go one step back. Raises InputError if there is none."""
        if not self.past:
            raise InputError("undo: nothing was changed before")
        self.future = [self.state, *self.future]
        self.state = self.past.pop()

    def redo(self) -> None:
        """Go one step forward again. Raises InputError if there is none."""
        if not self.future:
            raise InputError("redo: nothing was undone")
        self.past = [*self.past, self.state]
        self.state = self.future.pop(0)

    def pin(self, pinned: Pinned) -> None:
        """Keep a design. Raises InputError where there are too many."""
        if len(self.pins) >= MOST_PINS:
            raise InputError(f"pin: {MOST_PINS} designs are pinned, the limit; let one go first")
        self.pins = [*self.pins, pinned]

    def pinned(self, number: int) -> Pinned:
        """Return a pinned design. Raises InputError for a number that does not exist."""
        if number >= len(self.pins):
            raise InputError(f"pin {number}: there are {len(self.pins)} pinned designs")
        return self.pins[number]

    def unpin(self, number: int) -> None:
        """Let a design go."""
        gone = self.pinned(number)
        self.pins = [pin for pin in self.pins if pin is not gone]


def open_history(folder: Path, study: bytes, first: State, *, overwrite: bool = False) -> History:
    """Return the history in a folder, or a new one. Raises InputError where the folder is another study's.

    With `overwrite` a new one replaces that of any study, once something is changed.
    """
    path, fingerprint = folder / FILE, "sha256:" + hashlib.sha256(study).hexdigest()
    if not path.exists():
        if folder.is_dir() and any(folder.iterdir()):
            raise InputError(f"{folder}: holds files that are no explorer's; name another folder with --out")
        return History(study=fingerprint, state=first)
    try:
        history = History.model_validate(json.loads(path.read_bytes()))
    except (ValueError, ValidationError) as error:
        raise InputError(f"{path}: not written by `tvimdesign explore`; name another folder with --out") from error
    if overwrite:
        return History(study=fingerprint, state=first, saved=history.saved)
    if history.study != fingerprint:
        raise InputError(
            f"{folder}: holds what was explored of another study, or of this one before its file changed; --overwrite "
            "begins again, --out names another folder"
        )
    return history


def written_digest(folder: Path) -> str:
    """Return the digest of the file in a folder; empty where there is none."""
    return digest_of(folder / FILE) if (folder / FILE).is_file() else ""


def write_history(folder: Path, history: History, before: str) -> str:
    """Write the history, whole, and return its digest. Raises OutputError.

    A file that has not the digest `before` was changed by hand meanwhile: it is renamed, not replaced.
    """
    path = folder / FILE
    if os.path.lexists(path) and not is_as_written(folder, FILE, {before}):
        path.rename(free_name(path))
    atomic_write(path, history.model_dump_json(indent=1).encode() + b"\n")
    return digest_of(path)
