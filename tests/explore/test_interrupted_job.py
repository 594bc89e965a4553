"""A job of the explorer's process that is interrupted goes no further, whatever a library made of the interrupt."""

from __future__ import annotations

import io
import json
import os
import signal
from contextlib import suppress
from pathlib import Path
from typing import Any

from explored import small_study

from tvimdesign.explore.answers.engine import Answer, Engine, Progress, Stage
from tvimdesign.explore.answers.worker import _done
from tvimdesign.explore.states.source import open_source
from tvimdesign.explore.states.state import State


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
