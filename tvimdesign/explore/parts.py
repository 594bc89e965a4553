"""Exact CAD of the design that is shown, made in a thread beside, with its progress told to every page."""

from __future__ import annotations

import asyncio
import contextlib
import threading
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

from tvimdesign.base.errors import InputError, TvimError
from tvimdesign.base.results_folder import ResultsFolder
from tvimdesign.explore.states.history import PARTS
from tvimdesign.report.run.parts_of_design import in_short, make_parts_of


class PartsMaker:
    """One design's parts at a time."""

    def __init__(
        self, folder: Path, send: Callable[[dict[str, Any]], None], made: Callable[[], None] = lambda: None
    ) -> None:
        """Prepare to make parts, each design's in a folder of its own within `folder`.

        `made` is called when the parts of a design are there.
        """
        self._folder, self._send, self._made = folder, send, made
        self.shown: dict[str, Any] = {"design": "", "text": "", "busy": False}

    def make(self, design: Mapping[str, str] | None) -> None:
        """Begin. Raises InputError where there is no exact design yet, or parts are being made."""
        if self.shown["busy"]:
            raise InputError("make CAD: the parts of a design are being made; ask again when they are done")
        if design is None:
            raise InputError("make CAD: the exact design is still being computed; ask again in a moment")
        self._tell(design["name"], "parts: begun", busy=True)
        # Whoever ends the server does not wait for it: what it leaves is whole, and its child processes end with it.
        run = threading.Thread(target=self._make, args=(asyncio.get_running_loop(), dict(design)), daemon=True)
        run.start()

    def _tell(self, design: str, text: str, *, busy: bool) -> None:
        self.shown = {"design": design, "text": text, "busy": busy}
        self._send({"kind": "parts", **self.shown})

    def _make(self, loop: asyncio.AbstractEventLoop, design: dict[str, str]) -> None:
        """Make the parts in the thread, and hand progress to the loop."""

        def tell(text: str, busy: bool) -> None:
            with contextlib.suppress(RuntimeError):  # the loop is closed: nobody listens any more
                loop.call_soon_threadsafe(lambda: self._tell(design["name"], text, busy=busy))

        try:
            words = self._written(design["name"], design["json"], lambda text: tell(text, True) if text else None)
        except TvimError as error:
            words = str(error)
        tell(words, False)
        with contextlib.suppress(RuntimeError):
            loop.call_soon_threadsafe(self._made)

    def _written(self, name: str, text: str, progress: Callable[[str], None]) -> str:
        """Write the design's file and its parts, and return the result of the checks."""
        with ResultsFolder(self._folder / PARTS / name, overwrite=True) as folder:
            design = folder.write("design.json", text)
            report = make_parts_of(design, folder.path / "cad", progress)
            folder.finish("parts made", {}, {})
        return in_short(report.checks)
