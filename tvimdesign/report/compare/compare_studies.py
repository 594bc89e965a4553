"""One comparison, from study files to a finished folder: the order of things, and what is written."""

from __future__ import annotations

import json
import time
from collections.abc import Sequence
from contextlib import ExitStack
from pathlib import Path
from typing import Any

from rich.markup import escape

from tvimdesign.base.errors import InfeasibleError, InputError, TvimError
from tvimdesign.report.command import PARTLY_DONE
from tvimdesign.report.compare.children import Asked, answers
from tvimdesign.report.compare.comparison import Outcome
from tvimdesign.report.compare.comparison_page import comparison_page
from tvimdesign.report.compare.comparison_plot_data import drawings
from tvimdesign.report.compare.comparison_summary import print_comparison, summary_text
from tvimdesign.report.compare.comparison_table import compare_csv
from tvimdesign.report.figures.plot_process import PlotProcess
from tvimdesign.report.output.page_sections import write_page
from tvimdesign.report.output.progress import progress_output, wide_console
from tvimdesign.report.output.results_folder import ResultsFolder
from tvimdesign.report.run.check_study import refuse_what_cannot_be
from tvimdesign.study import read_tree
from tvimdesign.study.conditions import Case, refuse_unequal
from tvimdesign.study.design import Design, design_json
from tvimdesign.study.text.mistakes import Mistake, StudyError
from tvimdesign.study.text.source import printable
from tvimdesign.study.tree import study_file, tree_of_file


def compare_studies(
    paths: Sequence[Path], out: Path, *, points: int, overwrite: bool, plots: bool, as_json: bool,
    settings: Sequence[str] = (),
) -> None:  # fmt: skip
    """Compare studies and write the folder. Raises InputError for what cannot be compared, TvimError for failures."""
    began = time.perf_counter()
    entrants = labelled(_read(paths, settings))
    with ExitStack() as stack:
        progress = stack.enter_context(progress_output())
        drawing: PlotProcess | None = None

        def begin_drawing() -> None:
            nonlocal drawing
            drawing = stack.enter_context(PlotProcess()) if plots else None

        folder = stack.enter_context(ResultsFolder(out, overwrite))
        asked = [Asked(label, entrant.path) for label, entrant in entrants.items()]
        found = answers(asked, folder.path, points, progress, begin_drawing, settings)
        outcome = Outcome(entrants, found)
        outcome.seconds["all answers"] = time.perf_counter() - began
        asked_for = drawings(outcome)
        if drawing:
            drawing.begin(folder.path, asked_for, " against ".join(one.study.name for one in entrants.values()))
        _write(folder, outcome, settings)
        progress("")
        outcome.seconds["whole"] = time.perf_counter() - began
        reported = outcome.plain()
        folder.write_json("compare.json", reported)
        if not as_json:
            print_comparison(outcome, wide_console())
        troubles = [f"{label}, {trouble['step']}: {trouble['error']}" for label, trouble in outcome.troubles]
        if drawing and asked_for:
            progress("drawing the plots")
            try:
                drawing.finish()
            except TvimError as error:
                troubles.append(str(error))
        progress("")
        write_page(folder, comparison_page(folder, outcome, tuple(settings)))
        studies = {label: entrant.study.model_dump(mode="json") for label, entrant in entrants.items()}
        inputs = {label: entrant.path for label, entrant in entrants.items()}
        folder.finish(PARTLY_DONE if troubles else "compared", inputs, studies, outcome.seconds)
    _say(reported, folder.out, troubles, as_json=as_json)
    if troubles:
        raise _trouble(outcome, troubles)


def _say(reported: dict[str, Any], out: Path, troubles: Sequence[str], *, as_json: bool) -> None:
    if as_json:
        print(json.dumps({**reported, "folder": str(out), "not_done": list(troubles)}, indent=2, allow_nan=False))
    else:
        wide_console().print(f"\nResults are in [bold]{escape(str(out))}[/bold]", soft_wrap=True)


def labelled(entrants: Sequence[Case]) -> dict[str, Case]:
    """Studies by what they are called: their modes where these differ, else their files' names, else their paths."""
    for names in (
        [entrant.study.mode for entrant in entrants],
        [entrant.path.stem for entrant in entrants],
        [printable(entrant.path) for entrant in entrants],
    ):
        if len(set(names)) == len(names):
            break
    return dict(zip(names, entrants, strict=True))


def _read(paths: Sequence[Path], settings: Sequence[str]) -> list[Case]:
    """All studies, read and found comparable. Raises StudyError with everything that is wrong with any of them."""
    if len(paths) < 2:
        raise InputError("compare takes two studies or more; `tvimdesign run` answers one")
    problems: list[Mistake] = []
    found = []
    for path in paths:
        try:
            study = read_tree(tree_of_file(path, settings))
            refuse_what_cannot_be(study, proof=False)  # each search looks for itself
        except StudyError as error:
            problems += error.problems
        except InputError as error:
            shown = printable(path)
            problems.append(Mistake(shown, 0, 0, "", str(error).removeprefix(f"{shown}: ").removeprefix(f"{shown} ")))
        else:
            found.append(Case(path, study))
    if problems:
        raise StudyError(problems)
    refuse_unequal(found)
    return found


def _write(folder: ResultsFolder, outcome: Outcome, settings: Sequence[str]) -> None:
    folder.write("compare.csv", compare_csv(outcome.rows, outcome.alone))
    folder.write("summary.txt", summary_text(outcome))
    if outcome.fronts:
        folder.write("fronts.csv", outcome.fronts_csv())
        folder.write_json("fronts.json", outcome.fronts_plain())
    for label, found in outcome.found.items():
        name = Path(label).stem
        for which in ("drawn", "optimised"):
            if which in found:
                design = Design.model_validate(found[which]["design"])
                folder.write(f"{name}/{which}.json", design_json(design))
        folder.write(f"{name}/study.yaml", study_file(tree_of_file(outcome.entrants[label].path, settings)))


def _trouble(outcome: Outcome, troubles: Sequence[str]) -> TvimError:
    """What is told last: infeasible where that is all that went wrong, done in part otherwise."""
    codes = {trouble["exit_code"] for _, trouble in outcome.troubles}
    text = "\n".join(troubles) + "\nWhat the other studies came to is kept."
    if codes == {InfeasibleError.exit_code} and len(troubles) == len(outcome.troubles):
        return InfeasibleError(text)
    error = TvimError(f"done in part: {text}")
    error.exit_code = 4
    return error
