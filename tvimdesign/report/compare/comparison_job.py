"""The child process that answers one study of a comparison: its optimum first, fronts last.

`python -m tvimdesign.report.compare.comparison_job STUDY OUT POINTS SETTINGS OTHERS`. SETTINGS is a JSON list of
`name=value`; OTHERS are the studies it is compared with. After each step it writes what it has found to OUT, one JSON
object, and prints a line of JSON. A step that fails is listed under `troubles`, and the other steps are done.
"""

import json
import signal
import sys
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import asdict
from functools import cached_property
from pathlib import Path
from typing import Any

from tvimdesign.base.atomic_files import atomic_write
from tvimdesign.base.child_process import follow_parent, line_writer
from tvimdesign.base.errors import AboveRatingError, BelowYieldError, InfeasibleError, InputError, TvimError
from tvimdesign.report.output.numbers import all_finite
from tvimdesign.report.output.tables import results, soft_in_words
from tvimdesign.report.output.terminal import Progress
from tvimdesign.report.run.blocks.verdict import verdict
from tvimdesign.report.run.blocks.warnings import warnings_of
from tvimdesign.report.run.reasons import above_rating, complaint, starts_reported
from tvimdesign.report.run.uncertainty_data import below_yield, uncertainty_of
from tvimdesign.solve import anchored_search
from tvimdesign.solve.pareto.front import FrontSearch
from tvimdesign.solve.result import StudyResult, answer
from tvimdesign.study import Design, Study, StudyTree, drawn, read_design, read_tree, record_checks, tree_of_file


def compared_design(design: Design, results: Mapping[str, Any]) -> dict[str, Any]:
    """Return a design with its violated limits, warnings and search; `results` as results.json."""
    search = results.get("starts") or {"count": 0, "converged": 0, "optima": []}
    return {
        "design": design.model_dump(mode="json"),
        "broken": [check["limit"] for check in results.get("checks", ()) if not check["met"]],
        "warnings": [
            {"output": check["output"], "value": check["si"]["value"], "because": check["origin"]}
            for check in results.get("warnings", ())
        ],
        "verdict": results.get("verdict", ""), "soft": soft_in_words(design),
        "above_rating": list(design.above_rating), "accepting": list(design.accepting),
        "starts": search["count"], "converged": search["converged"],
        "optima": [{"objective": entry["objective"], "variables": entry["at"]} for entry in search["optima"]],
    }  # fmt: skip


def finished_run(source: Path, which: str) -> dict[str, Any]:
    """Return what a comparison of `which` designs needs of a finished run, by its design.json. Raises InputError."""
    design = read_design(source)
    path = source.parent / "results.json"
    try:
        results = json.loads(path.read_bytes()) if source.name == "design.json" else {}
    except FileNotFoundError:
        results = {}
    except (OSError, ValueError) as error:
        raise InputError(f"{path}: cannot be read: {error}") from error
    return {**empty_answer(), which: compared_design(design, results)}


def empty_answer() -> dict[str, Any]:
    """Return what a comparison has of a study before anything is computed."""
    return {"fronts": [], "seconds": {}, "troubles": []}


def front_outputs(study: Study) -> tuple[str, str, str]:
    """Return the time, mass and size that fronts are drawn over: those the study minimises, else the usual ones."""
    times = [name for name in study.minimize if study.table.unit(name) == "s"]
    sizes = [name for name in study.minimize if name in {"envelope_diameter", "envelope_volume", "envelope_height"}]
    return (times or ["response_time"])[0], "module_mass", (sizes or ["envelope_diameter"])[0]


class ComparisonJob:
    """The answer of one study: what was found, what failed, how long each step took."""

    def __init__(
        self, tree: StudyTree, points: int, others: Callable[[], Sequence[StudyTree]], say: Progress,
        keep: Callable[[dict[str, Any]], object] = lambda _: None,
    ) -> None:  # fmt: skip
        """Read the study. `others` gives the studies it is compared with; `keep` gets what is found, step by step."""
        self.study, self._keep = read_tree(tree), keep
        self._others = others
        self.table = self.study.table
        self.points, self.say = points, say
        self._fronts = FrontSearch(self.study)
        self.answer = empty_answer()

    @cached_property
    def others(self) -> list[Study]:
        """The studies it is compared with. If one cannot be read any more, only the optimum of this one fails."""
        return [read_tree(tree) for tree in self._others()]

    def run(self) -> dict[str, Any]:
        """Do every step that can be done."""
        which = "optimised" if self.study.vary else "drawn"
        answered: StudyResult | None = None
        if self.study.vary:
            with self._step("optimised"):
                answered = self._optimised()
        with self._step("as drawn"):
            self.say("as drawn")
            as_drawn = answer(drawn(self.study))
            self.answer["drawn"] = self._compared(as_drawn)
            answered = answered if self.study.vary else as_drawn
        with self._step("verdict"):
            if answered:
                self.say("verdict")
                warnings = warnings_of(answered, record_checks(self.study))
                self.answer[which]["verdict"] = verdict(answered, uncertainty_of(answered, self.study), warnings).text
        if answered and answered.solution and self.points:
            with self._step("fronts"):
                self._trade(answered)
        return self.answer

    @contextmanager
    def _step(self, name: str) -> Iterator[None]:
        """Time a step, note its failure so that the others are done, and hand on what is found."""
        began = time.perf_counter()
        try:
            yield
        except TvimError as error:
            self.answer["troubles"].append({"step": name, "error": str(error), "exit_code": error.exit_code})
        finally:
            spent = self.answer["seconds"].get(name, 0.0)
            self.answer["seconds"][name] = spent + time.perf_counter() - began
            self._keep(self.answer)

    def _optimised(self) -> StudyResult:
        starts = [anchored_search.at_its_start(study) for study in (self.study, *self.others)]
        common = anchored_search.common(starts)
        objectives = front_outputs(self.study) if self.points else ()
        answered = answer(self.study, self.say, common, self._fronts.keep, objectives)
        if not answered.has_design:
            raise InfeasibleError(complaint(answered))
        self.answer["optimised"] = self._compared(answered)
        if refused := above_rating(answered):
            self.answer["troubles"].append(
                {"step": "ratings", "error": refused, "exit_code": AboveRatingError.exit_code}
            )
        if missed := below_yield(answered):
            self.answer["troubles"].append({"step": "yield", "error": missed, "exit_code": BelowYieldError.exit_code})
        return answered

    def _compared(self, answered: StudyResult) -> dict[str, Any]:
        reported = results(answered) | {"starts": starts_reported(answered)}
        return compared_design(answered.design, reported)

    def _trade(self, best: StudyResult) -> None:
        assert best.solution is not None
        optimum = self._fronts.begin(best.solution, self.say)
        first, *others = front_outputs(self.study)
        for second in others:
            front = self._fronts.seek((first, second), self.points)
            entry = all_finite({
                "first": first, "second": second, "notes": front.notes, "dominated": front.dominated,
                "failures": [asdict(failure) for failure in front.failures],
                "points": [
                    {"where": point.where, "values": point.values, "current_profiles": point.current_profiles}
                    for point in front.joined(optimum)
                ],
            })  # fmt: skip
            self.answer["fronts"].append(entry)


def main(arguments: list[str]) -> int:
    """Run the job; print each step, and when something is written."""
    follow_parent()

    write_line = line_writer()

    def keep(design_answer: dict[str, Any]) -> None:
        atomic_write(Path(out), json.dumps(design_answer).encode())
        write_line({"kept": list(design_answer["seconds"])})

    signal.signal(signal.SIGINT, signal.SIG_IGN)  # an interrupt is the parent's to handle
    path, out, points, listed, *others = arguments
    settings = json.loads(listed)
    ComparisonJob(
        tree_of_file(path, settings), int(points), lambda: [tree_of_file(other, settings) for other in others],
        lambda text: write_line({"progress": text}), keep,
    ).run()  # fmt: skip
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
