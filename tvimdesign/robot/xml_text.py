"""XML as the models are written in: numbers that are read back the same, comments of lines, two spaces a level."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any
from xml.etree import ElementTree as Xml


def numbers(*values: float) -> str:
    """Numbers as an attribute has them, to ten digits."""
    return " ".join(f"{value:.10g}" for value in values)


def comment(lines: Sequence[str]) -> Xml.Element[Any]:
    """Lines as a comment; two hyphens, which XML does not allow in one, become one."""
    text = "\n".join(lines)
    while "--" in text:
        text = text.replace("--", "-")
    return Xml.Comment(f"\n{text}\n")


def document(root: Xml.Element) -> str:
    """The whole file."""
    Xml.indent(root)
    return '<?xml version="1.0" encoding="utf-8"?>\n' + Xml.tostring(root, encoding="unicode") + "\n"
