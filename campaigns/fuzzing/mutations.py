"""Texts, tables and plain data with something changed in them."""

from __future__ import annotations

import json
import random
from collections.abc import Iterator
from copy import deepcopy
from typing import Any

ODD: list[Any] = [
    None, True, 0, -1, 1e308, 1e-320, 10**400, "", "x", "nan", "inf", "-0", "1,5 mm", "1e999 mm", "0 mm", "1 K", "N.m",
    [], {}, [1], {"a": 1}, [["x"]], "[/bold]", "../../etc/passwd", "\u202e", "\ud800", "a\x00b", "!!python/none", "*a",
    "&a [*a]", "shear", "compression", "music_wire", ">= 5", "<= nan", ">= 1 N.m", "{choose: []}", "9" * 5000, "mm",
    "1 mm mm", "%", "5 %", "$(touch x)", "`id`", "https://example.org", "\u00b5m", "1 \u2126", "true", "~", "1_000",
    "é" * 300,
]  # fmt: skip
CELLS = ["", "0", "-1", "1e308", "-1e308", "1e-320", "nan", "inf", "1,5", "1.5.5", "---", "x", "\x00", "9" * 400,
         "1e5 Pa", "=1/0", "#N/A", "\u22125", "1'000", "5%", '"', "\ud800"]  # fmt: skip
LETTERS = "{}[]:,-#&*!|>'\"%@`~\t\n 0123456789eE.mKNré\x00\x07\ufeff"
SEPARATORS = ";\t, "


def encoded(text: str) -> bytes:
    """UTF-8, lone surrogates included."""
    return text.encode("utf-8", "surrogatepass")


def mutated_text(text: str, draw: random.Random) -> bytes:
    """Return a text with some letters, words or lines changed, or cut somewhere; not always UTF-8."""
    for _ in range(draw.choice((1, 1, 1, 2, 5))):
        lines, place = text.split("\n"), draw.randrange(len(text) + 1)
        row = draw.randrange(len(lines))
        change = draw.randrange(7)
        if change == 0:
            text = text[:place] + draw.choice(LETTERS) + text[place + draw.randrange(2) :]
        elif change == 1:
            text = "\n".join(lines[:row] + lines[row + 1 :])
        elif change == 2:
            text = "\n".join([*lines[:row], lines[row], lines[draw.randrange(len(lines))], *lines[row + 1 :]])
        elif change == 3:
            head, colon, _ = lines[row].partition(":")
            text = "\n".join([*lines[:row], f"{head}{colon} {draw.choice(ODD)}", *lines[row + 1 :]])
        elif change == 4:
            words = lines[row].split(" ")
            words[draw.randrange(len(words))] = str(draw.choice(ODD))
            text = "\n".join([*lines[:row], " ".join(words), *lines[row + 1 :]])
        elif change == 5:
            text = "\n".join([*lines[:row], "  " * draw.randrange(3) + lines[row], *lines[row + 1 :]])
        else:
            text = text[:place]
    data = encoded(text)
    return data if draw.random() < 0.98 else data.replace(b"e", bytes([draw.randrange(256)]), 1)


def mutated_table(text: str, draw: random.Random) -> str:
    """Return a table as text with cells, rows or its signs changed."""
    rows = text.split("\n")
    for _ in range(draw.choice((1, 1, 2, 4, 8))):
        at = draw.randrange(len(rows))
        sign = max(SEPARATORS, key=rows[at].count)
        cells = rows[at].split(sign)
        change = draw.randrange(9)
        if change < 4:
            cells[draw.randrange(len(cells))] = draw.choice(CELLS)
            rows[at] = sign.join(cells)
        elif change == 4:
            rows[at] = sign.join(draw.sample(cells, len(cells)))
        elif change == 5:
            rows[at : at + 1] = [rows[at]] * draw.randrange(3)
            rows = rows or [""]
        elif change == 6:
            rows[at] = sign.join(cells[: draw.randrange(len(cells) + 1)])
        elif change == 7:
            rows = [row.replace(".", ",") if draw.random() < 0.9 else row for row in rows]
        else:
            rows = [row.replace(sign, draw.choice(SEPARATORS)) for row in rows]
    return "\n".join(rows)


def mutated_bytes(data: bytes, draw: random.Random) -> bytes:
    """Some bytes changed, or the end left off."""
    changed = bytearray(data)
    for _ in range(draw.choice((1, 3, 10))):
        changed[draw.randrange(len(changed))] = draw.randrange(256)
    return bytes(changed[: draw.randrange(len(changed)) + 1] if draw.random() < 0.2 else changed)


def paths(node: Any, path: tuple[Any, ...] = ()) -> Iterator[tuple[Any, ...]]:
    """Yield the places in plain data but the whole."""
    items = node.items() if isinstance(node, dict) else enumerate(node) if isinstance(node, list) else ()
    for key, value in items:
        yield (*path, key)
        yield from paths(value, (*path, key))


def mutated_data(text: str, places: list[tuple[Any, ...]], draw: random.Random) -> Any:
    """Return the plain data of a JSON text with a value or two changed, renamed or taken away."""
    changed = json.loads(text)
    for _ in range(draw.choice((1, 1, 2, 4))):
        path, node = draw.choice(places), changed
        try:
            for key in path[:-1]:
                node = node[key]
            kind = draw.random()
            if kind < 0.25:
                del node[path[-1]]
            elif kind < 0.4 and isinstance(node, dict):
                node[str(draw.choice(ODD))] = node.pop(path[-1])
            else:
                node[path[-1]] = deepcopy(draw.choice(ODD))  # a later change may go into it
        except (KeyError, IndexError, TypeError):  # an earlier change took the place away
            continue
    return changed
