"""The user's folders for what is kept from one run to the next: parts that were made, code that was compiled."""

from __future__ import annotations

import os
from pathlib import Path

from tvimdesign.base.file_owner import is_own, is_own_folder, is_safe_parent

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
