"""Checks a study without answering it: its text, limits that cannot hold together, records with doubtful values."""

from collections.abc import Sequence
from pathlib import Path

from tvimdesign.base.errors import SimulationError
from tvimdesign.base.units import format_quantity
from tvimdesign.report.output.terminal import progress_output
from tvimdesign.study import Study, read_tree
from tvimdesign.study.resolve import record_checks
from tvimdesign.study.tree import tree_of_file
from tvimdesign.sweep.plan import swept_cells

CHECKING = "checking whether the requirements conflict"


def check_study(path: Path, settings: Sequence[str] = (), *, as_json: bool) -> None:
    """Print what a study asks. Raises StudyError with every mistake, and what `refuse_what_cannot_be` raises."""
    from tvimdesign.solve.infeasibility.early_checks import refuse_what_cannot_be

    tree = tree_of_file(path, settings)
    study = read_tree(tree)
    with progress_output() as progress:
        progress(CHECKING)
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
