"""A session between pages and the solver: messages become states, states become jobs, answers go to every page."""

import asyncio
import contextlib
import os
import re
import threading
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

from tvimdesign.base.atomic_files import atomic_write, digest_of, is_as_written, make_folder
from tvimdesign.base.errors import InputError, TvimError
from tvimdesign.base.results_folder import ResultsFolder
from tvimdesign.base.units import pretty
from tvimdesign.cad.make import make_parts_of
from tvimdesign.explore import messages, state
from tvimdesign.explore.engine import Stage, value_names
from tvimdesign.explore.messages import Change, Message
from tvimdesign.explore.source import Source, open_source
from tvimdesign.explore.worker_process import Job, Reply, WorkerProcess
from tvimdesign.report.output.numbers import label
from tvimdesign.report.run.parts_of_design import in_short
from tvimdesign.study import Study, read_tree
from tvimdesign.study.sizing import SIZED_MODE, JointTask


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
        with ResultsFolder(self._folder / state.PARTS / name, overwrite=True) as folder:
            design = folder.write("design.json", text)
            report = make_parts_of(design, folder.path / "cad", progress)
            folder.finish("parts made", {}, {})
        return in_short(report.checks)


QUIET = 0.35  # Seconds without a message after which the exact answer is sought
_FILE = re.compile(r"[A-Za-z0-9][A-Za-z0-9_.-]{0,80}\.yaml")
Send = Callable[[Reply], None]


class Session:
    """One study, explored by any count of pages at once."""

    def __init__(
        self, source: Path, folder: Path, send: Send, settings: Sequence[str] = (), *, overwrite: bool = False
    ) -> None:
        """Open the study, go on from what was kept in the folder, and start the solver. Raises InputError.

        `send` sends a message to all pages. Needs an event loop.
        """
        self.source: Source = open_source(source, settings)
        self.folder, self._send = folder, send
        self.history = state.open_history(folder, self.source.text, self.source.first, overwrite=overwrite)
        make_folder(folder)
        self._written = state.written_digest(folder)
        if not self._written:
            self._written = state.write_history(folder, self.history, "")
        self._since = self.history.state
        self._number = 0
        self._timer: asyncio.TimerHandle | None = None
        self.answers: dict[str, Reply] = {}  # The last quick answer and the last exact one, for pages that come later
        self._design: dict[str, str] | None = None
        self.parts = PartsMaker(folder, send, self._parts_made)
        self.draft: Reply | None = None  # The last draft in 3-D, or why there is none, for pages that come later
        self.drafter = WorkerProcess("tvimdesign.explore.draft_worker", [], self._drafted, low_priority=True)
        self.solver = WorkerProcess(
            "tvimdesign.explore.answer_worker", [str(source), str(folder), *settings], self._answered
        )
        self._ask("quick")

    def close(self) -> None:
        """End what runs."""
        if self._timer:
            self._timer.cancel()
        self.solver.close()
        self.drafter.close()

    # --- what a page asks ---

    def receive(self, text: str) -> list[Reply]:
        """Do what a message says; returns the replies to the page that sent it alone."""
        try:
            message = messages.read_message(text)
            return self._do(message)
        except TvimError as error:
            name = getattr(locals().get("message"), "name", "")
            return [{"kind": "refused", "name": name, "words": str(error)}]

    def _do(self, message: Message) -> list[Reply]:
        match message:
            case messages.SetWay():
                self._become(self.history.state.model_copy(update={"way": message.way}))
            case messages.Step(kind="reset"):
                self._become(self.source.first)
            case messages.Step():
                (self.history.undo if message.kind == "undo" else self.history.redo)()
                self._settle()
                self._ask("quick")
            case messages.Pin():
                self._pin(message.name)
            case messages.OfPin(kind="recall"):
                self._become(self.history.pinned(message.number).state)
            case messages.OfPin():
                self.history.unpin(message.number)
                self._settle()
            case messages.Point():
                self._become(self.source.at_point(message.number, self.history.state))
            case messages.Save():
                return [self._save(message.file)]
            case messages.Confirm():
                self._ask("confirmed")
            case messages.Size():
                self._size(message)
            case messages.MakeParts():
                self.parts.make(self._design if self._is_exact else None)
            case _:
                self._change(message)
        return []

    def _change(self, change: Change) -> None:
        before = self.history.state
        after = state.changed(self.source.tree, before, change, self._read("optimize"))
        self.history.state = after
        if change.final:
            self.history.advance(after, self._since)
            self._settle()
        if after != before:  # a control that is let go where it was dragged to has its answer, or will
            self._ask("quick")

    def _become(self, after: state.State) -> None:
        """Go to a state that differs in more than one value."""
        self.history.advance(after, self._since)
        self._settle()
        self._ask("quick")

    def _pin(self, label: str) -> None:
        answer = self.answers.get("quick")
        if answer is None or "values" not in answer["shown"] or answer["number"] != self._number:
            raise InputError("pin: the design is still being computed; pin it when its values are there")
        study = self._read("optimize")
        units = [pretty(study.table.unit(name)) for name in value_names(study)]
        numbers = zip(value_names(study), answer["shown"]["values"], units, strict=True)
        texts = {name: "never" if value is None else f"{value:.4g} {unit}".rstrip() for name, value, unit in numbers}
        variables = answer["shown"]["variables"].items()
        inputs = {name: f"{variable['value']:.4g} {pretty(study.table.unit(name))}".rstrip()
                  for name, variable in variables if variable["value"] is not None}  # fmt: skip
        self.history.pin(state.Pinned(name=label, state=self.history.state, values={**inputs, **texts}))
        self._settle()

    def _save(self, file: str) -> Reply:
        if not _FILE.fullmatch(file):
            raise InputError(f"save: {file!r} is no file name; letters, digits, _ . - and .yaml at the end")
        path = self.folder / file
        if os.path.lexists(path) and not is_as_written(self.folder, file, {self.history.saved.get(file, "-")}):
            raise InputError(f"save: {path} is there already, and is not what was saved from here; choose another name")
        atomic_write(path, state.saved_text(self.source.tree, self.history.state, self.folder).encode())
        self.history.saved[file] = digest_of(path)
        self._written = state.write_history(self.folder, self.history, self._written)
        return {"kind": "saved", "file": file, "path": str(path)}

    def _size(self, message: messages.Size) -> None:
        """Let the worker choose the hardware of a joint; its study becomes the state."""
        numbers = message.model_dump(exclude={"kind"})
        JointTask.read(**numbers)
        if self.source.study.mode != SIZED_MODE:
            raise InputError(f"size: it draws modules of {SIZED_MODE} mode; explore a study of that mode")
        self._number += 1
        fallback = {"refused": "size: the hardware could not be chosen; ask again"}
        self.solver.ask(Job(self._number, {"stage": "size", "numbers": numbers}, fallback, interruptible=True))

    def _sized(self, reply: Reply) -> None:
        """Go to the study of a joint, or say why there is none."""
        if "refused" in reply:
            self._send({"kind": "refused", "name": "", "words": reply["refused"]})
            self._ask("quick")
        else:
            self._become(state.sized_state(self.source.tree, reply["study"]))

    # --- what becomes of it ---

    def _read(self, way: messages.Way | None = None) -> Study:
        tree = state.tree_of(self.source.tree, self.history.state, way)
        return read_tree(tree, lambda _: self.source.study.table, lambda _: self.source.study.catalog)

    def _settle(self) -> None:
        """Write a state to which undo returns, and send it to every page."""
        self._since = self.history.state
        self._written = state.write_history(self.folder, self.history, self._written)
        self._send(self.state_shown())

    def state_shown(self) -> Reply:
        """Return all that a page needs beside answers."""
        free = self._read("optimize")
        return {
            "kind": "state", "name": free.name, "mode": free.mode, "way": self.history.state.way,
            "optimizes": bool(free.vary), "undo": bool(self.history.past), "redo": bool(self.history.future),
            "controls": state.controls_shown(free, self._read("evaluate"), self.history.state),
            "pins": [{"name": pin.name, "way": pin.state.way, "values": pin.values} for pin in self.history.pins],
            "quantities": [_quantity(free, name) for name in value_names(free)],
            "asked": list(dict.fromkeys([*free.minimize, *(limit.output for limit in free.require)])),
            "folder": str(self.folder), "parts": self.parts.shown,
        }  # fmt: skip

    def _ask(self, stage: Stage) -> None:
        self._number += 1
        self.solver.ask(self._job(self._number, stage))
        if stage == "quick":
            self._wait()

    def _job(self, number: int, stage: Stage) -> Job:
        current = self.history.state
        words = "the solver ended without an answer; what you did is kept: undo, or go on from here"
        shown = {"status": words, "found": False, "stage": stage, "way": current.way}
        return Job(number, {"stage": stage, "state": current.model_dump()}, {"shown": shown}, stage != "quick")

    def _wait(self) -> None:
        if self._timer:
            self._timer.cancel()
        self._timer = asyncio.get_running_loop().call_later(QUIET, self._exact_now, self._number)

    def _exact_now(self, number: int) -> None:
        if number == self._number and not self._is_exact:
            if self.solver.under_way is None:
                self.solver.ask(self._job(number, "exact"))
            else:
                self._wait()

    @property
    def _is_exact(self) -> bool:
        answer = self.answers.get("exact")
        return answer is not None and answer["number"] == self._number

    def _parts_made(self) -> None:
        """Show the assembly, if the design is still the one that is shown."""
        if self._is_exact:
            self.solver.ask(self._job(self._number, "report"))

    def _answered(self, job: Job, reply: Reply) -> None:
        if "progress" in reply or reply.get("superseded"):
            if reply.get("progress") and job.number == self._number:
                self._send({"kind": "progress", "number": job.number, "text": reply["progress"]})
            return
        if job.number < self._number and job.stage != "quick":
            return
        if job.stage == "size":
            self._sized(reply)
            return
        shown = reply["shown"]
        answer = {"kind": "answer", "number": job.number, "shown": shown}
        self.answers["quick" if "values" in shown else "refused"] = answer
        if job.stage != "quick":
            self.answers["exact"] = {**answer, "report": reply.get("report")}
            self._design = reply.get("design")
            answer = self.answers["exact"]
        self._follow(job, shown)
        self._send(answer)
        if reply.get("module"):
            fallback = {"words": "the module could not be drafted; `Make CAD` draws it exactly"}
            self.drafter.ask(Job(job.number, reply["module"], fallback))
        elif job.number == self._number:
            self._drafted(job, {"words": shown["status"]})

    def _drafted(self, job: Job, reply: Reply) -> None:
        """Send a draft, or the reason why there is none, unless a newer one was sent."""
        if self.draft is None or job.number >= self.draft["number"]:
            self.draft = {**reply, "kind": "draft", "number": job.number}
            self._send(self.draft)

    def _follow(self, job: Job, shown: Reply) -> None:
        """Let the hand's variables be the optimum's, so that it can be gone on from."""
        if "at" not in shown or job.number != self._number or self.history.state.way != "optimize":
            return
        if shown["at"] != self.history.state.at:
            self.history.state = self.history.state.model_copy(update={"at": shown["at"]})
            if job.stage != "quick":
                self._settle()


def _quantity(study: Study, name: str) -> dict[str, Any]:
    row = study.table.output(name.partition("@")[0])
    return {"name": name, "label": label(name), "unit": pretty(study.table.unit(name)), "means": row.description,
            "group": row.group, "headline": row.headline}  # fmt: skip
