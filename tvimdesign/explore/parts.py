"""Exact CAD of the design that is shown, made beside in a thread, with its progress told to every page."""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

from tvimdesign.base.errors import InputError, TvimError
from tvimdesign.base.whole_files import make_folder, write_whole
from tvimdesign.explore.report_fragment import PARTS
from tvimdesign.report.run.parts_of_design import make_parts_of
from tvimdesign.report.run.solid_checks import in_short


class PartsMaker:
    """One design's parts at a time."""

    def __init__(
        self, folder: Path, send: Callable[[dict[str, Any]], None], made: Callable[[], None] = lambda: None
    ) -> None:
        """Nothing is made yet; parts go into a folder of the design's own within `folder`.

        `made` is called when the parts of a design are there.
        """
        self._folder, self._send, self._made = folder, send, made
        self._task: asyncio.Task[None] | None = None
        self.shown: dict[str, Any] = {"design": "", "text": "", "busy": False}

    def make(self, design: Mapping[str, str] | None) -> None:
        """Begin. Raises InputError where there is no exact design yet, or parts are being made."""
        if self.shown["busy"]:
            raise InputError("make CAD: the parts of a design are being made; ask again when they are done")
        if design is None:
            raise InputError("make CAD: the exact design is still being computed; ask again in a moment")
        self._tell(design["name"], "parts: begun", busy=True)
        self._task = asyncio.create_task(self._make(design["name"], design["json"]))

    def _tell(self, design: str, text: str, *, busy: bool) -> None:
        self.shown = {"design": design, "text": text, "busy": busy}
        self._send({"kind": "parts", **self.shown})

    async def _make(self, name: str, text: str) -> None:
        loop = asyncio.get_running_loop()

        def progress(said: str) -> None:
            if said:
                loop.call_soon_threadsafe(lambda: self._tell(name, said, busy=True))

        try:
            words = await asyncio.to_thread(self._written, name, text, progress)
        except TvimError as error:
            words = str(error)
        await asyncio.sleep(0)  # what the thread told last comes first
        self._tell(name, words, busy=False)
        self._made()

    def _written(self, name: str, text: str, progress: Callable[[str], None]) -> str:
        """In the thread: the design's file and its parts; what the checks say."""
        own = self._folder / PARTS / name
        make_folder(own)
        write_whole(own / "design.json", text.encode())
        report = make_parts_of(own / "design.json", own / "cad", progress)
        return in_short(report.checks)
