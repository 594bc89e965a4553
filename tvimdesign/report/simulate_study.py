"""One virtual test, from a study file to a finished folder: sheets as CSV, the figure, and what was read off."""

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

from tvimdesign.base.errors import InputError
from tvimdesign.base.units import pretty, si_unit
from tvimdesign.report.output.command import Command, design_file, record_files
from tvimdesign.report.output.numbers import curves_csv, finite, finite_in, head, in_unit
from tvimdesign.report.output.page_sections import grid
from tvimdesign.report.output.plot_process import Drawing
from tvimdesign.report.page.blocks import Block, Drawn, Grid, Points, Section
from tvimdesign.simulation.trial import Trial
from tvimdesign.simulation.virtual_tests import find_test
from tvimdesign.simulation.working_cycle.device_functions import ResolvedModule, resolve_design, resolve_study
from tvimdesign.study import Study, read_design, read_tree, study_file, tree_of_file


def simulate_study(
    path: Path, test: str, out: Path, *, overwrite: bool, as_json: bool, settings: Sequence[str] = ()
) -> None:
    """Test a study's module and write the folder. Raises InputError, and TvimError once all but the figure is done."""
    do = find_test(test)
    source = design_file(path)
    resolved, module = _rig(source, settings)
    study = resolved.study
    with Command(out, overwrite=overwrite, as_json=as_json, plots=study.write.plots) as command:
        folder = command.folder
        command.progress(f"{test}: testing {study.name}")
        trial = do(resolved)
        trial = replace(trial, notes=(*module, *trial.notes))
        figure = figure_data(trial)
        command.begin_plots([Drawing(trial.test, "virtual_test_figures.trial", figure)], study.name)
        reported = findings(trial)
        tested = source.read_bytes() if source.suffix == ".json" else study_file(tree_of_file(source, settings))
        folder.write(f"tested{source.suffix}", tested)
        folder.write_json("findings.json", reported)
        for sheet in trial.sheets:
            columns, units = {c.name: c.shown for c in sheet.columns}, {c.name: c.unit for c in sheet.columns}
            folder.write(f"{sheet.name}.csv", curves_csv(columns, units, "1"))
        command.finish_plots()
        text = tested.decode() if isinstance(tested, bytes) else tested
        drawn = Drawn("curves", "lines.js", trial.title, figure, libraries=["echarts"])
        first: list[Block] = [findings_table(trial), Points(trial.notes)]
        page = command.page(
            f"{study.name}: {trial.title}", f"virtual test {trial.test}", "TESTED", first,
            [Section("curves", "Curves", [drawn])], study=text,
            files={f"{sheet.name}.csv": f"{sheet.name.replace('_', ' ')} as CSV" for sheet in trial.sheets},
        )  # fmt: skip
        choices = {row.name: getattr(resolved.values[row.name], "name", "") for row in resolved.table.choices}
        inputs = {"tested": source, **record_files(study, choices)}
        command.finish("tested", inputs, study.model_dump(mode="json"), page=page)
    command.report(reported, "Curves, figure and findings are")


def _rig(source: Path, settings: Sequence[str]) -> tuple[ResolvedModule, list[str]]:
    """Return the module of a study or of a design, and which one that is, in a sentence; ratings a design is beyond."""
    if source.suffix == ".json":
        if settings:
            raise InputError(f"--set {settings[0]}: {source} is a design, which is finished; give the study's file")
        design = read_design(source)
        study = Study.model_validate(design.study)
        return resolve_design(design), [f"Module: the design {source}.", *design.rating_notes]
    study = read_tree(tree_of_file(source, settings))
    resolved = resolve_study(study)
    if not study.vary:
        return resolved, [f"Module: {source}."]
    return resolved, [
        f"Module: the start of {source}, not its optimum; run it and give the run's design.json to test that."
    ]


def findings(trial: Trial) -> dict[str, Any]:
    """Return what was read off a test as plain data, every number in its unit."""
    return {
        **head(),
        "test": trial.test,
        "title": trial.title,
        "findings": [
            {
                "name": finding.name,
                **{part: finite_in(value, finding.unit) for part, value in finding.parts.items()},
                "unit": pretty(finding.unit),
                "si": {part: finite(value) for part, value in finding.parts.items()}
                | {"unit": pretty(si_unit(finding.unit))},
                "meaning": finding.meaning,
            }
            for finding in trial.findings
        ],
        "notes": list(trial.notes),
    }


def figure_data(trial: Trial) -> dict[str, Any]:
    """Return what the figure of a test is drawn from: every panel with its lines in the units of the axes."""
    sheets = {sheet.name: {column.name: column.shown for column in sheet.columns} for sheet in trial.sheets}
    panels = []
    for panel in trial.panels:
        lines = []
        for line in panel.lines:
            shown = sheets[line.sheet]
            band = [shown[name] for name in line.band] if line.band else None
            lines.append(
                {"x": shown[line.x], "y": shown[line.y], "band": band, "label": line.label, "dashed": line.dashed}
            )
        panels.append({**vars(panel), "lines": lines})
    return {"title": trial.title, "panels": panels}


def findings_table(trial: Trial) -> Grid:
    """Return what was read off, a row for each finding; of an interval its ends."""
    rows = []
    for finding in trial.findings:
        numbers = [number for part, number in finding.parts.items() if part != "nominal" and number is not None]
        value = " to ".join(in_unit(number, finding.unit) for number in numbers)
        rows.append((finding.name, value, pretty(finding.unit), finding.meaning))
    return grid("", ("finding", "value", "unit", "meaning"), rows, right=(1,))
