"""One tolerance analysis, from a study or a design to a finished folder and what the terminal says."""

from __future__ import annotations

import json
import os
from collections.abc import Sequence
from contextlib import ExitStack
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from rich.console import Console
from rich.markup import escape
from rich.table import Table as Grid

from tvimdesign.base.errors import InfeasibleError, InputError
from tvimdesign.base.units import from_si, pretty
from tvimdesign.device import Table
from tvimdesign.report.figures.plot_process import Drawing, PlotProcess
from tvimdesign.report.output.progress import Progress, progress_output, wide_console
from tvimdesign.report.output.results_folder import ResultsFolder
from tvimdesign.report.output.tables import number
from tvimdesign.report.output.thresholds import soft_of_module
from tvimdesign.report.run.infeasible_report import complaint
from tvimdesign.report.tolerate.tolerance_plot_data import figure_data
from tvimdesign.report.tolerate.tolerance_tables import (
    as_csv,
    contributor_rows,
    limit_rows,
    output_rows,
    reported,
    spreads,
)
from tvimdesign.report.tolerate.words import of_concern, sentences
from tvimdesign.simulation.working_cycle.resolved_module import ResolvedModule, resolve_design, resolve_study
from tvimdesign.solve.nlp.constraints import in_words
from tvimdesign.solve.nlp.spread import power_of_two
from tvimdesign.solve.result import answer
from tvimdesign.solve.uncertainty.tolerance import Preload, Spread, Tolerancing
from tvimdesign.study import Study, read_study, standard_tolerances
from tvimdesign.study.design import Design, read_design, write_design

FEWEST, MOST = 1 << 8, 1 << 22
"""Modules that may be drawn."""


@dataclass(frozen=True)
class TolerancedModule:
    """What is analysed: the module, the design it was found as, and what is to be said of where it came from."""

    resolved: ResolvedModule
    design: Design | None
    notes: tuple[str, ...]
    nominal: ResolvedModule | None = None
    """The optimum without the robustness the study asks for."""


def tolerate_study(path: Path, out: Path, samples: int, workers: int, *, overwrite: bool, as_json: bool) -> None:
    """Analyse a study's or a design's tolerances and write a folder. Raises InputError, InfeasibleError."""
    if not FEWEST <= samples <= MOST:
        raise InputError(f"--samples {samples}: must be {FEWEST} to {MOST}")
    count, threads = power_of_two(samples), workers or os.cpu_count() or 1
    source = path / "design.json" if path.is_dir() else path
    with ExitStack() as stack:
        study = _study(source)
        folder = stack.enter_context(ResultsFolder(out, overwrite))
        progress = stack.enter_context(progress_output())
        drawing = stack.enter_context(PlotProcess()) if study.write.plots else None
        subject = _subject(source, study, progress)
        found, preload = _analysed(subject.resolved, count, threads, progress)
        table, study = subject.resolved.table, subject.resolved.study
        data = reported(found, preload, table, study, count)
        data["notes"] = [*subject.notes, f"Soft is {soft_of_module(subject.resolved)}."]
        data["sentences"] = sentences(found, preload, table)
        if subject.nominal is not None:
            before, _ = _analysed(subject.nominal, count, threads, progress)
            data["cost_of_robustness"] = _price(before, found, table, study)
        _write(folder, source, subject, data, found, table)
        if drawing:
            progress("drawing the figure")
            figure = Drawing("spread", "tolerance_figure.spread", figure_data(found, table))
            drawing.begin(folder.path, [figure], study.name)
            drawing.finish()
        progress("")
        folder.finish("tolerated", {"tolerated": source}, study.model_dump(mode="json"))
        if as_json:
            print(json.dumps(data | {"folder": str(out)}, indent=2, allow_nan=False))
        else:
            _print(found, data, table, wide_console())
            wide_console().print(f"\nTables and figure are in [bold]{escape(str(out))}[/bold]", soft_wrap=True)


def _study(source: Path) -> Study:
    return Study.model_validate(read_design(source).study) if source.suffix == ".json" else read_study(source)


def _subject(source: Path, study: Study, progress: Progress) -> TolerancedModule:
    """The module to analyse: a design as it is, a study evaluated, or the optimum of one."""
    table = study.table
    notes = []
    if not study.tolerances:
        study = study.model_copy(update={"tolerances": standard_tolerances(table)})
        notes.append("The study gives no tolerances: the standard ones are taken.")
    if source.suffix == ".json":
        design = read_design(source)
        resolved = resolve_design(design)
        return TolerancedModule(
            replace(resolved, study=resolved.study.model_copy(update={"tolerances": study.tolerances})),
            None,
            (f"Module: the design {source}.", *design.rating_notes, *notes),
        )
    if not study.vary:
        return TolerancedModule(resolve_study(study), None, (f"Module: {source}.", *notes))
    progress("seeking the optimum")
    design = _optimum(study, progress)
    module = f"Module: the optimum of {source}{', robust as it asks' if study.robust else ''}."
    notes = [module, *design.rating_notes, *notes]
    nominal = None
    if study.robust:
        progress("seeking the optimum that is not robust")
        plain = _optimum(study.model_copy(update={"robust": None}), progress)
        nominal = resolve_design(plain)
    return TolerancedModule(resolve_design(design), design, tuple(notes), nominal)


def _optimum(study: Study, progress: Progress) -> Design:
    table = study.table
    found = answer(study, progress)
    if not found.found:
        raise InfeasibleError(complaint(found, table))
    return found.design


def _analysed(
    resolved: ResolvedModule, samples: int, workers: int, progress: Progress
) -> tuple[Spread, Preload | None]:
    analysis = Tolerancing(resolved, progress, workers)
    seed = resolved.study.solver.seed
    return analysis.analyse(samples, seed), analysis.preload(samples, seed)


def _price(before: Spread, after: Spread, table: Table, study: Study) -> list[dict[str, Any]]:
    """What robustness costs: each minimised output without and with it, and the yields."""
    rows: list[dict[str, Any]] = []
    for name in study.minimize:
        unit = table.unit(name)
        values = [from_si(float(one.nominal[one.outputs.index(name)]), unit) for one in (before, after)]
        rows.append({"output": name, "unit": pretty(unit), "nominal": values[0], "robust": values[1]})
    shares = [one.together.share for one in (before, after)]
    return [*rows, {"output": "yield of all limits", "unit": "", "nominal": shares[0], "robust": shares[1]}]


def _write(
    folder: ResultsFolder, source: Path, subject: TolerancedModule, data: dict[str, Any], found: Spread, table: Table
) -> None:
    folder.write(f"tolerated{source.suffix}", source.read_bytes())
    if subject.design is not None:
        write_design(subject.design, folder.path / "design.json")
    folder.write_json("tolerances.json", data)
    folder.write("outputs.csv", as_csv(list(output_rows(found, table))))
    folder.write("limits.csv", as_csv(list(limit_rows(found, table))))
    folder.write("contributors.csv", as_csv(list(contributor_rows(found, table, subject.resolved.study))))


def _print(found: Spread, data: dict[str, Any], table: Table, console: Console) -> None:
    for note in data["notes"]:
        console.print(f"[dim]{escape(note)}[/dim]")
    grid = _grid(
        "What spreads", ("", "as drawn", "worst case", "rss sd", "mc mean", "mc sd", "99.73 %", "unit", "most by")
    )
    for i, row in enumerate(data["outputs"]):
        if row["output"] in found.asked and spreads(found, i):
            most = int(found.shares[i].argmax())
            by = f"{found.contributors[most].name} {100.0 * found.shares[i, most]:.0f} %"
            grid.add_row(
                row["output"], _shown(row["as_drawn"]), _span(row["worst_low"], row["worst_high"]),
                _shown(row["deviation_rss"]), _shown(row["mean"]), _shown(row["deviation"]),
                _span(row["low"], row["high"]), row["unit"], by,
            )  # fmt: skip
    console.print(grid)
    concern = of_concern(found)
    if concern:
        grid = _grid("Limits that too many modules break", ("", "yield", "C_pk", "most by"))
        for kept in concern:
            i = found.outputs.index(kept.limit.output)
            most = int(found.shares[i].argmax())
            by = f"{found.contributors[most].name} {100.0 * found.shares[i, most]:.0f} %"
            grid.add_row(in_words(kept.limit, table), f"{100.0 * kept.share.share:.4g} %", f"{kept.capability:.2f}", by)
        console.print(grid)
    if "cost_of_robustness" in data:
        grid = _grid("What robustness costs", ("", "nominal optimum", "robust optimum", "unit"))
        for row in data["cost_of_robustness"]:
            grid.add_row(row["output"], number(row["nominal"]), number(row["robust"]), row["unit"])
        console.print(grid)
    for sentence in data["sentences"]:
        console.print(escape(sentence))


def _grid(title: str, columns: Sequence[str]) -> Grid:
    grid = Grid(title=title, title_justify="left", title_style="bold", box=None, pad_edge=False, padding=(0, 2, 0, 0),
                header_style="dim")  # fmt: skip
    for i, name in enumerate(columns):
        grid.add_column(name, justify="left" if i in (0, len(columns) - 1) or name == "unit" else "right")
    return grid


def _shown(value: float | None) -> str:
    return "never" if value is None else number(value)


def _span(low: float | None, high: float | None) -> str:
    return f"{_shown(low)} to {_shown(high)}"
