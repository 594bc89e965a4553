"""The user's cache: its folders, who can change a file in them, and what is stored by what it was made from.

A system without numbered owners trusts all files.

A file is named by the hash of what was compiled and by whom. It begins with the hash of its name and of the code that
follows, so that a file that is damaged or renamed is not used. Nor is a file that others could have written.
"""

import contextlib
import hashlib
import os
import stat
from pathlib import Path

from tvimdesign.base.atomic_files import atomic_write
from tvimdesign.base.errors import OutputError

FOLDER_VARIABLE = "TVIMDESIGN_CACHE"
"""Environment variable that names the folder of all that is kept; empty keeps nothing from one run to the next."""


def cache_folder(kind: str) -> Path | None:
    """Return the user's cache folder of a kind; None where there shall be none, or others could change it.

    The folder is made private. What others put there before is still in it: read it with `read_own_file`.
    """
    named = os.environ.get(FOLDER_VARIABLE)
    if named == "":
        return None
    try:
        home = os.environ.get("XDG_CACHE_HOME") or Path("~/.cache").expanduser()
        above = Path(named) if named else Path(home) / "tvimdesign"
        above = above.parent.resolve() / above.name
        for folder in (*reversed(above.parents), above, above / kind):
            folder.mkdir(mode=0o700, exist_ok=True)
        safe = all(is_safe_parent(folder) for folder in above.parents)
        return above / kind if safe and _is_private(above) and _is_private(above / kind) else None
    except (OSError, RuntimeError):  # no home, or links in a circle
        return None


def _is_private(folder: Path) -> bool:
    """Make this user's folder private; return whether it is theirs and can be written. Raises OSError."""
    if not folder.is_symlink() and is_own(folder.lstat()) and not is_own_folder(folder):
        folder.chmod(0o700)
    return is_own_folder(folder) and os.access(folder, os.W_OK)


ROOT = 0  # The user who can write all folders anyway; root's folders are as safe as the program
_HAS_OWNERS = hasattr(os, "getuid")


def is_own(status: os.stat_result) -> bool:
    """Return whether this user owns a file or a folder."""
    return not _HAS_OWNERS or status.st_uid == os.getuid()


def is_own_folder(folder: Path) -> bool:
    """Return whether a folder is there, is no link, is this user's, and nobody else can write to it."""
    try:
        status = folder.lstat()
    except OSError:
        return False
    return stat.S_ISDIR(status.st_mode) and is_own(status) and not _others_write(status)


def is_safe_parent(folder: Path) -> bool:
    """Return whether others cannot replace what stands in a folder: it is sticky, or only the user and root write."""
    status = folder.lstat()
    if not _HAS_OWNERS:
        return True
    if status.st_uid not in {os.getuid(), ROOT} or not stat.S_ISDIR(status.st_mode):
        return False
    return bool(status.st_mode & stat.S_ISVTX) or not _others_write(status)


def read_own_file(path: Path) -> bytes:
    """Read a regular file that this user owns and nobody else can change. Raises OSError for any other.

    The opened file is checked, not its name: no link, no second name (hard link), no pipe, not writable by others.
    """
    with open(path, "rb", opener=_open_no_link) as stream:
        status = os.fstat(stream.fileno())
        alone = stat.S_ISREG(status.st_mode) and status.st_nlink == 1
        if not alone or not is_own(status) or _others_write(status):
            raise PermissionError(f"{path}: not this user's own file")
        return stream.read()


def _open_no_link(path: str, flags: int) -> int:
    """Open a file; a link is an error, and a pipe does not wait for its writer."""
    return os.open(path, flags | getattr(os, "O_NOFOLLOW", 0) | getattr(os, "O_NONBLOCK", 0))


def _others_write(status: os.stat_result) -> bool:
    """Return whether others can write; a group with the user as its only member has no others."""
    if not _HAS_OWNERS or not status.st_mode & (stat.S_IWGRP | stat.S_IWOTH):
        return False
    return bool(status.st_mode & stat.S_IWOTH) or not _is_private_group(status.st_gid)


def _is_private_group(number: int) -> bool:
    """Return whether a group is this user's alone: their first, of their name, and without other members."""
    import grp
    import pwd

    try:
        user, group = pwd.getpwuid(os.getuid()), grp.getgrgid(number)
    except KeyError:
        return False
    return number == user.pw_gid and group.gr_name == user.pw_name and set(group.gr_mem) <= {user.pw_name}


_KIND = "code"
_MOST = 1000  # Files that are kept, a study's being some forty; those not used for the longest go first
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
        # Remove what is too much, and what a process that was killed has left half written long ago.
        with contextlib.suppress(OSError):
            oldest = sorted(folder.iterdir(), key=lambda path: -path.lstat().st_mtime)[_MOST:]
            for path in oldest:
                path.unlink(missing_ok=True)


def _name(compiled: tuple[str, ...]) -> str:
    digest = hashlib.sha256()
    for text in compiled:
        digest.update(f"{len(text)} ".encode() + text.encode())
    return digest.hexdigest()


def _seal(name: str, code: bytes) -> bytes:
    """Return the hash that a file begins with."""
    return hashlib.sha256(name.encode() + code).digest()
