"""The user's folders for what is kept from one run to the next: parts that were made, code that was compiled."""

from __future__ import annotations

import os
import stat
from pathlib import Path

FOLDER_VARIABLE = "TVIMDESIGN_CACHE"
"""Environment variable that names the folder of all that is kept; empty keeps nothing from one run to the next."""
_WRITABLE_BY_OTHERS = 0o022


def kept_folder(kind: str) -> Path | None:
    """The user's folder of kept things of a kind; None where none are to be kept, or it cannot be written or trusted.

    What is kept is used as it is, so a link, or a folder of another user, is not taken; the user's own is made private.
    """
    named = os.environ.get(FOLDER_VARIABLE)
    if named == "":
        return None
    home = os.environ.get("XDG_CACHE_HOME") or Path("~/.cache").expanduser()
    above = Path(named) if named else Path(home) / "tvimdesign"
    return above / kind if _is_private(above) and _is_private(above / kind) else None


def _is_private(folder: Path) -> bool:
    """Whether a folder, made where there is none, is this user's alone and can be written."""
    try:
        folder.mkdir(parents=True, exist_ok=True)
        found = folder.lstat()
        if stat.S_ISLNK(found.st_mode) or (hasattr(os, "getuid") and found.st_uid != os.getuid()):
            return False
        if found.st_mode & _WRITABLE_BY_OTHERS:
            folder.chmod(0o700)
    except OSError:
        return False
    return os.access(folder, os.W_OK)
