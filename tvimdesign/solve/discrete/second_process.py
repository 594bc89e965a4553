"""A second process that answers tasks of a search, with the same problems built from the same study.

Run as `python -m tvimdesign.solve.discrete.second_process`: reads pickles on standard input and writes them on standard
output, to the process that started it alone. `TwoProcesses` is the other end. As no answer depends on who gives it, two
processes find what one finds.
"""

from __future__ import annotations

import contextlib
import os
import pickle
import signal
import subprocess
import sys
import threading
from collections import deque
from collections.abc import Sequence
from types import TracebackType
from typing import Any, NamedTuple

from tvimdesign.base.child_process import PARENT, follow_parent, start_child
from tvimdesign.solve.discrete.box_tasks import Answer, OneProcess, Task, answer
from tvimdesign.solve.discrete.discrete_choices import Sizes, discrete_sizes
from tvimdesign.solve.discrete.record_families import families_of
from tvimdesign.solve.discrete.relaxation import Relaxation
from tvimdesign.solve.discrete.trees import Trees
from tvimdesign.solve.nlp.deadline import Deadline
from tvimdesign.solve.nlp.solution import SolverEffort
from tvimdesign.solve.nlp.solver_run import Run
from tvimdesign.study import Study

WORTH = 1000
"""Combinations from which on a second process is started: it takes seconds to build its problems."""
_LOST = (OSError, EOFError, pickle.UnpicklingError)


class _Asked(NamedTuple):
    """What the problems are built from."""

    study: str
    reference: dict[str, float] | None
    objectives: Sequence[str]
    seconds: float
    """Until the time is over."""


class _Found(NamedTuple):
    """What the starts of one tree came to."""

    sizes: Sizes
    optima: list[Run]
    ends: list[Run]


class TwoProcesses:
    """The process, and this one: each answers the next task. One that has died leaves this one to answer all."""

    def __init__(self, asked: _Asked) -> None:
        """Start it, and let it build its problems."""
        self._trees: Sequence[Relaxation] = ()
        self._alive = True
        self._worked: list[tuple[int, SolverEffort]] = []
        """By tree, not yet counted there."""
        self._child = start_child(
            "tvimdesign.solve.discrete.second_process",
            stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL,
        )  # fmt: skip
        self._write(asked)

    def __enter__(self) -> TwoProcesses:
        """Return itself."""
        return self

    def __exit__(self, kind: type[BaseException] | None, value: BaseException | None, at: TracebackType | None) -> None:
        """End the process."""
        self._child.kill()
        self._child.communicate()

    def begin(self, trees: Sequence[Relaxation]) -> None:
        """Say what the starts came to; tasks are of these trees from now on."""
        self._trees = trees
        self._write([_Found(tree.sizes, tree.optima, tree.ends) for tree in trees])

    def solve(self, tasks: Sequence[Task]) -> list[Answer]:
        """The answers, in the order of the tasks; each process takes the next one when it has answered one."""
        here, answers = OneProcess(self._trees), dict[int, Answer]()
        waiting = deque(range(len(tasks) if self._alive else 0))
        there = threading.Thread(target=self._ask, args=(tasks, waiting, answers), daemon=True)
        there.start()
        with contextlib.suppress(IndexError):
            while True:
                place = waiting.popleft()
                answers[place] = here.solve([tasks[place]])[0]
        there.join()
        for place, work in self._worked:
            self._trees[place].work = SolverEffort.total([self._trees[place].work, work])
        self._worked.clear()
        return [answers[i] if i in answers else here.solve([task])[0] for i, task in enumerate(tasks)]

    def _ask(self, tasks: Sequence[Task], waiting: deque[int], answers: dict[int, Answer]) -> None:
        """Hand one task after the other to the process, in a thread: the solver here lets it run meanwhile."""
        assert self._child.stdout is not None
        with contextlib.suppress(IndexError):  # none is left
            while self._alive:
                place = waiting.popleft()
                self._write(tasks[place])
                try:
                    found, work = pickle.load(self._child.stdout)
                except _LOST:  # it has died
                    self._alive = False
                    return
                answers[place] = found
                self._worked.append((tasks[place].place, work))

    def _write(self, what: Any) -> None:
        assert self._child.stdin is not None
        try:
            pickle.dump(what, self._child.stdin)
            self._child.stdin.flush()
        except OSError:
            self._alive = False


def second_process(
    study: Study,
    reference: dict[str, float] | None,
    objectives: Sequence[str],
    deadline: Deadline,
    combinations: int,
) -> contextlib.AbstractContextManager[TwoProcesses | None]:
    """A second process where it is worth one; not in a child of ours, as that shares the processors with others."""
    if combinations < WORTH or (os.cpu_count() or 1) < 2 or PARENT in os.environ:
        return contextlib.nullcontext()
    return TwoProcesses(_Asked(study.model_dump_json(), reference, list(objectives), deadline.remaining))


def main() -> None:
    """Build the problems, hear what the starts came to, and answer tasks until there are no more."""
    follow_parent()
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # an interrupt is the parent's to handle
    heard, told = sys.stdin.buffer, os.fdopen(os.dup(1), "wb")
    os.dup2(2, 1)  # what a library prints must not stand among the answers
    trees = _built(pickle.load(heard))
    for tree, (sizes, optima, ends) in zip(trees, pickle.load(heard), strict=True):
        tree.sizes, tree.optima, tree.ends = sizes, optima, ends
    with contextlib.suppress(EOFError):
        while True:
            task: Task = pickle.load(heard)
            found = answer(trees, task)
            pickle.dump((found, trees[task.place].work), told)
            told.flush()
            trees[task.place].work = SolverEffort()


def _built(asked: _Asked) -> list[Relaxation]:
    study = Study.model_validate_json(asked.study)
    sizes, families = discrete_sizes(study, study.table), families_of(study)
    deadline = Deadline(asked.seconds)
    return Trees(study, asked.reference, lambda _: None, asked.objectives, deadline, sizes).of(families)


if __name__ == "__main__":
    main()
