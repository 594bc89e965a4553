"""A study that has no design: refused before the search, with the reason left in the folder."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator
from contextlib import contextmanager

from tvimdesign.base.errors import InfeasibleError
from tvimdesign.report.output.number_format import FORMAT, UNITS
from tvimdesign.report.output.progress import Progress
from tvimdesign.report.output.results_folder import ResultsFolder
from tvimdesign.report.output.results_format import RefusedRun
from tvimdesign.study import Study
from tvimdesign.study.tree import StudyTree, study_file


def refuse_unfit(study: Study, progress: Callable[[str], None] = lambda _: None) -> None:
    """Raise InputError or InfeasibleError where the study can have no design: what `check` finds."""
    from tvimdesign.solve.infeasibility.arithmetic_conflict import refuse_infeasible
    from tvimdesign.solve.nlp.constraints import refuse_impossible

    refuse_impossible(study)
    progress("looking for limits that cannot hold together")
    refuse_infeasible(study)


@contextmanager
def write_failure(
    folder: ResultsFolder, tree: StudyTree, study: Study, progress: Progress, *, as_json: bool
) -> Iterator[None]:
    """Where a study is found to have no design, write why, and the study, before the error goes on."""
    try:
        yield
    except InfeasibleError as error:
        from tvimdesign.report.output.page_sections import write_page
        from tvimdesign.report.run.run_page import refused_page

        progress("")  # raises KeyboardInterrupt where a solver swallowed one, and its failure looks like a conflict
        refused: RefusedRun = {
            "format": FORMAT, "units": UNITS, "name": study.name, "mode": study.mode,
            "status": "infeasible", "feasible": False, "reason": str(error),
        }  # fmt: skip
        folder.write("study.yaml", study_file(tree))
        folder.write("study.resolved.json", study.model_dump_json(indent=2) + "\n")
        folder.write_json("results.json", refused)
        folder.write("summary.txt", f"{study.name}: no design.\n{error}\n")
        write_page(folder, refused_page(folder, tree, study, str(error)))
        folder.finish("infeasible", {"study": tree.path} if tree.path else {}, study.model_dump(mode="json"))
        if as_json:
            print(json.dumps({**refused, "folder": str(folder.out)}, indent=2))
        raise
