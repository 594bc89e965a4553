"""A process that answers jobs: one that cannot even start is given up, and not started for ever."""

from __future__ import annotations

import asyncio

from explored import awaited

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
