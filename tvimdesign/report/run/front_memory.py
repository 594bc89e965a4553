"""Keeps the points of a front in the results folder while it is sought, so that a run that was killed goes on there."""

from __future__ import annotations

import json
from dataclasses import asdict
from pathlib import Path
from typing import Any

import numpy as np

from tvimdesign import __version__
from tvimdesign.base.errors import InputError
from tvimdesign.report.output.results_folder import PROGRESS, ResultsFolder
from tvimdesign.solve.nlp.problem_parts import Objective
from tvimdesign.solve.nlp.solver_run import Trace
from tvimdesign.solve.pareto.tradeoff import Failure, Point
from tvimdesign.study import SolverOptions, Study


class FolderMemory:
    """The answers of a trade-off as files, one for each design that was sought, in their order."""

    def __init__(self, folder: ResultsFolder, study: Study) -> None:
        """Use what the folder holds; raises InputError where that is of another study or another version."""
        self._folder = folder
        solver = study.solver.model_copy(update={"time_limit": SolverOptions().time_limit})  # it changes no design
        asked_for = study.model_copy(update={"solver": solver})
        request = {"tvimdesign": __version__, "study": asked_for.model_dump(mode="json")}
        known = _read(folder.path / PROGRESS / "asked.json")
        if known is not None and known != request:
            raise InputError(f"{folder.out}: holds the front of another study or version; --overwrite to begin anew")
        folder.write_json(f"{PROGRESS}/asked.json", request)

    def recall(self, number: int, objective: Objective) -> Point | Failure | None:
        """Return the answer to a question; None where it is not there, or was of another objective."""
        known = _read(self._folder.path / PROGRESS / f"{number:04d}.json")
        if known is None or known["goal"] != _plain_objective(objective):
            return None
        if "reason" in known:
            return Failure(known["where"], known["reason"])
        trace = Trace(*(np.array(known["trace"][name]) for name in Trace._fields))
        entries = {name: known[name] for name in ("where", "values", "current_profiles", "cost", "root")}
        return Point(**entries, trace=trace, objective=objective)

    def keep(self, number: int, objective: Objective, outcome: Point | Failure) -> None:
        """Write an answer, every digit of it."""
        reported: dict[str, Any] = {"goal": _plain_objective(objective), "where": outcome.where}
        if isinstance(outcome, Failure):
            reported["reason"] = outcome.reason
        else:
            assert outcome.trace is not None  # whatever was sought has one
            reported |= {name: getattr(outcome, name) for name in ("values", "current_profiles", "cost", "root")}
            reported["trace"] = {name: getattr(outcome.trace, name).tolist() for name in Trace._fields}
        self._folder.write(f"{PROGRESS}/{number:04d}.json", json.dumps(reported))


def _plain_objective(objective: Objective) -> dict[str, Any]:
    return {"weights": dict(objective.weights), "bounds": [asdict(bound) for bound in objective.bounds]}


def _read(path: Path) -> dict[str, Any] | None:
    try:
        content: dict[str, Any] = json.loads(path.read_bytes())
    except (FileNotFoundError, ValueError):
        return None
    return content
