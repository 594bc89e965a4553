"""Files that appear whole.

Journal of an unfinished run: the name and digest of each file, recorded before the file exists.

A run writes into the folder `unfinished` of its results folder. Every process that writes there appends to a journal of
its own, so that a run that is killed leaves a list of what is its own. A file counts as the run's while its bytes have
a recorded digest. What the user adds or edits is never in a journal.
"""

from __future__ import annotations

import errno
import hashlib
import json
import os
import platform
import re
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
    """Yield a file beside, to be written by whoever needs its path, which then takes its place. Raises OutputError.

    In the folder of an unfinished run both names are in its journal before their files exist.
    """
    beside = path.with_name(f".{path.name[:100]}.{secrets.token_hex(8)}.part")
    try:
        record(beside, ANY)
        os.close(os.open(beside, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o666))  # the umask takes its part
        try:
            yield beside
            with beside.open("rb+") as stream:
                os.fsync(stream.fileno())
            record(path, digest_of(beside))
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


UNFINISHED = "unfinished"
"""Folder, within a results folder, that a run writes into until it is finished."""
RUN = ".run.json"
"""File in that folder that names the run and the process that writes."""
JOURNALS = ".written-*.jsonl"
ANY = "half written"
"""Digest of a file whose content is not known beforehand: one that is half written."""


def record(path: Path, digest: str) -> None:
    """Record that a file is about to be written; does nothing for a file outside an unfinished run.

    Raises OSError, also where a link leads out of the folder.
    """
    folder = next(
        (parent for parent in path.absolute().parents if parent.name == UNFINISHED and (parent / RUN).exists()), None
    )
    if folder is None:
        return
    name = path.absolute().relative_to(folder).as_posix()
    if way := folder if folder.is_symlink() else link_on_the_way(folder, name):
        raise OSError(errno.ELOOP, f"{way} is a link")
    host = re.sub(r"[^\w-]", "_", platform.node())
    handle = os.open(folder / f".written-{host}-{os.getpid()}.jsonl", os.O_WRONLY | os.O_CREAT | os.O_APPEND, 0o666)
    try:
        os.write(handle, (json.dumps({"name": name, "digest": digest}) + "\n").encode())
    finally:
        os.close(handle)


def recorded(folder: Path) -> dict[str, set[str]]:
    """Return the digests that the journals of an unfinished run give for each name."""
    digests: dict[str, set[str]] = {}
    for journal in sorted(folder.glob(JOURNALS)):
        for line in journal.read_bytes().splitlines():
            try:
                entry = json.loads(line)
                name, digest = str(entry["name"]), str(entry["digest"])
            except (ValueError, KeyError, TypeError):
                continue  # the process was killed within this line, before the file existed
            if is_inside(name):
                digests.setdefault(name, set()).add(digest)
    return digests


def is_inside(name: str) -> bool:
    """Return whether a relative name stays within its folder."""
    path = PurePosixPath(name)
    return bool(path.parts) and not path.is_absolute() and ".." not in path.parts


def digest_of(path: Path) -> str:
    """Return the SHA-256 digest of a file, as manifests and journals have it. Raises OSError."""
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
    return ANY in digests or digest_of(path) in digests


def free_name(path: Path) -> Path:
    """Return the first of name-1, name-2, ... that there is nothing at."""
    number = 1
    while os.path.lexists(free := path.with_name(f"{path.stem}-{number}{path.suffix}")):
        number += 1
    return free
