"""One input handed in, with an eye on time, on files and on how it ends."""

from __future__ import annotations

import os
import signal
import sys
import time
import traceback
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any
from unittest import mock

from fuzzing.kind import Kind
from tvimdesign.base.errors import TvimError
from tvimdesign.base.user_cache import FOLDER_VARIABLE

HANG = 3.0
"""Times the seconds a kind may take, after which an input is ended."""
_WRITES = os.O_WRONLY | os.O_RDWR | os.O_CREAT | os.O_TRUNC | os.O_APPEND
_CHANGES = {"os.mkdir": 1, "os.rmdir": 1, "os.remove": 1, "os.rename": 2, "os.link": 2, "os.symlink": 2,
            "os.truncate": 1, "os.chmod": 1, "os.chown": 1, "os.utime": 1}  # fmt: skip
"""What Python says it does to files, and how many paths it names first."""
_STARTS = {"subprocess.Popen", "os.system", "os.exec", "os.posix_spawn", "os.fork", "socket.connect", "socket.bind"}


class Hang(BaseException):
    """An input takes too long; nothing in the program catches it."""


class _Watch:
    """Hears of every file that is changed and every process that is started, by Python's audit events."""

    def __init__(self) -> None:
        self.on = False
        self.folder: Path | None = None
        """Where files may be written."""
        self.events: list[str] = []
        sys.addaudithook(self._heard)

    def _heard(self, event: str, arguments: tuple[Any, ...]) -> None:
        if not self.on:
            return
        if event == "open" and isinstance(arguments[2], int) and arguments[2] & _WRITES:
            self._changed(event, arguments[0])
        elif event in _CHANGES:
            for path in arguments[: _CHANGES[event]]:
                self._changed(event, path)
        elif event in _STARTS:
            self.events.append(event)

    def _changed(self, event: str, path: Any) -> None:
        if isinstance(path, int):
            return
        where = Path(os.fsdecode(path)).absolute()
        if str(where) != os.devnull and (
            self.folder is None or ".." in where.parts or self.folder not in where.parents
        ):
            self.events.append(f"{event} of {where}")

    @contextmanager
    def within(self, folder: Path | None) -> Iterator[list[str]]:
        """Watch for changes outside a folder; anywhere where there is none. The user's cache is off.

        A module imported meanwhile for the first time leaves no bytecode: that is the interpreter's, not the input's.
        """
        bytecode = sys.dont_write_bytecode
        sys.dont_write_bytecode = True
        self.folder, self.events, self.on = folder, [], True
        try:
            with mock.patch.dict(os.environ, {FOLDER_VARIABLE: ""}):
                yield self.events
        finally:
            self.on = False
            sys.dont_write_bytecode = bytecode


_WATCH: list[_Watch] = []
"""One a process, as an audit hook cannot be taken away."""


def watch() -> _Watch:
    """Return the watch of this process."""
    if not _WATCH:
        _WATCH.append(_Watch())
    return _WATCH[0]


def _too_long(*_: object) -> None:
    raise Hang


def ending(kind: Kind, path: Path) -> tuple[str, bool]:
    """Return what is wrong with how an input is taken, empty where nothing is; and whether it was refused."""
    began, fault, refused = time.process_time(), "", False
    signal.signal(signal.SIGPROF, _too_long)
    signal.setitimer(signal.ITIMER_PROF, HANG * kind.most_seconds)
    with watch().within(path.parent.absolute() if kind.writes else None) as changed:
        try:
            kind.use(path)
        except TvimError as error:
            refused, fault = True, "" if str(error).strip() else "an error without words"
        except BaseException as error:  # what is looked for; a library's panic is no Exception
            signal.setitimer(signal.ITIMER_PROF, 0.0)
            if isinstance(error, KeyboardInterrupt):
                raise
            places = traceback.extract_tb(error.__traceback__)
            last = next((place for place in reversed(places) if "tvimdesign" in place.filename), places[-1])
            fault = f"{type(error).__name__} in {Path(last.filename).name}:{last.name}: {str(error)[:120]!r}"
        finally:
            signal.setitimer(signal.ITIMER_PROF, 0.0)
    if not fault and (seconds := time.process_time() - began) > kind.most_seconds:
        fault = f"takes {seconds:.1f} s"
    return fault or (f"touches {changed[0]}" if changed else ""), refused
