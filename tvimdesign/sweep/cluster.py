"""A sweep on a cluster that dask.distributed runs: chunks go to its workers, their answers come to one shard here."""

from __future__ import annotations

import hashlib
import pickle
import threading
import time
from collections.abc import Iterator, Sequence
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import TYPE_CHECKING, Any

from tvimdesign import __version__
from tvimdesign.base.environment import require_extra
from tvimdesign.base.errors import InputError, TvimError
from tvimdesign.sweep.chunks import CellQueue, ChunkAnswers
from tvimdesign.sweep.plan import Cell, CellAnswer, SweptStudy
from tvimdesign.sweep.pool import Heard, Usage
from tvimdesign.sweep.shards import ShardWriter

if TYPE_CHECKING:
    from distributed import Client, Future

Answers = list[tuple[str, CellAnswer, float]]
AT_ONCE = 3
"""Chunks for each thread of the cluster: one is worked at, the others wait beside it."""
LOOK = 0.05
"""Seconds between two looks at what is done."""
AGAIN = 1.0
"""Seconds between two tries to find a scheduler."""
CONNECT = 30.0
"""Seconds to wait for the scheduler at first."""
GONE = 300.0
"""Seconds to wait for a scheduler that was there and is not any more."""

_lock = threading.Lock()
_known: dict[str, ChunkAnswers] = {}
"""What this process of the cluster has compiled, by job: one job at a time is kept."""


def answer_chunk(job: bytes, cells: Sequence[Cell], version: str) -> dict[str, Any]:
    """Answer a chunk on a worker of the cluster. Threads take turns: CasADi's objects are not to be shared.

    Raises InputError where the worker has another version than who asks.
    """
    if version != __version__:
        raise InputError(f"it has tvimdesign {__version__}, the sweep is by {version}: install that on the workers")
    name = hashlib.sha256(job).hexdigest()
    with _lock:
        if name not in _known:
            _known.clear()
            _known[name] = ChunkAnswers(pickle.loads(job))
        began, spent = time.perf_counter(), time.process_time()
        answers = _known[name].answer(cells)
        return {
            "told": answers, "done": len(answers), "warm": sum(answer.warm for _, answer, _ in answers),
            "cells_s": sum(seconds for _, _, seconds in answers), "chunk_s": time.perf_counter() - began,
            "cpu_s": time.process_time() - spent,
        }  # fmt: skip


class Cluster:
    """A dask scheduler by its address, and what is asked of it."""

    def __init__(self, address: str, job: SweptStudy, folder: Path, gone: float = GONE) -> None:
        """Prepare to submit; wait `gone` seconds for a scheduler that ends. Raises InputError."""
        require_extra("cluster", f"--scheduler {address}")
        import distributed

        self._distributed, self._address, self._gone = distributed, address, gone
        self._job, self._folder = job, folder

    def answer(self, cells: Sequence[Cell], heard: Heard) -> Usage:
        """Answer every cell; `heard` is called after each chunk.

        Raises InputError where no scheduler answers, TvimError where one that did stays away; cells are kept.
        """
        left, spent = CellQueue(cells, self._job, 1), Usage()
        with ShardWriter(self._folder, self._job.columns) as shard:
            client = self._connected(CONNECT)
            while len(left):
                with self._closing(client):
                    self._work(client, left, spent, shard, heard)
                if len(left):
                    client = self._connected(self._gone)
        return spent

    def _connected(self, seconds: float) -> Client:
        """Return a client of the scheduler, which may come up only now."""
        end = time.monotonic() + seconds
        while True:
            try:
                return self._distributed.Client(self._address, timeout=min(seconds, CONNECT), set_as_default=False)
            except (OSError, ValueError) as error:
                if time.monotonic() < end and not isinstance(error, ValueError):
                    time.sleep(AGAIN)
                    continue
                after = "is gone; what is done is kept: --resume goes on" if seconds > CONNECT else "does not answer"
                kind = TvimError if seconds > CONNECT else InputError
                raise kind(
                    f"--scheduler {self._address}: the scheduler {after} (waited {seconds:g} s); `dask scheduler` "
                    "starts one and says its address"
                ) from error

    @contextmanager
    def _closing(self, client: Client) -> Iterator[None]:
        """Close a client at the end; one whose scheduler has too much to do to answer in time has no more to tell."""
        try:
            yield
        finally:
            with suppress(OSError, TimeoutError, self._distributed.CancelledError):
                client.close()

    def _work(self, client: Client, left: CellQueue, spent: Usage, shard: ShardWriter, heard: Heard) -> None:
        """Ask for chunks until all are answered, or the scheduler is gone: what it had is left again then."""
        submitted: dict[Any, list[Cell]] = {}
        try:
            self._ask_and_take(client, submitted, left, (spent, shard, heard))
        except (OSError, TimeoutError, self._distributed.CancelledError):
            pass  # the scheduler has gone while it was asked
        finally:
            for chunk in submitted.values():
                left.put_back(chunk)

    def _ask_and_take(
        self, client: Client, submitted: dict[Any, list[Cell]], left: CellQueue, into: tuple[Usage, ShardWriter, Heard]
    ) -> None:
        spent, shard, heard = into
        job, threads, looked = pickle.dumps(self._job), 1, 0.0
        while (len(left) or submitted) and client.status == "running":
            if time.monotonic() > looked + AGAIN:  # machines come and go
                threads, looked = max(sum(client.nthreads().values()), 1), time.monotonic()
            while len(left) and len(submitted) < AT_ONCE * threads:
                chunk = left.next(len(submitted) % threads)
                submitted[client.submit(answer_chunk, job, chunk, __version__, pure=False)] = chunk
            for future in self._ended(list(submitted)):
                self._take(future, submitted[future], left, (spent, shard))
                del submitted[future]  # only now: where taking it fails, its cells are left again
                heard(spent)

    @staticmethod
    def _ended(futures: list[Future]) -> list[Future]:
        """Return those that have ended, however; a moment is waited for the first."""
        time.sleep(LOOK)
        return [future for future in futures if future.status not in {"pending", "processing"}]

    def _take(self, future: Future, chunk: list[Cell], left: CellQueue, into: tuple[Usage, ShardWriter]) -> None:
        """Keep what a chunk came to; one that was lost with its worker or its scheduler is left again."""
        spent, shard = into
        if future.status == "finished":
            try:
                reply = future.result(timeout=CONNECT)
            except (OSError, TimeoutError, self._distributed.CancelledError):
                left.put_back(chunk)
                return
            shard.append(reply.pop("told"))
            spent.add(reply)
            left.done(reply["done"], reply["chunk_s"])
            return
        error = future.exception(timeout=CONNECT) if future.status == "error" else None
        if error is None or (isinstance(error, self._distributed.KilledWorker) and len(chunk) > 1):
            left.put_back(chunk)
        elif isinstance(error, self._distributed.KilledWorker):
            nothing = CellAnswer("crashed", "its workers died", None, None, (None,) * len(self._job.columns))
            shard.append([(chunk[0].key, nothing, 0.0)])
            spent.cells += 1
        else:
            raise TvimError(f"--scheduler {self._address}: a worker of the cluster failed: {error}")
