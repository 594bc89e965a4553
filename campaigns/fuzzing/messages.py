"""Messages of a page of the explorer: conversations of messages, taken by the server's own session in this process.

The session is the product's; the worker process it starts is replaced by one that answers at once with the values of
the study's start. `ANSWERS` hands the state that a conversation ends in to the worker's engine as well.
"""

from __future__ import annotations

import asyncio
import json
import random
from functools import cache
from pathlib import Path
from typing import Any, ClassVar
from unittest.mock import patch

from fuzzing.kind import ROOT, Drawn, Kind
from fuzzing.mutations import ODD, mutated_text
from tvimdesign.explore import session as explored
from tvimdesign.explore.engine import Engine
from tvimdesign.explore.session import Session
from tvimdesign.explore.source import Source, open_source
from tvimdesign.explore.state import History
from tvimdesign.explore.worker_process import Job

STUDY = ROOT / "campaigns/small.yaml"
_NAMES = ["pcl_thickness", "current", "wire_diameter", "coil_count", "arc_count", "cover", "structure", "spring_steel",
          "hot_temperature", "temperature@hot", "peak_power", "joint_damping@hot", "module_mass", "response_time",
          "catalog", "solver", "front", "robust", "envelope_diameter", "a@b@c", "vary.current"]  # fmt: skip
_TEXTS = ["1 mm", "1.2 A", "2", "<= 9 W", ">= 1 N.m.s/rad", "none", "1", "0", "300 g", "90 degC", "<= 20 s", "-5 mm"]
_MOST = 8
_PROCESSES = ("WorkerProcess",)
"""The classes of a session by which it starts processes."""


class _Answered:
    """Stands in for the worker: says at once what the study's start does, of whatever is asked."""

    shown: ClassVar[dict[str, Any]] = {}
    under_way = None

    def __init__(self, *arguments: Any, low_priority: bool = False) -> None:
        self._report = None if low_priority else arguments[-1]

    def ask(self, job: Job) -> None:
        json.dumps(dict(job.data))
        if self._report:
            self._report(job, {"shown": {**self.shown, "stage": job.stage, "way": job.data["state"]["way"]}})


class _Talk:
    """One session, and an event loop for it, for all conversations of a process."""

    def __init__(self) -> None:
        self.source: Source = open_source(STUDY)
        self.engine = Engine(self.source.tree, compiled=False)
        _Answered.shown = self.engine.answer(self.source.first, "quick").shown
        self.runner = asyncio.Runner()

    async def hears(self, texts: list[str], folder: Path) -> History:
        """Do all that a server does with these messages; return what is kept then."""
        started = {name: _Answered for name in _PROCESSES if hasattr(explored, name)}
        with patch.multiple(explored, open_source=lambda *_: self.source, **started):
            session = Session(STUDY, folder, _sent)
        for text in texts:
            for reply in session.receive(text):
                _sent(reply)
        _sent(session.state_shown())
        if session._timer:
            session._timer.cancel()
        return session.history


def _sent(message: dict[str, Any]) -> None:
    """As the server sends it; what is not JSON, or not text, cannot be sent."""
    json.dumps(message, allow_nan=False).encode()


@cache
def _talk() -> _Talk:
    return _Talk()


def _text(draw: random.Random) -> str:
    return draw.choice(_TEXTS) if draw.random() < 0.6 else str(draw.choice(ODD))


def _name(draw: random.Random) -> str:
    return draw.choice(_NAMES) if draw.random() < 0.85 else str(draw.choice(ODD))


def _message(draw: random.Random) -> str:
    """Return a message of any kind with likely and unlikely fields; some are no JSON any more."""
    kind = draw.choice(["set", "set", "set", "require", "range", "weight", "way", "undo", "redo", "reset", "pin",
                        "unpin", "recall", "point", "save", "confirm", "cad", "x"])  # fmt: skip
    fields: dict[str, Any] = {
        "set": {"name": _name(draw), "text": _text(draw)},
        "require": {"name": _name(draw), "texts": [_text(draw) for _ in range(draw.randrange(4))]},
        "range": {"name": _name(draw), "low": _text(draw), "high": _text(draw)},
        "weight": {"name": _name(draw), "text": _text(draw)},
        "way": {"way": draw.choice(["evaluate", "optimize", "x"])},
        "pin": {"name": _name(draw)},
        "save": {
            "file": draw.choice(["a.yaml", "../a.yaml", "/tmp/a.yaml", "small.yaml", ".yaml", "a" * 90, "a.yaml\n"])
        },
    }.get(kind, {"number": draw.choice([0, 0, 1, -1, 5, 10**20, "0"])} if kind in ("unpin", "recall", "point") else {})
    if "name" in fields and kind != "pin" and draw.random() < 0.3:
        fields["final"] = draw.choice([False, True, 1, "x"])
    if draw.random() < 0.05:
        fields[str(draw.choice(ODD))] = draw.choice(ODD)
    text = json.dumps({"kind": kind, **fields})
    return text if draw.random() < 0.85 else mutated_text(text, draw).decode("utf-8", "replace")


def _conversation(draw: random.Random) -> Drawn:
    _talk()  # once, and no input's time
    texts = [_message(draw) for _ in range(draw.randint(1, _MOST))]
    return Drawn("input.json", json.dumps(texts).encode(), parts=len(texts))


def _use(path: Path) -> None:
    talk = _talk()
    talk.runner.run(talk.hears(json.loads(path.read_bytes()), path.parent / "out"))


def _use_answers(path: Path) -> None:
    talk = _talk()
    state_of_talk = talk.runner.run(talk.hears(json.loads(path.read_bytes()), path.parent / "out"))
    result = talk.engine.answer(state_of_talk.state, "quick")
    _sent(result.shown)


MESSAGES = Kind(_conversation, _use, writes=True)
ANSWERS = Kind(_conversation, _use_answers, writes=True, share=0.005)
