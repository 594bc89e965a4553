"""The command `compare`, from studies or finished runs to a folder: optima first, and each result written at once."""

from __future__ import annotations

import json
import time
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from tvimdesign.base.errors import InfeasibleError, InputError, TvimError
from tvimdesign.report.command import Command, design_file, done_in_part
from tvimdesign.report.compare.children import Asked, answers
from tvimdesign.report.compare.compared_design import finished_run, nothing_found
from tvimdesign.report.compare.comparison import COMPARISONS, Outcome
from tvimdesign.report.compare.comparison_page import comparison_page, drawings
from tvimdesign.report.compare.comparison_summary import print_comparison, summary_text
from tvimdesign.report.compare.comparison_table import compare_csv
from tvimdesign.report.output.results_folder import ResultsFolder
from tvimdesign.study import Study, read_tree
from tvimdesign.study.conditions import Case, refuse_unequal
from tvimdesign.study.design import Design, design_json, read_design
from tvimdesign.study.text.mistakes import Mistake, StudyError
from tvimdesign.study.text.source import printable
from tvimdesign.study.tree import study_file, tree_of_file


def compare_studies(
    paths: Sequence[Path], out: Path, *, points: int, overwrite: bool, plots: bool, as_json: bool,
    settings: Sequence[str] = (),
) -> None:  # fmt: skip
    """Compare studies, or the results of finished runs, and write the folder.

    Raises InputError for what cannot be compared, TvimError for what could not be done.
    """
    began = time.perf_counter()
    if len(paths) < 2:
        raise InputError("compare takes two studies or more, or two results; `tvimdesign run` answers one study")
    finished = [is_result(path) for path in paths]
    if any(finished) and (points or settings or not all(finished)):
        raise InputError("compare takes results of finished runs alone, without studies, --points and --set")
    cases = labelled(_results(paths) if all(finished) else _studies(paths, settings), paths)
    texts = {label: _study_text(case, settings) for label, case in cases.items()}
    with Command(out, overwrite=overwrite, as_json=as_json) as command:
        answers_by_label = {label: nothing_found() for label in cases}

        def keep(label: str, answer: dict[str, Any]) -> None:
            answers_by_label[label] = answer
            _write(command.folder, Outcome(cases, answers_by_label), texts)

        if all(finished):
            for (label, case), path in zip(cases.items(), paths, strict=True):
                answers_by_label[label] = finished_run(design_file(path), case.study.table)
        else:
            requests = [Asked(label, case.path) for label, case in cases.items()]
            start_plotter = command.start_plotter if plots else lambda: None
            answers_by_label |= answers(
                requests, command.folder.path, points, command.progress, start_plotter, settings, keep
            )
        outcome = Outcome(cases, answers_by_label)
        outcome.seconds["all answers"] = time.perf_counter() - began
        command.begin_plots(drawings(outcome), " against ".join(case.study.name for case in cases.values()))
        outcome.seconds["whole"] = time.perf_counter() - began
        _write(command.folder, outcome, texts)
        command.failures += [TvimError(text) for text in outcome.failures]
        command.finish_plots("drawing the plots")
        studies = {label: case.study.model_dump(mode="json") for label, case in cases.items()}
        inputs = {label: design_file(path) for label, path in zip(cases, paths, strict=True)}
        page = comparison_page(command.folder, outcome, texts)
        command.finish("compared", inputs, studies, outcome.seconds, page)
    codes = {trouble["exit_code"] for _, trouble in outcome.troubles}
    infeasible = codes == {InfeasibleError.exit_code} and len(command.failures) == len(outcome.troubles)
    command.report(
        outcome.plain(), lambda console: print_comparison(outcome, console), "Results are",
        _no_design if infeasible else done_in_part,
    )  # fmt: skip


def is_result(path: Path) -> bool:
    """Return whether a path is the folder or the design of a finished run, not a study."""
    return path.suffix == ".json" or path.is_dir()


def labelled(cases: Sequence[Case], paths: Sequence[Path]) -> dict[str, Case]:
    """Name cases by their modes if these differ, else by their files or folders, else by their paths."""
    for names in (
        [case.study.mode for case in cases],
        [path.resolve().name if path.is_dir() else path.stem for path in paths],
        [printable(path) for path in paths],
    ):
        if len(set(names)) == len(names):
            break
    return dict(zip(names, cases, strict=True))


def _studies(paths: Sequence[Path], settings: Sequence[str]) -> list[Case]:
    """Read studies. Raises StudyError with everything that is wrong with any of them, or differs between them."""
    from tvimdesign.report.run.check_study import refuse_what_cannot_be

    problems: list[Mistake] = []
    cases = []
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
            cases.append(Case(path, study))
    if problems:
        raise StudyError(problems)
    refuse_unequal(cases)
    return cases


def _results(paths: Sequence[Path]) -> list[Case]:
    """Read the studies of finished runs. Raises InputError, and StudyError where they differ."""
    cases = []
    for path in map(design_file, paths):
        study = Study.model_validate(read_design(path).study)
        beside = path.with_name("study.yaml")
        cases.append(Case(beside if beside.exists() and path.name == "design.json" else path, study))
    refuse_unequal(cases)
    return cases


def _study_text(case: Case, settings: Sequence[str]) -> str:
    """Return a study as it was answered, as text."""
    if case.path.suffix == ".json":
        return json.dumps(read_design(case.path).study, indent=2)
    text = study_file(tree_of_file(case.path, settings))
    return text if isinstance(text, str) else text.decode()


def _write(folder: ResultsFolder, outcome: Outcome, texts: dict[str, str]) -> None:
    """Write what is there: each study with its designs, and the tables once two studies have a design."""
    for label, answer in outcome.found.items():
        name = "-".join(part for part in Path(label).with_suffix("").parts if part not in {"/", ".."})
        for which in COMPARISONS:
            if which in answer:
                folder.write(f"{name}/{which}.json", design_json(Design.model_validate(answer[which]["design"])))
        folder.write(f"{name}/study.yaml", texts[label])
    folder.write("compare.csv", compare_csv(outcome.rows, outcome.alone))
    folder.write("summary.txt", summary_text(outcome))
    folder.write_json("compare.json", outcome.plain())
    if outcome.fronts:
        folder.write("fronts.csv", outcome.fronts_csv())
        folder.write_json("fronts.json", outcome.fronts_plain())


def _no_design(failures: Sequence[TvimError]) -> TvimError:
    """Return the error of a comparison in which studies have no design, and nothing else is missing."""
    return InfeasibleError("\n".join(map(str, failures)) + "\nThe results of the other studies are written.")
