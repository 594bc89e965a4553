"""From Python values to the nodes a study is read from, so that what a script gives meets the reader of study files."""

from __future__ import annotations

from collections.abc import Mapping as Mapped
from numbers import Integral, Real
from typing import Any

from tvimdesign.study.text.mistakes import At, Mistakes, quoted
from tvimdesign.study.text.source import CONTROL
from tvimdesign.study.text.yaml_text import DEEPEST, Broken, Mapping, Node, Sequence, Text


def node_of(value: Any, file: str, problems: Mistakes, path: str = "", depth: int = 0) -> Node:
    """Return the node a value would be in a study file; `file` names the option or the call it comes from.

    Text is text with its unit, a tuple `(1.2, "mm")` a number with its unit and `(0.6, 2, "mm")` a list of two; what
    has a magnitude and units is a quantity, as pint's are. Notes what cannot stand in a study in `problems`.
    """
    if depth > DEEPEST:
        problems.add(At(0, 0, file), path, f"nested deeper than {DEEPEST} levels", "the few levels of a study")
        return Broken(0, 0, file)
    if isinstance(value, tuple) and _has_unit(value):
        numbers = [f"{_number(number)} {value[-1]}" for number in value[:-1]]
        value = numbers[0] if len(numbers) == 1 else numbers
    if hasattr(getattr(value, "magnitude", value), "tolist"):  # numpy's arrays and numbers, with a unit or without
        value = value.tolist()
    if isinstance(value, Mapped):
        return _mapping(value, file, problems, path, depth)
    if isinstance(value, list | tuple):
        return Sequence(0, 0, [node_of(item, file, problems, path, depth + 1) for item in value], file)
    return _scalar(value, file, problems, path)


def _has_unit(value: tuple[Any, ...]) -> bool:
    """Return whether a tuple holds numbers and their unit."""
    *numbers, unit = value or ("",)
    return bool(numbers) and isinstance(unit, str) and all(_is_number(number) for number in numbers)


def _is_number(value: Any) -> bool:
    return isinstance(value, Real) and not isinstance(value, bool)


def _number(value: Any) -> str:
    """Write a number with all its digits."""
    return str(int(value)) if isinstance(value, Integral) else repr(float(value))


def _mapping(value: Mapped[Any, Any], file: str, problems: Mistakes, path: str, depth: int) -> Mapping:
    entries = {}
    for key, item in value.items():
        name = _scalar(key, file, problems, path)
        if isinstance(name, Text):
            entries[name.value] = (name, node_of(item, file, problems, path, depth + 1))
    return Mapping(0, 0, entries, file)


def _scalar(value: Any, file: str, problems: Mistakes, path: str) -> Text | Broken:
    if value is None:
        return Text(0, 0, "", file=file)
    text = _text(value)
    if text is None:
        message = f"a value of the type {type(value).__name__}"
        problems.add(At(0, 0, file), path, f"{message} does not fit here", "text with a unit, or a number")
    elif odd := CONTROL.search(text):
        problems.add(At(0, 0, file), path, f"control character U+{ord(odd[0]):04X} in {quoted(text)}", "plain text")
    else:
        return Text(0, 0, text, file=file)
    return Broken(0, 0, file)


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
        return f"{_number(value.magnitude)} {value.units}".strip()
    return None
