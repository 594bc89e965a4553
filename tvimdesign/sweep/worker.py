"""The child process that answers cells and keeps them in a shard of its own.

It reads on standard input a line with the job, then a line of JSON with cells, again and again, and answers each such
line with one: how many cells are done and what they took, or the error that ends it.
"""

from __future__ import annotations

import base64
import json
import os
import pickle
import signal
import sys
import time
from pathlib import Path
from typing import Any

from tvimdesign.base.child_process import follow_parent
from tvimdesign.base.environment import NAMES
from tvimdesign.base.errors import TvimError


def packed(job: Any, folder: Path) -> str:
    """Return the line that a worker begins with."""
    return base64.b64encode(pickle.dumps((job, str(folder)))).decode()


def main() -> int:
    """Answer cells until there are no more."""
    follow_parent()
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # an interrupt is the parent's to handle
    os.environ.update(dict.fromkeys(NAMES, "1"))  # there is a process for each core
    from tvimdesign.sweep.chunks import ChunkAnswers
    from tvimdesign.sweep.shards import ShardWriter

    job, folder = pickle.loads(base64.b64decode(sys.stdin.readline()))
    answers = ChunkAnswers(job)
    with ShardWriter(Path(folder), job.columns) as shard:
        for line in sys.stdin:
            began, spent = time.perf_counter(), time.process_time()
            try:
                reply = answers.answer(json.loads(line))
                shard.append(reply)
            except TvimError as error:
                _say({"error": str(error)})
                return error.exit_code
            cells = sum(seconds for _, _, seconds in reply)
            _say({
                "done": len(reply), "cells_s": cells, "chunk_s": time.perf_counter() - began,
                "cpu_s": time.process_time() - spent, "warm": sum(answer.warm for _, answer, _ in reply),
            })  # fmt: skip
    return 0


def _say(what: dict[str, Any]) -> None:
    sys.stdout.write(json.dumps(what) + "\n")
    sys.stdout.flush()


if __name__ == "__main__":
    sys.exit(main())
