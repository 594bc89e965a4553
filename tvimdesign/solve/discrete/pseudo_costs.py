"""Pseudo-costs: the past rises of bounds after divisions, which tell the best list to divide a box along.

Pseudo-costs, the usual rule of branch and bound: T. Achterberg, T. Koch, A. Martin, Branching rules revisited,
Operations Research Letters 33 (2005) 42-54. A list whose division raises the bounds of both halves is divided first;
one whose entries are as good as one another, whose halves would all be divided alike, is divided last.
"""

from __future__ import annotations

from dataclasses import dataclass, field

Side = int
"""0 is the half with the smaller sizes, 1 the one with the larger."""
_LEAST = 1e-6
"""Least that a half is taken to raise the bound by, in shares of it, so that the other half counts."""
_WITHOUT_DESIGN = 0.1
"""What a half without a design counts for, in shares of the bound: it is left as one beyond every bound is."""


@dataclass
class PseudoCosts:
    """By list and side: how much the bound rose, in shares of it, over how far the number had to move."""

    _risen: dict[tuple[int, Side], float] = field(default_factory=dict)
    _moved: dict[tuple[int, Side], float] = field(default_factory=dict)

    def learn(self, axis: int, side: Side, moved: float, risen: float | None) -> None:
        """Take in one half: how far its number had to move, and the rise of its bound; None where it has no design."""
        if moved <= 0.0:
            return
        key = (axis, side)
        rise = _WITHOUT_DESIGN if risen is None else min(max(risen, 0.0), _WITHOUT_DESIGN)
        self._risen[key] = self._risen.get(key, 0.0) + rise
        self._moved[key] = self._moved.get(key, 0.0) + moved

    def score(self, axis: int, moves: tuple[float, float]) -> float:
        """Return the score of a list, higher is better: the product of the expected rises of both halves."""
        expected = (self._rate(axis, side) * moves[side] for side in (0, 1))
        first, second = (max(rise, _LEAST) for rise in expected)
        return first * second

    def _rate(self, axis: int, side: Side) -> float:
        """Return the rise per move; that of all lists together if this list has not been divided yet."""
        key = (axis, side)
        if key in self._moved:
            return self._risen[key] / self._moved[key]
        every = sum(self._moved.values())
        return sum(self._risen.values()) / every if every else 1.0
