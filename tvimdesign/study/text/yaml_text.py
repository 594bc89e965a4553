"""From YAML text to nodes that know their place, with the caps that keep a hostile file harmless.

Nothing is constructed: the parser's events become three kinds of node, no deeper than a study is, and a scalar stays
the text it was written as, so `on`, `010`, `1:30` and `1e400` have no second meaning here.
"""

import re
from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Any, TypeAlias

import yaml

from tvimdesign.study.text.mistakes import CONTROL, At, Mistakes, quoted, step

MOST_NODES = 10_000
DEEPEST = 20
_TAGS = {"text": {"str", "int", "float", "bool", "null"}, "list": {"seq"}, "map": {"map"}}
_TAG_PREFIX = "tag:yaml.org,2002:"
LOADER: Any = getattr(yaml, "CSafeLoader", yaml.SafeLoader)


@dataclass(frozen=True, slots=True)
class Text(At):
    """A scalar, as written; `plain` says it stood without quotes."""

    value: str
    plain: bool = True

    @property
    def empty(self) -> bool:
        """True if nothing was written, or YAML's word for nothing."""
        return self.plain and self.value in {"", "~", "null"}


@dataclass(frozen=True, slots=True)
class Sequence(At):
    """A list."""

    items: "list[Node]" = field(default_factory=list)


@dataclass(frozen=True, slots=True)
class Mapping(At):
    """Keys and values, in the file's order; no key stands twice."""

    entries: "dict[str, tuple[Text, Node]]" = field(default_factory=dict)


@dataclass(frozen=True, slots=True)
class Broken(At):
    """A refused value, about which nothing more is reported."""


Node: TypeAlias = Text | Sequence | Mapping | Broken


def compose(text: str, problems: Mistakes, place: At | None = None) -> Node:
    """Turn YAML text into one node, noting every problem of form; raises StudyError where it cannot go on.

    `place` is that of every node if the text stands in no file, but in an option.
    """
    events = yaml.parse(text, Loader=LOADER)
    builder, root = _Builder(problems, place, events), None
    try:
        for event in events:
            if isinstance(event, yaml.DocumentStartEvent) and root is not None:
                problems.add(builder.place_of(event), "", "a second YAML document starts here", "one study a file")
                problems.stop()
            if isinstance(event, yaml.NodeEvent):
                root = builder.node(event, "")
    except yaml.YAMLError as error:
        _note_syntax(error, text, problems, place)
        problems.stop()
    if root is None or (isinstance(root, Text) and root.empty):
        problems.add(At(0, 0), "", "the study is empty", hint="`tvimdesign new` writes a commented one")
        problems.stop()
    assert root is not None
    return root


@dataclass
class _Builder:
    """Builds nodes from the parser's events."""

    problems: Mistakes
    place: At | None  # That of every node, if it is given
    events: Iterator[Any]
    nodes: int = 0

    def place_of(self, event: Any) -> At:
        """Return the place of an event."""
        return self.place or At(event.start_mark.line + 1, event.start_mark.column + 1)

    def node(self, event: Any, path: str, depth: int = 0) -> Node:
        """Return the node that begins with an event, under the keys of `path`."""
        place = self.place_of(event)
        line, column, file = place.line, place.column, place.file
        node: Node = Broken(line, column, file=file)
        if isinstance(event, yaml.AliasEvent):
            self.problems.add(place, path, f"the alias {quoted(f'*{event.anchor}')}", "the value itself: write it out")
        elif isinstance(event, yaml.ScalarEvent):
            if self._tag_allowed(event, "text", place, path):
                if odd := CONTROL.search(event.value):
                    self.problems.add(place, path, f"control character U+{ord(odd[0]):04X}", "plain text")
                else:
                    node = Text(line, column, event.value, not event.style, file=file)
        else:
            kind = "list" if isinstance(event, yaml.SequenceStartEvent) else "map"
            allowed = self._tag_allowed(event, kind, place, path)
            if depth >= DEEPEST:
                self.problems.add(place, "", f"nested deeper than {DEEPEST} levels", "the few levels of a study")
                self.problems.stop()
            if kind == "list":
                items = list(self._items(path, depth + 1))
                node = Sequence(line, column, items, file=file) if allowed else node
            else:
                pairs = list(self._pairs(path, depth + 1))
                node = Mapping(line, column, self._entries(pairs, path), file=file) if allowed else node
        self.nodes += 1
        if self.nodes > MOST_NODES:
            self.problems.add(node, "", f"more than {MOST_NODES} values", "a study, which has some dozens")
            self.problems.stop()
        return node

    def _items(self, path: str, depth: int) -> Iterator[Node]:
        while not isinstance(event := next(self.events), yaml.CollectionEndEvent):
            yield self.node(event, path, depth)

    def _pairs(self, path: str, depth: int) -> Iterator[tuple[Node, Node]]:
        for key in self._items(path, depth):
            inner = step(path, key.value) if isinstance(key, Text) else path
            yield key, self.node(next(self.events), inner, depth)

    def _tag_allowed(self, event: Any, kind: str, place: At, path: str) -> bool:
        tag = event.tag
        if tag is None or (tag.startswith(_TAG_PREFIX) and tag.removeprefix(_TAG_PREFIX) in _TAGS[kind]):
            return True
        shown = tag.replace(_TAG_PREFIX, "!!", 1)
        self.problems.add(place, path, f"the tag {quoted(shown)} is not allowed", "a plain value without a tag")
        return False

    def _entries(self, pairs: list[tuple[Node, Node]], path: str) -> dict[str, tuple[Text, Node]]:
        entries: dict[str, tuple[Text, Node]] = {}
        for key, value in pairs:
            if not isinstance(key, Text):
                if not isinstance(key, Broken):
                    self.problems.add(key, path, "a list or a mapping as a key", "a name")
            elif key.plain and key.value == "<<":
                self.problems.add(key, path, "a merge key `<<`", "the values themselves: write them out")
            elif key.value in entries:
                first = entries[key.value][0].line
                self.problems.add(key, step(path, key.value), f"given twice, first in line {first}", "one of the two")
            else:
                entries[key.value] = (key, value)
        return entries


_REMEDIES = (
    (r":\s*['\"]?[<>]=?", "block scalar", 'put a limit in quotes: ">= 5 N.m/rad"'),
    (r"", "mapping values are not allowed", "check the indentation, and put a text with ': ' in it in quotes"),
    (r"", "could not find expected ':'", "write 'name: value', with a space after the colon"),
    (r"", "did not find expected key", "check the indentation of this line and the ones before"),
    (r"", "cannot start any token", "put the value in quotes"),
)


def _note_syntax(error: yaml.YAMLError, text: str, problems: Mistakes, fixed: At | None) -> None:
    """Note the parser's complaint at its place, with what usually helps."""
    mark = getattr(error, "problem_mark", None) or getattr(error, "context_mark", None)
    complaint = " ".join(str(part) for part in (getattr(error, "context", ""), getattr(error, "problem", "")) if part)
    place = At(mark.line + 1, mark.column + 1) if mark else At(0, 0)
    lines = text.splitlines()
    line = lines[place.line - 1] if 0 < place.line <= len(lines) else ""
    hint = next((remedy for sign, words, remedy in _REMEDIES if words in complaint and re.search(sign, line)), "")
    problems.add(fixed or place, "", f"not valid YAML ({complaint or 'unreadable'})", hint=hint)


def place_of(root: Any, path: str) -> At:
    """Return the place of a path such as `study.module.current` in a YAML node, or of its last step that exists."""
    node = place = root
    for name in re.findall(r"[^.\[\]]+", path):
        if isinstance(node, yaml.MappingNode):
            entries = {key.value: (key, value) for key, value in node.value}
        elif isinstance(node, yaml.SequenceNode):
            entries = {str(number): (item, item) for number, item in enumerate(node.value)}
        else:
            break
        if name not in entries:
            break
        place, node = entries[name]
    return At(place.start_mark.line + 1, place.start_mark.column + 1) if place else At(0, 0)


_WIDTH = 120


def yaml_of(root: Node) -> str:
    """Return the YAML text of a tree, from which the reader makes the same tree, without comments and places."""
    events = [yaml.StreamStartEvent(), yaml.DocumentStartEvent(), *_written_events(root), yaml.DocumentEndEvent()]
    text: str = yaml.emit([*events, yaml.StreamEndEvent()], width=_WIDTH, allow_unicode=True)
    return text


def _written_events(node: Node) -> Iterator[yaml.Event]:
    match node:
        case Mapping():
            flow = all(isinstance(value, Text) for _, value in node.entries.values()) and len(node.entries) < 3
            yield yaml.MappingStartEvent(None, None, True, flow_style=flow)
            for key, value in node.entries.values():
                yield from _written_events(key)
                yield from _written_events(value)
            yield yaml.MappingEndEvent()
        case Sequence():
            yield yaml.SequenceStartEvent(None, None, True, flow_style=True)
            for item in node.items:
                yield from _written_events(item)
            yield yaml.SequenceEndEvent()
        case Text():
            text = Text(0, 0, node.value)
            quotes = "'" if text.empty and not node.plain else None
            yield yaml.ScalarEvent(None, None, (True, True), node.value, style=quotes)
        case Broken():
            raise ValueError("a study with mistakes is not written")
