"""Starting points of searches: a seed gives the same points, and many are evenly spread."""

from __future__ import annotations

import itertools
import subprocess
import sys

import numpy as np
from scipy.stats import qmc
from support import ROOT

from tvimdesign.solve.optimizer.starting_points import FEW, unit_points


def _points(starts: int, size: int, seed: int, count: int) -> np.ndarray:
    return np.array(list(itertools.islice(unit_points(starts, size, seed), count)))


def test_a_seed_gives_its_points_and_another_others() -> None:
    for starts in (3, 64):
        assert np.array_equal(_points(starts, 4, 1, 50), _points(starts, 4, 1, 50))
        assert not np.allclose(_points(starts, 4, 1, 50), _points(starts, 4, 2, 50))


def test_few_starts_begin_where_they_always_have() -> None:
    """numpy's generator, number for number."""
    assert np.array_equal(_points(FEW, 3, 7, 10), np.random.default_rng(7).random((10, 3)))


def test_many_points_fill_every_slice_of_every_range() -> None:
    # A Sobol sequence of 2^k points has one in each of 2^k slices; random points leave a third of them empty.
    points = _points(64, 12, 1, 64)
    for column in points.T:
        assert len(set((column * 64).astype(int))) == 64
    assert qmc.discrepancy(points) < 0.5 * qmc.discrepancy(np.random.default_rng(1).random((64, 12)))


def test_few_starts_leave_the_sobol_sequence_unloaded() -> None:
    code = (
        "import sys; from tvimdesign.solve import search; "
        "from tvimdesign.solve.optimizer.starting_points import unit_points; "
        "next(unit_points(16, 3, 1)); assert 'scipy.stats' not in sys.modules"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, cwd=ROOT, check=False)
    assert done.returncode == 0, done.stderr
