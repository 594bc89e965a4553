"""Chunks: some cells of a kind that go to a worker together, enough for half a second, and their answers."""

from __future__ import annotations

import time
from collections import deque
from collections.abc import Hashable, Iterable, Sequence

from tvimdesign.sweep.plan import Cell, CellAnswer, SweptStudy

CHUNK = 0.5
"""Seconds that a chunk is to take."""
MOST = 1000
"""Cells in one."""


class ChunkAnswers:
    """Answers chunks of some work, and says what each cell took."""

    def __init__(self, job: SweptStudy) -> None:
        from tvimdesign.sweep.answers import CellAnswers  # loads CasADi, which only workers need

        self._answers = CellAnswers(job)

    def answer(self, chunk: Sequence[tuple[str, Sequence[str]]]) -> list[tuple[str, CellAnswer, float]]:
        """Return each cell's key, answer, and seconds of the processor; a cell comes as a pair, as JSON has it."""
        answers = []
        for key, texts in chunk:
            began = time.process_time()
            cell = Cell(key, tuple(texts))
            answers.append((cell.key, self._answers.answer(cell), time.process_time() - began))
        return answers


class CellQueue:
    """The cells that are left, by kind: a worker stays with the kind it has compiled a module or a problem for."""

    def __init__(self, cells: Iterable[Cell], job: SweptStudy, workers: int) -> None:
        """Sort the cells by the words they are set to."""
        self._groups: dict[Hashable, deque[Cell]] = {}
        self._numbers, self._workers = job.numbers, max(workers, 1)
        self._at: dict[int, Hashable] = {}
        self._alone: set[str] = set()
        self._seconds = 0.0
        self._done = 0
        for cell in cells:
            self._groups.setdefault(self._kind(cell), deque()).append(cell)

    def __len__(self) -> int:
        return sum(map(len, self._groups.values()))

    def next(self, worker: int) -> list[Cell]:
        """Return the next chunk of a worker, by its number; empty where none is left."""
        kind = self._kind_for(worker)
        if kind is None:
            return []
        self._at[worker] = kind
        group = self._groups[kind]
        size = 1 if group[0].key in self._alone else min(self._size(), len(group))
        chunk = [group.popleft() for _ in range(size)]
        if not group:
            del self._groups[kind]
        return chunk

    def put_back(self, cells: Sequence[Cell]) -> None:
        """Take cells again whose worker has died; each is tried alone, so that the one to blame is found."""
        self._alone |= {cell.key for cell in cells}
        for cell in reversed(cells):
            self._groups.setdefault(self._kind(cell), deque()).appendleft(cell)

    def done(self, cells: int, seconds: float) -> None:
        """Learn what cells take."""
        self._done, self._seconds = self._done + cells, self._seconds + seconds

    def _kind(self, cell: Cell) -> Hashable:
        return tuple("" if number else text for text, number in zip(cell.texts, self._numbers, strict=True))

    def _kind_for(self, worker: int) -> Hashable | None:
        if self._at.get(worker) in self._groups:
            return self._at[worker]
        taken = {kind for other, kind in self._at.items() if other != worker}
        free = [kind for kind in self._groups if kind not in taken]
        return free[0] if free else max(self._groups, key=lambda kind: len(self._groups[kind]), default=None)

    def _size(self) -> int:
        if not self._done or not self._seconds:
            return 1
        fair = len(self) // (2 * self._workers)  # so that no worker has the last chunk while others wait
        return max(1, min(round(CHUNK * self._done / self._seconds), fair, MOST))
