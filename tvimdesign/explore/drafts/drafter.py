"""Jobs of the process that drafts: a module's numbers and chosen words, in SI."""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

from tvimdesign.explore.worker_process import Told, WorkerProcess

WORKER = "tvimdesign.explore.drafts.worker"


@dataclass(frozen=True)
class DraftJob:
    """A module to be drafted."""

    number: int
    module: Mapping[str, Any]
    """`mode`, `choices` and `values`, as the worker of answers gives them."""
    gives_way: bool = False

    def line(self) -> str:
        """As the worker reads it."""
        return json.dumps({"number": self.number, **self.module}) + "\n"

    def given_up(self) -> Told:
        """What is told where the worker ended over it."""
        return {"words": "the module could not be drafted; `Make CAD` draws it exactly"}


class Drafter(WorkerProcess[DraftJob]):
    """The process that drafts."""

    def __init__(self, told: Callable[[DraftJob, Told], None]) -> None:
        """Start it; `told` is called with what it says of a job."""
        super().__init__(WORKER, [], told, behind=True)
