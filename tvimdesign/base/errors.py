"""The package's exceptions: one small tree, each with the exit code the command line answers with."""

import math


class TvimError(Exception):
    """Anything tvimdesign says no to; the message names the thing, the value, the limit and the next step."""

    exit_code = 2


class InputError(TvimError):
    """The user's input is wrong: a study, a record, a file, an option."""


class FolderInUseError(InputError):
    """Another run writes the results folder."""


class CatalogError(InputError):
    """A catalogue record is missing, malformed or lacks a value."""


class UnitError(InputError):
    """A unit is unknown or has the wrong dimension."""


class InfeasibleError(TvimError):
    """No design meets the requirements, or the solver did not converge."""

    exit_code = 3


class SimulationError(InfeasibleError):
    """The heat equation could not be integrated for a design."""


class AboveRatingError(InfeasibleError):
    """The optimum is beyond what a material or a bought part is rated for, and the study does not accept that."""


class BelowYieldError(InfeasibleError):
    """Fewer modules satisfy the limits of the best design than the study requires."""


class TimeOverError(TvimError):
    """The time limit was over before a step was done; nothing is known of what it would have come to."""

    exit_code = 3

    def __init__(self, step: str, seconds: float) -> None:
        """`step` names what was not done."""
        limit = f"the time limit of {seconds:g} s" if math.isfinite(seconds) else "the time limit"
        super().__init__(f"{limit} was over before {step}: raise `solver.time_limit` (or --time-limit)")


class GeometryError(TvimError):
    """A part could not be built, or a built part is not what the model says it is."""

    exit_code = 4


class OutputError(TvimError):
    """A file of results cannot be written: the disk is full, or the folder may not be written."""

    exit_code = 4


class FolderWarning(UserWarning):
    """A folder of records is a link, or another user's."""
