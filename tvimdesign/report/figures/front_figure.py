"""The figure of a study's front: one panel for two outputs, three pairs of them for three."""

from __future__ import annotations

import itertools
from typing import Any

from matplotlib.figure import Figure

from tvimdesign.report.figures.canvas import new_figure


def front(data: dict[str, Any]) -> Figure:
    """Points of a front, the knee and the weighted optimum; of three outputs the third is the colour of the points."""
    labels, points = data["labels"], data["points"]
    pairs = list(itertools.combinations(range(len(labels)), 2))
    figure = new_figure(5.2 * len(pairs) + 0.6, 4.6)
    every = figure.subplots(1, len(pairs), squeeze=False)[0]
    for axes, (x, y) in zip(every, pairs, strict=True):
        across, up = [point[x] for point in points], [point[y] for point in points]
        if len(labels) == 2:
            axes.plot(across, up, color="C0", marker="o", markersize=4, label="front")
        else:
            (third,) = {0, 1, 2} - {x, y}
            dots = axes.scatter(across, up, c=[point[third] for point in points], cmap="viridis", s=28, label="front")
            figure.colorbar(dots, ax=axes, label=labels[third])
        if data["knee"] is not None:
            knee = points[data["knee"]]
            axes.plot(
                knee[x], knee[y], linestyle="", marker="D", color="C3", markersize=9, fillstyle="none", label="knee"
            )
        optimum = data["optimum"]
        axes.plot(optimum[x], optimum[y], linestyle="", marker="*", color="C1", markersize=12, label="weighted optimum")
        axes.set(xlabel=labels[x], ylabel=labels[y])
    every[0].legend(fontsize=8)
    figure.tight_layout()
    return figure
