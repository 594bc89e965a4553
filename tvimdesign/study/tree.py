"""A study as it is written, a tree of sections and values: from a file or from Python, with the changes made since."""

import os
from collections.abc import Mapping as Mapped
from collections.abc import Sequence as Sequenced
from contextlib import suppress
from dataclasses import dataclass, replace
from numbers import Integral, Real
from pathlib import Path
from typing import Any

from tvimdesign.study.sections import NAMES
from tvimdesign.study.text.mistakes import (
    CONTROL,
    At,
    Mistake,
    Mistakes,
    RefusedError,
    StudyError,
    check_characters,
    printable,
    quoted,
    read_text,
    step,
)
from tvimdesign.study.text.values import misfit
from tvimdesign.study.text.yaml_text import DEEPEST, Broken, Mapping, Node, Sequence, Text, compose, yaml_of

_OF_A_SEARCH = ("vary", "minimize", "front")  # The sections that go with the last variable
_LONGEST_SETTING = 100


@dataclass(frozen=True)
class StudyTree:
    """A study as it is written, before it is read."""

    root: Mapping
    file: str  # Name in messages
    name: str  # The study's name, unless it says one
    folder: Path  # Where its folder of records is looked for
    changes: tuple[str, ...] = ()  # The calls and options that changed it
    problems: tuple[Mistake, ...] = ()  # Mistakes of its form; the reader adds others
    path: Path | None = None  # Its file, where it has one

    def section(self, name: str) -> Node | None:
        """Return the node under one of the study's keys."""
        entry = self.root.entries.get(name)
        return entry[1] if entry else None


def tree_of_text(source: str, file: str, name: str, folder: Path) -> StudyTree:
    """Return the tree of a study's text. Raises StudyError if it is no YAML or no study."""
    problems = Mistakes(file)
    root = compose(check_characters(source, problems), problems)
    if isinstance(root, Mapping):
        return StudyTree(root, file, name, folder, problems=tuple(problems.items))
    with suppress(RefusedError):
        misfit(problems, root, "", "a study: lines such as 'mode: shear'")
    raise StudyError(problems.items)


def tree_of_file(path: str | os.PathLike[str], settings: Sequenced[str] = ()) -> StudyTree:
    """Return the tree of a study file after `name=value` settings. Raises StudyError, and InputError for no file."""
    path = Path(path)
    file = printable(path)
    tree = tree_of_text(read_text(path, Mistakes(file)), file, path.stem, path.parent)
    return with_settings(replace(tree, path=path), settings)


def tree_of_values(values: Mapped[str, Any], file: str, folder: Path) -> StudyTree:
    """Return the tree of a study given as Python values, by section."""
    problems = Mistakes(file)
    root = node_of(values, file, problems)
    assert isinstance(root, Mapping)  # as `values` is one
    return StudyTree(root, file, "study", folder, problems=tuple(problems.items))


def without_section(tree: StudyTree, name: str) -> StudyTree:
    """Return the tree without one of the study's sections."""
    left = {key: value for key, value in tree.root.entries.items() if key != name}
    return replace(tree, root=replace(tree.root, entries=left))


def tree_yaml(tree: StudyTree) -> str:
    """Return the study as text; its first lines name its origin and its changes."""
    changes = "".join(f"# {change}\n" for change in (tree.file, *tree.changes))
    return changes + yaml_of(tree.root)


def study_file(tree: StudyTree) -> str | bytes:
    """Return the study as its author wrote it, or as it is now if options or Python changed it."""
    return tree_yaml(tree) if tree.changes or tree.path is None else tree.path.read_bytes()


def study_text(tree: StudyTree) -> str:
    """Return what `study_file` returns as text."""
    text = study_file(tree)
    return text if isinstance(text, str) else text.decode("utf-8-sig")


def with_settings(tree: StudyTree, settings: Sequenced[str]) -> StudyTree:
    """Return the tree after settings of the form `name=value`; a malformed one is a problem of the tree."""
    for setting in settings:
        try:
            name, equals, value = setting.partition("=")
            problems = Mistakes(_short(f"--set {setting}"))
            if not equals or not name.strip():
                expected = 'name=value, such as --set pcl_thickness="1.2 mm"'
                problems.add(At(0, 0), "", "there is no '=' after a name", expected)
                problems.stop()
            node = _setting_node(value, problems)
            tree = with_value(tree, name.strip(), node, problems.file, tuple(problems.items))
        except StudyError as error:
            tree = replace(tree, problems=(*tree.problems, *error.problems))
    return tree


def _setting_node(value: str, problems: Mistakes) -> Node:
    """Return the node behind `=`: a list or a mapping in YAML's brackets, else text as it is."""
    if not value.lstrip().startswith(("[", "{")):
        return node_of(value, problems.file, problems)
    place = At(0, 0, file=problems.file)
    return compose(check_characters(value, problems, place), problems, place)


def with_value(tree: StudyTree, name: str, value: Node, source: str, problems: tuple[Mistake, ...] = ()) -> StudyTree:
    """Return the tree with one value set, or removed if the value is empty.

    A `name` without dots is an input or a choice of the module: it is fixed, so it is varied no longer. A section, or
    a path such as `require.holding_torque` or `operating_points.hot.temperature`, is set as it stands.
    `problems` are those of the value. Raises StudyError where a path leads nowhere.
    """
    source = _short(source)
    steps = name.split(".")
    if len(steps) > 1 and steps[0] not in NAMES:
        mistakes = Mistakes(source)
        mistakes.unknown(At(0, 0), "", f"section: {quoted(steps[0])}", steps[0], NAMES)
        mistakes.stop()
    root = tree.root
    if len(steps) == 1 and name not in NAMES:
        root = _without_variable(root, name)
        steps = ["module", name]
    root = _put(root, steps, value, source, "")
    changes = tree.changes if tree.changes[-1:] == (source,) else (*tree.changes, source)
    return replace(tree, root=root, changes=changes, problems=(*tree.problems, *problems))


def _without_variable(root: Mapping, name: str) -> Mapping:
    """Return the study without a variable; the last one takes along all that a search needs."""
    vary = root.entries.get("vary")
    if vary is None or not isinstance(vary[1], Mapping) or name not in vary[1].entries:
        return root
    left = {key: value for key, value in vary[1].entries.items() if key != name}
    if not left:
        return replace(root, entries={key: value for key, value in root.entries.items() if key not in _OF_A_SEARCH})
    return replace(root, entries={**root.entries, "vary": (vary[0], replace(vary[1], entries=left))})


def _put(node: Mapping, steps: Sequenced[str], value: Node, source: str, path: str) -> Mapping:
    """Return a mapping with the value at the end of the steps, everything else unchanged."""
    first, *inner_steps = steps
    where = step(path, first)
    entries = dict(node.entries)
    key, old = entries.get(first, (Text(0, 0, first, file=source), None))
    if inner_steps:
        inner = Mapping(0, 0, {}, file=source) if old is None or (isinstance(old, Text) and old.empty) else old
        if not isinstance(inner, Mapping):
            problems = Mistakes(source)
            problems.add(At(0, 0), where, "is no mapping, so nothing stands in it", f"a value for {where} itself")
            problems.stop()
        assert isinstance(inner, Mapping)  # else the problems have stopped it
        entries[first] = (key, _put(inner, inner_steps, value, source, where))
    elif isinstance(value, Text) and value.empty:
        entries.pop(first, None)
    else:
        entries[first] = (Text(0, 0, first, file=source), value)
    return replace(node, entries=entries)


def _short(source: str) -> str:
    shown = printable(Path(source))
    return shown if len(shown) <= _LONGEST_SETTING else shown[: _LONGEST_SETTING - 3] + "..."


def node_of(value: Any, file: str, problems: Mistakes, path: str = "", depth: int = 0) -> Node:
    """Return the node a value would be in a study file; `file` names the option or the call it comes from.

    Text is text with its unit, a tuple `(1.2, "mm")` a number with its unit, `(0.6, 2, "mm")`, `([0.6, 2], "mm")` and
    `(array, "mm")` are lists; what has a magnitude and units is a quantity, as pint's are. Notes what no study has in
    `problems`.
    """
    if depth > DEEPEST:
        problems.add(At(0, 0, file=file), path, f"nested deeper than {DEEPEST} levels", "the few levels of a study")
        return Broken(0, 0, file=file)
    if isinstance(value, tuple) and len(value) == 2 and getattr(value[0], "ndim", isinstance(value[0], list)) == 1:
        value = (*value[0], value[1])
    if isinstance(value, tuple) and _has_unit(value):
        numbers = [f"{_number(number)} {value[-1]}" for number in value[:-1]]
        value = numbers[0] if len(numbers) == 1 else numbers
    if hasattr(getattr(value, "magnitude", value), "tolist"):  # numpy's arrays and numbers, with a unit or without
        value = value.tolist()
    if isinstance(value, Mapped):
        return _mapping(value, file, problems, path, depth)
    if isinstance(value, list | tuple):
        return Sequence(0, 0, [node_of(item, file, problems, path, depth + 1) for item in value], file=file)
    return _scalar(value, file, problems, path)


def _has_unit(value: tuple[Any, ...]) -> bool:
    *numbers, unit = value or ("",)
    return bool(numbers) and isinstance(unit, str) and all(_is_number(number) for number in numbers)


def _is_number(value: Any) -> bool:
    return isinstance(value, Real) and not isinstance(value, bool)


def _number(value: Any) -> str:
    return str(int(value)) if isinstance(value, Integral) else repr(float(value))


def _mapping(value: Mapped[Any, Any], file: str, problems: Mistakes, path: str, depth: int) -> Mapping:
    entries = {}
    for key, item in value.items():
        name = _scalar(key, file, problems, path)
        if isinstance(name, Text):
            entries[name.value] = (name, node_of(item, file, problems, path, depth + 1))
    return Mapping(0, 0, entries, file=file)


def _scalar(value: Any, file: str, problems: Mistakes, path: str) -> Text | Broken:
    if value is None:
        return Text(0, 0, "", file=file)
    text = _text(value)
    if text is None:
        message = f"a value of the type {type(value).__name__}"
        problems.add(At(0, 0, file=file), path, f"{message} does not fit here", "text with a unit, or a number")
    elif odd := CONTROL.search(text):
        problems.add(
            At(0, 0, file=file), path, f"control character U+{ord(odd[0]):04X} in {quoted(text)}", "plain text"
        )
    else:
        return Text(0, 0, text, file=file)
    return Broken(0, 0, file=file)


def _text(value: Any) -> str | None:
    """Write a single value; None for a kind that no study has."""
    if isinstance(value, str):
        return value
    if isinstance(value, bool):
        return "true" if value else "false"
    if _is_number(value):
        return _number(value)
    if hasattr(value, "__fspath__"):
        return str(value)
    if _is_number(getattr(value, "magnitude", None)) and hasattr(value, "units"):
        return f"{_number(value.magnitude)} {value.units:~C}".strip()
    return None
