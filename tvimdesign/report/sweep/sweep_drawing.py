"""The figure of a sweep: drawn by a process of its own, or kept where an earlier sweep of the folder drew the same."""

from __future__ import annotations

import hashlib
import json
from contextlib import ExitStack
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from tvimdesign import __version__
from tvimdesign.report.figures.plot_process import Drawing, PlotProcess
from tvimdesign.report.output.results_folder import ResultsFolder
from tvimdesign.report.sweep.cell_table import CellTable
from tvimdesign.report.sweep.sweep_plot_data import figure_data
from tvimdesign.sweep.plan import SweepPlan

DRAWN_FROM = "drawn_from"
"""Name of the figure's mark in sweep.json."""


@dataclass(frozen=True)
class KeptFigure:
    """Files of a figure, and the mark of what it was drawn from; both empty where there is none."""

    mark: str = ""
    files: dict[str, bytes] = field(default_factory=dict)


def mark_of(data: dict[str, Any], *, vector: bool) -> str:
    """Mark of a figure: of its data, its forms, and the version that draws it."""
    text = json.dumps([__version__, vector, data], sort_keys=True)
    return hashlib.sha256(text.encode()).hexdigest()[:16]


def kept_figure(folder: Path) -> KeptFigure:
    """The figure that a folder has; its files are read, as a sweep that is resumed clears them away."""
    try:
        mark = json.loads((folder / "sweep.json").read_bytes()).get(DRAWN_FROM, "")
        files = {path.name: path.read_bytes() for path in folder.glob("sweep.*") if path.suffix != ".json"}
    except (OSError, ValueError, AttributeError):
        return KeptFigure()
    return KeptFigure(mark, files) if mark and files else KeptFigure()


class SweepDrawing:
    """What draws the figure of one sweep."""

    def __init__(self, stack: ExitStack, kept: KeptFigure) -> None:
        """Nothing is started yet; what is goes with the stack."""
        self._stack, self._kept = stack, kept
        self._process: PlotProcess | None = None

    def expect(self) -> None:
        """Load what draws while the cells are computed, unless a figure is there that will probably do."""
        if not self._kept.mark:
            self._process = self._stack.enter_context(PlotProcess())

    def draw(self, plan: SweepPlan, seen: CellTable, folder: ResultsFolder) -> str:
        """Put the figure into the folder; returns its mark. Raises TvimError if it cannot be drawn."""
        data, vector = figure_data(plan, seen), plan.study.write.vector
        mark = mark_of(data, vector=vector)
        if mark == self._kept.mark:
            for name, content in self._kept.files.items():
                folder.write(name, content)
            return mark
        process = self._process or self._stack.enter_context(PlotProcess())
        process.begin(folder.path, [Drawing("sweep", "sweep_figure.sweep", data)], plan.study.name, vector=vector)
        folder.look_up_versions()
        process.finish("repeat the command with --resume")
        return mark
