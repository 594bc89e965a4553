"""The command `fit`: files of measured data to parameters, a folder, and a record that a study names.

A measurement as plain data: parameters with intervals, notes, residuals, and the figure's panels.
"""

import json
import textwrap
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from rich.console import Console
from rich.markup import escape

from tvimdesign.base.errors import InputError
from tvimdesign.base.units import from_si, pretty
from tvimdesign.report.output.command import Command
from tvimdesign.report.output.numbers import finite, head, number, number_entry
from tvimdesign.report.output.page_sections import grid
from tvimdesign.report.output.plot_process import Drawing
from tvimdesign.report.output.terminal import print_grid, wide_console
from tvimdesign.report.page.blocks import Grid
from tvimdesign.simulation.measurement.fitting.fit import Estimate, Fit
from tvimdesign.simulation.measurement.measure_files import Measured, kind_sheets, measure_files
from tvimdesign.simulation.measurement.reading.headings import read_column_map
from tvimdesign.simulation.measurement.record_file import NoRecordError, write_records

_MOST_TABLES = 3  # Tables that the screen shows; `fit.json` has all


def fit_files(
    paths: Sequence[Path], kind: str, out: Path, *, settings: Sequence[str], columns: Path | None, record: str,
    based_on: str, catalog: Path, overwrite: bool, plots: bool, as_json: bool,
) -> None:  # fmt: skip
    """Fit files; write the folder and the record. Raises InputError, and TvimError once all but the figure is done."""
    given = _given(settings)
    column_map = read_column_map(columns) if columns else None
    with Command(out, overwrite=overwrite, as_json=as_json, plots=plots) as command:
        folder = command.folder
        command.progress("fitting")
        measured = measure_files(paths, kind, given, column_map)
        names = ", ".join(path.name for path in paths)
        command.begin_plots([Drawing("fit", "analysis_figures.fit", figure_data(measured))], names)
        written: dict[str, Path] = {}
        try:
            written = write_records(measured, catalog, record, based_on, overwrite=overwrite) if record else {}
        except NoRecordError as error:
            command.failures.append(error)  # its figure and residuals say why
        named = {choice: str(path) for choice, path in written.items()}
        first = next(iter(named.values()), None)
        data = fit_data(measured) | {"settings": dict(given), "record": first, "records": named}
        folder.write_json("fit.json", data)
        folder.write("residuals.csv", residuals_csv(measured.measurement.fit))
        command.finish_plots()
        command.finish("fitted", {path.name: path for path in paths}, {})
    command.report(data, "Values, residuals and figure are", lambda console: _print(measured, written, console))


def list_kinds(as_json: bool) -> None:
    """Print the kinds of measurement with what each needs and what can be set."""
    sheets = kind_sheets().values()
    if as_json:
        print(json.dumps({sheet.name: {"about": sheet.about, "needs": sheet.needs, "settings": dict(sheet.settings)}
                          for sheet in sheets}, indent=2))  # fmt: skip
        return
    console = wide_console()
    for sheet in sheets:
        console.print(f"[bold]{sheet.name}[/bold]: {escape(sheet.about)}")
        console.print(f"  columns: {', '.join(' or '.join(need) for need in sheet.needs)}")
        for name, entry in sheet.settings.items():
            default = f", {entry['default']:g} unless set" if "default" in entry else ""
            console.print(f"  --set {name}=... {escape('[' + entry['unit'] + ']')}: {escape(entry['about'])}{default}")


def _given(settings: Sequence[str]) -> Mapping[str, str]:
    given = {}
    for setting in settings:
        name, sign, value = setting.partition("=")
        if not sign or not value.strip():
            raise InputError(f"--set {setting}: expected a name, `=` and a value, such as arm='100 mm'")
        given[name.strip()] = value.strip()
    return given


def _print(measured: Measured, written: Mapping[str, Path], console: Console) -> None:
    measurement = measured.measurement
    for line in measured.read_for_the_fit(_MOST_TABLES):
        console.print(escape(line), style="dim", soft_wrap=True)
    print_grid(estimates(measured, ""), console)
    for line in (*measurement.notes, *measurement.fit.words):
        console.print(escape(line), soft_wrap=True)
    for i, path in enumerate(written.values()):
        console.print(f"{'' if i else chr(10)}Record: [bold]{escape(str(path))}[/bold]", soft_wrap=True)
    if written:
        named = ", ".join(f"{choice}: {path.stem}" for choice, path in written.items())
        folder = next(iter(written.values())).parent.parent
        console.print(escape(f"In a study: catalog: {folder}, module: {{{named}}}"), soft_wrap=True)


def estimates(measured: Measured, title: str) -> Grid:
    """Return a table of what was fitted, with intervals."""
    fit, rows = measured.measurement.fit, []
    for estimate in (*fit.parameters, *fit.derived):
        ends = ["open" if end is None else number(from_si(end, estimate.unit)) for end in (estimate.low, estimate.high)]
        value = number(from_si(estimate.value, estimate.unit))
        rows.append((estimate.name, value, *ends, pretty(estimate.unit), estimate.meaning))
    heads = ("parameter", "value", "95 % from", "to", "unit", "meaning")
    return grid(title, heads, rows, right=(1, 2, 3))


_MOST_PANELS, _TITLE_LETTERS = 6, 110
_DECADES = 30.0  # Largest over smallest value from which on an axis is logarithmic


def fit_data(measured: Measured) -> dict[str, Any]:
    """Return the content of `fit.json`."""
    measurement = measured.measurement
    names = [parameter.name for parameter in measurement.fit.problem.parameters]
    shown = [names.index(parameter.name) for parameter in measurement.fit.parameters]
    return {
        **head(),
        "kind": measured.kind.name,
        "files": [{"path": str(file.path), "sha256": file.sha256} for file in measured.files],
        "parameters": [_entry(parameter) for parameter in measurement.fit.parameters],
        "derived": [_entry(quantity) for quantity in measurement.fit.derived],
        "correlation": {
            "names": [names[i] for i in shown],
            "rows": [[finite(float(measurement.fit.correlation[i, j])) for j in shown] for i in shown],
        },
        "noise": [
            {"channel": channel.name, "unit": "1" if channel.relative else channel.unit,
             "deviation": noise if channel.relative else from_si(noise, channel.unit) - from_si(0.0, channel.unit),
             "values": len(channel.measured)}
            for channel, noise in zip(measurement.fit.problem.channels, measurement.fit.noise, strict=True)
        ],
        "notes": list(measurement.notes),
        "words": list(measurement.fit.words),
        "misfit": measurement.fit.misfit,
        "read": measured.read(),
    }  # fmt: skip


def _entry(estimate: Estimate) -> dict[str, Any]:
    return {
        "name": estimate.name,
        **number_entry(estimate.value, estimate.unit, (estimate.low, estimate.high)),
        "meaning": estimate.meaning,
    }


def _channels(fit: Fit) -> Iterator[tuple[Any, Any, Any, Any, Any]]:
    """Yield each channel with its places, what was measured and fitted, in units, and its residuals over the noise."""
    for channel, predicted, noise in zip(fit.problem.channels, fit.predicted, fit.noise, strict=True):
        left = np.log(channel.measured / predicted) if channel.relative else channel.measured - predicted
        measured, fitted = (from_si_array(values, channel.unit) for values in (channel.measured, predicted))
        yield channel, from_si_array(channel.at, channel.at_unit), measured, fitted, left / noise


def residuals_csv(fit: Fit) -> str:
    """Return every value with what the fit predicts, in the units of the data; a row each."""
    lines = ["channel,over,over unit,at,unit,measured,fitted,residual over noise"]
    for channel, *columns in _channels(fit):
        name = channel.name.replace(",", ";")
        lines += [
            f"{name},{channel.at_name},{channel.at_unit},{x:.8g},{channel.unit},{y:.8g},{z:.8g},{r:.4g}"
            for x, y, z, r in zip(*columns, strict=True)
        ]
    return "\n".join(lines) + "\n"


def from_si_array(values: Any, unit: str) -> Any:
    """Return values in a unit."""
    zero = from_si(0.0, unit)
    return zero + (from_si(1.0, unit) - zero) * values


def figure_data(measured: Measured) -> dict[str, Any]:
    """Return the panels of the figure: values and curves, each with its residuals below, and why there is no record."""
    fit = measured.measurement.fit
    why = fit.misfit or next((note for note in measured.measurement.notes if "no record" in note.lower()), "")
    sentences = [sentence for sentence in why.split(". ") if sentence]
    reason = textwrap.wrap(f"No record: {sentences[0]}", _TITLE_LETTERS) if sentences else []
    title = "\n".join([f"{measured.kind.name}: measured and fitted", *reason])
    return {"title": title, "panels": list(_panels(fit))}


def _panels(fit: Fit) -> Iterator[dict[str, Any]]:
    """Yield a panel for every channel, the first few of many."""
    for channel, x, measured, fitted, residual in list(_channels(fit))[:_MOST_PANELS]:
        words, _, where = channel.name.partition(" of ")
        yield {
            "title": where.replace("\\", "/").rpartition("/")[-1],  # the file, without its folders
            "x_label": f"{channel.at_name} / {pretty(channel.at_unit)}", "y_label": f"{words} / {pretty(channel.unit)}",
            "log_x": bool(np.min(x) > 0.0 and np.max(x) > _DECADES * np.min(x)), "log_y": channel.relative,
            "x": x.tolist(), "measured": measured.tolist(), "fitted": fitted.tolist(), "residual": residual.tolist(),
        }  # fmt: skip
