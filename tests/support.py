"""Names that tests share: where the project is, its studies, and the type of the command fixture."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from subprocess import CompletedProcess

ROOT = Path(__file__).resolve().parents[1]
STUDIES = sorted((ROOT / "studies").glob("*.yaml"))
Command = Callable[..., CompletedProcess[str]]
