"""What the terminal sees while a run works: results on standard output, progress on standard error."""

from __future__ import annotations

import os
import signal
from collections.abc import Callable, Iterator
from contextlib import contextmanager, nullcontext

from rich.console import Console

Progress = Callable[[str], None]
WIDTH = 132


def wide_console() -> Console:
    """Standard output: as wide as the terminal, and wide enough for a table where there is none."""
    console = Console(highlight=False)
    wide = not console.is_terminal and "COLUMNS" not in os.environ
    return Console(highlight=False, width=WIDTH) if wide else console


@contextmanager
def progress_output() -> Iterator[Progress]:
    """Say on standard error what is going on: one moving line on a terminal, plain lines elsewhere.

    An interrupt that a library swallows is raised again at the next thing said; CasADi swallows some. An empty text
    ends the line, to print something else.
    """
    interrupted: list[int] = []

    def interrupt(number: int, _: object) -> None:
        interrupted.append(number)
        raise KeyboardInterrupt

    before = signal.signal(signal.SIGINT, interrupt)
    console = Console(stderr=True, highlight=False, markup=False)
    status = console.status("reading") if console.is_terminal else None

    def say(text: str) -> None:
        if interrupted:
            raise KeyboardInterrupt
        if status is None:
            if text:
                console.print(f"... {text}")
        elif text:
            status.update(text)
            status.start()
        else:
            status.stop()

    try:
        with status or nullcontext():
            yield say
    except RuntimeError as error:
        if interrupted:
            raise KeyboardInterrupt from error
        raise
    finally:
        signal.signal(signal.SIGINT, before)
