"""The figures of virtual tests and of the paper's case: each takes plain data and returns a matplotlib figure."""

from __future__ import annotations

import math
from typing import Any

from matplotlib.figure import Figure
from matplotlib.ticker import NullLocator

from tvimdesign.report.figures.canvas import new_figure

_ACROSS = 3
_DECADES_SHOWN = 1e10
"""Largest over smallest value of a logarithmic axis: what is smaller is nothing, and would press all else flat."""


def trial(data: dict[str, Any]) -> Figure:
    """The panels of a virtual test side by side, at most three in a row; bands where the layer's history decides."""
    panels = data["panels"]
    down = -(-len(panels) // _ACROSS)
    across = -(-len(panels) // down)
    key = 0.15 * max(len(panel["lines"]) for panel in panels) + 0.2  # inches of legend below each panel
    width, height = 4.6 * across + 0.55, (3.9 + key) * down + 0.1
    figure = new_figure(width, height)
    grid = figure.subplots(down, across, squeeze=False).ravel()
    for axes, panel in zip(grid, panels, strict=False):
        _panel(axes, panel)
    for axes in grid[len(panels) :]:
        axes.set_axis_off()
    figure.suptitle(data["title"], y=1.0 - 0.14 / height, va="top")
    figure.subplots_adjust(left=0.95 / width, right=1.0 - 0.15 / width, bottom=(0.5 + key) / height,
                           top=1.0 - 0.8 / height, wspace=0.28, hspace=0.34 + key / 3.0)  # fmt: skip
    return figure


_STYLES = ("-", ":", "-.", (0, (1, 3)))
"""Lines of one colour, in the order in which they come."""


def _panel(axes: Any, panel: dict[str, Any]) -> None:
    """One pair of axes of a virtual test; a colour for each beginning of a label."""
    styles: dict[str, list[Any]] = {}
    for line in panel["lines"]:
        family = line["label"].partition(",")[0]
        left = styles.setdefault(family, list(_STYLES))
        colour = f"C{list(styles).index(family)}"
        style = "--" if line["dashed"] else left.pop(0) if left else "-"
        axes.plot(line["x"], line["y"], color=colour, linestyle=style, label=line["label"])
        if line["band"]:
            axes.fill_between(line["x"], *line["band"], color=colour, alpha=0.15, linewidth=0.0)
    if panel["log_x"]:
        axes.set_xscale("log")
    if panel["log_y"]:
        _logarithmic(axes, panel["lines"])
    axes.set(xlabel=panel["x_label"], ylabel=panel["y_label"], title=panel["title"])
    axes.legend(fontsize=7, loc="upper center", bbox_to_anchor=(0.5, -0.16))


def _logarithmic(axes: Any, lines: list[dict[str, Any]]) -> None:
    """A logarithmic y axis that shows no more decades than there is something on."""
    axes.set_yscale("log", nonpositive="clip")
    drawn = [value for line in lines for part in (line["y"], *(line["band"] or ())) for value in part if value > 0.0]
    least, most = max(min(drawn), max(drawn) / _DECADES_SHOWN), max(drawn)
    axes.set_ylim(least / 1.5, most * 1.5)
    if most / least > 100.0:  # minor ticks take longer to draw than all else; within a decade they are the only ones
        axes.yaxis.set_minor_locator(NullLocator())


_PLACES = {"near_face_time": "near face at its target", "mean_time": "mean at its target",
           "far_face_time": "far face at its target", "softening_time": "joint soft"}  # fmt: skip


def level_sets(data: dict[str, Any]) -> Figure:
    """Thickness that gives one response time against other parameters, a line for each place of the sensor."""
    figure = new_figure(4.2 * len(data["panels"]), 4.5)
    every = figure.subplots(1, len(data["panels"]), sharey=True, squeeze=False)[0]
    for axes, one in zip(every, data["panels"], strict=True):
        for place, label in _PLACES.items():
            line = [math.nan if y is None else y for y in one["lines"][place]]
            none = all(math.isnan(y) for y in line)
            axes.plot(one["x"], line, marker=".", label=f"{label}: none here" if none else label)
        axes.plot(*one["published"], "k+", markersize=10, label="as assumed here")
        axes.set(xlabel=one["label"], ylim=(0.0, data["range"][1]))
        if one["logarithmic"]:
            axes.set_xscale("log")
        axes.legend(fontsize=7)
    every[0].set_ylabel("thickness of the layer (mm)")
    figure.suptitle(f"What gives {data['wanted']:g} s: thickness from {data['range'][0]:g} to {data['range'][1]:g} mm")
    figure.subplots_adjust(left=0.06, right=0.98, bottom=0.14, top=0.9, wspace=0.08)
    return figure


def tornado(data: dict[str, Any]) -> Figure:
    """Ratio of compression to shear time: a bar for each input through its range, a mark for each other choice."""
    bars, choices, middle = data["bars"][::-1], data["choices"][::-1], data["ratio"]
    figure = new_figure(9.0, 1.2 + 0.3 * (len(bars) + len(choices)))
    axes = figure.subplots()
    for i, choice in enumerate(choices):
        axes.plot(choice["ratio"], i, "D", color="tab:green")
        axes.text(choice["ratio"], i + 0.15, f"{choice['ratio']:.2f}", fontsize=7, ha="center", va="bottom")
    for i, bar in enumerate(bars, start=len(choices)):
        for end, ratio, colour in zip(bar["ends"], bar["ratios"], ("tab:blue", "tab:orange"), strict=True):
            if ratio is not None:  # one of the two never gets there
                axes.barh(i, ratio - middle, left=middle, color=colour, height=0.7)
                axes.text(ratio, i, f" {end} ", fontsize=7, va="center", ha="left" if ratio > middle else "right")
    axes.axvline(middle, color="black", linewidth=0.8)
    labels = [choice["label"] for choice in choices] + [bar["label"] for bar in bars]
    axes.set(yticks=range(len(labels)), yticklabels=labels, xlabel="time in compression over time in shear")
    axes.tick_params(axis="y", labelsize=7)
    axes.grid(axis="y", visible=False)
    axes.margins(x=0.1, y=0.02)
    figure.suptitle("The paper's 2 : 1, with each assumed input alone through its plausible range")
    inches = figure.get_figheight()
    figure.subplots_adjust(left=0.42, right=0.98, bottom=0.5 / inches, top=1.0 - 0.4 / inches)
    return figure
