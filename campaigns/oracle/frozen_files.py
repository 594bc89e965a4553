"""Read and write frozen values: sorted JSON with one value a line, so that a change of one is one line of a diff."""

from __future__ import annotations

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

FOLDER = Path(__file__).parents[1] / "frozen"


def write_frozen(path: Path, data: Mapping[str, Any]) -> None:
    """Write frozen data. Numbers have all their digits; infinity and not-a-number are written as JavaScript does."""
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(json.dumps(data, indent=0, sort_keys=True) + "\n", encoding="utf-8")


def read_frozen(path: Path) -> dict[str, Any]:
    """Read frozen data.

    Raises
    ------
    FileNotFoundError
        If nothing was frozen there.
    """
    if not path.exists():
        raise FileNotFoundError(f"{path.name} is not frozen; write it with --freeze")
    data: dict[str, Any] = json.loads(path.read_text(encoding="utf-8"))
    return data
