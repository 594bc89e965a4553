"""The figure of a sweep: a panel an output, lines over what is swept or a cloud over two axes with a scale."""

from __future__ import annotations

from typing import Any

from matplotlib.cm import ScalarMappable
from matplotlib.colors import Normalize
from matplotlib.figure import Figure

from tvimdesign.report.figures.theme.axes import TICKS
from tvimdesign.report.figures.theme.canvas import caption, new_figure, place
from tvimdesign.report.figures.theme.style import BROKEN, SEQUENCE, SMALL, WIDTH, style_of

_EACH = 2.0
"""Inches of a panel."""


def sweep(data: dict[str, Any]) -> Figure:
    """Draw each output; cells that break a limit are hollow."""
    panels, cloud = data["panels"], bool(data["y"])
    labelled = any(series["label"] for panel in panels for series in panel["series"])
    height = 0.75 + len(panels) * (_EACH + 0.3)
    figure = new_figure(height)
    wide = WIDTH - (1.9 if cloud or labelled else 0.9)
    for number, panel in enumerate(panels):
        bottom = 0.55 + (len(panels) - 1 - number) * (_EACH + 0.3)
        axes = place(figure, 0.75, bottom, wide, _EACH)
        last = number == len(panels) - 1
        if cloud:
            _cloud(figure, axes, panel, place(figure, 0.75 + wide + 0.12, bottom, 0.1, _EACH))
        else:
            _lines(axes, panel, joined=data["joined"])
        axes.set(xlabel=data["x"] if last else "", ylabel=data["y"] if cloud else panel["label"])
        axes.locator_params(nbins=TICKS)
        if labelled and not cloud and number == 0:
            figure.legend(
                *axes.get_legend_handles_labels(), loc="upper right", title=data["legend"], title_fontsize=SMALL
            )
    if any(not all(series["kept"]) for panel in panels for series in panel["series"]):
        caption(figure, "Hollow: a limit is broken.")
    return figure


def _lines(axes: Any, panel: dict[str, Any], *, joined: bool) -> None:
    for number, series in enumerate(panel["series"]):
        style = style_of(number)
        if not joined:
            style = {**style, "linestyle": ""}
        axes.plot(series["x"], series["y"], marker="o", markersize=3.5, label=series["label"] or None, **style)
        broken = [(x, y) for x, y, kept in zip(series["x"], series["y"], series["kept"], strict=True) if not kept]
        if broken:
            axes.plot(*zip(*broken, strict=True), linestyle="", marker="o", markersize=3.5, color=BROKEN,
                      markerfacecolor="white")  # fmt: skip


def _cloud(figure: Figure, axes: Any, panel: dict[str, Any], scale: Any) -> None:
    (series,) = panel["series"]
    points = list(zip(series["x"], series["y"], series["colour"], series["kept"], strict=True))
    if not points:
        return
    kept, broken = ([point for point in points if point[3] == which] for which in (True, False))
    ends = {"vmin": min(series["colour"]), "vmax": max(series["colour"])}
    for some, size in ((broken, 5), (kept, 14)):
        if some:
            x, y, colour, _ = zip(*some, strict=True)
            hollow = {"marker": "o", "linewidths": 0.0} if some is kept else {"marker": "."}
            axes.scatter(x, y, c=colour, cmap=SEQUENCE, s=size, **hollow, **ends)
    figure.colorbar(ScalarMappable(Normalize(**ends), SEQUENCE), cax=scale, label=panel["label"])
