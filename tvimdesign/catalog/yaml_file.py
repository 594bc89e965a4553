"""Reads one YAML file into plain text, lists and mappings: safely, with limits, and with every error in words."""

from __future__ import annotations

from pathlib import Path
from typing import Any, TypeAlias

import yaml

from tvimdesign.base.errors import CatalogError

Tree: TypeAlias = "str | list[Tree] | dict[str, Tree]"
"""Numbers stay text until their unit is known, so that no YAML rule turns 1:30 or 010 into something else."""

LARGEST_FILE = 1_000_000
DEEPEST = 8
MOST_NODES = 10_000
_Loader: Any = getattr(yaml, "CSafeLoader", yaml.SafeLoader)


def read_tree(path: Path) -> dict[str, Tree]:
    """Read a file whose top is a mapping; raises CatalogError naming file and line."""
    try:
        if not path.is_file():  # a pipe or a device would be read for ever
            raise CatalogError(f"{path}: this is no file")
        with path.open("rb") as stream:
            data = stream.read(LARGEST_FILE + 1)
    except (OSError, ValueError) as error:
        raise CatalogError(f"{path}: cannot be read ({type(error).__name__})") from None
    if len(data) > LARGEST_FILE:
        raise CatalogError(f"{path}: larger than {LARGEST_FILE // 1000} kB, which no record is")
    try:
        text = data.decode("utf-8-sig")
        _guard(text)
        node = yaml.compose(text, Loader=_Loader)
        tree = _plain(node) if node is not None else ""
    except UnicodeDecodeError:
        raise CatalogError(f"{path}: this is no UTF-8 text") from None
    except CatalogError as error:
        raise CatalogError(f"{path}:{error}") from None
    except yaml.MarkedYAMLError as error:
        mark = error.problem_mark or error.context_mark
        line = mark.line + 1 if mark else 1
        raise CatalogError(f"{path}:{line}: this is no YAML ({error.problem or error.context})") from None
    except (yaml.YAMLError, RecursionError, ValueError):
        raise CatalogError(f"{path}: this is no YAML") from None
    if not isinstance(tree, dict):
        raise CatalogError(f"{path}: expected a mapping with title, values, tables and words")
    return tree


def _guard(text: str) -> None:
    """Refuse aliases, tags, depth and size while the file is still a stream of events."""
    depth = 0
    events: Any = yaml.parse(text, Loader=_Loader)
    for count, event in enumerate(events):
        line = event.start_mark.line + 1
        if isinstance(event, yaml.AliasEvent) or getattr(event, "anchor", None):
            raise CatalogError(f"{line}: anchors and aliases (& and *) are not read; write the value out")
        if getattr(event, "tag", None):
            raise CatalogError(f"{line}: tags ({str(event.tag)[:40]!r}) are not read")
        if isinstance(event, yaml.CollectionStartEvent):
            depth += 1
        elif isinstance(event, yaml.CollectionEndEvent):
            depth -= 1
        if depth > DEEPEST or count > MOST_NODES:
            raise CatalogError(f"{line}: deeper or longer than any record is")


def _plain(node: Any) -> Tree:
    """Turn nodes into text, lists and mappings; a key said twice is an error."""
    if isinstance(node, yaml.ScalarNode):
        return str(node.value)
    if isinstance(node, yaml.SequenceNode):
        return [_plain(child) for child in node.value]
    tree: dict[str, Tree] = {}
    for key, child in node.value:
        line = key.start_mark.line + 1
        if not isinstance(key, yaml.ScalarNode):
            raise CatalogError(f"{line}: a key must be a plain word")
        if key.value in tree:
            raise CatalogError(f"{line}: {key.value[:40]!r} is given twice")
        tree[str(key.value)] = _plain(child)
    return tree
