"""The heat map of sensitivities: percent of each output for one percent of each variable."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.colors import Normalize
from matplotlib.figure import Figure

from tvimdesign.report.figures.theme.canvas import caption, new_figure, place
from tvimdesign.report.figures.theme.style import WIDTH

_STRONGEST = 3.0
"""Elasticity from which on colours are the same: a few fourth powers would leave all else pale."""
_DARK = 0.6
_WRITTEN = 0.05
_LEFT, _BELOW = 2.3, 1.4  # inches


def sensitivities(data: dict[str, Any]) -> Figure:
    """Outputs down, variables across; red rises with the variable, blue falls, and the number says which."""
    values = np.array(data["values"])
    down, across = values.shape
    width, high = max(WIDTH, _LEFT + 0.35 * across + 0.2), 0.18 * down
    figure = new_figure(high + _BELOW + 0.6, width)
    axes = place(figure, _LEFT, _BELOW, width - _LEFT - 0.2, high)
    axes.imshow(values, aspect="auto", cmap="RdBu_r", norm=Normalize(-_STRONGEST, _STRONGEST))
    for (i, j), value in np.ndenumerate(values):
        if abs(value) >= _WRITTEN:
            colour = "white" if abs(value) > _DARK * _STRONGEST else "black"
            axes.text(j, i, f"{value:+.2g}", ha="center", va="center", fontsize=5.5, color=colour)
    axes.set(xticks=range(across), yticks=range(down))
    axes.set_xticklabels(data["variables"], rotation=45, ha="right", rotation_mode="anchor")
    axes.set_yticklabels(data["outputs"])
    axes.grid(visible=False)
    caption(figure, "Change of the output (%) for 1 % more of the variable")
    return figure
