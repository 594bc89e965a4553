"""One deadline for a command: parts of it end earlier, and what is left out is known to all."""

from __future__ import annotations

import pytest

from tvimdesign.base.deadline import NEVER, Deadline
from tvimdesign.base.errors import TimeOverError


class Clock:
    """A clock that is set."""

    now = 0.0

    def __call__(self) -> float:
        return self.now


@pytest.fixture
def clock() -> Clock:
    return Clock()


def test_a_part_leaves_time_to_what_follows(clock: Clock) -> None:
    whole = Deadline(20.0, clock)
    part = whole.leaving(4.0)
    assert (part.remaining, part.late.remaining, whole.remaining) == (16.0, 18.0, 20.0)
    clock.now = 17.0
    assert (part.passed, part.late.passed, whole.passed) == (True, False, False)
    assert part.whole is whole


def test_a_part_leaves_half_of_the_time_at_most(clock: Clock) -> None:
    part = Deadline(5.0, clock).leaving(30.0)
    assert part.remaining == 2.5
    clock.now = 2.0
    part.leave(1.0)
    assert part.remaining == 0.5  # once left, time is not taken back


def test_a_step_without_time_is_noted_and_not_done(clock: Clock) -> None:
    whole = Deadline(5.0, clock)
    part, done = whole.leaving(1.0), list[str]()
    assert part.attempt("the first", lambda: done.append("first") or 1) == 1
    clock.now = 4.5
    assert part.attempt("the second", lambda: done.append("second") or 2) is None
    assert (done, whole.left_out, part.met, whole.met) == (["first"], ["the second"], True, False)


def test_a_step_that_runs_out_of_time_is_noted_once(clock: Clock) -> None:
    whole = Deadline(5.0, clock)

    def late() -> None:
        clock.now = 6.0
        whole.check("it was done")

    whole.attempt("it", late)
    whole.attempt("it", late)
    assert whole.left_out == ["it"]


def test_the_error_names_the_step_and_what_to_do(clock: Clock) -> None:
    clock.now = 1.0
    limit = Deadline(20.0, clock)
    clock.now = 21.0
    with pytest.raises(TimeOverError, match=r"limit of 20 s was over before all was done: raise .*--time-limit"):
        limit.check("all was done")


def test_without_a_limit_no_part_ends() -> None:
    part = NEVER.leaving(4.0)
    assert not part.passed
    assert not part.late.passed
