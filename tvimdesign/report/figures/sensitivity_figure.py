"""The heat map of sensitivities: percent of each output for one percent of each variable."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.colors import Normalize
from matplotlib.figure import Figure

from tvimdesign.report.figures.canvas import new_figure

_STRONGEST = 3.0
"""Elasticity from which on colours are the same: a few fourth powers would leave all else pale."""
_DARK = 0.6
_WRITTEN = 0.05


def sensitivities(data: dict[str, Any]) -> Figure:
    """Outputs down, variables across; red rises with the variable, blue falls."""
    values = np.array(data["values"])
    down, across = values.shape
    width, height = 3.2 + 0.5 * across, 1.9 + 0.24 * down
    figure = new_figure(width, height)
    axes = figure.subplots()
    axes.imshow(values, aspect="auto", cmap="RdBu_r", norm=Normalize(-_STRONGEST, _STRONGEST))
    for (i, j), value in np.ndenumerate(values):
        if abs(value) >= _WRITTEN:
            colour = "white" if abs(value) > _DARK * _STRONGEST else "black"
            axes.text(j, i, f"{value:.2g}", ha="center", va="center", fontsize=7, color=colour)
    axes.set(xticks=range(across), yticks=range(down), title="Percent of the output for 1 % more of the variable")
    axes.set_xticklabels(data["variables"], rotation=45, ha="right", fontsize=8)
    axes.set_yticklabels(data["outputs"], fontsize=8)
    axes.grid(visible=False)
    figure.subplots_adjust(left=2.3 / width, right=1.0 - 0.2 / width, bottom=1.4 / height, top=1.0 - 0.45 / height)
    return figure
