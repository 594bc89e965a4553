"""The figure of a spread: what each output's variance is made of, and how the modules lie about their limits."""

from __future__ import annotations

from typing import Any

from matplotlib.figure import Figure

from tvimdesign.report.figures.canvas import new_figure

_COLOURS = ["#4477aa", "#ee6677", "#228833", "#ccbb44", "#66ccee", "#aa3377", "#bbbbbb"]


def spread(data: dict[str, Any]) -> Figure:
    """Bars of contributors on the left, histograms with limits on the right."""
    panels = data["panels"]
    down = max((len(panels) + 1) // 2, 1)
    figure = new_figure(13.0, max(4.0, 2.3 * down))
    grid = figure.add_gridspec(down, 3, width_ratios=[1.5, 1.0, 1.0])
    bars = figure.add_subplot(grid[:, 0])
    left = [0.0] * len(data["outputs"])
    for i, part in enumerate(data["parts"]):
        bars.barh(data["outputs"], part["shares"], left=left, color=_COLOURS[i % len(_COLOURS)], label=part["name"])
        left = [a + b for a, b in zip(left, part["shares"], strict=True)]
    bars.invert_yaxis()
    bars.set(xlabel="share of the variance (%)", xlim=(0.0, 100.0))
    bars.tick_params(axis="y", labelsize=8)
    bars.grid(visible=False)
    bars.legend(fontsize=7, ncols=2, loc="lower center", bbox_to_anchor=(0.4, 1.0))
    for i, panel in enumerate(panels):
        axes = figure.add_subplot(grid[i // 2, 1 + i % 2])
        axes.stairs(panel["counts"], panel["edges"], fill=True, color="#4477aa", alpha=0.6)
        for limit in panel["limits"]:
            axes.axvline(limit, color="#ee6677", linewidth=1.5)
        axes.axvline(panel["as_drawn"], color="black", linewidth=0.8, linestyle=":")
        axes.set_title(panel["title"], fontsize=8)
        axes.set(yticks=[])
        axes.tick_params(axis="x", labelsize=8)
        axes.grid(visible=False)
    figure.subplots_adjust(left=0.15, right=0.985, bottom=0.1, top=0.84, hspace=0.75, wspace=0.12)
    return figure
