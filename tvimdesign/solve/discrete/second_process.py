"""A second process that answers tasks of a search, with the same problems built from the same study.

Run as `python -m tvimdesign.solve.discrete.second_process`: reads pickles on standard input and writes them on standard
output, to the process that started it alone. `ParallelSolver` is the other end. As no answer depends on who gives it,
two processes find what one finds.
"""

from __future__ import annotations

import contextlib
import os
import pickle
import signal
import subprocess
import sys
import threading
from collections.abc import Sequence
from functools import partial
from types import TracebackType
from typing import Any, NamedTuple

from tvimdesign.base.child_process import follow_parent, own_processors, start_child
from tvimdesign.base.deadline import Deadline
from tvimdesign.solve.discrete.box_tasks import Answer, OneProcess, Task, answer
from tvimdesign.solve.discrete.discrete_choices import Box
from tvimdesign.solve.discrete.relaxation import Relaxation
from tvimdesign.solve.discrete.trees import ProblemSpec, SearchState
from tvimdesign.solve.nlp.solution import SolverEffort
from tvimdesign.study import Study

WORTH = 1000
"""Combinations from which on a second process is started: it takes seconds to build its problems."""
_LOOK_AGAIN = 1.0  # s
_LOST = (OSError, EOFError, pickle.UnpicklingError)


class _Heard(NamedTuple):
    """The other process's answer to a task, which is kept as its key is good as long as it is."""

    task: Task
    answer: Answer
    work: SolverEffort


class ParallelSolver:
    """The process, and this one: each answers the next task, the other one those ahead where none is left.

    What the other one has answered is used where it is asked, so that the search goes the way that it goes alone. One
    that has died leaves this one to answer all.
    """

    def __init__(self, asked: ProblemSpec) -> None:
        """Start it, and let it build its problems."""
        self._trees: Sequence[Relaxation] = ()
        self._alive = True
        self._changed = threading.Condition()
        self._waiting: list[Task] = []
        """Tasks not started, the most urgent first."""
        self._under_way: Task | None = None
        """The other process's task."""
        self._taken: set[tuple[int, Box, str, int]] = set()
        """Its tasks that were taken from it."""
        self._heard: dict[tuple[int, Box, str, int], _Heard] = {}
        self._child = start_child(
            "tvimdesign.solve.discrete.second_process",
            stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL,
        )  # fmt: skip
        self._write(asked)

    def __enter__(self) -> ParallelSolver:
        """Return itself."""
        return self

    def __exit__(self, kind: type[BaseException] | None, value: BaseException | None, at: TracebackType | None) -> None:
        """End the process."""
        self._child.kill()
        with self._changed:
            self._alive = False
            self._changed.notify_all()
        self._child.communicate()

    def begin(self, trees: Sequence[Relaxation]) -> None:
        """Say what the starts came to; tasks are of these trees from now on."""
        self._trees = trees
        self._write(SearchState.of(trees))
        threading.Thread(target=self._hand_on, daemon=True).start()

    def solve(self, tasks: Sequence[Task], ahead: Sequence[Task] = (), /) -> list[Answer]:
        """Return the answers in the order of the tasks."""
        with self._changed:
            started = {self._under_way.key} if self._under_way else set()
            known = started | self._heard.keys()
            self._waiting = [task for task in (*tasks, *ahead) if task.key not in known]
            self._changed.notify_all()
        here = OneProcess(self._trees)
        mine = {task.key: here.solve([task])[0] for task in iter(partial(self._next_of, tasks), None)}
        return [mine[task.key] if task.key in mine else self._used(task) for task in tasks]

    def _next_of(self, tasks: Sequence[Task]) -> Task | None:
        """Return a task that is not started; None once the other process has answered the last of them.

        Once the time is over its task is taken from it, as it would have to be waited for: here it ends at once.
        """
        keys, deadline = {task.key for task in tasks}, self._trees[0].optimizer.deadline
        with self._changed:
            while True:
                for task in self._waiting:
                    if task.key in keys:
                        self._waiting.remove(task)
                        return task
                under_way = self._under_way
                if under_way is None or under_way.key not in keys or under_way.key in self._taken:
                    return None
                if deadline.passed:
                    self._taken.add(under_way.key)
                    return under_way
                self._changed.wait(min(_LOOK_AGAIN, deadline.remaining))

    def _used(self, task: Task) -> Answer:
        """Return the other process's answer; its effort counts as work of the tree here."""
        heard = self._heard[task.key]
        tree = self._trees[task.place]
        tree.work = SolverEffort.total([tree.work, heard.work])
        return heard.answer

    def _hand_on(self) -> None:
        """Hand one task after the other to the process, in a thread: the solver lets it run meanwhile."""
        assert self._child.stdout is not None
        while True:
            with self._changed:
                while self._alive and not self._waiting:
                    self._changed.wait()
                if not self._alive:
                    return
                task = self._under_way = self._waiting.pop(0)
            self._write(task)
            heard: _Heard | None = None
            with contextlib.suppress(*_LOST):
                heard = _Heard(task, *pickle.load(self._child.stdout))
            with self._changed:
                if heard is None:
                    self._alive = False
                    self._waiting.insert(0, task)
                else:
                    self._heard[task.key] = heard
                self._under_way = None
                self._changed.notify_all()

    def _write(self, what: Any) -> None:
        assert self._child.stdin is not None
        with contextlib.suppress(OSError):  # that it has died is seen when it is to be heard
            pickle.dump(what, self._child.stdin)
            self._child.stdin.flush()


def second_process(
    study: Study,
    reference: dict[str, float] | None,
    objectives: Sequence[str],
    deadline: Deadline,
    combinations: int,
) -> contextlib.AbstractContextManager[ParallelSolver | None]:
    """Return a second process if it pays off; none in a child process, which shares the processors with others."""
    if combinations < WORTH or own_processors() < 2:
        return contextlib.nullcontext()
    return ParallelSolver(ProblemSpec(study.model_dump_json(), reference, list(objectives), deadline.remaining))


def main() -> None:
    """Build the problems, hear what the starts came to, and answer tasks until there are no more."""
    follow_parent()
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # an interrupt is the parent's to handle
    heard, sent = sys.stdin.buffer, os.fdopen(os.dup(1), "wb")
    os.dup2(2, 1)  # what a library prints must not stand among the answers
    spec: ProblemSpec = pickle.load(heard)
    trees = spec.built()
    for tree, state in zip(trees, pickle.load(heard), strict=True):
        state.take(tree)
    with contextlib.suppress(EOFError):
        while True:
            task: Task = pickle.load(heard)
            result = answer(trees, task)
            pickle.dump((result, trees[task.place].work), sent)
            sent.flush()
            trees[task.place].work = SolverEffort()


if __name__ == "__main__":
    main()
