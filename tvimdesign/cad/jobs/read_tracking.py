"""What a piece of work reads of a design: the numbers and words that decide whether it must be done again."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

from tvimdesign.cad.geometry.dimensions import Dimensions, dimensions
from tvimdesign.study.design import Design

Reads = dict[str, dict[str, Any]]
"""Value by name, for each part of a design that is read; None for what the design does not have."""


class Watched(Mapping[str, Any]):
    """A mapping that writes down what is read of it."""

    def __init__(self, whole: Mapping[str, Any], read: dict[str, Any]) -> None:
        """`read` is where it is written down."""
        self._whole, self._read = whole, read

    def __getitem__(self, name: str) -> Any:
        """Read one value."""
        self._read[name] = self._whole.get(name)
        return self._whole[name]

    def __contains__(self, name: object) -> bool:
        """Whether there is a value of that name, which is read too."""
        self._read[str(name)] = self._whole.get(str(name))
        return name in self._whole

    def __iter__(self) -> Iterator[str]:
        """All names; then all of it counts as read."""
        self._read.update(self._whole)
        return iter(self._whole)

    def __len__(self) -> int:
        """How many names there are."""
        return len(self._whole)


class TrackedDesign:
    """A design and its dimensions, from which pieces of work read."""

    def __init__(self, design: Design, titles: Mapping[str, str]) -> None:
        """Work out the dimensions of a design once; `titles` says what the catalogue calls each chosen record."""
        self._mode = design.mode
        self._lengths = dimensions(design).by_name
        self._design = design
        self._parts: dict[str, Mapping[str, Any]] = {
            "dimensions": self._lengths,
            "values": design.values,
            "choices": design.choices,
            "titles": titles,
            "said": {"name": design.name, "mode": design.mode},
        }

    def watched(self, named: bool) -> tuple[Design, Dimensions, Mapping[str, str], Reads]:
        """Return the design, its dimensions and titles to work with, and where is written what was read of them.

        The design has its name only for work that is `named`; all else is the same for designs of any name.
        """
        reads: Reads = {part: {} for part in self._parts}
        reads["said"] = {"mode": self._mode} | ({"name": self._design.name} if named else {})
        seen = {part: Watched(self._parts[part], reads[part]) for part in self._parts if part != "said"}
        name = self._design.name if named else ""
        seen_by_work = {"name": name, "values": seen["values"], "choices": seen["choices"]}
        design = self._design.model_copy(update=seen_by_work)
        return design, Dimensions(self._mode, seen["dimensions"]), seen["titles"], reads

    def agrees_with(self, reads: Reads) -> bool:
        """Whether all that was read then is the same in this design."""
        return all(
            part in self._parts and all(self._parts[part].get(name) == value for name, value in read.items())
            for part, read in reads.items()
        )
