"""The figure of a fit: what was measured, what the equations give, and the residuals below."""

from __future__ import annotations

from typing import Any

from matplotlib.figure import Figure

from tvimdesign.report.figures.theme.axes import TICKS, heading, log_ticks
from tvimdesign.report.figures.theme.canvas import caption, new_figure, place
from tvimdesign.report.figures.theme.style import COLOURS, NAME_STRIP, WIDTH

_ACROSS = 2
_LEFT, _GAP, _HIGH, _LOW, _ABOVE, _BELOW = 0.65, 0.75, 1.5, 0.5, 0.3, 0.5  # inches
_LONGEST = 84  # letters of the titles in a row


def fit(data: dict[str, Any]) -> Figure:
    """Two panels in a row at most."""
    panels = data["panels"]
    down, across = -(-len(panels) // _ACROSS), min(len(panels), _ACROSS)
    row = _HIGH + _LOW + _ABOVE + _BELOW + 0.08
    figure = new_figure(NAME_STRIP + 0.22 + row * down)
    caption(figure, data["title"])
    wide = (WIDTH - _LEFT - 0.15 - _GAP * (across - 1)) / across
    for i, panel in enumerate(panels):
        left = _LEFT + (i % across) * (wide + _GAP)
        bottom = _BELOW + row * (down - 1 - i // across)
        below = place(figure, left, bottom, wide, _LOW)
        above = place(figure, left, bottom + _LOW + 0.08, wide, _HIGH)
        _panel(above, below, panel, _LONGEST // across)
    return figure


def _panel(above: Any, below: Any, panel: dict[str, Any], longest: int) -> None:
    title = panel["title"]
    heading(above, title if len(title) <= longest else "… " + title[-longest:])
    order = sorted(range(len(panel["x"])), key=panel["x"].__getitem__) if panel["log_x"] else range(len(panel["x"]))
    above.plot(panel["x"], panel["measured"], "o", color=COLOURS[0], markersize=2.5, label="measured")
    above.plot([panel["x"][i] for i in order], [panel["fitted"][i] for i in order], color=COLOURS[1], label="fitted")
    below.plot(panel["x"], panel["residual"], "o", color=COLOURS[0], markersize=2.0)
    below.axhline(0.0, color="0.5", linewidth=0.6)
    above.set_ylabel(panel["y_label"])
    below.set_ylabel("residual / σ")
    below.set_xlabel(panel["x_label"])
    above.set_xticklabels([])
    for axes in (above, below):
        axes.locator_params(nbins=TICKS)
        if panel["log_x"]:
            axes.set_xscale("log")
            log_ticks(axes.xaxis)
    if panel["log_y"]:
        above.set_yscale("log")
        log_ticks(above.yaxis)
    above.set_xticklabels([])
    above.legend(loc="best", fontsize=6)
