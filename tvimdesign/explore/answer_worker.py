"""The process that solves for a page: one job at a time, read as a line of JSON, answered as lines of JSON.

Run as `python -m tvimdesign.explore.answer_worker SOURCE FOLDER [SETTING...]`. An interrupt ends the job that is
under way, as a newer one stands in its place; the process goes on.
"""

import hashlib
import json
import signal
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

from tvimdesign.base.child_process import follow_parent, line_writer
from tvimdesign.base.errors import TvimError
from tvimdesign.base.interrupts import interrupt_handler, raise_pending
from tvimdesign.base.results_folder import ResultsFolder
from tvimdesign.device import table_for
from tvimdesign.explore.engine import Answer, Engine, refused
from tvimdesign.explore.source import open_source
from tvimdesign.explore.state import PARTS, State
from tvimdesign.report.output.numbers import all_finite
from tvimdesign.report.page.page_file import page_fragment
from tvimdesign.report.run.answered_study import AnsweredStudy
from tvimdesign.report.run.run_page import run_page
from tvimdesign.report.run.study_files import choose_sized
from tvimdesign.study import Design, design_json, tree_yaml
from tvimdesign.study.sizing import JointTask


def main() -> None:
    """Answer jobs until there are no more."""
    follow_parent()
    write = line_writer()
    signal.signal(signal.SIGINT, lambda *_: None)  # between jobs there is nothing to end
    source, folder, settings = Path(sys.argv[1]), Path(sys.argv[2]), sys.argv[3:]
    engine = Engine(open_source(source, settings).tree)
    write({"ready": True})
    for line in sys.stdin:
        job = json.loads(line)
        write({"number": job["number"], **_done(engine, job, folder, write)})


def _done(engine: Engine, job: dict[str, Any], folder: Path, write: Callable[[Any], None]) -> dict[str, Any]:
    """Answer a job; an interrupted one has no answer, whatever a library made of the interrupt."""

    def progress(text: str) -> None:
        raise_pending()
        write({"number": job["number"], "progress": text})

    try:
        with interrupt_handler((signal.SIGINT,)):
            try:
                if job["stage"] == "size":
                    return {"study": tree_yaml(choose_sized(JointTask.read(**job["numbers"]), "Joint", progress)[0])}
                reply = engine.answer(State.model_validate(job["state"]), job["stage"], progress)
                data = _reply_data(reply, folder)
            except TvimError as error:
                if job["stage"] == "size":
                    return {"refused": str(error)}
                data = {"shown": {**refused(error), "stage": job["stage"], "way": job["state"]["way"]}}
            raise_pending()
    except KeyboardInterrupt:
        return {"superseded": True}
    return data


def _reply_data(reply: Answer, folder: Path) -> dict[str, Any]:
    data: dict[str, Any] = {"shown": reply.shown, "module": reply.module}
    if reply.answered is not None:
        design = reply.answered.result.design
        data["report"] = report_fragment(folder, reply.answered)
        data["design"] = {"name": design_name(design), "json": design_json(design).decode()}
    return data


class DesignFolder(ResultsFolder):
    """The folder of one design that an explorer made parts of, if it did; nothing is claimed in it."""

    def __init__(self, path: Path) -> None:
        self.path = path


def design_name(design: Design) -> str:
    """Return the name of a design's folder, which depends on choices and numbers alone."""
    inputs = {row.name for row in table_for(design.mode).inputs}
    numbers = {
        name: f"{value:.9g}" for name, value in sorted(design.values.items()) if name.partition("@")[0] in inputs
    }
    content = json.dumps([design.mode, design.choices, numbers], sort_keys=True)
    return hashlib.sha256(content.encode()).hexdigest()[:16]


def report_fragment(folder: Path, answered: AnsweredStudy) -> dict[str, Any]:
    """Return first screen and sections as HTML, with the data of their figures."""
    own = folder / PARTS / design_name(answered.result.design)
    page = run_page(DesignFolder(own), answered)
    left_out = {"study", "versions", *(() if (own / "cad").is_dir() else ("assembly",))}
    return {"folder": f"{PARTS}/{own.name}", **all_finite(page_fragment(page, left_out))}


if __name__ == "__main__":
    main()
