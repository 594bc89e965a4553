"""Check who owns a file or a folder and who can change it. A system without numbered owners trusts all files."""

from __future__ import annotations

import os
import stat
from pathlib import Path

ROOT = 0
"""The user who can write all folders anyway; root's folders are as safe as the program."""
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
