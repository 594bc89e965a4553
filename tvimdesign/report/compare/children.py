"""Answers the studies of a comparison in child processes, two at once: where one crashes, the others are kept."""

from __future__ import annotations

import json
import queue
import subprocess
import tempfile
import time
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any, NamedTuple

from tvimdesign.base.child_process import read_lines, start_child
from tvimdesign.base.errors import TvimError
from tvimdesign.report.output.progress import Progress

AT_ONCE = 2
"""Children at a time: each has one thread, and the machines this is for have two cores or more."""
HALF_DONE = ".studies."
"""Folder beside the results in which children answer: a pattern. One is left where a comparison was killed."""
_CRASHED = TvimError.exit_code + 2


class Asked(NamedTuple):
    """One study to answer, and what it is called meanwhile."""

    label: str
    path: Path


class _Child(NamedTuple):
    label: str
    process: subprocess.Popen[str]
    out: Path
    errors: Path
    began: float


def answers(
    asked: Sequence[Asked],
    out: Path,
    points: int,
    progress: Progress,
    when_idle: Callable[[], object] = lambda: None,
    settings: Sequence[str] = (),
) -> dict[str, dict[str, Any]]:
    """What each study's job found, by label; a job that died has its reason under `troubles`.

    They answer in a folder within `out`, which is gone then.
    `when_idle` is called as soon as there is nothing more to start: from then on a core is free. Every study is read
    with the `settings`, each `name=value`.
    """
    waiting, running = list(asked), list[_Child]()
    found: dict[str, dict[str, Any]] = {}
    said: queue.Queue[tuple[str, str | None]] = queue.Queue()
    with tempfile.TemporaryDirectory(dir=out, prefix=HALF_DONE) as folder:
        try:
            while waiting or running:
                while waiting and len(running) < AT_ONCE:
                    number = len(asked) - len(waiting)
                    one = waiting.pop(0)
                    others = [other.path for other in asked if other is not one]
                    running.append(_start(one, others, (points, settings), Path(folder) / str(number), said))
                label, line = said.get()
                if line is not None:
                    progress(f"{label}: {json.loads(line)['progress']}")
                    continue
                child = next(child for child in running if child.label == label)
                running.remove(child)
                found[label] = _finish(child)
                if not waiting and len(running) == AT_ONCE - 1:
                    when_idle()
        finally:
            for child in running:
                child.process.kill()
                child.process.wait()
    return {one.label: found[one.label] for one in asked}


def crashed(error: str) -> dict[str, Any]:
    """What is told of a study whose process has died."""
    troubles = [{"step": "all", "error": error, "exit_code": _CRASHED}]
    return {"fronts": [], "seconds": {}, "release": {}, "heat": {}, "troubles": troubles}


def _start(
    one: Asked,
    others: Sequence[Path],
    how: tuple[int, Sequence[str]],
    stem: Path,
    said: queue.Queue[tuple[str, str | None]],
) -> _Child:
    """Start a child process; `how` is the count of points of a front, and the settings."""
    out, errors = stem.with_suffix(".json"), stem.with_suffix(".txt")
    paths = [str(path.resolve()) for path in (one.path, out, *others)]
    with errors.open("wb") as stream:
        process = start_child(
            "tvimdesign.report.compare.comparison_job", [*paths[:2], str(how[0]), json.dumps(list(how[1])), *paths[2:]],
            stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=stream, text=True, encoding="utf-8",
        )  # fmt: skip
    read_lines(process, lambda line: said.put((one.label, line)))
    return _Child(one.label, process, out, errors, time.perf_counter())


def _finish(child: _Child) -> dict[str, Any]:
    code = child.process.wait()
    if child.out.exists():
        found: dict[str, Any] = json.loads(child.out.read_text())
    else:
        last = " ".join(child.errors.read_text(errors="replace").strip().splitlines()[-1:])
        error = f"its process ended with code {code}: {last or 'nothing was said'}"
        found = crashed(error)
    found["seconds"]["whole process"] = time.perf_counter() - child.began
    return found
