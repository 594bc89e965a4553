"""Parts of a module that many tests draw alike, drawn once in a process.

A part is drawn again only where a dimension that it reads is another. Each test gets a copy, which it may mesh.
"""

from collections.abc import Callable, Iterator
from functools import partial
from types import FunctionType
from typing import Any

import cadquery as cq
import pytest

from tvimdesign.cad.assembly import assembly
from tvimdesign.cad.geometry.dimensions import Dimensions
from tvimdesign.cad.parts import shear_parts

Drawn = tuple[dict[str, float | None], cq.Solid]
MOST = 12
"""Variants of a part that are kept, those drawn last."""


class Noted(dict[str, float]):
    """Values that note which of them are read, and which are asked for and not there."""

    def __init__(self, values: Any) -> None:
        super().__init__(values)
        self.read: dict[str, float | None] = {}

    def get(self, name: str, default: Any = None) -> Any:
        self.read[name] = super().get(name)
        return super().get(name, default)

    def __getitem__(self, name: str) -> float:
        self.read[name] = super().get(name)
        return super().__getitem__(name)

    def __contains__(self, name: object) -> bool:
        self.read[str(name)] = super().get(str(name))
        return super().__contains__(name)


@pytest.fixture(scope="session", autouse=True)
def _shared_solids() -> Iterator[None]:
    usual = assembly.one_solid
    parts: dict[tuple[Any, ...], list[Drawn]] = {}

    def built(name: str, draw: Callable[[], cq.Shape]) -> cq.Solid:
        if not isinstance(draw, partial) or not isinstance(draw.func, FunctionType) or "<" in draw.func.__qualname__:
            return usual(name, draw)
        *more, dims = draw.args
        if type(dims.by_name) is not dict:  # they note what is read themselves
            return usual(name, draw)
        variants = parts.setdefault((draw.func, *more, dims.mode, shear_parts._pocket), [])  # a test replaces this
        for read, solid in variants:
            if all(dims.by_name.get(row) == value for row, value in read.items()):
                return solid.copy()
        noted = Noted(dims.by_name)
        solid = usual(name, partial(draw.func, *more, Dimensions(dims.mode, noted)))
        variants[:] = [*variants, (noted.read, solid)][-MOST:]
        return solid.copy()

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(assembly, "one_solid", built)
        yield
