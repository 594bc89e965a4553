"""Files that appear whole."""

from __future__ import annotations

import os
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from tvimdesign.base.errors import OutputError

TABLE_ENCODING = "utf-8-sig"
"""Of a CSV file: with a byte order mark, without which Excel shows N·m as NÂ·m. Readers name it, too."""


HALF_WRITTEN = ".*.part"
"""Files that a process which was killed has left half written: a pattern."""


def write_whole(path: Path, data: bytes) -> None:
    """Write beside, flush to disk, rename: a reader never sees half a file. Raises OutputError."""
    with whole_file(path) as beside:
        beside.write_bytes(data)


@contextmanager
def whole_file(path: Path) -> Iterator[Path]:
    """A file beside, to be written by whoever needs its path, which then takes its place. Raises OutputError."""
    try:
        handle, name = tempfile.mkstemp(dir=path.parent, prefix=f".{path.name[:100]}.", suffix=".part")
        os.close(handle)
        beside = Path(name)
        try:
            yield beside
            with beside.open("rb+") as stream:
                os.fsync(stream.fileno())
            beside.chmod(0o644)
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
