"""A sweep as plain data: axes with their values or ranges, and the arrangement of cells."""

from dataclasses import dataclass
from typing import Literal

from tvimdesign.study.text.yaml_text import Text

Sense = Literal["<=", ">=", ""]
METHODS = ("grid", "list", "latin_hypercube", "sobol")
SAMPLED = ("latin_hypercube", "sobol")
TASKS = ("evaluate", "optimize")
EVERY_OUTPUT = "all"
MOST_CELLS = 100_000
"""Cells of a sweep unless it says `most`: a typing error is not to become a month of work."""


@dataclass(frozen=True)
class SweptRange:
    """Numbers between two ends: `count` of them in a grid; drawn where a sweep is sampled."""

    lower: float
    """SI."""
    upper: float
    count: int = 0
    logarithmic: bool = False


@dataclass(frozen=True)
class SweptAxis:
    """One thing that is swept: its name as `--set` takes it, and its values as they are written, or a range."""

    name: str
    unit: str
    """Of its numbers; empty for words and for settings."""
    whole: bool
    """True if it counts things."""
    number: bool
    """True for a size of the module or a condition, which a search from a neighbour can follow."""
    sense: Sense = ""
    """Of a limit."""
    values: tuple[Text, ...] = ()
    range: SweptRange | None = None


@dataclass(frozen=True)
class SweepBlock:
    """A `sweep:` section."""

    method: str
    axes: tuple[SweptAxis, ...]
    rows: tuple[tuple[Text, ...], ...] = ()
    """The cells of a list, a value for each axis."""
    task: str = ""
    """`evaluate` or `optimize`; what the study asks for where it is empty."""
    count: int = 0
    """Cells of a sample."""
    seed: int = 1
    outputs: tuple[str, ...] = ()
    """Outputs that are kept beside those the study asks about."""
    most: int = MOST_CELLS
