"""The results folder: every file whole, a manifest of what made it, nobody else's files touched."""

from __future__ import annotations

import hashlib
import json
import os
import platform
import shutil
import subprocess
from collections.abc import Sequence
from datetime import UTC, datetime
from functools import cached_property
from importlib import metadata
from pathlib import Path
from types import TracebackType
from typing import Any

from tvimdesign import __version__
from tvimdesign.base.errors import InputError, OutputError
from tvimdesign.base.interrupts import raise_pending
from tvimdesign.base.whole_files import HALF_WRITTEN, TABLE_ENCODING, make_folder, write_whole

MANIFEST = "manifest.json"
RUNNING = "running"
PROGRESS = "front/progress"
"""Folder of what a run can go on from where it was killed."""
_LIBRARIES = ("casadi", "numpy", "scipy", "pydantic", "pint", "matplotlib", "cadquery", "cadquery-ocp", "trimesh",
              "ezdxf")  # fmt: skip


class ResultsFolder:
    """A folder that one run writes; files go in whole, and the manifest says which and with what hash.

    As a context manager it always leaves a manifest: of a run that ended early, too.
    """

    def __init__(
        self, path: Path, overwrite: bool = False, resume: bool = False, progress: str = PROGRESS,
        kept: Sequence[str] = (),
    ) -> None:  # fmt: skip
        """Make the folder, or empty it of an earlier run's files where `overwrite` says so. Raises InputError.

        With `resume` what an unfinished run can go on from stays: the files of the folder `progress` in it, and all
        within the folders that are `kept`.
        """
        if overwrite and resume:
            raise InputError("--overwrite and --resume: choose one")
        self.path, self._progress, self._kept = path, progress, tuple(path / name for name in kept)
        self._started = datetime.now(UTC)
        self._finished = False
        try:
            self._claim(overwrite, resume)
        except OSError as error:
            raise InputError(f"{path}: cannot be used as a results folder: {error.strerror}") from error
        self.write_json(MANIFEST, {"status": RUNNING, "process": os.getpid(), "host": platform.node()})

    def __enter__(self) -> ResultsFolder:
        """Return itself."""
        return self

    def __exit__(self, kind: type[BaseException] | None, value: BaseException | None, at: TracebackType | None) -> None:
        """Leave a manifest of a run that did not come to its end."""
        if self._finished:
            return
        try:
            self._tell("interrupted" if kind and issubclass(kind, KeyboardInterrupt) else "failed", {}, {}, {})
        except OutputError:
            if value is None:
                raise

    def look_up_versions(self) -> None:
        """Do now what takes time of the manifest: good where a run waits for something else."""
        _ = self.made_by

    @cached_property
    def made_by(self) -> dict[str, Any]:
        """Versions and commit."""
        return {
            "tvimdesign": __version__,
            "commit": _commit(),
            "python": platform.python_version(),
            "platform": platform.platform(),
            "libraries": {name: _version(name) for name in _LIBRARIES},
        }

    def _claim(self, overwrite: bool, resume: bool) -> None:
        if self.path.exists() and not self.path.is_dir():
            raise InputError(f"{self.path}: is a file; name a folder with --out")
        self.path.mkdir(parents=True, exist_ok=True)
        if not any(self.path.iterdir()):
            return
        goes_on = any(folder.is_dir() for folder in (self.path / self._progress, *self._kept))
        if resume and (self.path / MANIFEST).exists() and not goes_on:
            raise InputError(f"{self.path}: there is nothing to resume in it; --overwrite to do it again")
        if (
            not (overwrite or resume)
            and (self.path / MANIFEST).exists()
            and any(p.name != MANIFEST for p in self.path.iterdir())
        ):
            raise InputError(
                f"{self.path}: holds results already; say --overwrite to replace them, or --out another folder; "
                "--resume goes on with a front or a sweep that was stopped, or with what --prove does"
            )
        for target in self._earlier():
            if resume and (target.parent == self.path / self._progress or set(self._kept) & set(target.parents)):
                continue
            if target.resolve().is_relative_to(self.path.resolve()):
                target.unlink(missing_ok=True)
        for folder in ("plots", "cad", "front", "shards"):
            _remove_if_empty(self.path / folder)

    def _earlier(self) -> list[Path]:
        """Files of an earlier run; raises InputError where another run is at work, or none ever was."""
        manifest = self.path / MANIFEST
        if not manifest.exists():
            raise InputError(
                f"{self.path}: not a folder of results (no {MANIFEST}); --overwrite would lose other files"
            )
        try:
            said = json.loads(manifest.read_bytes())
            files = [*said.get("files", {}), MANIFEST]
        except (ValueError, AttributeError) as error:
            raise InputError(f"{manifest}: not written by tvimdesign; --overwrite would lose other files") from error
        if said.get("status") != RUNNING:
            return [self.path / name for name in files]
        if said.get("host") == platform.node() and _alive(said.get("process")):
            raise InputError(f"{self.path}: another run (process {said['process']}) is writing it; name another --out")
        # A run that was killed: it began in an empty folder, so what is here is its own.
        return [path for path in self.path.rglob("*") if path.is_file()]

    def write(self, name: str, data: str | bytes) -> Path:
        """Write one file, whole; text of a table in the encoding that Excel reads. Raises OutputError.

        Raises KeyboardInterrupt where a library swallowed an interrupt: what it gave since is not to be kept.
        """
        if not self._finished:
            raise_pending()
        return self.write_at_the_end(name, data)

    def write_at_the_end(self, name: str, data: str | bytes) -> Path:
        """The same of what is kept though the run was interrupted."""
        path = self.path / name
        make_folder(path.parent)
        write_whole(
            path, data.encode(TABLE_ENCODING if path.suffix == ".csv" else "utf-8") if isinstance(data, str) else data
        )
        return path

    def write_json(self, name: str, data: Any) -> Path:
        """Write one JSON file, whole; infinities are not JSON and raise ValueError."""
        return self.write(name, json.dumps(data, indent=2, allow_nan=False) + "\n")

    def finish(
        self, status: str, inputs: dict[str, Path], study: dict[str, Any], timing: dict[str, float] | None = None
    ) -> None:
        """Write the manifest: versions, commit, seed, hashes of what went in and of what came out.

        An interrupt that comes before it is written has it say so.
        """
        raise_pending()
        self._tell(status, inputs, study, timing or {})

    def _tell(self, status: str, inputs: dict[str, Path], study: dict[str, Any], timing: dict[str, float]) -> None:
        for half in self.path.rglob(HALF_WRITTEN):
            half.unlink(missing_ok=True)
        files = sorted(p for p in self.path.rglob("*") if p.is_file() and p.name != MANIFEST)
        manifest = {
            "status": status,
            **self.made_by,
            "started": self._started.isoformat(timespec="seconds"),
            "seconds": round((datetime.now(UTC) - self._started).total_seconds(), 3),
            "timing": timing,
            "seed": study.get("solver", {}).get("seed"),
            "inputs": {name: hash_of(path) for name, path in inputs.items()},
            "files": {p.relative_to(self.path).as_posix(): hash_of(p) for p in files},
        }
        self.write_at_the_end(MANIFEST, json.dumps(manifest, indent=2, allow_nan=False) + "\n")
        self._finished = True


def rewrite(folder: Path, name: str, data: bytes) -> None:
    """Write a file of a finished folder anew, and its hash in the manifest."""
    write_whole(folder / name, data)
    manifest = json.loads((folder / MANIFEST).read_bytes())
    manifest["files"][name] = hash_of(folder / name)
    write_whole(folder / MANIFEST, (json.dumps(manifest, indent=2, allow_nan=False) + "\n").encode())


def made_from(folder: Path, name: str) -> str:
    """Hash of what went into a finished folder under a name; empty where there is no such folder."""
    try:
        inputs = json.loads((folder / MANIFEST).read_bytes()).get("inputs", {})
    except (OSError, ValueError, AttributeError):
        return ""
    return str(inputs.get(name, ""))


def _alive(process: object) -> bool:
    """Whether a process of this number runs here."""
    if not isinstance(process, int) or process == os.getpid():
        return False
    try:
        os.kill(process, 0)
    except ProcessLookupError:
        return False
    except OSError:
        return True
    return True


def _remove_if_empty(folder: Path) -> None:
    if folder.is_dir() and not any(p.is_file() for p in folder.rglob("*")):
        shutil.rmtree(folder)


def hash_of(path: Path) -> str:
    """The hash of a file, as manifests have it."""
    return "sha256:" + hashlib.sha256(path.read_bytes()).hexdigest()


def _version(name: str) -> str | None:
    try:
        return metadata.version(name)
    except metadata.PackageNotFoundError:
        return None


def _commit() -> str | None:
    """Commit of the source tree this package runs from, or None when it runs from an installed wheel."""
    source = Path(__file__).resolve().parents[3]
    if not (source / ".git").exists():
        return None
    try:
        found = subprocess.run(
            ["git", "rev-parse", "HEAD"], cwd=source, capture_output=True, text=True, timeout=5, check=False
        )
    except (OSError, subprocess.TimeoutExpired):
        return None
    return found.stdout.strip() or None
