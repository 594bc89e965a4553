"""Figures for notebooks and scripts: the same drawings as a run's, as matplotlib figures."""

from __future__ import annotations

import io
from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from tvimdesign.report.figures.plot_process import Drawing

_RESOLUTION = 110
"""Dots per inch on a screen."""


def drawn(drawing: Drawing) -> Figure:
    """Draw a figure that shows in a notebook; the settings of matplotlib outside it stay as they are."""
    import matplotlib as mpl

    with mpl.rc_context():
        from tvimdesign.report.figures.canvas import SETTINGS

        mpl.rcParams.update(SETTINGS)
        room, _, function = drawing.figure.rpartition(".")
        drawn_by = import_module(f"tvimdesign.report.figures.{room or 'run_figures'}")
        return shown(getattr(drawn_by, function)(drawing.data))


def shown(figure: Figure) -> Figure:
    """The figure, of a size for screens, with the picture that a notebook asks for."""
    figure.set_dpi(_RESOLUTION)
    noted: Any = figure
    noted._repr_png_ = lambda: _png(figure)
    return figure


def _png(figure: Figure) -> bytes:
    stream = io.BytesIO()
    figure.savefig(stream, format="png", dpi=_RESOLUTION)
    return stream.getvalue()
