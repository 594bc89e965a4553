"""Jobs of the process that solves: a state, and how exactly it is to be answered."""

from __future__ import annotations

import json
from collections.abc import Callable, Sequence
from dataclasses import dataclass

from tvimdesign.explore.answers.engine import Stage
from tvimdesign.explore.states.state import State
from tvimdesign.explore.worker_process import Told, WorkerProcess

WORKER = "tvimdesign.explore.answers.worker"


@dataclass(frozen=True)
class Job:
    """A state to be answered."""

    number: int
    stage: Stage
    state: State

    @property
    def gives_way(self) -> bool:
        """What is slow is interrupted when another job comes."""
        return self.stage != "quick"

    def line(self) -> str:
        """As the worker reads it."""
        return json.dumps({"number": self.number, "stage": self.stage, "state": self.state.model_dump()}) + "\n"

    def given_up(self) -> Told:
        """What is told where the worker ended over it."""
        words = "the solver ended without an answer; what you did is kept: undo, or go on from here"
        return {"shown": {"status": words, "found": False, "stage": self.stage, "way": self.state.way}}


class Solver(WorkerProcess[Job]):
    """The process that solves."""

    def __init__(self, arguments: Sequence[str], told: Callable[[Job, Told], None]) -> None:
        """Start it; `told` is called with all it says of a job."""
        super().__init__(WORKER, arguments, told)
