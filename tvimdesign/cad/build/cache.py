"""Keeps what pieces of work have made, by what they read, so that only what changed is made again.

A result is a folder: `out/` with the files for the user, `kept/` with what other pieces of work need, `trace.json` with
what was read, the checks, and the hash of each file. It is used again where the code, what was read of the design and
the results it was made from are the same; a file that is not what it was when it was written makes it void.
"""

from __future__ import annotations

import hashlib
import json
import os
import shutil
import tempfile
import time
from collections.abc import Iterator, Mapping
from dataclasses import asdict, dataclass
from importlib import metadata
from pathlib import Path
from typing import Any

from tvimdesign.cad.build.read_tracking import Reads, TrackedDesign
from tvimdesign.cad.cad_report import SolidCheck

FOLDER_VARIABLE = "TVIMDESIGN_CACHE"
"""Environment variable that names the folder of kept results; empty keeps none from one run to the next."""
_MOST = 16
"""Results of one piece of work that are kept; the one not used for the longest goes first."""
_HALF_MADE = 3600.0
"""Seconds after which a result that is not finished never will be."""
_TRACE = "trace.json"
_LIBRARIES = ("cadquery", "cadquery-ocp", "ezdxf", "matplotlib", "numpy", "trimesh", "vtk")


@dataclass(frozen=True)
class Result:
    """What a piece of work made."""

    folder: Path
    files: Mapping[str, str]
    """Hash of each file under `folder`."""
    checks: tuple[SolidCheck, ...]

    @property
    def out(self) -> list[str]:
        """Names of the files for the user."""
        return sorted(name.removeprefix("out/") for name in self.files if name.startswith("out/"))

    @property
    def digest(self) -> str:
        """What results made from this one hang on: the files that are kept for them."""
        kept = {name: reported for name, reported in self.files.items() if name.startswith("kept/")}
        return _digest(json.dumps(kept, sort_keys=True).encode())


class Cache:
    """The kept results of all pieces of work, in one folder."""

    def __init__(self, folder: Path) -> None:
        """`folder` is made where there is none."""
        self._folder = folder
        self._code = code_digest()

    def fresh(self, name: str) -> Path:
        """Return an empty folder for a piece of work to write into."""
        place = self._folder / name
        place.mkdir(parents=True, exist_ok=True)
        made = Path(tempfile.mkdtemp(dir=place, prefix=".new."))
        for part in ("out", "kept"):
            (made / part).mkdir()
        return made

    def close(
        self, name: str, made: Path, reads: Reads, needs: Mapping[str, Result], checks: list[SolidCheck]
    ) -> Result:
        """Keep what was written into a fresh folder; returns the result."""
        files = {path.relative_to(made).as_posix(): _digest(path.read_bytes()) for path in _files(made)}
        trace = {
            "code": self._code,
            "reads": reads,
            "needs": {need: result.digest for need, result in needs.items()},
            "files": files,
            "checks": [asdict(check) for check in checks],
        }
        text = json.dumps(trace, sort_keys=True)
        (made / _TRACE).write_text(text, encoding="utf-8")
        final = self._folder / name / _digest(text.encode())
        if final.is_dir() and _is_sound(final, files):
            shutil.rmtree(made)  # another run was quicker
        else:
            shutil.rmtree(final, ignore_errors=True)
            made.rename(final)
        self._tidy(name)
        return Result(final, files, tuple(checks))

    def discard(self, made: Path) -> None:
        """Take away a fresh folder whose work came to nothing."""
        shutil.rmtree(made, ignore_errors=True)

    def find(self, name: str, subject: TrackedDesign, needs: Mapping[str, Result]) -> Result | None:
        """Return the result of a piece of work for a design, where it is there and sound."""
        wanted = {need: result.digest for need, result in needs.items()}
        for folder in self._kept(name):
            trace = _read(folder / _TRACE)
            if trace is None or trace["code"] != self._code or trace["needs"] != wanted:
                continue
            if subject.agrees_with(trace["reads"]) and _is_sound(folder, trace["files"]):
                os.utime(folder)
                return Result(folder, trace["files"], tuple(SolidCheck(**check) for check in trace["checks"]))
        return None

    def _kept(self, name: str) -> list[Path]:
        """Folders of a piece of work's results, the latest used first."""
        place = self._folder / name
        found = [path for path in place.iterdir() if not path.name.startswith(".")] if place.is_dir() else []
        return sorted(found, key=lambda path: path.stat().st_mtime, reverse=True)

    def _tidy(self, name: str) -> None:
        """Remove what is too much, and what a run that was killed has left half made."""
        left = [
            path for path in (self._folder / name).glob(".new.*") if path.stat().st_mtime < time.time() - _HALF_MADE
        ]
        for old in [*self._kept(name)[_MOST:], *left]:
            shutil.rmtree(old, ignore_errors=True)


def user_folder() -> Path | None:
    """The user's folder of kept results; None where none are to be kept, or it cannot be written."""
    named = os.environ.get(FOLDER_VARIABLE)
    home = os.environ.get("XDG_CACHE_HOME") or Path("~/.cache").expanduser()
    if named == "":
        return None
    folder = Path(named) if named else Path(home) / "tvimdesign" / "cad"
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError:
        return None
    return folder if os.access(folder, os.W_OK) else None


def code_digest() -> str:
    """Digest of all that makes parts of a design: this package's code and the libraries it draws with."""
    digest = hashlib.sha256()
    here = Path(__file__).parents[1]  # all of `cad/`
    for path in sorted(path for suffix in ("*.py", "*.yaml") for path in here.rglob(suffix)):
        digest.update(path.relative_to(here).as_posix().encode() + b"\0" + path.read_bytes() + b"\0")
    for name in _LIBRARIES:
        digest.update(f"{name} {metadata.version(name)}\n".encode())
    return digest.hexdigest()


def _files(folder: Path) -> Iterator[Path]:
    return (path for path in sorted(folder.rglob("*")) if path.is_file())


def _read(path: Path) -> dict[str, Any] | None:
    try:
        trace: dict[str, Any] = json.loads(path.read_bytes())
    except (OSError, ValueError):
        return None
    return trace if trace.keys() >= {"code", "reads", "needs", "files", "checks"} else None


def _is_sound(folder: Path, files: Mapping[str, str]) -> bool:
    try:
        return all(_digest((folder / name).read_bytes()) == reported for name, reported in files.items())
    except OSError:
        return False


def _digest(data: bytes) -> str:
    return hashlib.sha256(data).hexdigest()
