"""Names that studies and designs had in an earlier release: read as what they are called now, with a warning."""

from __future__ import annotations

import warnings
from dataclasses import replace
from functools import lru_cache
from typing import Any

from tvimdesign.base.errors import RenamedWarning
from tvimdesign.study.text import yaml_text
from tvimdesign.study.text.yaml_text import Node, Text

_SUFFIXES = {"_reserve": "_margin"}
"""Ends of names of quantities, the old by the new one; read until the release after 0.1."""
_SECTIONS = ("module", "vary", "require", "accept", "minimize", "front", "tolerances")
"""The sections in which quantities are named."""
_PLAIN = {"drives": "current_profiles"}
"""Fields of a design that are called otherwise now."""
_LATER_CHOICES = {"joint": "none"}
"""Choices that there were not when an earlier release wrote a design, and what all its designs had."""


@lru_cache(maxsize=10_000)
def new_name(name: str) -> str:
    """What a quantity is called now, with its `@point`; the name itself where it is not an old one."""
    base, at, point = name.partition("@")
    for old, new in _SUFFIXES.items():
        if base.endswith(old):
            return base.removesuffix(old) + new + at + point
    return name


def renamed(root: yaml_text.Mapping, file: str) -> yaml_text.Mapping:
    """A study's tree with every old name as it is now; one RenamedWarning names them all."""
    found: dict[str, str] = {}
    sections = {
        name: (key, _renamed(value, found) if name in _SECTIONS else value)
        for name, (key, value) in root.entries.items()
    }
    _tell(found, file)
    return replace(root, entries=sections)


def renamed_value(value: Node, section: str, source: str) -> Node:
    """The same of a value that is put into a section."""
    found: dict[str, str] = {}
    value = _renamed(value, found) if section in _SECTIONS else value
    _tell(found, source)
    return value


def _tell(found: dict[str, str], file: str) -> None:
    if found:
        names = ", ".join(f"{old} is now {new}" for old, new in found.items())
        warnings.warn(f"{file}: {names}; the old names are read until the next release", RenamedWarning, stacklevel=3)


def _renamed(node: Node, found: dict[str, str]) -> Node:
    """The same of one node, itself where nothing is old. An old name beside its new one stays, and is a mistake."""
    if isinstance(node, yaml_text.Mapping):
        entries: dict[str, tuple[Text, Node]] = {}
        for name, (key, value) in node.entries.items():
            new = name if (now := new_name(name)) in node.entries else now
            found |= {name: new} if new != name else {}
            entries[new] = (replace(key, value=new) if new != name else key, _renamed(value, found))
        same = all(value is node.entries.get(name, (None, None))[1] for name, (_, value) in entries.items())
        return node if same else replace(node, entries=entries)
    if isinstance(node, yaml_text.Sequence):
        items = [_renamed(item, found) for item in node.items]
        same = all(now is item for now, item in zip(items, node.items, strict=True))
        return node if same else replace(node, items=items)
    if isinstance(node, Text) and (new := new_name(node.value)) != node.value:
        found[node.value] = new
        return replace(node, value=new)
    return node


def renamed_plain(data: Any) -> Any:
    """Plain data, such as a design's, with every old name as it is now; without a warning, as no person wrote it."""
    if isinstance(data, dict):
        return {_PLAIN.get(name, new_name(name)): renamed_plain(value) for name, value in data.items()}
    if isinstance(data, list):
        return [renamed_plain(item) for item in data]
    return new_name(data) if isinstance(data, str) and data.isidentifier() else data


def with_later_choices(design: Any) -> Any:
    """A design's plain data with the choices that came after it was written."""
    choices = design.get("choices") if isinstance(design, dict) else None
    return {**design, "choices": {**_LATER_CHOICES, **choices}} if isinstance(choices, dict) else design
