"""The command `compare`: optima first, by two child processes at once, and each result written at once."""

import json
import queue
import subprocess
import tempfile
import time
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple

from tvimdesign.base.child_process import read_lines, start_child
from tvimdesign.base.errors import InfeasibleError, InputError, TvimError
from tvimdesign.base.results_folder import ResultsFolder
from tvimdesign.report.compare import comparison
from tvimdesign.report.compare.comparison_job import empty_answer, finished_run
from tvimdesign.report.compare.comparison_table import compare_csv
from tvimdesign.report.output.command import Command, design_file, done_in_part
from tvimdesign.report.output.page_sections import tone_of
from tvimdesign.report.output.terminal import Progress
from tvimdesign.study import Design, Study, design_json, read_design, read_tree, study_text, tree_of_file
from tvimdesign.study.conditions import Case, differences, refuse_repeated, refuse_unequal
from tvimdesign.study.text.mistakes import Mistake, StudyError, printable


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
    if missing := [path for path in paths if not path.exists()]:
        raise InputError(f"{missing[0]}: no such file or folder")
    finished = [path.suffix == ".json" or path.is_dir() for path in paths]
    if any(finished) and (points or settings or not all(finished)):
        raise InputError("compare takes results of finished runs alone, without studies, --points and --set")
    cases = labelled(_results(paths) if all(finished) else _studies(paths, settings), paths)
    texts = {label: _study_text(case, settings) for label, case in cases.items()}
    of_file = {case.file: label for label, case in cases.items()}
    unequal = [f"{of_file[each.file]}, {each.path}: {each.message}" for each in differences([*cases.values()])]
    with Command(out, overwrite=overwrite, as_json=as_json) as command:
        answers_by_label = {label: empty_answer() for label in cases}

        def keep(label: str, answer: dict[str, Any]) -> None:
            answers_by_label[label] = answer
            _write(command.folder, comparison.Outcome(cases, answers_by_label, unequal), texts)

        if all(finished):
            which = "optimised" if all(case.study.vary for case in cases.values()) else "drawn"
            for label, path in zip(cases, paths, strict=True):
                answers_by_label[label] = finished_run(design_file(path), which)
        else:
            studies_by_label = {label: case.path for label, case in cases.items()}
            start_plotter = command.start_plotter if plots else lambda: None
            answers_by_label |= answers(
                studies_by_label, command.folder.path, points, command.progress, start_plotter, settings, keep
            )
        outcome = comparison.Outcome(cases, answers_by_label, unequal)
        outcome.seconds["all answers"] = time.perf_counter() - began
        command.begin_plots(comparison.drawings(outcome), comparison.title_of(outcome))
        outcome.seconds["whole"] = time.perf_counter() - began
        _write(command.folder, outcome, texts)
        command.failures += [TvimError(text) for text in outcome.failures]
        command.finish_plots("drawing the plots")
        studies = {label: case.study.model_dump(mode="json") for label, case in cases.items()}
        inputs = {label: design_file(path) for label, path in zip(cases, paths, strict=True)}
        status = "PARTLY DONE" if outcome.failures else f"COMPARED {comparison.COMPARISONS[outcome.which].upper()}"
        page = command.page(
            comparison.title_of(outcome), "comparison", status, comparison.first_blocks(outcome),
            comparison.comparison_sections(outcome, texts), tone=tone_of(status.lower()), files=comparison.FILES,
        )  # fmt: skip
        command.finish("compared", inputs, studies, outcome.seconds, page)
    codes = {trouble["exit_code"] for _, trouble in outcome.troubles}
    infeasible = codes == {InfeasibleError.exit_code} and len(command.failures) == len(outcome.troubles)
    command.report(outcome.plain(), "Results are", error=_no_design if infeasible else done_in_part)


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
    from tvimdesign.solve.infeasibility.early_checks import refuse_what_cannot_be

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
    """Read the studies of finished runs. Raises InputError, and StudyError if a run is given twice."""
    cases = []
    for path in map(design_file, paths):
        study = Study.model_validate(read_design(path).study)
        beside = path.with_name("study.yaml")
        cases.append(Case(beside if beside.exists() and path.name == "design.json" else path, study))
    refuse_repeated(cases)
    return cases


def _study_text(case: Case, settings: Sequence[str]) -> str:
    if case.path.suffix == ".json":
        return json.dumps(read_design(case.path).study, indent=2)
    return study_text(tree_of_file(case.path, settings))


def _write(folder: ResultsFolder, outcome: comparison.Outcome, texts: dict[str, str]) -> None:
    """Write what is there: each study with its designs, and the tables once two studies have a design."""
    for label, answer in outcome.answers.items():
        name = "-".join(part for part in Path(label).with_suffix("").parts if part not in {"/", ".."})
        for which in comparison.COMPARISONS:
            if which in answer:
                folder.write(f"{name}/{which}.json", design_json(Design.model_validate(answer[which]["design"])))
        folder.write(f"{name}/study.yaml", texts[label])
    folder.write("compare.csv", compare_csv(outcome.rows))
    folder.write("summary.txt", comparison.summary_text(outcome))
    folder.write_json("compare.json", outcome.plain())
    if outcome.fronts:
        folder.write("fronts.csv", outcome.fronts_csv())
        folder.write_json("fronts.json", outcome.fronts_plain())


def _no_design(failures: Sequence[TvimError]) -> TvimError:
    """Return the error of a comparison in which studies have no design, and nothing else is missing."""
    return InfeasibleError("\n".join(map(str, failures)) + "\nThe results of the other studies are written.")


AT_ONCE = 2  # Children at a time: each has one thread, and the machines this is for have two cores or more
HALF_DONE = ".studies."
"""Folder beside the results in which children answer: a pattern. One is left where a comparison was killed."""
_CRASHED = TvimError.exit_code + 2


class _Child(NamedTuple):
    label: str
    process: subprocess.Popen[str]
    out: Path
    errors: Path
    began: float


def answers(
    studies: Mapping[str, Path],
    out: Path,
    points: int,
    progress: Progress,
    when_idle: Callable[[], object] = lambda: None,
    settings: Sequence[str] = (),
    keep: Callable[[str, dict[str, Any]], object] = lambda _label, _answer: None,
) -> dict[str, dict[str, Any]]:
    """Return what each study's job found, by label; a job that died has its reason under `troubles`.

    Jobs write into a folder of their own within `out`, which is removed at the end. `when_idle` is called as soon as
    nothing more is to be started: from then on a core is free. `keep` is called with a label and what is found so far,
    after each step of a job.
    """
    waiting, running = list(studies), list[_Child]()
    answers_by_label: dict[str, dict[str, Any]] = {}
    lines: queue.Queue[tuple[str, str | None]] = queue.Queue()
    with tempfile.TemporaryDirectory(dir=out, prefix=HALF_DONE) as folder:
        try:
            while waiting or running:
                while waiting and len(running) < AT_ONCE:
                    stem = Path(folder) / str(len(studies) - len(waiting))
                    label = waiting.pop(0)
                    progress(f"{label}, preparing the equations")
                    paths = [studies[label], *(path for other, path in studies.items() if other != label)]
                    running.append(_start(label, paths, (points, settings), stem, lines))
                label, line = lines.get()
                child = next(child for child in running if child.label == label)
                if line is not None:
                    message = json.loads(line)
                    if "progress" in message:
                        progress(f"{label}, {message['progress']}")
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
    return {label: answers_by_label[label] for label in studies}


def _start(
    label: str, studies: Sequence[Path], how: tuple[int, Sequence[str]], stem: Path,
    lines: queue.Queue[tuple[str, str | None]],
) -> _Child:  # fmt: skip
    """Start a child process for the first of some studies; `how` is the points of a front, and the settings."""
    out, errors = stem.with_suffix(".json"), stem.with_suffix(".txt")
    paths = [str(path.resolve()) for path in (studies[0], out, *studies[1:])]
    with errors.open("wb") as stream:
        process = start_child(
            "tvimdesign.report.compare.comparison_job", [*paths[:2], str(how[0]), json.dumps(list(how[1])), *paths[2:]],
            stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=stream, text=True, encoding="utf-8",
        )  # fmt: skip
    read_lines(process, lambda line: lines.put((label, line)))
    return _Child(label, process, out, errors, time.perf_counter())


def _finish(child: _Child) -> dict[str, Any]:
    code = child.process.wait()
    answer: dict[str, Any] = json.loads(child.out.read_text()) if child.out.exists() else empty_answer()
    if code:
        last = " ".join(child.errors.read_text(errors="replace").strip().splitlines()[-1:])
        error = f"its process ended with code {code}: {last or 'without a message'}"
        answer["troubles"].append({"step": "all", "error": error, "exit_code": _CRASHED})
    answer["seconds"]["whole process"] = time.perf_counter() - child.began
    return answer
