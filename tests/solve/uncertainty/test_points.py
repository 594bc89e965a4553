"""Points that are drawn here, or kept from one run to the next, are scipy's."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from scipy.stats import qmc

from tvimdesign.solve.uncertainty.intervals import draw
from tvimdesign.solve.uncertainty.sobol_points import sobol_points
from tvimdesign.solve.uncertainty.unmeasured import UnmeasuredInput


@pytest.mark.parametrize(("inputs", "count", "seed"), [(1, 8, 1), (7, 64, 3), (40, 512, 11)])
def test_ranges_are_drawn_as_scipys_latin_hypercube(inputs: int, count: int, seed: int) -> None:
    shares = [UnmeasuredInput(f"share_{i}", 0.5, 0.0, 1.0, "assumed") for i in range(inputs)]
    expected = qmc.LatinHypercube(inputs, rng=np.random.default_rng(seed)).random(count).T
    assert np.array_equal(draw(shares, count, seed), expected)


def test_kept_points_are_scipys_and_scipy_is_not_loaded_for_them(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("TVIMDESIGN_CACHE", str(tmp_path))
    expected = qmc.Sobol(5, rng=np.random.default_rng(2)).random(64)
    assert np.array_equal(sobol_points(5, 64, 2), expected)
    again = (
        "import sys\nfrom tvimdesign.solve.uncertainty.sobol_points import sobol_points\n"
        "points = sobol_points(5, 64, 2)\nassert 'scipy.stats' not in sys.modules\nprint(points.tobytes().hex())"
    )
    said = subprocess.run([sys.executable, "-c", again], capture_output=True, text=True, check=True).stdout
    assert bytes.fromhex(said.strip()) == expected.tobytes()


def test_points_of_another_seed_or_count_are_others(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("TVIMDESIGN_CACHE", str(tmp_path))
    first = sobol_points(3, 16, 1)
    assert not np.array_equal(first, sobol_points(3, 16, 2))
    assert sobol_points(3, 32, 1).shape == (32, 3)
    assert np.array_equal(first, sobol_points(3, 32, 1)[:16])
