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


def drawn(drawing: Drawing, study: str) -> Figure:
    """Draw a figure, signed with the study's name, that shows in a notebook.

    The settings of matplotlib outside it stay as they are.
    """
    import matplotlib as mpl

    with mpl.rc_context():
        from tvimdesign.report.figures.theme.canvas import sign
        from tvimdesign.report.figures.theme.style import SETTINGS

        mpl.rcParams.update(SETTINGS)
        file, _, function = drawing.figure.partition(".")
        figure = getattr(import_module(f"tvimdesign.report.figures.{file}"), function)(drawing.data)
        sign(figure, study)
        return shown(figure)


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
