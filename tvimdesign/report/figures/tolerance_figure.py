"""The figure of a spread: what each output's variance is made of, and how the modules lie about their limits."""

from __future__ import annotations

from typing import Any

from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from tvimdesign.report.figures.theme.axes import heading, row_texts
from tvimdesign.report.figures.theme.canvas import new_figure, place
from tvimdesign.report.figures.theme.style import BROKEN, COLOURS, FAINT, HATCHES, LIMIT, NAME_STRIP

_ACROSS = 3


def spread(data: dict[str, Any]) -> Figure:
    """Bars of contributors above, histograms with limits below."""
    panels, outputs = data["panels"], data["outputs"]
    down = -(-len(panels) // _ACROSS)
    bars_high, row = 0.17 * len(outputs) + 0.1, 1.85
    keys = 0.14 * -(-len(data["parts"]) // 4) + 0.1
    figure = new_figure(NAME_STRIP + keys + bars_high + 0.5 + row * down + 0.3)
    top = figure.get_figheight() - NAME_STRIP - keys
    _contributors(place(figure, 2.0, top - bars_high, 4.9, bars_high), data)
    for i, panel in enumerate(panels):
        bottom = top - bars_high - 0.5 - row * (i // _ACROSS + 1) + 0.5
        _histogram(place(figure, 0.6 + (i % _ACROSS) * 2.28, bottom, 1.75, 1.0), panel)
    marks = [Line2D([], [], color=BROKEN, linewidth=1.5, label="limit"), Line2D([], [], label="as drawn", **LIMIT)]
    figure.legend(handles=marks, loc="lower center", ncols=2)
    return figure


def _contributors(axes: Any, data: dict[str, Any]) -> None:
    rows = range(len(data["outputs"]))
    left = [0.0] * len(rows)
    for i, part in enumerate(data["parts"]):
        colour = COLOURS[i] if i < len(COLOURS) else FAINT
        axes.barh(rows, part["shares"], left=left, facecolor=colour, hatch=HATCHES[i % len(HATCHES)],
                  edgecolor="white", linewidth=0.3, label=part["name"])  # fmt: skip
        left = [a + b for a, b in zip(left, part["shares"], strict=True)]
    axes.set(xlabel="Share of the variance (%)", xlim=(0.0, 100.0), ylim=(len(rows) - 0.4, -0.6))
    axes.grid(visible=False)
    row_texts(axes, data["outputs"], [])
    axes.legend(ncols=4, loc="lower right", bbox_to_anchor=(1.0, 1.0))


def _histogram(axes: Any, panel: dict[str, Any]) -> None:
    axes.stairs(panel["counts"], panel["edges"], fill=True, color=COLOURS[0], alpha=0.5)
    for limit in panel["limits"]:
        axes.axvline(limit, color=BROKEN, linewidth=1.5)
    axes.axvline(panel["as_drawn"], **LIMIT)
    axes.set(xlabel=panel["label"], ylabel="Modules (count)")
    axes.locator_params(nbins=4)
    axes.grid(visible=False)
    heading(axes, panel["title"])
