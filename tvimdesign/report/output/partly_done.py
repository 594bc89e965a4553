"""Commands that do all but one thing, such as a plot: they go on, and say at the end what is missing."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

from tvimdesign.base.errors import InputError, TvimError

PARTLY_DONE = "partly done"
"""Status in a manifest."""


@contextmanager
def noting(failures: list[TvimError]) -> Iterator[None]:
    """Add a failure to a list, so that the command goes on; wrong input stays an error of its own."""
    try:
        yield
    except InputError:
        raise
    except TvimError as error:
        failures.append(error)


def done_in_part(failures: list[TvimError]) -> TvimError:
    """Return the error, with exit code 4, by which a command ends that has noted failures."""
    error = TvimError("done in part: " + "; ".join(str(failure) for failure in failures))
    error.exit_code = 4
    return error


def not_done(failures: list[TvimError]) -> dict[str, list[str]]:
    """Return the failures as the field that the output of `--json` has."""
    return {"not_done": [str(failure) for failure in failures]}
