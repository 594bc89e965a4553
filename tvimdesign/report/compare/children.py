"""Child processes that answer the studies of a comparison, two at once; if one crashes, the others continue."""

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
from tvimdesign.report.compare.compared_design import nothing_found
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
    requests: Sequence[Asked],
    out: Path,
    points: int,
    progress: Progress,
    when_idle: Callable[[], object] = lambda: None,
    settings: Sequence[str] = (),
    keep: Callable[[str, dict[str, Any]], object] = lambda _label, _found: None,
) -> dict[str, dict[str, Any]]:
    """Return what each study's job found, by label; a job that died has its reason under `troubles`.

    Parameters
    ----------
    out
        Folder in which the jobs write into a folder of their own, which is removed at the end.
    when_idle
        Called as soon as nothing more is to be started: from then on a core is free.
    settings
        Changes to every study, each `name=value`.
    keep
        Called with a label and what is found so far, after each step of a job.
    """
    waiting, running = list(requests), list[_Child]()
    answers_by_label: dict[str, dict[str, Any]] = {}
    lines: queue.Queue[tuple[str, str | None]] = queue.Queue()
    with tempfile.TemporaryDirectory(dir=out, prefix=HALF_DONE) as folder:
        try:
            while waiting or running:
                while waiting and len(running) < AT_ONCE:
                    number = len(requests) - len(waiting)
                    study = waiting.pop(0)
                    others = [other.path for other in requests if other is not study]
                    running.append(_start(study, others, (points, settings), Path(folder) / str(number), lines))
                label, line = lines.get()
                child = next(child for child in running if child.label == label)
                if line is not None:
                    message = json.loads(line)
                    if "progress" in message:
                        progress(f"{label}: {message['progress']}")
                    else:
                        keep(label, json.loads(child.out.read_text()))
                    continue
                running.remove(child)
                answers_by_label[label] = _finish(child)
                if not waiting and len(running) == AT_ONCE - 1:
                    when_idle()
        finally:
            for child in running:
                child.process.kill()
                child.process.wait()
    return {study.label: answers_by_label[study.label] for study in requests}


def _start(
    study: Asked, others: Sequence[Path], how: tuple[int, Sequence[str]], stem: Path,
    lines: queue.Queue[tuple[str, str | None]],
) -> _Child:  # fmt: skip
    """Start a child process; `how` is the count of points of a front, and the settings."""
    out, errors = stem.with_suffix(".json"), stem.with_suffix(".txt")
    paths = [str(path.resolve()) for path in (study.path, out, *others)]
    with errors.open("wb") as stream:
        process = start_child(
            "tvimdesign.report.compare.comparison_job", [*paths[:2], str(how[0]), json.dumps(list(how[1])), *paths[2:]],
            stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=stream, text=True, encoding="utf-8",
        )  # fmt: skip
    read_lines(process, lambda line: lines.put((study.label, line)))
    return _Child(study.label, process, out, errors, time.perf_counter())


def _finish(child: _Child) -> dict[str, Any]:
    code = child.process.wait()
    answer: dict[str, Any] = json.loads(child.out.read_text()) if child.out.exists() else nothing_found()
    if code:
        last = " ".join(child.errors.read_text(errors="replace").strip().splitlines()[-1:])
        error = f"its process ended with code {code}: {last or 'without a message'}"
        answer["troubles"].append({"step": "all", "error": error, "exit_code": _CRASHED})
    answer["seconds"]["whole process"] = time.perf_counter() - child.began
    return answer
