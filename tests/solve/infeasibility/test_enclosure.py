"""What bounds claim of the whole table holds at every point of the ranges, in both modes; and it is of use."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest
from support import ROOT

from tvimdesign.catalog import Catalog
from tvimdesign.device import table_for
from tvimdesign.solve.infeasibility.enclosure import Enclosure
from tvimdesign.solve.infeasibility.infeasibility_proof import Ranges, ranges_of
from tvimdesign.solve.nlp.constraints import on_cycle
from tvimdesign.study import read_study

STUDIES = ["paper_shear", pytest.param("wrist_compression", marks=pytest.mark.slow)]
POINTS = 100


@cache
def _ranges(name: str) -> Ranges:
    study = read_study(ROOT / f"studies/{name}.yaml")
    return ranges_of(study, Catalog(), table_for(study.mode))


@cache
def _enclosure(name: str) -> Enclosure:
    ranges = _ranges(name)
    return ranges.enclosure([one for one in ranges.model.output_names if not on_cycle(ranges.table, one)])


def _sub_boxes(ranges: Ranges, random: np.random.Generator) -> tuple[np.ndarray, np.ndarray]:
    """The ranges, and boxes within them down to a thousandth."""
    width = ranges.high - ranges.low
    sizes = np.array([1.0, 0.1, 1e-3])[:, None] * width
    low = ranges.low + random.random(sizes.shape) * (width - sizes)
    return low, np.minimum(low + sizes, ranges.high)


@pytest.mark.parametrize("name", STUDIES)
def test_every_algebraic_output_lies_within_its_bounds_at_random_points(name: str) -> None:
    ranges, enclosure, random = _ranges(name), _enclosure(name), np.random.default_rng(5)
    for low, high in zip(*_sub_boxes(ranges, random), strict=True):
        bounds = enclosure.bounds(low, high)
        for _ in range(POINTS):
            values = enclosure.values(low + random.random(len(low)) * (high - low))
            there = np.isfinite(values)
            wrong = there & ~((bounds.low <= values) & (values <= bounds.high))
            assert not wrong.any(), [enclosure.outputs[i] for i in np.flatnonzero(wrong)]
            assert not np.any(~there & bounds.whole)


@pytest.mark.parametrize("name", STUDIES)
def test_every_slope_lies_within_its_bounds_at_random_points(name: str) -> None:
    ranges, enclosure, random = _ranges(name), _enclosure(name), np.random.default_rng(6)
    lows, highs = _sub_boxes(ranges, random)
    boxes = enclosure.slopes(lows, highs)
    for k in range(len(lows)):
        inside = lows[k] + random.random((POINTS, len(lows[k]))) * (highs[k] - lows[k])
        at = enclosure.slopes(inside, inside)
        known = np.isfinite(at.low) & np.isfinite(at.high)
        assert np.mean(known) > 0.5
        assert np.all(~known | ((boxes.low[k] <= at.high) & (at.low <= boxes.high[k])))


def test_a_slope_is_the_difference_of_the_values() -> None:
    enclosure, ranges = _enclosure("paper_shear"), _ranges("paper_shear")
    middle = 0.5 * (ranges.low + ranges.high)
    i, place = enclosure.outputs.index("envelope_volume"), enclosure.free.index("wire_diameter")
    step = np.zeros_like(middle)
    step[place] = 1e-7
    difference = (enclosure.values(middle + step)[i] - enclosure.values(middle - step)[i]) / 2e-7
    slopes = enclosure.slopes(middle[None], middle[None])
    assert slopes.low[0, i, place] == pytest.approx(difference, rel=1e-6)
    assert slopes.high[0, i, place] == pytest.approx(difference, rel=1e-6)


@pytest.mark.parametrize("name", STUDIES)
def test_bounds_of_an_output_that_only_rises_are_reached(name: str) -> None:
    """The envelope's diameter rises with every number it hangs on, so it is least and greatest at two corners."""
    enclosure, ranges = _enclosure(name), _ranges(name)
    i = enclosure.outputs.index("envelope_diameter")
    bounds = enclosure.bounds(ranges.low, ranges.high)
    assert bounds.low[i] == pytest.approx(enclosure.values(ranges.low)[i], rel=1e-12)
    assert bounds.high[i] == pytest.approx(enclosure.values(ranges.high)[i], rel=1e-12)
