"""A study as Python users hold it: read from a file or written in Python, changed by copies, answered by a call."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

from tvimdesign.api import notebook
from tvimdesign.api.notebook import shown_progress
from tvimdesign.base.atomic_files import atomic_write
from tvimdesign.base.errors import InputError
from tvimdesign.base.units import format_quantity
from tvimdesign.study import (
    Range,
    StudyTree,
    node_of,
    read_tree,
    tree_of_file,
    tree_of_text,
    tree_of_values,
    tree_yaml,
    with_value,
)
from tvimdesign.study import Study as ResolvedStudy
from tvimdesign.study.sections import NAMES
from tvimdesign.study.text.mistakes import Mistakes
from tvimdesign.study.written_studies import example_text

if TYPE_CHECKING:
    from tvimdesign.api.result import Result
    from tvimdesign.api.sweep import Sweep

Values = Mapping[str, Any]


def load(path: str | os.PathLike[str]) -> Study:
    """Read a study file. Raises StudyError with every mistake in it, and InputError where there is no such file."""
    study = Study._of(tree_of_file(path))
    _ = study.resolved
    return study


def example(name: str) -> Study:
    """Read a shipped study by name, such as "elbow_printed"; `tvimdesign new --list` lists them. Raises InputError."""
    return Study._of(tree_of_text(example_text(name), f"{name}.yaml", name, Path()))


def size(
    *, torque: str, stiffness: str, diameter: str, time: str, supply: str, stroke: str = "",
    stiff_time: str = "", process: str = "", name: str = "joint", progress: bool = True,
) -> Result[Study]:  # fmt: skip
    """Size a joint from five numbers, as `tvimdesign size` does.

    Parameters
    ----------
    torque : str
        Torque that the frozen joint holds, such as ``"8 N.m"``.
    stiffness : str
        Stiffness of the soft joint, without its damping: ``"1.5 N.m/rad"`` means 20 % to either side,
        ``"1 to 2 N.m/rad"`` a range.
    diameter : str
        Largest outer diameter, 20 to 200 mm.
    time : str
        Time within which the joint gets soft.
    supply : str
        Voltage, and the current if it has a limit, such as ``"24 V"`` or ``"24 V, 3 A"``.
    stroke : str, optional
        Angle that the soft joint turns to either side; 0.104 rad unless given.
    stiff_time : str, optional
        Time within which the joint gets stiff again.
    process : str, optional
        Process that makes the parts, such as ``"machine_6061"``.
    name : str
        Name of the study.
    progress : bool
        Show what is being done.

    Returns
    -------
    Result
        The optimum; its `study` can be changed and run again.

    Raises
    ------
    InputError
        For a quantity that is none.
    InfeasibleError
        For limits that conflict before the search.
    NoDesignError
        If the search finds no design.
    """
    from tvimdesign.api.result import Result
    from tvimdesign.report.run.study_files import choose_sized
    from tvimdesign.study.sizing import JointTask

    task = JointTask.read(torque, stiffness, diameter, time, supply, stroke, stiff_time, process)
    with shown_progress(progress) as say:
        tree, answered = choose_sized(task, name, say)
    study = Study._of(tree)
    return Result.of(answered, study) if answered else study.run(progress=progress)


class Study:
    """Study: a module, its variables, its requirements and its objective.

    Every argument is a section of the study file and takes what the file takes: text with its unit ("1.2 mm"), pairs of
    them for ranges, `{"choose": [...]}`, limits (">= 15 N.m"). A number with its unit may also be `(1.2, "mm")` or a
    quantity of pint. A study does not change: `set`, `vary`, `require`, `accept` and `minimize`
    return a changed copy, which is read, and refused where it is wrong, when it is first used.
    """

    _tree: StudyTree

    def __init__(
        self,
        *,
        mode: str,
        name: str | None = None,
        description: str | None = None,
        module: Values | None = None,
        vary: Values | None = None,
        require: Values | None = None,
        accept: str | Sequence[str] | None = None,
        minimize: str | Values | None = None,
        front: Values | None = None,
        operating_points: Values | None = None,
        profile: Values | None = None,
        currents: Values | None = None,
        tolerances: Any = None,
        robust: Any = None,
        solver: Values | None = None,
        sweep: Values | None = None,
        write: Values | None = None,
        catalog: str | os.PathLike[str] | None = None,
        folder: str | os.PathLike[str] = ".",
    ) -> None:
        """Read the study; `catalog` is a folder of the user's records in `folder`. Raises StudyError."""
        sections = locals()
        given = {name: sections[name] for name in NAMES if sections.get(name) is not None}
        self._tree = tree_of_values(given, "Study(...)", Path(folder))
        _ = self.resolved

    @classmethod
    def _of(cls, tree: StudyTree) -> Study:
        study = cls.__new__(cls)
        study._tree = tree
        return study

    @cached_property
    def resolved(self) -> ResolvedStudy:
        """The study as it was read, every number in SI. Raises StudyError with every mistake."""
        return read_tree(self._tree)

    @property
    def name(self) -> str:
        """Return the study's name."""
        return self.resolved.name

    @property
    def mode(self) -> str:
        """`shear` or `compression`."""
        return self.resolved.mode

    @property
    def text(self) -> str:
        """The study as YAML, as a study file has it; comments of the file it came from are not in it."""
        return tree_yaml(self._tree)

    def save(self, path: str | os.PathLike[str]) -> Path:
        """Write the study as a file; returns its path."""
        atomic_write(Path(path), self.text.encode())
        return Path(path)

    def set(self, values: Values | None = None, /, **more: Any) -> Study:
        """Return a copy with inputs and choices of the module fixed, which are varied no longer; None takes one away.

        A path such as "operating_points.hot.temperature" or "solver.starts" sets what stands there.
        """
        return self._changed("set", "", {**(values or {}), **more})

    def vary(self, values: Values | None = None, /, **more: Any) -> Study:
        """Return a copy in which these may change too, or in other ranges; None fixes one at its value."""
        return self._changed("vary", "vary.", {**(values or {}), **more})

    def require(self, values: Values | None = None, /, **more: Any) -> Study:
        """Return a copy with these limits in place of earlier ones on the same outputs; None takes them away."""
        return self._changed("require", "require.", {**(values or {}), **more})

    def accept(self, *ratings: str) -> Study:
        """Return a copy whose design may be beyond these ratings, by the quantity's name, and beyond no others."""
        return self._changed("accept", "", {"accept": list(ratings) or None})

    def minimize(self, output: str | Values | None = None, /, **weights: float) -> Study:
        """Return a copy that minimises this output, or these with their weights, and no others."""
        goal = output if isinstance(output, str) else {**(output or {}), **weights}
        return self._changed("minimize", "", {"minimize": goal})

    def _changed(self, call: str, section: str, values: Values) -> Study:
        tree = self._tree
        for name, value in values.items():
            source = f"study.{call}({name}={value!r})"
            problems = Mistakes(source)
            node = node_of(value, source, problems, name)
            tree = with_value(tree, f"{section}{name}", node, source, tuple(problems.items))
        return Study._of(tree)

    def check(self) -> list[str]:
        """Refuse a study that cannot be answered; return what is doubtful about its records, and ratings it exceeds.

        Raises StudyError for every mistake, InputError for a module that cannot be, InfeasibleError for limits that
        bounds prove impossible.
        """
        from tvimdesign.report.run.run_study import foreseen_ratings
        from tvimdesign.solve.infeasibility.early_checks import refuse_what_cannot_be
        from tvimdesign.study import record_checks

        study = refuse_what_cannot_be(self.resolved)
        return [*record_checks(study), *foreseen_ratings(study)]

    def run(self, *, prove: bool = False, progress: bool = True) -> Result[Study]:
        """Evaluate or optimise the study, as `tvimdesign run` does, without writing a file.

        Raises NoDesignError, which has the closest design, where no design is feasible.
        """
        from tvimdesign.api.result import Result
        from tvimdesign.report.run.answered_study import answer_study

        with shown_progress(progress) as say:
            return Result.of(answer_study(self._tree, say, prove=prove), self)

    def evaluate(self, *, progress: bool = True) -> Result[Study]:
        """Evaluate the module as it is drawn: what may change stands at its start, and nothing is optimised."""
        from tvimdesign.api.result import Result
        from tvimdesign.report.run.answered_study import answer_study

        with shown_progress(progress) as say:
            return Result.of(answer_study(self._tree, say, drawn_only=True), self)

    def sweep(
        self,
        axes: Values | None = None,
        /,
        *,
        method: str | None = None,
        count: int | None = None,
        seed: int | None = None,
        task: str | None = None,
        cells: Sequence[Values] | None = None,
        outputs: Sequence[str] | str | None = None,
        out: str | os.PathLike[str] | None = None,
        workers: int = 0,
        overwrite: bool = False,
        progress: bool = True,
        **more: Any,
    ) -> Sweep[Study]:
        """Answer the study at every cell of a grid or a sample; each value is set as `set` does.

        An axis is a list or an array of values, `(array, "mm")`, or a range `{"from": "0.6 mm", "to": "2 mm",
        "count": 20}`. Without axes the study's own `sweep` section gives them. `method` is `grid`, `latin_hypercube` or
        `sobol`, these with a `count` of cells and a `seed`; `cells` names each cell instead. `task="evaluate"`
        optimises nothing. What else may change is optimised in each cell, from the study's own optimum where that can
        be done. A cell without a design is a row with its reason.

        Cells are answered in this process and nothing is written, unless `out` names a folder: then `workers` processes
        (as many as processors unless given) keep them there, and cells that are there are not computed again. A folder
        has the `outputs` the study asks about, and those named; here all are kept. Raises StudyError for a value that
        cannot be set.
        """
        from tvimdesign.api.sweep import swept
        from tvimdesign.sweep.run_sweep import Executor

        if out is None and (workers or overwrite):
            raise InputError("sweep: workers keep their cells in a folder; name it with out=")
        section = {"over": {**(axes or {}), **more} or None, "method": method, "count": count, "seed": seed,
                   "task": task, "cells": cells, "outputs": outputs or ("all" if out is None else None)}  # fmt: skip
        given = {name: value for name, value in section.items() if value is not None}
        if "over" in given or cells is not None:
            tree = self._changed("sweep", "", {"sweep": given})._tree
        else:
            tree = self._changed("sweep", "sweep.", given)._tree if self._tree.section("sweep") else self._tree
        return swept(tree, Study._of, progress, out, Executor(workers), overwrite=overwrite)

    def __repr__(self) -> str:
        study = self.resolved
        return f"<Study {study.name!r}: {_task(study)}>"

    def _repr_html_(self) -> str:
        study = self.resolved
        module = getattr(self._tree.section("module"), "entries", {})
        rows = [(f"module.{name}", str(getattr(value, "value", "..."))) for name, (_, value) in module.items()]
        rows += [(f"vary.{name}", _range(name, study)) for name in study.vary]
        rows += [(f"require.{limit.output}", limit.text) for limit in study.require]
        rows += [("minimize", ", ".join(f"{name}: {weight:g}" for name, weight in study.minimize.items()) or "nothing")]
        return notebook.heading(study.name, _task(study)) + notebook.grid(("", "what the study says"), rows)


def _task(study: ResolvedStudy) -> str:
    what = f"optimises {len(study.vary)} variables" if study.task == "optimize" else "evaluates one module"
    return f"{study.mode} mode, {what}, {len(study.require)} requirements"


def _range(name: str, study: ResolvedStudy) -> str:
    vary = study.vary[name]
    values: Sequence[float | str] = (vary.lower, vary.upper) if isinstance(vary, Range) else vary.values
    shown = [value if isinstance(value, str) else format_quantity(value, study.table.unit(name)) for value in values]
    return " to ".join(map(str, shown)) if isinstance(vary, Range) else "one of " + ", ".join(map(str, shown))
