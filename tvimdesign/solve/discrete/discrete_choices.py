"""Choices that a study lists: records, sizes of numbers, and boxes of sizes that a search divides."""

import bisect
import itertools
import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

from tvimdesign.device import Input, Table
from tvimdesign.solve.nlp.mixture import Mixture
from tvimdesign.solve.nlp.solver_run import Ends
from tvimdesign.study import Options, Study

Box = tuple[tuple[int, int], ...]
"""First and last place among the sizes of each listed number and the records of each mixture, in their order."""

SAME_SIZE = 1e-6  # Share of a size within which a number has it
_ONE_RECORD = 1e-4
"""Share of other records up to which a design is that of one: a solver leaves as much of what it does not want."""
_RECORDS_LAST = 0.1
"""Distance [shares of a size] at which half of another record lies, twice: records that are as good as one another stay
mixed while sizes are divided, for their boxes would all be divided alike."""
_BESIDE = 0.45  # A mixed design is nearer to the record it has most of than to the next


@dataclass(frozen=True)
class Sizes:
    """The listed numbers of a study, each with its sizes (SI) from the smallest up; then its mixtures of records.

    The records of a mixture have the sizes 1, 2, ... in their order. A mixed design lies beside the record that it has
    most of, farther from it the more it has of others.
    """

    names: tuple[str, ...]
    sizes: tuple[tuple[float, ...], ...]
    mixtures: tuple[Mixture, ...] = ()

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

    def mixed(self, mixtures: Sequence[Mixture]) -> "Sizes":
        """Return the listed numbers and the records of mixtures."""
        numbers = len(self.names) - len(self.mixtures)
        places = tuple(tuple(float(i + 1) for i in range(len(mixture.records))) for mixture in mixtures)
        names = (*self.names[:numbers], *(mixture.name for mixture in mixtures))
        return Sizes(names, (*self.sizes[:numbers], *places), tuple(mixtures))

    def numbers(self, box: Box) -> dict[str, Ends]:
        """Least and largest value of each listed number in a box."""
        count = len(self.names) - len(self.mixtures)
        return {
            name: (sizes[first], sizes[last])
            for name, sizes, (first, last) in zip(self.names[:count], self.sizes, box, strict=False)
        }

    def ends(self, box: Box) -> dict[str, Ends]:
        """Return the ends of all sizes, and the least and largest share of each record."""
        sizes = self.numbers(box)
        for mixture, (first, last) in zip(self.mixtures, self._places(box), strict=True):
            for place, name in enumerate(mixture.shares):
                inside = first <= place <= last
                sizes[name] = (float(inside and first == last), float(inside))
        return sizes

    def records(self, box: Box) -> dict[str, str]:
        """Return the records chosen in a box of one combination."""
        chosen: dict[str, str] = {}
        for mixture, (first, _) in zip(self.mixtures, self._places(box), strict=True):
            chosen |= mixture.records[first]
        return chosen

    def values(self, inputs: Mapping[str, float]) -> dict[str, float]:
        """Return the listed numbers of a design and its place among the records of each mixture."""
        numbers = {name: inputs[name] for name in self.names[: len(self.names) - len(self.mixtures)]}
        return numbers | {mixture.name: _among([inputs[name] for name in mixture.shares]) for mixture in self.mixtures}

    def apart(self, place: int, value: float, size: float) -> float:
        """Return the distance of a value from a size, relative to the size; relative to the largest size if it is zero.

        Records are nearer to one another, so that sizes are divided first.
        """
        if place >= len(self.names) - len(self.mixtures):
            return _RECORDS_LAST * abs(value - size)
        if value > 0.0 and size > 0.0:
            return abs(math.log(value / size))
        return abs(value - size) / (abs(self.sizes[place][-1]) or 1.0)

    def _places(self, box: Box) -> Box:
        return box[len(self.names) - len(self.mixtures) :]

    def each(self) -> Iterator[Box]:
        """Yield every combination once, each a neighbour of its predecessor: to and fro along number after number."""
        return map(self.combination, range(self.count))

    def combination(self, number: int) -> Box:
        """Return the combination at a position, counted from 0, in the order of `each`."""
        places, remainder = [], number
        for count in reversed(self.shape):
            turn, place = divmod(remainder, count)
            places.append(place if turn % 2 == 0 else count - 1 - place)
            remainder = turn
        return tuple((place, place) for place in reversed(places))

    def nearest(self, values: Mapping[str, float], box: Box) -> Box:
        """Return the combination in a box whose sizes are nearest to some values."""
        places = []
        for name, sizes, (first, last) in zip(self.names, self.sizes, box, strict=True):
            place = min(range(first, last + 1), key=lambda i: abs(sizes[i] - values[name]))
            places.append((place, place))
        return tuple(places)

    def around(self, values: Mapping[str, float]) -> Iterator[Box]:
        """Yield the combinations of the sizes beside some values: the next below each, or the next above."""
        sides = []
        for name, sizes in zip(self.names, self.sizes, strict=True):
            above = bisect.bisect_left(sizes, values[name] * (1.0 - SAME_SIZE))
            sides.append([(place, place) for place in (above - 1, above) if 0 <= place < len(sizes)])
        return itertools.product(*sides)

    def are_sizes(self, values: Mapping[str, float], box: Box) -> bool:
        """Return whether values are the sizes of one combination in a box."""
        return self.hold(values, self.nearest(values, box))

    def hold(self, values: Mapping[str, float], box: Box) -> bool:
        """Return whether values lie in a box."""
        return all(
            sizes[first] * (1.0 - SAME_SIZE) <= values[name] <= sizes[last] * (1.0 + SAME_SIZE)
            for name, sizes, (first, last) in zip(self.names, self.sizes, box, strict=True)
        )


def _among(shares: Sequence[float]) -> float:
    """Return the place of shares among records: at one of them, or beside it towards the larger share of the others."""
    most = max(range(len(shares)), key=shares.__getitem__)
    beside = min(1.0 - shares[most], _BESIDE)
    if beside < _ONE_RECORD:
        return most + 1.0
    more = sum(shares[:most]) < sum(shares[most + 1 :])
    return most + 1.0 + (beside if more else -beside)


def is_one(box: Box) -> bool:
    """Return whether a box holds one combination."""
    return all(first == last for first, last in box)


def discrete_sizes(study: Study, table: Table) -> Sizes:
    """Return the numbers whose sizes a study lists."""
    listed = {
        name: tuple(sorted(float(value) for value in vary.values))
        for name, vary in study.vary.items()
        if isinstance(vary, Options) and isinstance(table.quantity(name), Input)
    }
    return Sizes(tuple(listed), tuple(listed.values()))
