"""Checks a study without answering it: its text, limits that cannot hold together, records with doubtful values.

`check --deep`: the problem of a study looked at before it is trusted, in words and as plain data.
"""

from __future__ import annotations

import json
import math
from collections.abc import Sequence
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Any

from tvimdesign.base.errors import SimulationError
from tvimdesign.base.units import format_quantity
from tvimdesign.report.output.numbers import all_finite, number
from tvimdesign.report.output.terminal import progress_output, wide_console
from tvimdesign.report.run.reasons import endings
from tvimdesign.study import Study, read_tree
from tvimdesign.study.resolve import record_checks
from tvimdesign.study.tree import tree_of_file
from tvimdesign.sweep.plan import swept_cells

if TYPE_CHECKING:
    from tvimdesign.solve.infeasibility.inspection import Conditioning, DerivativeCheck, Diagnostics, Structure


def check_study(path: Path, settings: Sequence[str] = (), *, as_json: bool) -> None:
    """Print what a study asks. Raises StudyError with every mistake, and what `refuse_what_cannot_be` raises."""
    from tvimdesign.solve.infeasibility.early_checks import refuse_what_cannot_be

    tree = tree_of_file(path, settings)
    study = read_tree(tree)
    refuse_what_cannot_be(study)
    cells = swept_cells(tree)
    print(study.model_dump_json(indent=2) if as_json else describe(study))
    if cells and not as_json:
        print(f"Its sweep has {cells} cells.")


def describe(study: Study) -> str:
    """Return one line on what a valid study asks, then one for each of its records that contradicts itself."""
    what = f"optimises {len(study.vary)} variables" if study.task == "optimize" else "evaluates one module"
    summary = f"{study.name}: valid; {what}, {len(study.require)} requirements ({study.mode} mode)."
    return "\n".join([summary, *record_checks(study), *foreseen_ratings(study)])


def foreseen_ratings(study: Study) -> list[str]:
    """Return ratings that the module the study starts from is beyond and the study neither accepts nor excludes."""
    from tvimdesign.solve.optimizer.verify_optimum import exceeded_at_start

    try:
        exceeded = exceeded_at_start(study)
    except SimulationError:
        return []
    module, then = ("The module", "") if not study.vary else ("The module it starts from", " An optimum may be, too.")
    return [
        f"{module} is beyond a rating: {name} is {format_quantity(value, study.table.unit(name))}.{then} Accept it, "
        f'`accept: [{name}]`, or exclude it, `require: {{{name}: ">= 0 {study.table.unit(name)}"}}`.'
        for name, value in exceeded.items()
    ]


def check_deep(study: Study, *, as_json: bool) -> None:
    """Check a study, build its problem and look at that. Raises InputError, InfeasibleError."""
    from tvimdesign.solve.infeasibility.early_checks import refuse_what_cannot_be
    from tvimdesign.solve.infeasibility.inspection import inspect_study

    refuse_what_cannot_be(study)
    with progress_output() as progress:
        diagnostics = inspect_study(study, progress)
        progress("")
    if as_json:
        print(json.dumps(plain(diagnostics), indent=2, allow_nan=False))
        return
    console = wide_console()
    console.print(describe(study), markup=False, soft_wrap=True)
    for line in in_words(diagnostics):
        console.print(line, markup=False, soft_wrap=True)


def in_words(diagnostics: Diagnostics) -> list[str]:
    """Return the check for people, every finding with what to do about it."""
    lines = [*_scaling(diagnostics), *_conditioning(diagnostics.conditioning), *_derivatives(diagnostics.derivatives)]
    lines += _structure(diagnostics.structure)
    converged = f"converged in {diagnostics.start.iterations} iterations, objective {diagnostics.start.objective:.5g}"
    lines.append(
        f"One solve from the start {converged}." if diagnostics.start.converged else endings([diagnostics.start])[0]
    )
    return [*lines, "Nothing speaks against the problem." if diagnostics.sound else "Look at what is marked with !."]


def _mark(good: bool) -> str:
    return " " if good else "!"


def _scaling(diagnostics: Diagnostics) -> list[str]:
    lines = []
    for what, spread in (("rows", diagnostics.rows), ("unknowns", diagnostics.columns)):
        (most, greatest), (least, smallest) = spread.largest, spread.smallest
        lines.append(
            f"{_mark(spread.good)} scaling of {what}: greatest derivative {number(greatest, 2)} "
            f"({most}), least {number(smallest, 2)} ({least}); {spread.ratio:.1e} apart."
        )
    return lines


def _conditioning(conditioning: Conditioning) -> list[str]:
    lines = [
        f"{_mark(conditioning.good)} conditioning: equations of heat and time {conditioning.equations:.1e}; "
        f"limits and goal by the variables {_number(conditioning.decisions)}."
    ]
    lines += [
        f"  {' and '.join(names)} can be traded for each other at the start, and no limit or goal notices; "
        "fix one of them, or minimise something that tells them apart."
        for names in conditioning.objectives
        if names
    ]
    return lines


def _number(value: float) -> str:
    return f"{value:.1e}" if math.isfinite(value) else "not determined"


def _derivatives(derivative_check: DerivativeCheck) -> list[str]:
    row, by, error = derivative_check.worst[0]
    lines = [
        f"{_mark(derivative_check.right)} derivatives: exact and differenced agree to {error:.0e} ({row} by {by})."
    ]
    if not derivative_check.right:
        lines += [f"    {row} by {by}: off by {error:.1e}" for row, by, error in derivative_check.worst]
        lines.append("    A row may have a kink at the start; move the start a little, and look again.")
    return lines


def _structure(structure: Structure) -> list[str]:
    lines = []
    if structure.idle:
        lines.append(f"! no limit and no goal depends on {', '.join(structure.idle)}; take it out of `vary`.")
    if structure.goal_flat:
        lines.append(
            "! nothing under `vary` moves the goal: every design within the limits is as good as any other. Vary what "
            "the goal depends on, or minimise something else."
        )
    if structure.unchangeable:
        lines.append(f"  nothing under `vary` can change {'; '.join(structure.unchangeable)}; it holds.")
    return lines


def plain(diagnostics: Diagnostics) -> dict[str, Any]:
    """Return the check as plain data; null for what is infinite."""
    reported = asdict(diagnostics) | {"sound": diagnostics.sound}
    reported["start"].pop("seconds")
    plain_data: dict[str, Any] = all_finite(reported)
    return plain_data
