"""Level sets of the paper's response time: its module with another thickness, contact, current or sensor place.

The paper states one time and neither thickness nor contacts; many designs keep it. `write_level_sets` computes them for
the reconstructed module and writes tables and a figure; beside them, what the ratio of both modes hangs on.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

import numpy as np

from tvimdesign.base.units import from_si, pretty
from tvimdesign.report.output.command import Command
from tvimdesign.report.output.numbers import csv_text
from tvimdesign.report.output.plot_process import Drawing
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


def write_level_sets(out: Path, *, overwrite: bool, as_json: bool) -> None:
    """Compute and draw them, and write the folder. Raises InputError where the folder is in use.

    Raises TvimError once all but the plots is done. Nothing is printed for scripts: the paper check was.
    """
    model, wanted, thin = published_model(), from_paper("response_time"), list(THICKNESSES)
    with Command(out, overwrite=overwrite, as_json=as_json, plots=True) as command:
        folder, say = command.folder, command.progress
        sets = [level_set(model, name, list(values), thin, wanted, say) for name, values in AGAINST.items()]
        say("what the ratio of compression to shear hangs on: every assumed input through its range")
        case = Drawing("paper_case", "comparison_figures.tornado", paper_case.figure_data())
        lines = Drawing("level_sets", "comparison_figures.level_sets", _figure_data(sets, model, wanted))
        command.begin_plots([lines, case], "The paper's module, reconstructed")
        units = {each.parameter: model.table.unit(each.parameter) for each in sets}
        folder.write("level_sets.csv", _table(_line_rows(sets, units)))
        folder.write("response_times.csv", _table(_time_rows(sets, units)))
        folder.write("paper_case.csv", _table(paper_case.table_rows()))
        folder.write("paper_case_choices.csv", _table(paper_case.alternative_rows()))
        command.finish_plots("drawing")
        command.finish("evaluated", {}, {})
    command.report(None, "What gives the paper's response times is")


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


def _line_rows(sets: list[LevelSet], units: dict[str, str]) -> Iterable[dict[str, str | float]]:
    for each in sets:
        for i, value in enumerate(each.values):
            lines = {f"pcl_thickness for {place} [mm]": 1e3 * each.line[place][i] for place in PLACES}
            yield {**_place(each, float(value), units), **lines}


def _time_rows(sets: list[LevelSet], units: dict[str, str]) -> Iterable[dict[str, str | float]]:
    for each in sets:
        for i, value in enumerate(each.values):
            for j, thickness in enumerate(each.thicknesses):
                times = {f"{place} [s]": each.times[place][i, j] for place in PLACES}
                yield {**_place(each, float(value), units), "pcl_thickness [mm]": 1e3 * thickness, **times}


def _place(each: LevelSet, value: float, units: dict[str, str]) -> dict[str, str | float]:
    unit = units[each.parameter]
    return {"parameter": each.parameter, "value": from_si(value, unit), "unit": unit}


def _table(rows: Iterable[Mapping[str, str | float]]) -> str:
    """Return rows as CSV; a number that is none is empty."""
    return csv_text(({name: _cell(cell) for name, cell in row.items()} for row in rows), digits=6)


def _cell(value: str | float) -> str | float | None:
    return value if isinstance(value, str) or math.isfinite(value) else None
