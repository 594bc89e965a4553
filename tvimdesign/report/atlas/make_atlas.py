"""The command atlas, from a plan to a finished folder."""

import time
from collections import Counter
from pathlib import Path

from tvimdesign.page.page_file import FILE
from tvimdesign.report.atlas.atlas_page import STUDIES, atlas_page, figure_data, rows_of
from tvimdesign.report.output.command import Command
from tvimdesign.report.output.numbers import csv_text, head
from tvimdesign.report.output.plot_process import Drawing
from tvimdesign.solve.nlp.solver_run import OPTIMAL
from tvimdesign.study.atlas_studies import Atlas
from tvimdesign.study.written_studies import study_text
from tvimdesign.sweep.atlas import FAMILIES, cells_of, compute, study_of

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
            if cell.status == OPTIMAL:
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
