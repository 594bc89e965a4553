"""Files that appear whole, their digests, and the folder `unfinished` that a run writes into until it is done.

That folder is the run's own. What a user adds to it becomes a result, or goes with what a killed run has left.
"""

import hashlib
import os
import secrets
import stat
from collections.abc import Collection, Iterator
from contextlib import contextmanager
from pathlib import Path, PurePosixPath

from tvimdesign.base.errors import OutputError

TABLE_ENCODING = "utf-8-sig"
"""Of a CSV file: with a byte order mark, without which Excel shows N·m as NÂ·m. Readers name it, too."""


def atomic_write(path: Path, data: bytes) -> None:
    """Write beside, flush to disk, rename: a reader never sees half a file. Raises OutputError."""
    with whole_file(path) as beside:
        beside.write_bytes(data)


@contextmanager
def whole_file(path: Path) -> Iterator[Path]:
    """Yield a file beside, to be written by whoever needs its path, which then takes its place. Raises OutputError."""
    beside = path.with_name(f".{path.name[:100]}.{secrets.token_hex(8)}.part")
    try:
        os.close(os.open(beside, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o666))  # the umask takes its part
        try:
            yield beside
            with beside.open("rb+") as stream:
                os.fsync(stream.fileno())
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


UNFINISHED = "unfinished"  # Folder, within a results folder, that a run writes into until it is finished
RUN = ".run.json"  # File in that folder that names the run and the process that writes


def files_in(folder: Path) -> list[str]:
    """Return the names of a run's files in its folder, without links, and without what has a dot in front.

    Such are its claim and files that are half written.
    """
    if folder.is_symlink():
        return []
    there = (path for path in folder.rglob("*") if path.is_file() and not path.is_symlink())
    names = sorted(path.relative_to(folder).as_posix() for path in there)
    return [name for name in names if not any(part.startswith(".") for part in PurePosixPath(name).parts)]


def is_inside(name: str) -> bool:
    """Return whether a relative name stays within its folder."""
    path = PurePosixPath(name)
    return bool(path.parts) and not path.is_absolute() and ".." not in path.parts


def digest_of(path: Path) -> str:
    """Return the SHA-256 digest of a file, as manifests have it. Raises OSError."""
    with path.open("rb") as stream:
        return "sha256:" + hashlib.file_digest(stream, "sha256").hexdigest()


def link_on_the_way(folder: Path, name: str) -> Path | None:
    """Return the first link, or file, among the folders that lead to a name within `folder`; None if there is none."""
    parts = PurePosixPath(name).parts[:-1]
    ways = (folder.joinpath(*parts[: count + 1]) for count in range(len(parts)))
    return next((way for way in ways if way.is_symlink() or (way.exists() and not way.is_dir())), None)


def is_as_written(folder: Path, name: str, digests: Collection[str]) -> bool:
    """Return whether a name is a regular file, not reached through a link, with one of the digests. Raises OSError."""
    path = folder / name
    if link_on_the_way(folder, name):
        return False
    try:
        if not stat.S_ISREG(path.lstat().st_mode):
            return False
    except FileNotFoundError:
        return False
    return digest_of(path) in digests


def free_name(path: Path) -> Path:
    """Return the first of name-1, name-2, ... that there is nothing at."""
    number = 1
    while os.path.lexists(free := path.with_name(f"{path.stem}-{number}{path.suffix}")):
        number += 1
    return free
