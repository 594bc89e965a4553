"""Claim on a results folder: one run writes it at a time, and the system releases the claim when its process ends."""

import json
import os
import platform
import sys
import time
from contextlib import suppress
from pathlib import Path
from typing import Any

import psutil

from tvimdesign.base.atomic_files import RUN, UNFINISHED
from tvimdesign.base.errors import FolderInUseError

if sys.platform != "win32":
    import fcntl

FORMAT = "tvimdesign results 1"
RUNNING = "running"
IN_PARTS = "in parts"  # Status of a run whose cells are computed by the jobs of an array
_WAIT = 10.0  # Seconds for which a job of an array waits for another one that prepares the folder


class Claim:
    """The right to write into a results folder: alone, or `shared` with other jobs of an array."""

    def __init__(self, out: Path, *, shared: bool = False) -> None:
        """Claim a folder, whose part `unfinished` is made. Raises FolderInUseError, OSError."""
        self.folder = out / UNFINISHED
        self._path = self.folder / RUN
        end = time.monotonic() + (_WAIT if shared else 0.0)
        while True:
            self._handle, is_new, is_locked = _opened(self._path, shared=shared)
            content = _content(self._handle)
            if self._is_free(content, is_new=is_new, is_locked=is_locked):
                return
            os.close(self._handle)
            if time.monotonic() >= end:
                raise FolderInUseError(f"{out}: {_who(content)} is writing it; {_next_step(content, self._path)}")
            time.sleep(0.05)

    @staticmethod
    def _is_free(content: dict[str, Any], *, is_new: bool, is_locked: bool | None) -> bool:
        """Return whether nobody else is at work; a running process of another host is not taken for dead."""
        if is_locked is False or content.get("status") == IN_PARTS:
            return is_locked is not False
        if content.get("status") == RUNNING and content.get("host") != platform.node():
            return False
        return is_locked is True or is_new or (bool(content) and not _is_alive(content))

    def write(self, status: str, run: str) -> None:
        """Record who writes the folder, and what became of the run."""
        process = psutil.Process()
        content = {
            "format": FORMAT, "run": run, "status": status, "host": platform.node(), "process": process.pid,
            "started": process.create_time(),
        }  # fmt: skip
        data = (json.dumps(content, indent=2) + "\n").encode()
        os.ftruncate(self._handle, 0)
        os.lseek(self._handle, 0, os.SEEK_SET)
        os.write(self._handle, data)

    def release(self, *, remove: bool = True) -> None:
        """Let others claim the folder, and remove its part `unfinished` where the run has left nothing there."""
        if self._handle < 0:
            return
        with suppress(OSError):  # the user may have removed it
            if remove and not self.folder.is_symlink() and {path.name for path in self.folder.iterdir()} <= {RUN}:
                self._path.unlink(missing_ok=True)
                self.folder.rmdir()
        os.close(self._handle)
        self._handle = -1


def is_run(folder: Path) -> bool:
    """Return whether `unfinished` is a run's folder, or one that a run has just made."""
    if folder.is_symlink() or not folder.is_dir():
        return False
    try:
        content = json.loads((folder / RUN).read_bytes() or b"{}")
    except FileNotFoundError:
        return not any(folder.iterdir())
    except (OSError, ValueError):
        return False
    return isinstance(content, dict) and (not content or content.get("format") == FORMAT)


def _opened(path: Path, *, shared: bool) -> tuple[int, bool, bool | None]:
    """Open a claim's file; whether it was made here, and whether it is locked for us: None where the system cannot."""
    while True:
        path.parent.mkdir(parents=True, exist_ok=True)
        flags, is_new = os.O_RDWR | os.O_CREAT | getattr(os, "O_NOFOLLOW", 0), True
        try:
            handle = os.open(path, flags | os.O_EXCL, 0o666)
        except FileExistsError:
            is_new = False
            try:
                handle = os.open(path, flags & ~os.O_CREAT)
            except FileNotFoundError:
                continue  # its owner has just released it
        except FileNotFoundError:
            continue
        is_locked = _locked(handle, shared=shared)
        try:
            same = os.path.samestat(os.fstat(handle), path.stat())
        except FileNotFoundError:
            same = False
        if same:
            return handle, is_new, is_locked
        os.close(handle)


def _locked(handle: int, *, shared: bool) -> bool | None:
    if sys.platform == "win32":  # no such locks: the process that the file names is looked up instead
        return None
    try:
        fcntl.flock(handle, (fcntl.LOCK_SH if shared else fcntl.LOCK_EX) | fcntl.LOCK_NB)
    except BlockingIOError:
        return False
    except OSError:  # a file system without locks
        return None
    return True


def _content(handle: int) -> dict[str, Any]:
    """Return what a claim's file says; empty where its owner has not written it yet."""
    try:
        os.lseek(handle, 0, os.SEEK_SET)
        content = json.loads(os.read(handle, 1 << 16))
    except ValueError:
        return {}
    return content if isinstance(content, dict) else {}


def _is_alive(content: dict[str, Any]) -> bool:
    """Return whether the process that a claim names is at work on this host: number and start time are the same."""
    if content.get("status") != RUNNING:
        return False
    try:
        return abs(psutil.Process(int(content["process"])).create_time() - float(content["started"])) < 1.0
    except (psutil.NoSuchProcess, KeyError, TypeError, ValueError):
        return False


def _who(content: dict[str, Any]) -> str:
    if not content:
        return "another run"
    elsewhere = f" on {content.get('host')}" if content.get("host") != platform.node() else ""
    return f"another run (process {content.get('process')}{elsewhere})"


def _next_step(content: dict[str, Any], path: Path) -> str:
    elsewhere = bool(content) and content.get("host") != platform.node()
    return "name another --out" + (f", or remove {path} if that process has ended" if elsewhere else "")
