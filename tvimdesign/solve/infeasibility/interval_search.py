"""Ranges cut into boxes, and boxes thrown away that provably hold no design: a proof of emptiness, or a lower bound.

Each limit's residual over a box is at least its interval's lower end, and its mean-value form says how much of each
side of the box can keep it at all. What is left is halved along the number that matters most, the box with the least
objective first. Limits on times are not looked at; leaving limits out only adds designs, so what is proved holds.
Source: Hansen and Walster, Global Optimization Using Interval Analysis, 2nd ed. (2004), ch. 10 and 12.
"""

from __future__ import annotations

import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from tvimdesign.solve.infeasibility.enclosure import Enclosure
from tvimdesign.solve.infeasibility.linear_relaxation import LinearBelow
from tvimdesign.solve.nlp.constraints import Constraint

Array = NDArray[np.float64]
_BATCH = 64
"""Boxes looked at in one go; up to that many cost hardly more than one."""
_ROUNDING = 1e-12
"""Share by which sums of interval ends are widened: far more than their rounding, far less than a tolerance."""
_STEEP = 1e3
"""Scales of a limit across a side beyond which it matters no more."""
_WIDTH_LEFT = 1e-9
"""Share of its range below which a side is not halved again."""


@dataclass(frozen=True)
class Objective:
    """What is to be small, of outputs the enclosure has: sum of weight times output, plus what is known of the rest."""

    weights: Mapping[str, float]
    rest: float = 0.0


@dataclass(frozen=True)
class Paved:
    """What is known after a paving."""

    empty: bool
    """Whether it is proved that nothing within the ranges keeps the limits."""
    bound: float
    """No design has a lesser objective; infinite where there is none at all."""
    boxes: int
    cutting: tuple[int, ...]
    """The limits that threw a box away or cut one, by their place."""


@dataclass(frozen=True)
class _Seen:
    """The rows over boxes: ends, ends by the middle, slopes; boxes by rows (by free numbers)."""

    low: Array
    middle: Array
    slope_low: Array
    slope_high: Array


class Paver:
    """Limits, and a goal where there is one, over the ranges of an enclosure."""

    def __init__(
        self, enclosure: Enclosure, limits: Sequence[Constraint], tolerance: float, goal: Objective | None = None
    ) -> None:
        """`tolerance` is the residual up to which a limit counts as kept."""
        self.enclosure, self.limits, self.goal = enclosure, tuple(limits), goal
        place = {name: i for i, name in enumerate(enclosure.outputs)}
        rows = len(self.limits) + (goal is not None)
        self._factor, self._offset = np.zeros((rows, len(place))), np.zeros(rows)
        self._caps = np.full(rows, tolerance)
        for k, limit in enumerate(self.limits):
            sign = 1.0 if limit.sense == "<=" else -1.0
            self._factor[k, place[limit.output]] = sign / limit.scale
            self._offset[k] = -sign * limit.limit / limit.scale
        if goal is not None:
            for name, weight in goal.weights.items():
                self._factor[-1, place[name]] = weight
            self._offset[-1] = goal.rest
            self._caps[-1] = np.inf

    def pave(self, low: Array, high: Array, seconds: float, most: int = 100_000, below: float = np.inf) -> Paved:
        """Cut and halve for about so many seconds or boxes; designs with an objective above `below` do not count."""
        caps = self._caps.copy()
        if self.goal is not None:
            caps[-1] = below
        lows, highs, bounds = low[None].copy(), high[None].copy(), np.array([-np.inf])
        cutting: set[int] = set()
        boxes, end = 0, time.process_time() + seconds
        finished = np.inf  # the least bound of boxes too small to halve
        while len(lows) and boxes < most and (boxes == 0 or time.process_time() < end):
            order = np.argsort(bounds, kind="stable")
            now, later = order[:_BATCH], order[_BATCH:]
            boxes += len(now)
            found = self._cut(lows[now], highs[now], bounds[now], caps, cutting)
            halves = self._halved(*found, low, high)
            finished = min(finished, halves[3])
            lows = np.concatenate([lows[later], halves[0]])
            highs = np.concatenate([highs[later], halves[1]])
            bounds = np.concatenate([bounds[later], halves[2]])
        bound = float(min(np.min(bounds, initial=np.inf), finished))
        return Paved(len(bounds) == 0 and not np.isfinite(finished), min(bound, below), boxes, tuple(sorted(cutting)))

    def _cut(
        self, low: Array, high: Array, bound: Array, caps: Array, cutting: set[int]
    ) -> tuple[Array, Array, Array, Array]:
        """What is left of boxes, their bounds, and how much each side matters."""
        seen = self._seen(low, high)
        dead = seen.low > caps
        cutting.update(int(k) for k in np.flatnonzero(np.any(dead[:, : len(self.limits)], axis=0)))
        alive = ~np.any(dead, axis=1)
        least, most, by_low, by_high = _narrowed(seen, low, high, caps)
        narrowed = (by_low > low[:, None, :]) | (by_high < high[:, None, :])
        cutting.update(int(k) for k in np.flatnonzero(np.any(narrowed[:, : len(self.limits)], axis=(0, 2))))
        alive &= np.all(least <= most, axis=1)
        if self.goal is not None:
            bound = np.maximum(bound, seen.low[:, -1])
        if self.goal is not None and np.any(alive):
            below = self._relaxed(seen, least[alive], most[alive], caps, alive)
            bound[alive] = np.maximum(bound[alive], below)
            alive &= bound <= caps[-1]
        matters = self._matters(low, high) * (most - least)
        return least[alive], most[alive], bound[alive], matters[alive]

    def _matters(self, low: Array, high: Array) -> Array:
        """How much the rows change with each free number in the middle of boxes; the goal counts as all limits do."""
        middle = 0.5 * (low + high)
        slopes = self.enclosure.slopes(middle, middle)
        sizes = np.abs(self._lower(slopes.low, slopes.high))
        sizes = np.minimum(np.where(np.isfinite(sizes), sizes, 0.0), _STEEP / (high - low + 1e-300)[:, None, :])
        total: Array = np.sum(sizes[:, : len(self.limits)], axis=1)
        if self.goal is not None:
            total += len(self.limits) * sizes[:, -1]
        return total

    def _relaxed(self, seen: _Seen, low: Array, high: Array, caps: Array, alive: NDArray[np.bool_]) -> Array:
        """What linear programmes below the rows say of boxes that are left."""
        corners = []
        for corner in (low, high):
            found = self.enclosure.natural(corner, corner)
            corners.append(self._lower(found.low, found.high) + self._offset)
        width = (high - low)[:, None, :]
        with np.errstate(invalid="ignore"):
            rising, falling = seen.slope_low[alive] * width, seen.slope_high[alive] * width
        boxes = zip(corners[0], rising, corners[1], falling, strict=True)
        return np.array([LinearBelow(*box, caps).bound() for box in boxes])

    @staticmethod
    def _halved(
        low: Array, high: Array, bound: Array, matters: Array, first_low: Array, first_high: Array
    ) -> tuple[Array, Array, Array, float]:
        """Both halves of every box along the side that matters most; boxes that are next to points are done."""
        if not len(low):
            return low, high, bound, np.inf
        wide = (high - low) > _WIDTH_LEFT * (first_high - first_low)
        open_ = np.any(wide, axis=1)
        done = float(np.min(bound[~open_], initial=np.inf)) if np.any(~open_) else np.inf
        low, high, bound = low[open_], high[open_], bound[open_]
        side = np.argmax(np.where(wide, matters, -1.0)[open_], axis=1)
        boxes = np.arange(len(low))
        middle = 0.5 * (low[boxes, side] + high[boxes, side])
        left, right = high.copy(), low.copy()
        left[boxes, side] = middle
        right[boxes, side] = middle
        return np.concatenate([low, right]), np.concatenate([left, high]), np.concatenate([bound, bound]), done

    def _seen(self, low: Array, high: Array) -> _Seen:
        """The rows over the boxes: the best of their own ends and of the mean-value form."""
        natural, slopes = self.enclosure.natural(low, high), self.enclosure.slopes(low, high)
        middle = 0.5 * (low + high)
        at_middle = self.enclosure.natural(middle, middle)
        rows = self._lower(natural.low, natural.high) + self._offset
        centre = self._lower(at_middle.low, at_middle.high) + self._offset
        slope_low = self._lower(slopes.low, slopes.high)
        slope_high = self._upper(slopes.low, slopes.high)
        usable = ~np.any((self._factor != 0.0)[None] & ~natural.whole[:, None, :], axis=2)
        slope_low = np.where(usable[:, :, None], slope_low, -np.inf)
        slope_high = np.where(usable[:, :, None], slope_high, np.inf)
        total = centre + np.sum(_least_swing(slope_low, slope_high, low, high), axis=2)
        total = total - _ROUNDING * (1.0 + np.abs(total))
        return _Seen(np.fmax(rows, total), centre, slope_low, slope_high)

    def _upper(self, low: Array, high: Array) -> Array:
        """Upper ends of the rows, less their offsets."""
        return -self._lower(-high, -low)

    def _lower(self, low: Array, high: Array) -> Array:
        """Lower ends of the rows, less their offsets, from the ends of the outputs (boxes by outputs, and so on)."""
        found = np.zeros((len(low), len(self._factor), *low.shape[2:]))
        for k, factors in enumerate(self._factor):
            for i in np.flatnonzero(factors):
                part = factors[i] * (low[:, i] if factors[i] > 0.0 else high[:, i])
                found[:, k] += part - _ROUNDING * np.where(np.isfinite(part), np.abs(part), 0.0)
        return found


def _least_swing(slope_low: Array, slope_high: Array, low: Array, high: Array) -> Array:
    """The least that slope times distance from the middle can be, boxes by rows by free numbers."""
    half = 0.5 * (high - low) * (1.0 + _ROUNDING)
    steepest = np.maximum(np.abs(slope_low), np.abs(slope_high))
    with np.errstate(invalid="ignore"):
        return -np.where(half[:, None, :] > 0.0, steepest * half[:, None, :], 0.0)


def _narrowed(seen: _Seen, low: Array, high: Array, caps: Array) -> tuple[Array, Array, Array, Array]:
    """What of each side can keep the rows below their caps by the mean-value form: for all rows, and for each.

    Of sum_j G_j d_j <= cap - f(c), with d the distance from the middle, all but one term is set to its least.
    """
    middle = 0.5 * (low + high)
    with np.errstate(all="ignore"):
        swing = _least_swing(seen.slope_low, seen.slope_high, low, high)
        unknown = ~np.isfinite(swing)
        known = np.where(unknown, 0.0, swing)
        others_known = np.sum(known, axis=2, keepdims=True) - known
        hidden = np.sum(unknown, axis=2, keepdims=True) - unknown
        room = (caps - seen.middle)[:, :, None] - others_known
        room = np.where(hidden > 0, np.inf, room)
        room = room + _ROUNDING * (1.0 + np.abs(room) + np.sum(np.abs(known), axis=2, keepdims=True))
        rising, falling = seen.slope_low > 0.0, seen.slope_high < 0.0
        far = np.where(room >= 0.0, room / seen.slope_low, room / seen.slope_high)
        near = np.where(room >= 0.0, room / seen.slope_high, room / seen.slope_low)
        by_high = np.where(rising & np.isfinite(room), middle[:, None, :] + far, np.inf)
        by_low = np.where(falling & np.isfinite(room), middle[:, None, :] + near, -np.inf)
        slack = _ROUNDING * (np.abs(low) + np.abs(high))[:, None, :]
        by_high = np.where(np.isnan(by_high), np.inf, by_high + slack)
        by_low = np.where(np.isnan(by_low), -np.inf, by_low - slack)
    return np.maximum(low, by_low.max(axis=1)), np.minimum(high, by_high.min(axis=1)), by_low, by_high
