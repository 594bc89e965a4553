"""State of an explorer: changes to a study, values of the controls, and pinned designs."""

from __future__ import annotations

import os
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from pydantic import BaseModel, ConfigDict

from tvimdesign.base.errors import InputError, UnitError
from tvimdesign.base.units import parse_quantity
from tvimdesign.explore.states.messages import Change, SetLimits, SetRange, SetValue, Way
from tvimdesign.study import Range, Study, given, read_tree
from tvimdesign.study.text.mistakes import Mistakes
from tvimdesign.study.text.python_values import node_of
from tvimdesign.study.text.values import exactly
from tvimdesign.study.text.yaml_text import Text
from tvimdesign.study.tree import StudyTree, tree_yaml, with_value

SOURCE = "explore"
"""What messages call the place a change was made in."""
_OF_SEARCHES = ("robust", "profile")


class _Part(BaseModel):
    model_config = ConfigDict(frozen=True, extra="forbid")


class State(_Part):
    """All that undo goes back over."""

    way: Way
    changes: dict[str, Any] = {}
    """Values as a study has them, by their path in it."""
    at: dict[str, str] = {}
    """The variables of the module under the hand, by name, as text."""


class Pinned(_Part):
    """A design kept to be held beside others: its state, and what was shown of it."""

    name: str
    state: State
    values: dict[str, str]
    """Texts with units, by the quantity's full name."""


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
        tree = _set(tree, path, value)
    return tree


def _set(tree: StudyTree, path: str, value: Any) -> StudyTree:
    problems = Mistakes(SOURCE)
    return with_value(tree, path, node_of(value, SOURCE, problems), SOURCE, tuple(problems.items))


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
