"""Puts right what the CAD kernel leaves in a STEP file: colours in the order of memory addresses, and UTF-8 text."""

from __future__ import annotations

import re
from itertools import pairwise

_STYLES = re.compile(r"^#(\d+) = MECHANICAL_DESIGN_GEOMETRIC_PRESENTATION_REPRESENTATION\('',", re.MULTILINE)
_NUMBER = re.compile(r"#(\d+)")
_COLOUR = re.compile(r"^#(\d+) = COLOUR_RGB\(.*\n", re.MULTILINE)
_CONTEXT = re.compile(r",#(\d+)\);")


def in_fixed_order(text: str) -> str:
    """Sort the blocks of colours at the end of a STEP file by the part they belong to, and number them anew.

    Each block is one presentation with the entities it refers to; its last reference is the part's context, which
    stands earlier in the file and has the same number every time. A colour that parts share stands in the first block.
    """
    starts = [match.start() for match in _STYLES.finditer(text)]
    if len(starts) < 2:
        return text
    end = text.index("ENDSEC;", starts[-1])
    blocks = [_unwrapped(text[first:last]) for first, last in pairwise([*starts, end])]
    first_number = min(int(number[1]) for block in blocks if (number := _NUMBER.match(block)))
    blocks.sort(key=_context)
    blocks = _colours_where_first_used(blocks)
    old = [int(number) for block in blocks for number in re.findall(r"^#(\d+) =", block, re.MULTILINE)]
    new = {number: first_number + index for index, number in enumerate(old)}
    tail = _NUMBER.sub(lambda match: f"#{new.get(int(match[1]), int(match[1]))}", "".join(blocks))
    return text[: starts[0]] + tail + text[end:]


def _colours_where_first_used(blocks: list[str]) -> list[str]:
    """Write each colour after the first line that refers to it; the kernel writes it with the part it meets first."""
    colours = {match[1]: match[0] for block in blocks for match in _COLOUR.finditer(block)}
    found = []
    for block in blocks:
        lines = []
        for line in _COLOUR.sub("", block).splitlines(keepends=True):
            lines.append(line)
            lines += [colours.pop(number) for number in _NUMBER.findall(line) if number in colours]
        found.append("".join(lines))
    return found


def plain_text(text: str) -> bytes:
    """Encode a STEP file: letters beyond ASCII are written as ISO 10303-21 has them, hexadecimal between X2 and X0."""

    def escaped(letters: re.Match[str]) -> str:
        return "\\X2\\" + letters[0].encode("utf-16-be").hex().upper() + "\\X0\\"

    return re.sub(r"[^\x00-\x7f]+", escaped, text).encode("ascii")


def _unwrapped(block: str) -> str:
    """One entity a line; where the kernel breaks lines depends on the numbers."""
    return re.sub(r"\n +", "", block)


def _context(block: str) -> int:
    found = _CONTEXT.search(block.partition("\n")[0])
    return int(found[1]) if found else 0
