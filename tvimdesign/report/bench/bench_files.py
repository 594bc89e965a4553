"""The command `bench`: a folder of tests for who builds a module, and the filled folder against the prediction."""

from __future__ import annotations

import json
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
from rich.console import Console
from rich.markup import escape

from tvimdesign.base.errors import InputError
from tvimdesign.base.units import from_si, pretty
from tvimdesign.base.yaml_data import plain_data
from tvimdesign.report.fit.fit_files import estimates, fit_data, from_si_array
from tvimdesign.report.output.command import Command, design_file
from tvimdesign.report.output.numbers import number
from tvimdesign.report.output.page_sections import grid
from tvimdesign.report.output.plot_process import Drawing
from tvimdesign.report.output.terminal import print_grid
from tvimdesign.simulation.measurement import bench_tests
from tvimdesign.simulation.measurement.bench_tests import Columns
from tvimdesign.simulation.measurement.measure_files import Measured, kind_sheet, measure_files
from tvimdesign.simulation.measurement.measurement import LEAST_ROWS
from tvimdesign.simulation.measurement.reading.data_file import Block
from tvimdesign.simulation.measurement.record_file import NoRecordError, write_records
from tvimdesign.simulation.working_cycle.resolved_module import ResolvedModule, resolve_design
from tvimdesign.solve.uncertainty.uncertain_inputs import unmeasured_inputs
from tvimdesign.study.design import Design, read_design, write_design

_DATA = "data.csv"


@dataclass(frozen=True)
class Prediction:
    """A test of a module: what its columns are by the model, and between which ends the measured ones may lie."""

    name: str
    columns: Columns
    low: Columns
    high: Columns
    settings: Mapping[str, str]
    explains: tuple[str, ...]
    holding: str
    """Torque that the weakest part of the frozen joint bears."""

    @property
    def of_first_specimen(self) -> Prediction:
        """Return the rows of the first specimen: what is predicted is the same for all."""
        if "specimen" not in self.columns:
            return self
        first = self.columns["specimen"] == self.columns["specimen"][0]
        columns, low, high = (
            {name: values[first] for name, values in part.items()} for part in (self.columns, self.low, self.high)
        )
        return replace(self, columns=columns, low=low, high=high)

    @property
    def sheet(self) -> Mapping[str, Any]:
        """Title, kind, columns and protocol."""
        sheet: Mapping[str, Any] = protocols()[self.name]
        return sheet


@cache
def protocols() -> dict[str, Any]:
    """Return the content of `protocols.yaml`."""
    content: dict[str, Any] = plain_data(Path(__file__).with_name("protocols.yaml").read_text(encoding="utf-8"))
    return content


def write_bench(path: Path, out: Path, filled: Path | None, *, overwrite: bool, plots: bool, as_json: bool) -> None:
    """Write the tests of a result's module, or fit those of a `filled` folder. Raises InputError."""
    source = design_file(path)
    design = read_design(source)
    with Command(out, overwrite=overwrite, as_json=as_json, plots=plots) as command:
        command.progress("predicting the tests")
        predictions = predict(design)
        if not predictions:
            raise InputError(f"{source}: no test of `bench` fits this module")
        shares = _shares(source.with_name("results.json"))
        predictions.sort(key=lambda each: -sum(shares.get(name, 0.0) for name in each.explains))
        write_design(design, command.folder.path / bench_tests.DESIGN)
        measured = _measured(predictions, filled, source, command) if filled else {}
        blocks = {name: done.blocks for name, done in measured.items()}
        command.begin_plots([Drawing("bench", "analysis_figures.bench", _figure(predictions, blocks))], design.name)
        if filled is None:
            for prediction in predictions:
                command.folder.write(f"{prediction.name}/{_DATA}", blank(prediction))
                command.folder.write(f"{prediction.name}/predicted.csv", predicted(prediction))
            command.folder.write("README.md", readme(design, predictions, shares))
        records = {name: _record(name, done, command) for name, done in measured.items()}
        data = {
            "tests": [_entry(prediction, shares) for prediction in predictions],
            "fits": {name: fit_data(done) | {"records": records[name]} for name, done in measured.items()},
        }
        command.folder.write_json("bench.json", data)
        command.finish_plots()
        command.finish("compared" if filled else "written", {"design": source}, design.study)
    where = "Fits, figure and records are" if filled else "Protocols, blank tables and predictions are"
    command.report(data, where, lambda console: _print(predictions, measured, records, console))


def predict(design: Design) -> list[Prediction]:
    """Return the tests that a design's module can be put to."""
    resolved = resolve_design(design)
    values = {**resolved.values, "response_time": design.value("response_time")}
    module = ResolvedModule(resolved.study, values, resolved.current_profiles)
    ranges = {each.name: (each.low, each.high) for each in unmeasured_inputs(resolved)}
    holding, predictions = f"{bench_tests.holding(module):.3g} N.m", []
    for name, (columns_of, settings_of) in bench_tests.TESTS.items():
        if not bench_tests.possible(name, module):
            continue
        explains = bench_tests.explained(name, module)
        drawn = columns_of(module, {})
        moved = [columns_of(module, {each: end}) for each in explains for end in ranges.get(each, ())]
        low, high = ({column: _end(drawn[column], [each[column] for each in moved], sign)
                      for column in protocols()[name]["measured"]} for sign in (-1.0, 1.0))  # fmt: skip
        predictions.append(Prediction(name, drawn, low, high, settings_of(module), explains, holding))
    return predictions


def _end(drawn: Any, moved: Sequence[Any], sign: float) -> Any:
    """Return an end of an interval: the moves to that side together, as their squares add."""
    away = [np.maximum(sign * (each - drawn), 0.0) for each in moved]
    return drawn + sign * np.sqrt(np.sum(np.square(away), axis=0)) if away else drawn


def _shares(results: Path) -> dict[str, float]:
    """Return by input the share of the variance of all outputs that measuring it takes away; empty without results."""
    if not results.exists():
        return {}
    intervals = (json.loads(results.read_text(encoding="utf-8")).get("uncertainty") or {}).get("intervals") or {}
    shares: dict[str, float] = {}
    for interval in intervals.values():
        for name, share in interval["shares"].items():
            shares[name] = shares.get(name, 0.0) + share / len(intervals)
    return shares


def blank(prediction: Prediction) -> str:
    """Return the table to fill in, with headings that `fit` reads and rows that are set."""
    sheet = prediction.sheet
    heads = [f"{name.replace('_', ' ')} [{unit}]" if unit != "1" else name
             for name, unit in {**sheet["set"], **sheet["measured"]}.items()]  # fmt: skip
    rows = zip(*(from_si_array(prediction.columns[name], unit) for name, unit in sheet["set"].items()), strict=True)
    empty = [""] * len(sheet["measured"])
    return "\n".join([";".join(heads), *(";".join([*(f"{x:.6g}" for x in row), *empty]) for row in rows)]) + "\n"


def predicted(prediction: Prediction) -> str:
    """Return what the model predicts for those rows, with the interval of each value."""
    sheet = prediction.sheet
    columns = {f"{name} [{unit}]": from_si_array(prediction.columns[name], unit) for name, unit in sheet["set"].items()}
    for name, unit in sheet["measured"].items():
        for end, values in (("", prediction.columns), (" low", prediction.low), (" high", prediction.high)):
            columns[f"{name}{end} [{unit}]"] = from_si_array(values[name], unit)
    rows = [",".join(f"{x:.6g}" for x in row) for row in zip(*columns.values(), strict=True)]
    return "\n".join([",".join(columns), *rows]) + "\n"


def readme(design: Design, predictions: Sequence[Prediction], shares: Mapping[str, float]) -> str:
    """Return the folder's page: what to measure first, the protocols, and the fields of a published data set."""
    lines = [
        f"# Bench of {design.name}", "",
        "Fill the blank columns of each `data.csv`; `predicted.csv` has the model's values with intervals. Then:", "",
        "```sh", "tvimdesign bench RESULT --measured THIS_FOLDER", "```", "",
        "fits every table that has rows, draws it against the prediction and writes the records.", "",
        "## Measure first", "", "| test | measures | share of the variance |", "|---|---|---|",
    ]  # fmt: skip
    lines += [
        f"| {each.sheet['title']} (`{each.name}/`) | {', '.join(each.explains)} | "
        f"{100.0 * sum(shares.get(name, 0.0) for name in each.explains):.2g} % |"
        for each in predictions
    ]
    if not shares:
        lines += ["", "The result has no intervals: the order is not by their size."]
    for each in predictions:
        words = {**each.settings, "holding": each.holding, "first": _first(each)}
        steps = (step.format(**words) for step in each.sheet["protocol"])
        options = " ".join(f"--set {name}='{text}'" for name, text in each.settings.items())
        lines += [
            "", f"## {each.sheet['title']}", "", *(f"{i}. {step}" for i, step in enumerate(steps, start=1)), "",
            "```sh", f"tvimdesign fit {each.name}/{_DATA} --as {each.sheet['kind']} {options}".rstrip(), "```", "",
            f"Predicted: {_spread(each)}. It measures {', '.join(each.explains)}, and becomes "
            f"`my_records/{kind_sheet(each.sheet['kind']).category}/bench_{each.name}.yaml`.",
        ]  # fmt: skip
    fields = ("DOI of the data", "DOI of the design (design.json)", "Authors with ORCID", "License", "Laboratory",
              "Date", "Instruments, with last calibration", "Batch of polymer, wire and pads",
              "Deviations from the protocol")  # fmt: skip
    lines += ["", "## Publication", "", "| field | |", "|---|---|", *(f"| {field} | |" for field in fields), ""]
    return "\n".join(lines)


def _first(prediction: Prediction) -> str:
    angle = prediction.columns.get("angle")
    return "" if angle is None else f"{from_si(float(angle[0]), 'deg'):.3g} degrees"


def _spread(prediction: Prediction) -> str:
    """Describe the last row of each measured column that is farthest from the first."""
    texts = []
    for name, unit in prediction.sheet["measured"].items():
        values = prediction.columns[name]
        at = int(np.argmax(np.abs(values - values[0])))
        columns = (prediction.low, prediction.columns, prediction.high)
        low, value, high = (number(from_si(float(column[name][at]), unit)) for column in columns)
        texts.append(f"{name.replace('_', ' ')} {value} {pretty(unit)} ({low} to {high}) in row {at + 1}")
    return ", ".join(texts)


def _measured(predictions: Sequence[Prediction], filled: Path, source: Path, command: Command) -> dict[str, Measured]:
    """Fit the tables of a folder that have rows. Raises InputError where none has."""
    done = {}
    for prediction in predictions:
        path = filled / prediction.name / _DATA
        if not path.exists() or not _is_filled(path, prediction):
            continue
        command.progress(f"fitting {prediction.name}")
        settings = {name: str(source) if name == "study" else text for name, text in prediction.settings.items()}
        try:
            done[prediction.name] = measure_files([path], prediction.sheet["kind"], settings)
        except InputError as error:  # the other tests are fitted all the same
            command.failures.append(error)
    if not done:
        raise InputError(f"{filled}: no {_DATA} has {LEAST_ROWS} filled rows; write values into its blank columns")
    return done


def _is_filled(path: Path, prediction: Prediction) -> bool:
    """Return whether a table has more filled cells than the blank one."""
    filled, empty = (sum(map(bool, re.split(r"[;,\t\n]", text.replace(" ", "")))) for text in (
        path.read_text(encoding="utf-8-sig", errors="replace"), blank(prediction)))  # fmt: skip
    return bool(filled >= empty + LEAST_ROWS)


def _record(name: str, done: Measured, command: Command) -> list[str]:
    """Write the records of a fit into the folder; returns their paths there, and notes why there is none."""
    try:
        written = write_records(done, command.folder.path / "my_records", f"bench_{name}")
    except NoRecordError as error:
        command.failures.append(error)
        return []
    return [str(path.relative_to(command.folder.path)) for path in written.values()]


def _figure(predictions: Sequence[Prediction], blocks: Mapping[str, Sequence[Block]]) -> dict[str, Any]:
    """Return the panels: each test over what is set, with what was measured."""
    panels = []
    for prediction in (each.of_first_specimen for each in predictions):
        sheet = prediction.sheet
        over = list(sheet["set"])[-1] if "time" not in sheet["set"] else "time"
        x_unit, tables = sheet["set"][over], blocks.get(prediction.name, ())
        groups: dict[str, list[str]] = {}
        for name, unit in sheet["measured"].items():
            groups.setdefault(unit, []).append(name)
        for unit, names in groups.items():
            panels.append({
                "title": sheet["title"], "x": from_si_array(prediction.columns[over], x_unit).tolist(),
                "x_label": f"{over} / {pretty(x_unit)}",
                "y_label": f"{names[0] if len(names) == 1 else 'temperature'} / {pretty(unit)}",
                "series": [_series(prediction, name, unit, over, x_unit, tables) for name in names],
            })  # fmt: skip
    filled = ", and measured" if blocks else ""
    return {"title": f"Tests of the module: predicted with interval{filled}", "panels": panels}


def _series(
    prediction: Prediction, name: str, unit: str, over: str, x_unit: str, tables: Sequence[Block]
) -> dict[str, Any]:
    pairs = [(block.values(over), block.values(name)) for block in tables if {over, name} <= block.columns.keys()]
    at, seen = (np.concatenate([pair[i] for pair in pairs]) if pairs else np.zeros(0) for i in (0, 1))
    good = np.isfinite(at) & np.isfinite(seen)
    ends = {end: from_si_array(values[name], unit).tolist() for end, values in (
        ("value", prediction.columns), ("low", prediction.low), ("high", prediction.high))}  # fmt: skip
    return {
        "name": name.replace("_temperature", "").replace("_", " "), **ends,
        "at": from_si_array(at[good], x_unit).tolist(), "measured": from_si_array(seen[good], unit).tolist(),
    }  # fmt: skip


def _entry(prediction: Prediction, shares: Mapping[str, float]) -> dict[str, Any]:
    return {
        "name": prediction.name, "kind": prediction.sheet["kind"], "explains": list(prediction.explains),
        "share": sum(shares.get(name, 0.0) for name in prediction.explains), "settings": dict(prediction.settings),
    }  # fmt: skip


def _print(
    predictions: Sequence[Prediction], measured: Mapping[str, Measured], records: Mapping[str, Sequence[str]],
    console: Console,
) -> None:  # fmt: skip
    if not measured:
        order = [(each.name, each.sheet["title"], ", ".join(each.explains)) for each in predictions]
        print_grid(grid("Measure in this order", ("test", "", "measures"), order), console)
        return
    for name, done in measured.items():
        print_grid(estimates(done, protocols()[name]["title"]), console)
        for path in records[name]:
            console.print(f"Record: [bold]{escape(path)}[/bold]", soft_wrap=True)
