"""The figures of a comparison: fronts of every study on one pair of axes, heat through the polymer side by side."""

from __future__ import annotations

from typing import Any

from matplotlib.cm import ScalarMappable
from matplotlib.colors import Normalize
from matplotlib.figure import Figure

from tvimdesign.report.figures.canvas import new_figure

_MARKS = "osD^vP"


def fronts(data: dict[str, Any]) -> Figure:
    """Fronts of all studies, a panel for each pair of outputs; the optimum of each study is filled."""
    figure = new_figure(5.6 * len(data["panels"]), 4.6)
    every = figure.subplots(1, len(data["panels"]), squeeze=False)[0]
    for axes, panel in zip(every, data["panels"], strict=True):
        for i, line in enumerate(panel["lines"]):
            mark = _MARKS[i % len(_MARKS)]
            axes.plot(line["x"], line["y"], color=f"C{i}", marker=mark, markerfacecolor="white", label=line["label"])
            axes.plot(*line["optimum"], color=f"C{i}", marker=mark, linestyle="", markersize=8)
        axes.set(xlabel=panel["x_label"], ylabel=panel["y_label"])
        axes.legend(fontsize=8)
    figure.suptitle(data["title"])
    figure.subplots_adjust(left=0.09, right=0.98, bottom=0.13, top=0.9, wspace=0.25)
    return figure


def heat(data: dict[str, Any]) -> Figure:
    """Temperature through the polymer over time while it heats, every study on the same scale of colours."""
    studies = data["studies"]
    figure = new_figure(4.8 * len(studies) + 1.0, 4.2)
    every = figure.subplots(1, len(studies), squeeze=False)[0]
    scale = Normalize(data["coldest"], data["hottest"])
    for axes, one in zip(every, studies, strict=True):
        axes.pcolormesh(one["time"], one["depth"], one["temperature"], shading="gouraud", cmap="inferno", norm=scale)
        axes.contour(one["time"], one["depth"], one["temperature"], levels=data["melting"], colors="white",
                     linewidths=0.8)  # fmt: skip
        axes.set(xlabel="time (s)", title=one["label"])
        axes.grid(visible=False)
    every[0].set_ylabel("depth from the Peltier pads (mm)")
    figure.subplots_adjust(left=0.08, right=0.88, bottom=0.13, top=0.85, wspace=0.2)
    place = figure.add_axes((0.9, 0.13, 0.015, 0.72))
    figure.colorbar(ScalarMappable(scale, "inferno"), cax=place, label="temperature (°C)")
    figure.suptitle(data["title"])
    return figure
