"""Owners of the user's records: a link or another user's folder is reported, one that anybody may write refused."""

from __future__ import annotations

import stat
import warnings
from collections.abc import Sequence
from pathlib import Path

from tvimdesign.base import file_owner
from tvimdesign.base.errors import CatalogError, FolderWarning


def vouch_for(folder: Path, categories: Sequence[str]) -> None:
    """Tell of a folder of records, and of those of its categories, that is a link or another user's.

    Raises CatalogError for one of another user that anybody may write: what it says is nobody's word. Raises OSError.
    """
    for one in (folder, *(folder / category for category in categories)):
        owner = _other_owner(one)
        leads = f"leads to {one.resolve()}" if one.is_symlink() else ""
        belongs = f"belongs to another user, {owner}" if owner else ""
        if said := " and ".join(filter(None, (leads, belongs))):
            warnings.warn(f"{one}: the folder of records {said}", FolderWarning, stacklevel=3)


def _other_owner(folder: Path) -> str:
    """Return the owner of a folder; empty for this user and root. Raises CatalogError if anybody may write to it."""
    found = folder.stat()
    if file_owner.is_own(found):
        return ""
    if found.st_mode & stat.S_IWOTH:
        raise CatalogError(
            f"{str(folder)[:200]}: the folder of records belongs to another user, {_name(folder)}, and anybody may "
            "write to it; copy it, or have its owner run chmod o-w on it"
        )
    return "" if found.st_uid == file_owner.ROOT else _name(folder)


def _name(folder: Path) -> str:
    try:
        return folder.owner()
    except KeyError:  # it has a number alone
        return str(folder.stat().st_uid)
