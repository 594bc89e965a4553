"""Machine code, and the like that takes long to make, kept from one run to the next by what it was made from.

A file is named by the hash of what was compiled and by whom; it begins with the hash of the code behind it, so that a
file that does not read back whole is none.
"""

from __future__ import annotations

import contextlib
import hashlib
import os
from pathlib import Path

from tvimdesign.base.errors import OutputError
from tvimdesign.base.kept_folder import kept_folder
from tvimdesign.base.whole_files import write_whole

_KIND = "code"
_MOST = 300
"""Files that are kept, a study's kernels being some ten; those not used for the longest go first."""
_DIGEST = hashlib.sha256().digest_size


def find_code(*compiled: str) -> bytes | None:
    """What was kept of a text and its compiler, or what else it is of; None where there is none that is whole."""
    folder = kept_folder(_KIND)
    if folder is None:
        return None
    path = folder / _name(compiled)
    try:
        if path.is_symlink():
            return None
        data = path.read_bytes()
        os.utime(path)
    except OSError:
        return None
    code = data[_DIGEST:]
    return code if hashlib.sha256(code).digest() == data[:_DIGEST] else None


def keep_code(code: bytes, *compiled: str) -> None:
    """Keep what was made for the next run, where there is a place for it; nothing is lost where there is none."""
    folder = kept_folder(_KIND)
    if folder is None:
        return
    with contextlib.suppress(OutputError):
        write_whole(folder / _name(compiled), hashlib.sha256(code).digest() + code)
        _tidy(folder)


def _name(compiled: tuple[str, ...]) -> str:
    digest = hashlib.sha256()
    for text in compiled:
        digest.update(f"{len(text)} ".encode() + text.encode())
    return digest.hexdigest()


def _tidy(folder: Path) -> None:
    """Remove what is too much, and what a process that was killed has left half written long ago."""
    with contextlib.suppress(OSError):
        oldest = sorted(folder.iterdir(), key=lambda path: -path.lstat().st_mtime)[_MOST:]
        for path in oldest:
            path.unlink(missing_ok=True)
