"""Reads a file a user names: an ordinary one, of a sensible size, with an error in words for anything else."""

from __future__ import annotations

import stat
from collections.abc import Callable
from pathlib import Path

from tvimdesign.base.errors import InputError


def printable(path: Path) -> str:
    """Write a path so that a terminal shows it and obeys nothing in it."""
    return "".join(c if c.isprintable() else ascii(c)[1:-1] for c in str(path))


def is_folder(path: Path) -> bool:
    """Return whether a path is a folder; one that is too long to be a path is none."""
    try:
        return path.is_dir()
    except (OSError, ValueError):  # no permission, a name too long
        return False


def ordinary_bytes(path: Path, most: int, wanted: str, too_big: Callable[[int], Exception]) -> bytes:
    """Return at most `most` + 1 bytes of an ordinary file; `wanted` says what should have been given.

    Raises FileNotFoundError as it is, what `too_big` makes of a size above `most`, and InputError for the rest: a
    folder, a pipe or a device, which might never end.
    """
    shown = printable(path)
    try:
        status = path.stat()
        if stat.S_ISDIR(status.st_mode):
            raise InputError(f"{shown} is a folder; give the path of {wanted}")
        if not stat.S_ISREG(status.st_mode):
            raise InputError(f"{shown} is no ordinary file; give the path of {wanted}")
        if status.st_size > most:
            raise too_big(status.st_size)
        with path.open("rb") as file:
            return file.read(most + 1)
    except FileNotFoundError:
        raise
    except (OSError, ValueError) as error:
        reason = error.strerror if isinstance(error, OSError) and error.strerror else str(error)
        raise InputError(f"{shown} cannot be read: {reason}") from None
