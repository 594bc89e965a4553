"""Factors of one pattern without pivots against numpy, for random patterns that are dominated by their diagonal."""

from typing import NamedTuple

import numba
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray

from tvimdesign.engine.sparse_lu import Pattern, factor, pattern_of, solve, solve_many

Array = NDArray[np.float64]


class Case(NamedTuple):
    matrix: Array
    rows: NDArray[np.int64]
    columns: NDArray[np.int64]
    """Of the entries that are given; their values lie in the matrix, and so do those of the diagonal."""


@st.composite
def cases(draw: st.DrawFn) -> Case:
    """Return a random pattern, often without parts of its diagonal, with values that need no pivots."""
    size = draw(st.integers(1, 14))
    share, seed = draw(st.sampled_from([0.0, 0.1, 0.3, 1.0])), draw(st.integers(0, 2**32 - 1))
    generator = np.random.default_rng(seed)
    hit = generator.random((size, size)) < share
    matrix = np.where(hit, generator.uniform(-1.0, 1.0, (size, size)), 0.0)
    matrix[np.diag_indices(size)] = generator.choice([-1.0, 1.0], size) * (1.0 + np.abs(matrix).sum(axis=1))
    rows, columns = np.nonzero(hit)
    return Case(matrix, rows.astype(np.int64), columns.astype(np.int64))


def factored(case: Case) -> tuple[Pattern, Array]:
    pattern, entries, diagonal = pattern_of(len(case.matrix), case.rows, case.columns)
    w = np.zeros(pattern.size)
    on = case.rows == case.columns
    w[entries[~on]] = case.matrix[case.rows[~on], case.columns[~on]]
    w[diagonal] = np.diagonal(case.matrix)
    factor(pattern, w)
    return pattern, w


@given(case=cases())
def test_one_compiled_program_takes_every_pattern(case: Case) -> None:
    usual, _, _ = pattern_of(2, np.array([0]), np.array([1]))
    pattern, _, _ = pattern_of(len(case.matrix), case.rows, case.columns)
    assert numba.typeof(pattern) == numba.typeof(usual)


@given(case=cases(), lanes=st.integers(0, 5), seed=st.integers(0, 2**32 - 1))
def test_solutions_are_numpys(case: Case, lanes: int, seed: int) -> None:
    pattern, w = factored(case)
    right = np.random.default_rng(seed).uniform(-3.0, 3.0, (len(case.matrix), lanes + 1))
    expected = np.linalg.solve(case.matrix, right)
    many, one = right[pattern.order].copy(), right[pattern.order, 0].copy()
    solve_many(pattern, w, many)
    solve(pattern, w, one)
    found = np.empty_like(many)
    found[pattern.order] = many
    assert found == pytest.approx(expected, rel=1e-10, abs=1e-12)
    assert one == pytest.approx(many[:, 0], rel=1e-12, abs=1e-14)


def test_arrows_and_chains_are_eliminated_without_fill_in() -> None:
    size = 30
    tips = np.arange(1, size)
    nothing = np.zeros(size - 1, np.int64)
    pattern, *_ = pattern_of(size, np.append(tips, nothing), np.append(nothing, tips))
    assert pattern.size == 3 * size - 2
    assert pattern.order[0] != 0
    size = 40
    low = np.arange(size - 1)
    pattern, *_ = pattern_of(size, np.append(low, low + 1), np.append(low + 1, low))
    assert pattern.size == 3 * size - 2


def test_a_matrix_without_a_pivot_gives_no_number() -> None:
    pattern, entries, diagonal = pattern_of(2, np.array([0, 1]), np.array([1, 0]))
    w = np.zeros(pattern.size)
    w[entries] = 1.0
    assert not w[diagonal].any()
    factor(pattern, w)
    right = np.ones(2)
    solve(pattern, w, right)
    assert not np.all(np.isfinite(right))
