"""Files that appear whole."""

from __future__ import annotations

import os
import secrets
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from tvimdesign.base import journal
from tvimdesign.base.errors import OutputError

TABLE_ENCODING = "utf-8-sig"
"""Of a CSV file: with a byte order mark, without which Excel shows N·m as NÂ·m. Readers name it, too."""


def atomic_write(path: Path, data: bytes) -> None:
    """Write beside, flush to disk, rename: a reader never sees half a file. Raises OutputError."""
    with whole_file(path) as beside:
        beside.write_bytes(data)


@contextmanager
def whole_file(path: Path) -> Iterator[Path]:
    """Yield a file beside, to be written by whoever needs its path, which then takes its place. Raises OutputError.

    In the folder of an unfinished run both names are in its journal before their files exist.
    """
    beside = path.with_name(f".{path.name[:100]}.{secrets.token_hex(8)}.part")
    try:
        journal.record(beside, journal.ANY)
        os.close(os.open(beside, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o666))  # the umask takes its part
        try:
            yield beside
            with beside.open("rb+") as stream:
                os.fsync(stream.fileno())
            journal.record(path, journal.digest_of(beside))
            beside.replace(path)
        except BaseException:
            beside.unlink(missing_ok=True)
            raise
    except OSError as error:
        raise _cannot(path, error) from error


def make_folder(path: Path) -> None:
    """Make a folder, and those it stands in, where there is none. Raises OutputError."""
    try:
        path.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise _cannot(path, error) from error


def _cannot(path: Path, error: OSError) -> OutputError:
    return OutputError(
        f"{path}: cannot be written: {error.strerror or error}; what was written before is whole: make room, or name "
        "another folder with --out"
    )
