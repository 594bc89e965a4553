"""From nodes back to YAML text, for a study that was changed after its file was read or that never had one."""

from __future__ import annotations

from collections.abc import Iterator

import yaml

from tvimdesign.study.text.yaml_text import Broken, Mapping, Node, Sequence, Text

_WIDTH = 120


def yaml_of(root: Node) -> str:
    """Return the YAML text of a tree, from which the reader makes the same tree, without comments and places."""
    events = [yaml.StreamStartEvent(), yaml.DocumentStartEvent(), *_events(root), yaml.DocumentEndEvent()]
    text: str = yaml.emit([*events, yaml.StreamEndEvent()], width=_WIDTH, allow_unicode=True)
    return text


def _events(node: Node) -> Iterator[yaml.Event]:
    match node:
        case Mapping():
            flow = all(isinstance(value, Text) for _, value in node.entries.values()) and len(node.entries) < 3
            yield yaml.MappingStartEvent(None, None, True, flow_style=flow)
            for key, value in node.entries.values():
                yield from _events(key)
                yield from _events(value)
            yield yaml.MappingEndEvent()
        case Sequence():
            yield yaml.SequenceStartEvent(None, None, True, flow_style=True)
            for item in node.items:
                yield from _events(item)
            yield yaml.SequenceEndEvent()
        case Text():
            text = Text(0, 0, node.value)
            quotes = "'" if text.empty and not node.plain else None
            yield yaml.ScalarEvent(None, None, (True, True), node.value, style=quotes)
        case Broken():
            raise ValueError("a study with mistakes is not written")
