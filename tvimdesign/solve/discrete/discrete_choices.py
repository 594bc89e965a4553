"""What a study lists to choose from: records, sizes of numbers, and boxes of sizes that a search divides."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass

from tvimdesign.base.units import format_quantity
from tvimdesign.device import Input, Table
from tvimdesign.solve.nlp.solver_run import Ends
from tvimdesign.study import Options, Study

Box = tuple[tuple[int, int], ...]
"""First and last place among the sizes of each listed number, in their order."""

SAME_SIZE = 1e-6
"""Share of a size within which a number has it."""


@dataclass(frozen=True)
class Sizes:
    """The listed numbers of a study, each with its sizes (SI) from the smallest up."""

    names: tuple[str, ...]
    sizes: tuple[tuple[float, ...], ...]

    @property
    def count(self) -> int:
        """Combinations of sizes; one where none is listed."""
        return math.prod(self.shape)

    @property
    def shape(self) -> tuple[int, ...]:
        """Count of sizes of each number."""
        return tuple(len(sizes) for sizes in self.sizes)

    @property
    def whole(self) -> Box:
        """The box of all sizes."""
        return tuple((0, count - 1) for count in self.shape)

    def ends(self, box: Box) -> dict[str, Ends]:
        """Least and largest value of each listed number in a box."""
        return {
            name: (sizes[first], sizes[last])
            for name, sizes, (first, last) in zip(self.names, self.sizes, box, strict=True)
        }

    def each(self) -> Iterator[Box]:
        """Every combination once, each a neighbour of the one before: to and fro along one number after another."""
        places: list[tuple[int, ...]] = [()]
        for count in self.shape:
            there = range(count)
            places = [
                (*before, place)
                for turn, before in enumerate(places)
                for place in (there if turn % 2 == 0 else reversed(there))
            ]
        return (tuple((place, place) for place in combination) for combination in places)

    def nearest(self, values: Mapping[str, float], box: Box) -> Box:
        """The combination in a box whose sizes are nearest to some values."""
        found = []
        for name, sizes, (first, last) in zip(self.names, self.sizes, box, strict=True):
            place = min(range(first, last + 1), key=lambda i: abs(sizes[i] - values[name]))
            found.append((place, place))
        return tuple(found)

    def are_sizes(self, values: Mapping[str, float], box: Box) -> bool:
        """Whether values are those of one combination in a box."""
        ends = self.ends(self.nearest(values, box))
        return all(abs(values[name] - size) <= SAME_SIZE * abs(size) for name, (size, _) in ends.items())

    def in_words(self, table: Table, box: Box) -> str:
        """`wire_diameter 2 mm, coil_count 3.25`: the smallest of a box."""
        ends = self.ends(box).items()
        return ", ".join(f"{name} {format_quantity(low, table.unit(name))}" for name, (low, _) in ends)


def is_one(box: Box) -> bool:
    """Whether a box holds one combination."""
    return all(first == last for first, last in box)


def discrete_sizes(study: Study, table: Table) -> Sizes:
    """The numbers whose sizes a study lists."""
    listed = {
        name: tuple(sorted(float(value) for value in vary.values))
        for name, vary in study.vary.items()
        if isinstance(vary, Options) and isinstance(table.quantity(name), Input)
    }
    return Sizes(tuple(listed), tuple(listed.values()))
