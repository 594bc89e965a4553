"""Machine code, and the like that takes long to make, kept from one run to the next by what it was made from.

A file is named by the hash of what was compiled and by whom. It begins with the hash of its name and of the code that
follows, so that a file that is damaged or renamed is not used. Nor is a file that others could have written.
"""

from __future__ import annotations

import contextlib
import hashlib
import os
from pathlib import Path

from tvimdesign.base.atomic_files import atomic_write
from tvimdesign.base.cache_folder import cache_folder
from tvimdesign.base.errors import OutputError
from tvimdesign.base.file_owner import read_own_file

_KIND = "code"
_MOST = 300
"""Files that are kept, a study's kernels being some ten; those not used for the longest go first."""
_DIGEST = hashlib.sha256().digest_size


def find_code(*compiled: str) -> bytes | None:
    """Return the stored code of a text and its compiler; None if there is none, or none that is whole."""
    folder = cache_folder(_KIND)
    if folder is None:
        return None
    path = folder / _name(compiled)
    try:
        data = read_own_file(path)
        os.utime(path)
    except OSError:
        return None
    code = data[_DIGEST:]
    return code if _seal(path.name, code) == data[:_DIGEST] else None


def keep_code(code: bytes, *compiled: str) -> None:
    """Keep what was made for the next run, where there is a place for it; nothing is lost where there is none."""
    folder = cache_folder(_KIND)
    if folder is None:
        return
    name = _name(compiled)
    with contextlib.suppress(OutputError):
        atomic_write(folder / name, _seal(name, code) + code)
        _tidy(folder)


def _name(compiled: tuple[str, ...]) -> str:
    digest = hashlib.sha256()
    for text in compiled:
        digest.update(f"{len(text)} ".encode() + text.encode())
    return digest.hexdigest()


def _seal(name: str, code: bytes) -> bytes:
    """Return the hash that a file begins with."""
    return hashlib.sha256(name.encode() + code).digest()


def _tidy(folder: Path) -> None:
    """Remove what is too much, and what a process that was killed has left half written long ago."""
    with contextlib.suppress(OSError):
        oldest = sorted(folder.iterdir(), key=lambda path: -path.lstat().st_mtime)[_MOST:]
        for path in oldest:
            path.unlink(missing_ok=True)
