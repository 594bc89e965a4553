"""Keeps what pieces of work have made, by what they read, so that only what changed is made again.

A result is a folder: `out/` with the files for the user, `kept/` with what other pieces of work need, `trace.json` with
what was read, the checks, and the hash of each file. It is used again where the code, what was read of the design and
the results it was made from are the same. A file that has changed, or that others could have written, makes it void.
"""

import contextlib
import hashlib
import json
import os
import secrets
import shutil
import tempfile
import time
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cache
from importlib import metadata
from pathlib import Path
from typing import Any

from tvimdesign.base.user_cache import is_own_folder, read_own_file
from tvimdesign.cad.cad_report import SolidCheck
from tvimdesign.cad.geometry.dimensions import Dimensions, dimensions
from tvimdesign.study import Design

Reads = dict[str, dict[str, Any]]
"""Value by name, for each part of a design that is read; None for what the design does not have."""


class Watched(Mapping[str, Any]):
    """A mapping that writes down what is read of it."""

    def __init__(self, whole: Mapping[str, Any], read: dict[str, Any]) -> None:
        """`read` is where it is written down."""
        self._whole, self._read = whole, read

    def __getitem__(self, name: str) -> Any:
        self._read[name] = self._whole.get(name)
        return self._whole[name]

    def __contains__(self, name: object) -> bool:
        """Return whether there is a value of that name, which is read too."""
        self._read[str(name)] = self._whole.get(str(name))
        return name in self._whole

    def __iter__(self) -> Iterator[str]:
        """Yield all names; then all of it counts as read."""
        self._read.update(self._whole)
        return iter(self._whole)

    def __len__(self) -> int:
        return len(self._whole)


class TrackedDesign:
    """A design and its dimensions, from which pieces of work read."""

    def __init__(self, design: Design, titles: Mapping[str, str]) -> None:
        """Work out the dimensions of a design once; `titles` says what the catalogue calls each chosen record."""
        self._mode = design.mode
        self._lengths = dimensions(design).by_name
        self._design = design
        self._parts: dict[str, Mapping[str, Any]] = {
            "dimensions": self._lengths,
            "values": design.values,
            "choices": design.choices,
            "titles": titles,
            "said": {"name": design.name, "mode": design.mode},
        }

    def watched(self, named: bool) -> tuple[Design, Dimensions, Mapping[str, str], Reads]:
        """Return the design, its dimensions and titles to work with, and where is written what was read of them.

        The design has its name only for work that is `named`; all else is the same for designs of any name.
        """
        reads: Reads = {part: {} for part in self._parts}
        reads["said"] = {"mode": self._mode} | ({"name": self._design.name} if named else {})
        seen = {part: Watched(self._parts[part], reads[part]) for part in self._parts if part != "said"}
        name = self._design.name if named else ""
        seen_by_work = {"name": name, "values": seen["values"], "choices": seen["choices"]}
        design = self._design.model_copy(update=seen_by_work)
        return design, Dimensions(self._mode, seen["dimensions"]), seen["titles"], reads

    def agrees_with(self, reads: Reads) -> bool:
        """Return whether all that was read then is the same in this design."""
        return all(
            part in self._parts and all(self._parts[part].get(name) == value for name, value in read.items())
            for part, read in reads.items()
        )


_MOST = 16  # Results of one piece of work that are kept; the one not used for the longest goes first
_HALF_MADE = 3600.0  # Seconds after which a result that is not finished never will be
_TRACE = "trace.json"
_LIBRARIES = ("cadquery", "cadquery-ocp", "ezdxf", "manifold3d", "matplotlib", "numba", "numpy", "trimesh", "vtk")


@dataclass(frozen=True)
class Result:
    """Result of a piece of work."""

    folder: Path
    files: Mapping[str, str]  # Hash of each file under `folder`
    checks: tuple[SolidCheck, ...]

    @property
    def out(self) -> list[str]:
        """Names of the files for the user."""
        return sorted(name.removeprefix("out/") for name in self.files if name.startswith("out/"))

    @property
    def digest(self) -> str:
        """Digest of the files kept for results made from this one."""
        files = {name: reported for name, reported in self.files.items() if name.startswith("kept/")}
        return _digest(json.dumps(files, sort_keys=True).encode())


class Cache:
    """The kept results of all pieces of work, in one folder."""

    def __init__(self, folder: Path) -> None:
        """`folder` is made where there is none."""
        self._folder = folder
        self._code = code_digest()
        self.damaged: list[str] = []
        """Names of the pieces of work that are made again because others changed what was kept, or could have."""

    def fresh(self, name: str) -> Path:
        """Return an empty folder for a piece of work to write into."""
        place = self._folder / name
        self._folder.mkdir(mode=0o700, parents=True, exist_ok=True)
        if os.path.lexists(place) and not is_own_folder(place):
            _remove(place)
        place.mkdir(mode=0o700, exist_ok=True)
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
            "name": name,
            "code": self._code,
            "reads": reads,
            "needs": {need: result.digest for need, result in needs.items()},
            "files": files,
            "checks": [check.fields() for check in checks],
        }
        text = json.dumps(trace, sort_keys=True)
        (made / _TRACE).write_text(text, encoding="utf-8")
        for path in made.rglob("*"):
            path.chmod(0o700 if path.is_dir() else 0o600)
        final = self._folder / name / _digest(text.encode())
        if _is_sound(final, files):
            shutil.rmtree(made)  # another run was quicker
        else:
            _remove(final)
            made.rename(final)
        self._tidy(name)
        return Result(final, files, tuple(checks))

    def discard(self, made: Path) -> None:
        """Take away a fresh folder whose work came to nothing."""
        shutil.rmtree(made, ignore_errors=True)

    def find(self, name: str, subject: TrackedDesign, needs: Mapping[str, Result]) -> Result | None:
        """Return the result of a piece of work for a design, where it is there and sound."""
        same = {"name": name, "code": self._code, "needs": {need: result.digest for need, result in needs.items()}}
        for folder in self._stored(name):
            trace = _read(folder)
            if trace is None:
                self._drop(name, folder)
            elif all(trace.get(key) == value for key, value in same.items()) and subject.agrees_with(trace["reads"]):
                if _is_sound(folder, trace["files"]):
                    with contextlib.suppress(OSError):  # another run may have removed it since
                        os.utime(folder)
                    return Result(folder, trace["files"], tuple(SolidCheck(**check) for check in trace["checks"]))
                self._drop(name, folder)
        return None

    def _drop(self, name: str, folder: Path) -> None:
        """Take away a result that is not what was written."""
        _remove(folder)
        if name not in self.damaged:
            self.damaged.append(name)

    def _stored(self, name: str) -> list[Path]:
        """Return the folders of a piece of work's results, the latest used first."""
        place = self._folder / name
        if not is_own_folder(place):
            return []
        folders = [path for path in place.iterdir() if not path.name.startswith(".") and not path.is_symlink()]
        return sorted((path for path in folders if path.is_dir()), key=_age)

    def _tidy(self, name: str) -> None:
        """Remove what is too much, and what a run that was killed has left half made."""
        left = [path for path in (self._folder / name).glob(".new.*") if time.time() - _HALF_MADE > -_age(path)]
        for old in [*self._stored(name)[_MOST:], *left]:
            shutil.rmtree(old, ignore_errors=True)


def _age(path: Path) -> float:
    """Return what sorts the latest used first; a folder that another run has removed since comes last."""
    try:
        return -path.lstat().st_mtime
    except OSError:
        return 0.0


@cache
def code_digest() -> str:
    """Return the digest of all that makes parts of a design: this package's code and the libraries it draws with."""
    digest = hashlib.sha256()
    here = Path(__file__).parents[1]  # all of `cad/`
    for path in sorted(path for suffix in ("*.py", "*.txt", "*.yaml") for path in here.rglob(suffix)):
        digest.update(path.relative_to(here).as_posix().encode() + b"\0" + path.read_bytes() + b"\0")
    for name in _LIBRARIES:
        digest.update(f"{name} {metadata.version(name)}\n".encode())
    return digest.hexdigest()


def _files(folder: Path) -> Iterator[Path]:
    return (path for path in sorted(folder.rglob("*")) if path.is_file())


def _remove(path: Path) -> None:
    """Remove a file, a link or a folder; what another user put there may only be moved out of the way."""
    with contextlib.suppress(OSError):  # another run may have removed it
        aside = path.rename(path.with_name(f".new.{secrets.token_hex(8)}"))
        if aside.is_symlink() or not aside.is_dir():
            aside.unlink()
        else:
            shutil.rmtree(aside, ignore_errors=True)


def _read(folder: Path) -> dict[str, Any] | None:
    """Return what was written of a result; None if that is not what the folder is named by, its hash."""
    try:
        data = read_own_file(folder / _TRACE)
        trace: dict[str, Any] = json.loads(data) if _digest(data) == folder.name else {}
    except (OSError, ValueError):
        return None
    return trace or None


def _is_sound(folder: Path, files: Mapping[str, str]) -> bool:
    """Return whether all files are what they were when written, and nobody else can change them."""
    folders = {above for name in files for above in (folder / name).parents if above.is_relative_to(folder)}
    try:
        return all(map(is_own_folder, folders | {folder})) and all(
            _digest(read_own_file(folder / name)) == reported for name, reported in files.items()
        )
    except OSError:
        return False


def _digest(data: bytes) -> str:
    return hashlib.sha256(data).hexdigest()
