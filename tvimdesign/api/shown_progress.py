"""What Python users see while a study is worked on: one moving line in a notebook and in a terminal, else nothing."""

from __future__ import annotations

import sys
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from importlib import import_module
from typing import Any

from tvimdesign.report.output.progress import Progress, progress_output


@contextmanager
def shown_progress(wanted: bool) -> Iterator[Progress]:
    """Say what is going on where somebody sees it: nothing in a pipe, in a thread, or where it is not wanted."""
    if wanted and in_notebook():
        yield from _notebook_line()
    elif wanted and sys.stderr.isatty() and threading.current_thread() is threading.main_thread():
        with progress_output() as progress:
            yield progress
    else:
        yield lambda _: None


def in_notebook() -> bool:
    """Whether this runs in the kernel of a notebook."""
    ipython: Any = sys.modules.get("IPython")
    return ipython is not None and hasattr(ipython.get_ipython(), "kernel")


def _notebook_line() -> Iterator[Progress]:
    """A line below the cell that changes with each thing said, and is empty in the end."""
    show: Any = import_module("IPython.display").display
    line = show({"text/plain": "..."}, raw=True, display_id=True)

    def say(text: str) -> None:
        line.update({"text/plain": text and f"... {text}"}, raw=True)

    try:
        yield say
    finally:
        say("")
