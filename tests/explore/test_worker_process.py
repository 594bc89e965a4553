"""A process that answers jobs: given up if it cannot start, and stopped where a job is interrupted."""

import asyncio
import io
import json
import os
import signal
from contextlib import suppress
from pathlib import Path
from typing import Any

from explored import awaited, small_study

from tvimdesign.explore.answers.engine import Answer, Engine, Progress, Stage
from tvimdesign.explore.answers.worker import _done
from tvimdesign.explore.states.source import open_source
from tvimdesign.explore.states.state import State
from tvimdesign.explore.worker_process import Job, WorkerProcess


class _Counted(WorkerProcess):
    """Counts how often it starts its process."""

    starts = 0

    def _start(self) -> None:
        self.starts += 1
        super()._start()


def test_a_worker_that_cannot_start_is_tried_again_per_job() -> None:
    async def reply_of() -> tuple[list[tuple[int, str]], int]:
        reported: list[tuple[int, str]] = []
        worker = _Counted(
            "tvimdesign.no_such_module", [], lambda job, reply: reported.append((job.number, reply["words"]))
        )
        started = worker.starts
        for number in (1, 2):
            worker.ask(Job(number, {}, {"words": "given up"}))
            async with asyncio.timeout(600.0):
                while (number, "given up") not in reported:
                    await asyncio.sleep(0.02)
        await asyncio.sleep(0.3)
        worker.close()
        return reported, worker.starts - started

    reported, starts = awaited(reply_of())
    assert reported == [(1, "given up"), (2, "given up")]
    assert starts <= 2


class _Interrupted(Engine):
    """Interrupted while it answers an exact job, which a library swallows."""

    went_on = False

    def answer(self, state: State, stage: Stage, progress: Progress = lambda _: None) -> Answer:
        if stage == "exact":
            with suppress(KeyboardInterrupt):
                os.kill(os.getpid(), signal.SIGINT)
            progress("the next start")
            self.went_on = True
        return super().answer(state, stage, progress)


def test_a_job_ends_at_the_next_thing_it_says_and_another_is_answered(tmp_path: Path) -> None:
    source = open_source(small_study(tmp_path))
    engine, answers = _Interrupted(source.tree), io.StringIO()
    state = json.loads(source.first.model_dump_json())

    def done(number: int, stage: str) -> dict[str, Any]:
        return _done(engine, {"number": number, "stage": stage, "state": state}, tmp_path, answers)

    assert done(1, "exact") == {"superseded": True}
    assert not engine.went_on
    assert answers.getvalue() == ""
    assert done(2, "quick")["shown"]["stage"] == "quick"
