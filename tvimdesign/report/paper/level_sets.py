"""Level sets of the paper's response time: its module with another thickness, contact, current or sensor place.

The paper states one time and neither thickness nor contacts; many designs keep it. `write_level_sets` computes them for
the reconstructed module and writes tables and a figure; beside them, what the ratio of both modes hangs on.
"""

from __future__ import annotations

import csv
import io
import math
from collections.abc import Iterable
from pathlib import Path
from typing import Any

import numpy as np
from rich.markup import escape

from tvimdesign.base.errors import TvimError
from tvimdesign.base.units import from_si, pretty
from tvimdesign.report.output.command import PARTLY_DONE, done_in_part, noting
from tvimdesign.report.output.plot_process import Drawing, PlotProcess
from tvimdesign.report.output.results_folder import ResultsFolder
from tvimdesign.report.output.terminal import progress_output, wide_console
from tvimdesign.report.paper import paper_case
from tvimdesign.report.paper.paper_case import from_paper, published_model
from tvimdesign.simulation.working_cycle.device_functions import DeviceFunctions
from tvimdesign.solve.sensitivity.response_times import PLACES, LevelSet, level_set

THICKNESSES = np.geomspace(0.2e-3, 2e-3, 8)  # m
AGAINST = {
    "hot_contact": np.geomspace(1e2, 1e5, 13),  # W/m^2 K, from dry to well wetted
    "rotor_contact": np.geomspace(1e2, 1e5, 13),
    "current": np.linspace(1.4, 2.8, 15),  # A
}


def write_level_sets(out: Path, overwrite: bool) -> Path:
    """Compute and draw them, and write the folder; returns it. Raises InputError where the folder is in use.

    Raises TvimError once all but the plots is done.
    """
    model, wanted, thin = published_model(), from_paper("response_time"), list(THICKNESSES)
    failures: list[TvimError] = []
    with ResultsFolder(out, overwrite) as folder, progress_output() as say, PlotProcess() as drawing:
        sets = [level_set(model, name, list(values), thin, wanted, say) for name, values in AGAINST.items()]
        say("what the ratio of compression to shear hangs on: every assumed input through its range")
        case = Drawing("paper_case", "comparison_figures.tornado", paper_case.figure_data())
        say("drawing")
        drawing.begin(
            folder.path,
            [Drawing("level_sets", "comparison_figures.level_sets", _figure_data(sets, model, wanted)), case],
            "The paper's module, reconstructed",
        )
        units = {each.parameter: model.table.unit(each.parameter) for each in sets}
        folder.write("level_sets.csv", _table(_line_rows(sets, units)))
        folder.write("response_times.csv", _table(_time_rows(sets, units)))
        folder.write("paper_case.csv", _table(_in_cells(paper_case.table_rows())))
        folder.write("paper_case_choices.csv", _table(_in_cells(paper_case.alternative_rows())))
        with noting(failures):
            drawing.finish()
        folder.finish(PARTLY_DONE if failures else "evaluated", {}, {})
    if failures:
        raise done_in_part(failures)
    return folder.path


def print_level_sets(out: Path, overwrite: bool, as_json: bool) -> None:
    """Write the folder, and tell people where it is; scripts know."""
    folder = write_level_sets(out, overwrite)
    if not as_json:
        wide_console().print(
            f"\nWhat gives the paper's response times is in [bold]{escape(str(folder))}[/bold]", soft_wrap=True
        )


def _figure_data(sets: list[LevelSet], model: DeviceFunctions, wanted: float) -> dict[str, Any]:
    """Return plain data for the process that draws, in the units people read."""
    ends = [1e3 * float(end) for end in (THICKNESSES[0], THICKNESSES[-1])]
    return {"wanted": wanted, "range": ends, "panels": [_panel(each, model) for each in sets]}


def _panel(level_line: LevelSet, model: DeviceFunctions) -> dict[str, Any]:
    """Return one parameter's lines, a gap being None, and the module as assumed here."""
    row, unit = model.table.quantity(level_line.parameter), model.table.unit(level_line.parameter)
    start = {name: float(model.start[model.index[name]]) for name in (level_line.parameter, "pcl_thickness")}
    return {
        "label": f"{row.description.partition(',')[0]} ({pretty(unit)})",
        "logarithmic": bool(level_line.values[-1] / level_line.values[0] > 10.0),
        "x": [from_si(float(value), unit) for value in level_line.values],
        "lines": {
            place: [None if math.isnan(t) else 1e3 * t for t in level_line.line[place].tolist()] for place in PLACES
        },
        "published": [from_si(start[level_line.parameter], unit), 1e3 * start["pcl_thickness"]],
    }


def _line_rows(sets: list[LevelSet], units: dict[str, str]) -> Iterable[dict[str, str]]:
    for each in sets:
        unit = units[each.parameter]
        for i, value in enumerate(each.values):
            lines = {f"pcl_thickness for {place} [mm]": _cell(1e3 * each.line[place][i]) for place in PLACES}
            yield {"parameter": each.parameter, "value": f"{from_si(float(value), unit):.6g}", "unit": unit, **lines}


def _time_rows(sets: list[LevelSet], units: dict[str, str]) -> Iterable[dict[str, str]]:
    for each in sets:
        unit = units[each.parameter]
        for i, value in enumerate(each.values):
            for j, thickness in enumerate(each.thicknesses):
                times = {f"{place} [s]": _cell(each.times[place][i, j]) for place in PLACES}
                place = {"parameter": each.parameter, "value": f"{from_si(float(value), unit):.6g}", "unit": unit}
                yield {**place, "pcl_thickness [mm]": f"{1e3 * thickness:.6g}", **times}


def _in_cells(rows: Iterable[dict[str, str | float]]) -> Iterable[dict[str, str]]:
    for row in rows:
        yield {name: value if isinstance(value, str) else _cell(value) for name, value in row.items()}


def _cell(value: float) -> str:
    """Return a number, or nothing where there is none."""
    return f"{value:.6g}" if math.isfinite(value) else ""


def _table(rows: Iterable[dict[str, str]]) -> str:
    listed, stream = list(rows), io.StringIO()
    writer = csv.DictWriter(stream, list(listed[0]), lineterminator="\n")
    writer.writeheader()
    writer.writerows(listed)
    return stream.getvalue()
