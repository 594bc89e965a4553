"""A check of many items names all that fail, and fails where there is none."""

import pytest
from every import of_every


def _is_even(number: int) -> None:
    assert number % 2 == 0, "odd"


def test_all_that_fail_are_named_at_once() -> None:
    with pytest.raises(AssertionError, match=r"2 of 4 fail:\n  1: AssertionError: odd\n  3: AssertionError: odd"):
        of_every([1, 2, 3, 4], _is_even)
    of_every([2, 4], _is_even)


def test_what_is_raised_otherwise_counts_and_nothing_to_check_fails() -> None:
    def check(name: str) -> None:
        with pytest.raises(KeyError):
            {"a": 1}[name]

    with pytest.raises(AssertionError, match="a: Failed: DID NOT RAISE"):
        of_every(["a", "b"], check)
    with pytest.raises(AssertionError, match="nothing to check"):
        of_every([], check)
