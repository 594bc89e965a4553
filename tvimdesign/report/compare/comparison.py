"""Result of a comparison: designs, rows, fronts, the winner of each pair, and the sections that show them."""

import math
from collections.abc import Iterator, Mapping, Sequence
from functools import cached_property
from typing import Any

from rich.console import Console
from rich.markup import escape

from tvimdesign.base.units import from_si, pretty
from tvimdesign.report.compare import comparison_table
from tvimdesign.report.compare.comparison_table import ParetoComparison, Row
from tvimdesign.report.output.numbers import axis_label, csv_text, finite_in, head, in_unit, number
from tvimdesign.report.output.page_sections import grid
from tvimdesign.report.output.plot_process import Drawing
from tvimdesign.report.output.terminal import WIDTH, plain_text, print_section
from tvimdesign.report.page.blocks import Block, Drawn, Folded, Grid, Listing, Points, Section, Warned, Words
from tvimdesign.report.run.blocks.warnings import advice_text
from tvimdesign.solve.pareto.front_shape import leads
from tvimdesign.study import Design
from tvimdesign.study.conditions import Case

COMPARISONS = {"optimised": "each optimised for itself", "drawn": "as drawn"}
_DEFAULT_OUTPUTS = ("envelope_diameter", "module_mass", "cycle_time", "response_time")


class Outcome:
    """All studies' answers under their labels; the others are compared with the first study."""

    def __init__(
        self, cases: Mapping[str, Case], answers: Mapping[str, dict[str, Any]], differences: Sequence[str] = ()
    ) -> None:
        """Take what each child process wrote as `answers`, and the conditions in which finished runs differ."""
        self.cases, self.answers, self.differences = dict(cases), dict(answers), list(differences)
        self.tables = {label: case.study.table for label, case in cases.items()}
        self.seconds: dict[str, float] = {}

    @property
    def troubles(self) -> list[tuple[str, dict[str, Any]]]:
        """(study, what failed) of everything that was not done."""
        return [(label, trouble) for label, answer in self.answers.items() for trouble in answer["troubles"]]

    @property
    def failures(self) -> list[str]:
        """Everything that was not done, a line each."""
        return [f"{label}, {trouble['step']}: {trouble['error']}" for label, trouble in self.troubles]

    @cached_property
    def designs(self) -> dict[str, dict[str, Design]]:
        """Designs by comparison and study; only those there are."""
        return {
            which: {
                label: Design.model_validate(answer[which]["design"])
                for label, answer in self.answers.items() if which in answer
            }
            for which in COMPARISONS
        }  # fmt: skip

    @property
    def which(self) -> str:
        """Say what is compared: the optima where every study that has a design has one, else the designs as drawn."""
        with_design = [answer for answer in self.answers.values() if any(which in answer for which in COMPARISONS)]
        return "optimised" if with_design and all("optimised" in answer for answer in with_design) else "drawn"

    @cached_property
    def rows(self) -> dict[str, list[Row]]:
        """Return the rows that all designs have, by comparison; none where fewer than two studies have an answer."""
        return {
            which: comparison_table.common_rows(designs, self.tables)
            for which, designs in self.designs.items()
            if len(designs) > 1
        }

    @property
    def fronts(self) -> dict[tuple[str, str], dict[str, dict[str, Any]]]:
        """Fronts by their two outputs, then by study."""
        fronts_by_pair: dict[tuple[str, str], dict[str, dict[str, Any]]] = {}
        for label, answer in self.answers.items():
            for front in answer["fronts"]:
                fronts_by_pair.setdefault((front["first"], front["second"]), {})[label] = front
        return fronts_by_pair

    def unit(self, name: str) -> str:
        """Return the unit of a row that any of the studies has."""
        return next(table.unit(name) for table in self.tables.values() if name.partition("@")[0] in table.by_name)

    @cached_property
    def contests(self) -> list[ParetoComparison]:
        """Compare the fronts over each pair of outputs with a limit on either of them."""
        comparisons = []
        for (first, second), fronts in self.fronts.items():
            points = {label: _curve(front, second, first) for label, front in fronts.items()}
            for gained, limited, curves in (
                (first, second, points),
                (second, first, {label: [(y, x) for x, y in curve] for label, curve in points.items()}),
            ):
                led = tuple(leads(curves))
                if led and len(fronts) > 1:
                    comparisons.append(ParetoComparison(gained, limited, self.unit(gained), self.unit(limited), led))
        return comparisons

    def fronts_plain(self) -> dict[str, Any]:
        """Return every front, its points in their units; null is never."""
        names = {name for _, _, point in self._points() for name in point["values"]}
        return {
            **head(),
            "units_of_values": {name: pretty(self.unit(name)) for name in sorted(names)},
            "fronts": [
                {
                    "study": label, "first": first, "second": second,
                    "points": [
                        {"where": point["where"],
                         "values": {name: finite_in(value, self.unit(name)) for name, value in point["values"].items()},
                         "si": point["values"], "current_profiles": point["current_profiles"]}
                        for point in front["points"]
                    ],
                    **{kind: front[kind] for kind in ("dominated", "failures", "notes")},
                }
                for (first, second), fronts in self.fronts.items() for label, front in fronts.items()
            ],
        }  # fmt: skip

    def fronts_csv(self) -> str:
        """Return a line for each point of each front, every input and output of its design in a column."""
        names = list(dict.fromkeys(name for _, _, point in self._points() for name in point["values"]))
        heads = {name: f"{name} [{pretty(self.unit(name))}]" for name in names}
        rows = [
            {"study": label, "front": front,
             **{heads[name]: finite_in(value, self.unit(name)) for name, value in point["values"].items()}}
            for label, front, point in self._points()
        ]  # fmt: skip
        return csv_text(rows, ["study", "front", *heads.values()], 8)

    def _points(self) -> Iterator[tuple[str, str, dict[str, Any]]]:
        for (first, second), fronts in self.fronts.items():
            for label, front in fronts.items():
                yield from ((label, f"{first} against {second}", point) for point in front["points"])

    @cached_property
    def conclusions(self) -> list[str]:
        """The sentences that follow, the conditions first."""
        designs = {label: answer.get(self.which, {}) for label, answer in self.answers.items()}
        sentences = [self.sentence]
        sentences += [f"Verdict on {label}: {of['verdict']}." for label, of in designs.items() if of.get("verdict")]
        for which in self.rows:
            texts = self._against(which) if which != self.which else []
            broken = self._violated(which) if which != self.which else []
            sentences += [f"{COMPARISONS[which].capitalize()}: {text}." for text in (*texts, *broken)]
        return [*sentences, *(comparison_table.standing(contest) for contest in self.contests)]

    @property
    def sentence(self) -> str:
        """The answer with its conditions: how the others stand against the first."""
        reported = [*self._without_design(), *self._violated(self.which), *self._against(self.which)]
        alike = ", ".join(comparison_table.conditions(self.cases))
        count = f"{len(self.differences)} different conditions (below)"
        return f"With {count if self.differences else alike}, {COMPARISONS[self.which]}: {'; '.join(reported)}."

    def _without_design(self) -> list[str]:
        so = ", so that the modules are compared as drawn" if self.which == "drawn" else ""
        without = [label for label, trouble in self.troubles if trouble["step"] == "optimised"]
        return [f"no feasible design was found for {label}{so}" for label in without]

    def _violated(self, which: str) -> list[str]:
        answers = {label: self.answers[label][which]["broken"] for label in self.designs[which]}
        return [f"{label} is infeasible: not {', '.join(broken)}" for label, broken in answers.items() if broken]

    def _against(self, which: str) -> list[str]:
        labels = list(self.designs[which])
        rows = self.rows.get(which, [])
        reported = list(next(iter(self.cases.values())).study.minimize) or list(_DEFAULT_OUTPUTS)
        return [comparison_table.against(label, labels[0], rows, reported) for label in labels[1:]]

    def plain(self) -> dict[str, Any]:
        """Return everything a script wants to know."""
        return {
            **head(),
            "sentence": self.sentence,
            "conclusions": self.conclusions,
            "differences": self.differences,
            "studies": {label: self._study(label) for label in self.cases},
            "comparisons": {which: [comparison_table.plain(row) for row in rows] for which, rows in self.rows.items()},
            "leads": [contest.plain() for contest in self.contests],
            "fronts": self.fronts_plain() if self.fronts else {},
            "seconds": self.seconds,
        }

    def _study(self, label: str) -> dict[str, Any]:
        case, answer = self.cases[label], self.answers[label]
        return {
            "file": str(case.path), "name": case.study.name, "mode": case.study.mode,
            **{which: {key: value for key, value in answer[which].items() if key != "design"}
               for which in COMPARISONS if which in answer},
            "troubles": answer["troubles"], "seconds": answer["seconds"],
        }  # fmt: skip


def _curve(front: dict[str, Any], x: str, y: str) -> list[tuple[float, float]]:
    points = [(point["values"][x], point["values"][y]) for point in front["points"]]
    return sorted((a, b) for a, b in points if a is not None and b is not None and math.isfinite(a + b))


def drawings(outcome: Outcome) -> list[Drawing]:
    """Return every picture there is something for."""
    return [Drawing("fronts", "design_figures.fronts", _fronts(outcome))] if outcome.fronts else []


def _fronts(outcome: Outcome) -> dict[str, Any]:
    panels = []
    for (first, second), fronts in outcome.fronts.items():
        units = {name: outcome.unit(name) for name in (first, second)}

        def shown(name: str, values: Any, units: dict[str, str] = units) -> float:
            return from_si(values[name], units[name])

        lines = []
        for label, front in fronts.items():
            points = sorted((shown(second, p["values"]), shown(first, p["values"])) for p in front["points"])
            optimum = outcome.designs["optimised"][label].values
            lines.append({
                "label": label, "x": [x for x, _ in points], "y": [y for _, y in points],
                "points": True, "optimum": [[shown(second, optimum)], [shown(first, optimum)]],
            })  # fmt: skip
        axes = {f"{axis}_label": axis_label(name, units[name]) for axis, name in (("x", second), ("y", first))}
        panels.append({"lines": lines, **axes})
    return {"title": "Fronts; filled: each study's optimum", "panels": panels}


FILES = {"summary.txt": "all of this as text", "compare.csv": "every output", "fronts.csv": "the fronts"}


def comparison_sections(outcome: Outcome, texts: Mapping[str, str]) -> list[Section]:
    """Return what follows, the tables it follows from, figures and the studies; `texts` are the studies' files."""
    follows, troubles = outcome.conclusions[1:], outcome.failures
    fronts: list[Block] = [
        Drawn("fronts", "lines.js", "The fronts: each point is a whole design.", drawing.data, libraries=["echarts"])
        for drawing in drawings(outcome)
    ]
    # Show headlines and requirements; then everything that all studies have.
    required = {limit.output for case in outcome.cases.values() for limit in case.study.require}
    blocks: list[Block] = [
        side_by_side(COMPARISONS[which].capitalize(), [row for row in rows if row.headline or row.name in required])
        for which, rows in outcome.rows.items()
    ]
    every = [side_by_side(COMPARISONS[which], rows) for which, rows in outcome.rows.items()]
    blocks += [Folded("Every output that all studies have", every)] if every else []
    return [
        *([Section("follows", "What follows", [Points(follows)])] if follows else []),
        Section("side-by-side", "Side by side", blocks),
        *([Section("curves", "Fronts", fronts)] if fronts else []),
        *([Section("differ", "Different conditions", [Points(outcome.differences)])] if outcome.differences else []),
        Section("searches", "How they were found", [Points(list(_searches(outcome)))]),
        *([Section("not-done", "Not done", [Points(troubles)])] if troubles else []),
        Section(
            "study", "Studies", [Folded(label, [Listing(f"Study of {label}", text)]) for label, text in texts.items()]
        ),
    ]


def first_blocks(outcome: Outcome) -> list[Block]:
    """Return the conclusion with its conditions, and the warnings."""
    warnings = [(text, "") for text in warnings_of(outcome)]
    return [Words(outcome.conclusions[:1]), *([Warned(warnings)] if warnings else [])]


def title_of(outcome: Outcome) -> str:
    """Return the names of the studies, their labels if two have one name."""
    names = [case.study.name for case in outcome.cases.values()]
    return " against ".join(names if len(set(names)) == len(names) else outcome.cases)


def summary_text(outcome: Outcome) -> str:
    """Return the text and the tables of the page that are not folded."""

    def show(console: Console) -> None:
        console.print(f"[bold]{escape(title_of(outcome))}[/bold]", soft_wrap=True)
        for section in (Section("first", "", first_blocks(outcome)), *comparison_sections(outcome, {})):
            print_section(section, console, folded=False)

    return plain_text(show, WIDTH)


def side_by_side(title: str, rows: Sequence[Row]) -> Grid:
    """Tabulate outputs that differ in four digits between the studies, with each one's ratio to the first."""
    labels = list(rows[0].values) if rows else []
    heads = ["", *labels, "unit"]
    heads += [head for label in labels[1:] for head in (f"{label} / {labels[0]}", f"{label} is")]
    differing = [row for row in rows if len({_value(row, label) for label in labels}) > 1]
    equal = len(rows) - len(differing)
    cells = []
    for row in differing:
        against: list[str] = []
        for label in labels[1:]:
            ratio = row.ratio(label)
            against += ["" if ratio is None else number(ratio, 3), row.verdict(label)]
        cells.append([row.name, *(_value(row, label) for label in labels), pretty(row.unit), *against])
    ratios = range(len(labels) + 2, len(heads), 2)
    right, toned = (*range(1, len(labels) + 1), *ratios), range(len(labels) + 3, len(heads), 2)
    return grid(title, heads, cells, right=right, toned=toned, note=f"{equal} more are equal." if equal else "")


def _value(row: Row, label: str) -> str:
    """Return a value for people; low to high where history leaves it open."""
    if label in row.ends:
        return " to ".join(in_unit(end, row.unit, 2) for end in row.ends[label])
    value = row.values[label]
    return "-" if math.isnan(value) else in_unit(value, row.unit)


def _searches(outcome: Outcome) -> Iterator[str]:
    """Yield what soft means, how optima and fronts were found, and what is accepted."""
    which = outcome.which
    texts = [f"{label}: {answer[which]['soft']}" for label, answer in outcome.answers.items() if which in answer]
    if texts:
        yield f"Soft is, {COMPARISONS[which]}, {'; '.join(texts)}."
    for label, answer in outcome.answers.items():
        search, seconds = answer.get("optimised"), answer["seconds"].get("optimised")
        if search and search["optima"]:
            optima = [f"{optimum['objective']:.5g}" for optimum in search["optima"]]
            agree = "all at one optimum" if len(optima) == 1 else f"at {len(optima)} optima"
            took = "" if seconds is None else f"; {seconds:.1f} s"
            yield (
                f"{label}: {search['converged']} of {search['starts']} starts converged, {agree}, objective "
                f"{', '.join(optima)}{took}."
            )
        if names := answer.get(which, {}).get("accepting"):
            yield f"{label} is beyond its rating, as its study accepts: {', '.join(names)}."
    for (first, second), fronts in outcome.fronts.items():
        for label, front in fronts.items():
            points = [f"{len(front['points'])} points", *front["notes"]]
            points += [f"{front['dominated']} more are no better in anything"] if front["dominated"] else []
            points += [f"no design at {failure['where']}: {failure['reason']}" for failure in front["failures"]]
            yield f"Front of {first} against {second}, {label}: {'; '.join(points)}."


def warnings_of(outcome: Outcome) -> Iterator[str]:
    """Yield the advice that the compared designs do not follow."""
    for label, answer in outcome.answers.items():
        for warning in answer.get(outcome.which, {"warnings": []})["warnings"]:
            value = math.inf if warning["value"] is None else warning["value"]
            unit = outcome.unit(warning["output"])
            yield f"{label}: {advice_text(warning['output'], value, warning['because'], unit)}"
