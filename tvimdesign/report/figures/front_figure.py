"""The figure of a study's front: one panel for two outputs, three pairs of them for three."""

from __future__ import annotations

import itertools
from typing import Any

from matplotlib.cm import ScalarMappable
from matplotlib.colors import Normalize
from matplotlib.figure import Figure

from tvimdesign.report.figures.theme.axes import TICKS
from tvimdesign.report.figures.theme.canvas import new_figure, place
from tvimdesign.report.figures.theme.style import BROKEN, COLOURS, SEQUENCE, WIDTH, style_of


def front(data: dict[str, Any]) -> Figure:
    """Points of a front, the knee and the weighted optimum; of three outputs the first is the colour of the points."""
    labels, points = data["labels"], data["points"]
    pairs = list(itertools.combinations(range(len(labels)), 2))
    key = 0.62 if len(labels) > 2 else 0.0  # inches below the panels: the scale of colours
    figure = new_figure(2.85 + key)
    gap, left = 0.65, 0.62
    wide = min((WIDTH - left - 0.15 - gap * (len(pairs) - 1)) / len(pairs), 4.5)
    scale = Normalize(min(point[0] for point in points), max(point[0] for point in points))
    for i, (x, y) in enumerate(pairs):
        axes = place(figure, left + i * (wide + gap), 0.45 + key, wide, 1.85)
        across, up = [point[x] for point in points], [point[y] for point in points]
        if len(labels) == 2:
            axes.plot(across, up, marker="o", label="front", **style_of(0))
        else:
            axes.scatter(across, up, c=[point[0] for point in points], cmap=SEQUENCE, norm=scale, s=16, label="front")
        _marks(axes, data, x, y)
        axes.set(xlabel=labels[x], ylabel=labels[y])
        axes.locator_params(nbins=TICKS)
    figure.legend(*axes.get_legend_handles_labels(), loc="upper right", ncols=3)
    if key:
        colours = place(figure, 1.8, 0.4, 3.5, 0.1)
        figure.colorbar(ScalarMappable(scale, SEQUENCE), cax=colours, orientation="horizontal", label=labels[0])
    return figure


def _marks(axes: Any, data: dict[str, Any], x: int, y: int) -> None:
    if data["knee"] is not None:
        knee = data["points"][data["knee"]]
        axes.plot(
            knee[x], knee[y], linestyle="", marker="D", color=BROKEN, markersize=8, fillstyle="none", label="knee"
        )
    optimum = data["optimum"]
    axes.plot(optimum[x], optimum[y], linestyle="", marker="*", color=COLOURS[1], markeredgecolor="black",
              markeredgewidth=0.5, markersize=9, label="weighted optimum")  # fmt: skip
