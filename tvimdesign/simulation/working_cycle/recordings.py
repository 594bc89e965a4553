"""Recordings of a device's equations in the user's cache, written only where they are new.

A recording is named by the code that writes equations, by the structure of the device, and by what is recorded of it.
"""

import hashlib
import io
from collections.abc import Callable, Iterator, Sequence
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tvimdesign.base.user_cache import find_code, keep_code
from tvimdesign.engine.tape import Tape
from tvimdesign.simulation.working_cycle.symbols import ca

_PACKAGE = Path(__file__).parents[2]
WRITERS = ("base", "physics", "device", "engine", "simulation/working_cycle", "solve/nlp", "solve/batch")
"""Folders whose code and data make up the equations."""


@cache
def _code() -> str:
    """Return the hash of all that equations follow from beside a device's structure."""
    digest = hashlib.sha256(vars(ca)["__version__"].encode())
    for folder in WRITERS:
        for path in sorted((_PACKAGE / folder).rglob("*.*")):
            if path.suffix != ".pyc" and path.parent.name != "__pycache__":
                digest.update(f"{path.relative_to(_PACKAGE)} ".encode() + path.read_bytes())
    return digest.hexdigest()


class Recordings:
    """The recordings of one structure."""

    def __init__(self, structure: str) -> None:
        """Take all that tells the structure apart; nothing is kept of one that is empty."""
        self._structure = structure

    def arrays(self, name: str, record: Callable[[], Sequence[NDArray[Any]]]) -> Iterator[NDArray[Any]]:
        """Return the arrays of a name, recorded where the cache has none."""
        key = (_code(), self._structure, name) if self._structure else ()
        if key and (stored := find_code(*key)) is not None:
            return iter(np.load(io.BytesIO(stored)).values())
        arrays = record()
        if key:
            stream = io.BytesIO()
            np.savez(stream, *arrays)
            keep_code(stream.getvalue(), *key)
        return iter(arrays)

    def tapes(self, name: str, count: int, record: Callable[[], Sequence[Tape]]) -> list[Tape]:
        """Return the `count` tapes of a name, recorded where the cache has none."""
        arrays = self.arrays(name, lambda: [array for tape in record() for array in tape.arrays()])
        return [Tape.of_arrays(arrays) for _ in range(count)]
