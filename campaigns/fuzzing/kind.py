"""A kind of input: how one is drawn, and what is done with it."""

from __future__ import annotations

import random
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]


@dataclass(frozen=True)
class Drawn:
    """One input: a file's path in the folder it is handed in, and what it holds."""

    name: str
    data: bytes
    parts: int = 1
    """Inputs in it, such as the messages of a conversation."""

    def written(self, folder: Path) -> Path:
        """Return the file in a folder."""
        path = folder / self.name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(self.data)
        return path


@dataclass(frozen=True)
class Kind:
    """Kind of input that a user can hand in."""

    draw: Callable[[random.Random], Drawn]
    use: Callable[[Path], None]
    """Does with the file what the commands do first. Raises the package's errors."""
    writes: bool = False
    """Whether files may be written in the folder of the input."""
    most_seconds: float = 2.0
    """Of the processor, as the machine may have other work; an input that takes longer is a failure."""
    share: float = 1.0
    """Of the inputs asked for of each kind; those that cost more get less."""
