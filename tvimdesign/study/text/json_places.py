"""Where a value of a JSON file stands, so that a message can name its line."""

from __future__ import annotations

import re
from typing import Any

import yaml

from tvimdesign.study.text.mistakes import At

_MOST_BYTES = 1_000_000
"""Of a file in which lines are looked for; in a larger one it would take seconds."""
_LOADER: Any = getattr(yaml, "CSafeLoader", yaml.SafeLoader)


class JsonPlaces:
    """The lines of a JSON file; none are known of one that is too large or broken."""

    def __init__(self, data: bytes) -> None:
        """Parse the file as YAML, of which JSON is a part and whose nodes know their places."""
        self._root: Any = None
        if len(data) <= _MOST_BYTES:
            try:
                self._root = yaml.compose(data, Loader=_LOADER)
            except (yaml.YAMLError, RecursionError, ValueError):
                return

    def at(self, path: str) -> At:
        """Where the value at a path such as `study.module.current` stands, or the last of its steps that is there."""
        node = self._root
        if node is None:
            return At(0, 0)
        place = node.start_mark
        for name in re.findall(r"[^.\[\]]+", path):
            found = _child(node, name)
            if found is None:
                break
            key, node = found
            place = key.start_mark
        return At(place.line + 1, place.column + 1)


def _child(node: Any, name: str) -> tuple[Any, Any] | None:
    """The key and the value of that name, or the item of that number twice."""
    if isinstance(node, yaml.MappingNode):
        return next(((key, value) for key, value in node.value if key.value == name), None)
    if isinstance(node, yaml.SequenceNode) and name.isdecimal() and int(name) < len(node.value):
        return node.value[int(name)], node.value[int(name)]
    return None
