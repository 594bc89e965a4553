"""The command atlas: its rows, its page, and from a plan to a finished folder."""

import math
import time
from collections import Counter
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from tvimdesign.base.units import from_si
from tvimdesign.report.output.command import Command
from tvimdesign.report.output.numbers import axis_label, csv_text, head, number
from tvimdesign.report.output.page_sections import grid, number_cell
from tvimdesign.report.output.plot_process import Drawing
from tvimdesign.report.page.blocks import Cell, Drawn, Facts, Grid, Head, Page, Section
from tvimdesign.report.page.page_file import FILE
from tvimdesign.study.atlas_studies import Atlas
from tvimdesign.study.written_studies import study_text
from tvimdesign.sweep.atlas import FAMILIES, OUTPUTS, AtlasCell, cells_of, compute, front_of, study_of

STUDIES = "studies"
_OPEN = "unanswered"  # Status of a cell that no search decided
_UNITS = dict(zip(OUTPUTS, ("g", "N*m", "N*m/rad", "s", "J", "mm"), strict=True))
_BRUSHED = ("cycle_time", "module_mass", "holding_torque", "cycle_energy", "envelope_diameter")


def rows_of(cells: Sequence[AtlasCell]) -> list[dict[str, Any]]:
    """Return a row a cell in the units of its columns; empty cells have the limits that end them.

    An end at a time that never comes is nothing.
    """
    rows = []
    for cell in cells:
        there = cell.has_design
        row: dict[str, Any] = {
            "kind": cell.kind, "torque [N*m]": cell.torque, "cycle [s]": cell.cycle, "status": cell.status,
            "hardware": cell.hardware, "density [N*m/kg]": cell.density if there else None,
        }  # fmt: skip
        for name in OUTPUTS:
            row[f"{name} [{_UNITS[name]}]"] = from_si(cell.values[name], _UNITS[name]) if there else None
        for name, (low, high) in cell.intervals.items():
            row |= {
                f"{name} {end}": each if math.isfinite(each) else None for end, each in (("low", low), ("high", high))
            }
        rows.append({**row, "limits": "; ".join(cell.limits)})
    return rows


def figure_data(plan: Atlas, cells: Sequence[AtlasCell]) -> dict[str, Any]:
    """Return a series of each kind: the designs of its front, with energy and interval."""
    series = []
    for kind, entry in plan.kinds.items():
        front = front_of(cell for cell in cells if cell.kind == kind)
        series.append(
            {
                "label": entry["title"],
                "cycle": [cell.cycle_time for cell in front],
                "density": [cell.density for cell in front],
                "energy": [cell.values["cycle_energy"] for cell in front],
                "bands": [cell.band for cell in front],
            }
        )
    modules = sorted((cell for cell in cells if cell.has_design), key=lambda cell: cell.density)
    densest = {(cell.torque, cell.cycle): cell.density for cell in modules}
    density = [[densest.get((torque, cycle)) for cycle in plan.cycles] for torque in plan.torques]
    doubtful = {(cell.torque, cell.cycle) for cell in cells if cell.status == _OPEN} - densest.keys()
    places = [[plan.cycles.index(cycle), plan.torques.index(torque)] for torque, cycle in sorted(doubtful)]
    return {
        "series": series,
        "map": {"torques": plan.torques, "cycles": plan.cycles, "density": density, "unanswered": places},
        "caption": "Larger marks: more energy a cycle. Thin lines: intervals of assumed values. Grey: empty; ?: open.",
    }


def ending_limits(cells: Sequence[AtlasCell]) -> str:
    """Return the limits that most often come first in empty cells, with their shares."""
    first = Counter(cell.limits[0] for cell in cells if cell.status == "empty" and cell.limits)
    total = sum(first.values())
    return ", ".join(f"{text} ({100.0 * times / total:.0f} %)" for text, times in first.most_common(3))


def atlas_page(plan: Atlas, cells: Sequence[AtlasCell], counts: Mapping[str, float], command: Command) -> Page:
    """Return the page of an atlas."""
    statuses = Counter(cell.status for cell in cells)
    answered = sum(count for status, count in statuses.items() if status != _OPEN)
    facts = [
        ("Torque, cycle", f"{_ends(plan.torques)} N·m, {_ends(plan.cycles)} s"),
        ("Soft", f"at most {plan.softness:g} N·m/rad a newton metre of torque held"),
        ("Cells", f"{len(cells)}: {', '.join(f'{count} {status}' for status, count in statuses.items())}"),
        ("Families", f"{counts['families']:g}, {counts['computed']:g} computed now"),
    ]
    for kind, entry in plan.kinds.items():
        facts.append((kind, _in_short(entry["title"], [cell for cell in cells if cell.kind == kind])))
    modules = [cell for cell in cells if cell.has_design]
    sections = [
        Section("map", "Map", [_brushed(cells, command.out), _grid(modules)]),
        Section("empty", "Empty cells", [_empty([cell for cell in cells if not cell.has_design])]),
    ]
    files = {"atlas.csv": "every cell", "atlas.png": "the figure", "atlas.svg": "for print", "atlas.pdf": "for print"}
    verdict = f"{number(100.0 * answered / len(cells))} % of the cells answered"
    return command.page("Atlas", "the lightest modules", verdict, [Facts(facts)], sections, files=files)


def _ends(values: Sequence[float]) -> str:
    return f"{values[0]:g} to {values[-1]:g}"


def _in_short(title: str, cells: Sequence[AtlasCell]) -> str:
    modules = [cell for cell in cells if cell.has_design]
    if not modules:
        return f"{title}: no design"
    fastest, densest = min(modules, key=lambda c: c.cycle_time), max(modules, key=lambda c: c.density)
    sentences = [
        f"{title}: {len(modules)} modules", f"fastest {number(fastest.cycle_time)} s at {fastest.torque:g} N·m",
        f"most torque a mass {number(densest.density)} N·m/kg at {densest.torque:g} N·m",
    ]  # fmt: skip
    ends = ending_limits(cells)
    return "; ".join([*sentences, *([f"ended by {ends}"] if ends else [])])


def module_points(rows: Sequence[Mapping[str, Any]]) -> dict[str, Any]:
    """Return the rows with a module as points, numbered as in the table of modules."""
    modules = [row for row in rows if row["density [N*m/kg]"] is not None]
    kinds = list(dict.fromkeys(row["kind"] for row in rows))
    columns = {"torque": "torque [N*m]", "density": "density [N*m/kg]"}
    columns |= {name: f"{name} [{_UNITS[name]}]" for name in _BRUSHED}
    labels = ["torque asked [N·m]", "torque over mass [N·m/kg]", *(axis_label(name, _UNITS[name]) for name in _BRUSHED)]
    points = [
        {
            "number": number, "status": row["kind"], "hollow": False, "group": kinds.index(row["kind"]),
            "values": [row[column] for column in columns.values()],
        }
        for number, row in enumerate(modules, start=1)
    ]  # fmt: skip
    words = {"title": "Modules", "one": "module", "many": "modules"}
    return {"of": ["cycle_time", "density"], "names": list(columns), "labels": labels, "points": points, "words": words}


def _brushed(cells: Sequence[AtlasCell], folder: Path) -> Drawn:
    says = (
        "Each point is the lightest module of a cell. Drag along an axis below to keep only what lies within. Click a "
        f"point for its row and study; `tvimdesign explore {folder}` shows it in 3-D."
    )
    return Drawn("brushed", "front.js", says, module_points(rows_of(cells)), libraries=["echarts"])


def _grid(modules: Sequence[AtlasCell]) -> Grid:
    limits = [Head("torque [N·m]", True), Head("cycle [s]", True)]
    outputs = [Head(axis_label(name, _UNITS[name]), True) for name in OUTPUTS]
    heads = [Head("cell"), Head("kind"), *limits, Head("hardware"), Head("N·m/kg", True), *outputs, Head("study")]
    rows = []
    for place, cell in enumerate(modules, start=1):
        numbers = [cell.density, *(from_si(cell.values[name], _UNITS[name]) for name in OUTPUTS)]
        study = Cell("", links=[(f"{cell.name}.yaml", f"{STUDIES}/{cell.name}.yaml")])
        rows.append([Cell(str(place), place), Cell(cell.kind), number_cell(cell.torque), number_cell(cell.cycle),
                     Cell(cell.hardware), *map(number_cell, numbers), study])  # fmt: skip
    return Grid("Modules", heads, rows)


def _empty(cells: Sequence[AtlasCell]) -> Grid:
    heads = ("kind", "torque [N·m]", "cycle [s]", "status", "limits that end it")
    rows = [(c.kind, number(c.torque), number(c.cycle), c.status, "; ".join(c.limits)) for c in cells]
    return grid("Cells without a module", heads, rows, right=(1, 2), code=())


SUMMARY = "atlas.json"  # File of every row, with counts


def make_atlas(
    plan: Path | None, out: Path, *, kinds: tuple[str, ...], workers: int, overwrite: bool, resume: bool, plots: bool,
    as_json: bool, reuse: tuple[Path, ...] = (),
) -> None:  # fmt: skip
    """Compute an atlas, with the families of others, and write its folder. Raises InputError, OutputError."""
    atlas, began = Atlas.read(plan).only(kinds), time.perf_counter()
    command = Command(out, overwrite=overwrite, as_json=as_json, plots=plots, resume=resume, keep=FAMILIES)
    with command:
        folder = command.folder
        counts, failures = compute(atlas, folder.path, workers, command.progress, reuse)
        command.failures += failures
        command.progress("gathering the cells")
        cells = cells_of(atlas, folder.path)
        rows = rows_of(cells)
        folder.write("atlas.csv", csv_text(rows, list(dict.fromkeys(name for row in rows for name in row))))
        for cell in cells:
            if cell.has_design:
                text = study_text(study_of(atlas, cell), f"Cell {cell.name} of an atlas", folder.path)
                folder.write(f"{STUDIES}/{cell.name}.yaml", text)
        summary = {
            **head(), "cells": len(cells), "statuses": dict(Counter(cell.status for cell in cells)), **counts,
            "rows": rows,
        }  # fmt: skip
        folder.write_json(SUMMARY, summary)
        command.begin_plots([Drawing("atlas", "analysis_figures.atlas", figure_data(atlas, cells))], "Atlas")
        page = atlas_page(atlas, cells, counts, command)
        command.shown = command.shown[:1]  # the tables are in the page and in atlas.csv
        command.finish_plots(again="repeat the command with --resume")
        command.finish("mapped", {"plan": plan} if plan else {}, {}, {"seconds": time.perf_counter() - began}, page)
    command.report(summary, f"{FILE}, atlas.csv and {STUDIES}/ are")
