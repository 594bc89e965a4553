"""Loads what every run's figures need, and fills matplotlib's caches, while the solver still works."""

from __future__ import annotations

from importlib import import_module

from tvimdesign.report.figures import bounds_figure, cycle_figures, module_figures
from tvimdesign.report.figures.theme.axes import log_ticks
from tvimdesign.report.figures.theme.canvas import new_figure, place, png

LOADED = (bounds_figure, cycle_figures, module_figures)


def warm_up() -> None:
    """Draw something on every kind of axes, so that fonts and caches are loaded before there is work."""
    figure = new_figure(3.0)
    linear, logarithmic = place(figure, 0.5, 0.5, 2.0, 2.0), place(figure, 4.0, 0.5, 2.0, 2.0)
    linear.plot([0.0, 1.0], label="°")
    linear.barh([0.0], [1.0], hatch="//")
    linear.legend(title="text")
    logarithmic.semilogy([1.0, 1e3])
    log_ticks(logarithmic.yaxis)
    png(figure)
    import_module("fontTools.subset")  # what cuts a PDF's fonts
