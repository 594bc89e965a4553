"""Plain records that a page consists of. Numbers in them are text already, as the terminal prints them."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, Literal

Tone = Literal["", "good", "warn", "bad"]
"""What a status or a cell means; the page says it by a word or a mark too, not by its colour alone."""


@dataclass(frozen=True)
class Cell:
    """One cell of a grid: its text, the number it is sorted by where that is not in the text, and its tone."""

    text: str
    sort: float | None = None
    tone: Tone = ""
    code: bool = False
    links: Sequence[tuple[str, str]] = ()  # Texts with addresses relative to the page, which stand instead of the text


@dataclass(frozen=True)
class Head:
    """A column of a grid."""

    text: str
    right: bool = False
    wide: bool = False  # True if a narrow screen hides the column until it is asked for


@dataclass(frozen=True)
class Grid:
    """A table that can be sorted; one of many rows can be filtered, too."""

    caption: str
    heads: Sequence[Head]
    rows: Sequence[Sequence[Cell]]
    note: str = ""


@dataclass(frozen=True)
class Facts:
    """Labels with their texts."""

    rows: Sequence[tuple[str, str]]


@dataclass(frozen=True)
class Words:
    """Paragraphs."""

    lines: Sequence[str]


@dataclass(frozen=True)
class Points:
    """A list of sentences."""

    lines: Sequence[str]


@dataclass(frozen=True)
class Steps:
    """Steps in order, each with a picture that the figure of that name takes of it."""

    lines: Sequence[str]
    figure: str


@dataclass(frozen=True)
class Warned:
    """Warnings, each with what to write in the study."""

    rows: Sequence[tuple[str, str]]


@dataclass(frozen=True)
class Listing:
    """A text as it is in its file."""

    title: str
    text: str


@dataclass(frozen=True)
class Picture:
    """A picture that is part of the page: PNG or WebP, on white."""

    data: bytes
    says: str  # Text for readers who cannot see it
    caption: str = ""

    @property
    def media(self) -> str:
        """Type of the file."""
        return "image/webp" if self.data[8:12] == b"WEBP" else "image/png"


@dataclass(frozen=True)
class Drawn:
    """A figure that the page's own code draws from plain data, such as curves, a front or the module's solids."""

    name: str  # Unique on the page
    by: str  # The module of static/ that draws it
    says: str  # Its caption, which stands for it where nothing can be drawn
    data: Mapping[str, Any]
    binary: bytes = b""  # Meshes, which are too large for JSON
    libraries: Sequence[str] = ()


@dataclass(frozen=True)
class Folded:
    """Blocks behind a line that opens them."""

    title: str
    blocks: "Sequence[Block]"
    file: str = ""  # Where in the folder of results it is: text names that in place of the blocks


Block = Grid | Facts | Words | Points | Steps | Warned | Listing | Picture | Drawn | Folded


@dataclass(frozen=True)
class Section:
    """One part of the page, under a heading of its own."""

    name: str  # The end of its address: `report.html#name`
    title: str
    blocks: Sequence[Block]
    folded: bool = False  # True if only the heading is shown until it is opened


@dataclass(frozen=True)
class Page:
    """A whole page."""

    title: str
    kind: str  # Result: `shear module`, `comparison`
    status: str
    tone: Tone
    first: Sequence[Block]  # The first screen
    picture: Picture | None
    sections: Sequence[Section]
    made_by: str
    files: Mapping[str, str] = field(default_factory=dict)  # Files of the folder to look at, by what they are
    carried: Mapping[str, bytes] = field(default_factory=dict)
    """Files that links of the page lead to, by address: a page in a mail has no folder beside it. First come those
    that matter most; those for which the page has no room are left to the folder."""
