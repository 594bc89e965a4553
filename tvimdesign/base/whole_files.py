"""Files that appear whole."""

from __future__ import annotations

import os
import tempfile
from pathlib import Path

TABLE_ENCODING = "utf-8-sig"
"""Of a CSV file: with a byte order mark, without which Excel shows N·m as NÂ·m. Readers name it, too."""


def write_whole(path: Path, data: bytes) -> None:
    """Write beside, flush to disk, rename: a reader never sees half a file."""
    handle, beside = tempfile.mkstemp(dir=path.parent, prefix=f".{path.name}.")
    try:
        with os.fdopen(handle, "wb") as stream:
            stream.write(data)
            stream.flush()
            os.fsync(stream.fileno())
        Path(beside).chmod(0o644)
        Path(beside).replace(path)
    except BaseException:
        Path(beside).unlink(missing_ok=True)
        raise
