"""Display in notebooks: small tables, figures and progress."""

from __future__ import annotations

import io
import sys
import threading
from collections.abc import Iterable, Iterator, Sequence
from contextlib import contextmanager
from html import escape
from importlib import import_module
from typing import TYPE_CHECKING, Any

from tvimdesign.report.output import plot_process
from tvimdesign.report.output.terminal import Progress, progress_output

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def heading(title: str, more: str) -> str:
    """Return a title in bold, and a line about it."""
    return f"<p><b>{escape(title)}</b> &middot; {escape(more)}</p>"


def grid(columns: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """Return a table; nothing where it has no rows."""
    lines = [_line("td", row) for row in rows]
    return f"<table><thead>{_line('th', columns)}</thead><tbody>{''.join(lines)}</tbody></table>" if lines else ""


def _line(tag: str, cells: Sequence[str]) -> str:
    return "<tr>" + "".join(f'<{tag} style="text-align:left">{escape(cell)}</{tag}>' for cell in cells) + "</tr>"


_RESOLUTION = 110  # Dots per inch on a screen


def drawn(drawing: plot_process.Drawing, study: str) -> Figure:
    """Draw a figure, signed with the study's name, that shows in a notebook.

    The settings of matplotlib outside it stay as they are.
    """
    import matplotlib as mpl

    with mpl.rc_context():
        from tvimdesign.report.figures.theme import SETTINGS

        mpl.rcParams.update(SETTINGS)
        return shown(plot_process.drawn(drawing, study))


def shown(figure: Figure) -> Figure:
    """Return the figure, of a size for screens, with the picture that a notebook asks for."""
    figure.set_dpi(_RESOLUTION)
    noted: Any = figure
    noted._repr_png_ = lambda: _png(figure)
    return figure


def _png(figure: Figure) -> bytes:
    stream = io.BytesIO()
    figure.savefig(stream, format="png", dpi=_RESOLUTION)
    return stream.getvalue()


@contextmanager
def shown_progress(wanted: bool) -> Iterator[Progress]:
    """Say what is going on below a notebook's cell, else on standard error as the commands do; nothing in a thread."""
    if wanted and in_notebook():
        yield from _notebook_line()
    elif wanted and threading.current_thread() is threading.main_thread():
        with progress_output() as progress:
            yield progress
    else:
        yield lambda _: None


def in_notebook() -> bool:
    """Return whether this runs in the kernel of a notebook."""
    ipython: Any = sys.modules.get("IPython")
    return ipython is not None and hasattr(ipython.get_ipython(), "kernel")


def _notebook_line() -> Iterator[Progress]:
    """Yield a line below the cell that changes with each thing said, and is empty in the end."""
    show: Any = import_module("IPython.display").display
    line = show({"text/plain": "..."}, raw=True, display_id=True)

    def say(text: str) -> None:
        line.update({"text/plain": text and f"... {text}"}, raw=True)

    try:
        yield say
    finally:
        say("")
