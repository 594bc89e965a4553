"""Ends a process with all that it has started, or lets it wait for others: psutil does so on every system."""

from __future__ import annotations

import contextlib

import psutil

_POLITE, _LAST = 10, 19
"""A process of the first niceness has a tenth of a processor that another wants whole, one of the second an eighth of
one that the first wants."""


def end_process_tree(process: int) -> None:
    """Kill a process and its descendants, those it starts meanwhile included; one that is gone is none to end.

    Whoever started the process waits for it.
    """
    try:
        root = psutil.Process(process)
    except psutil.NoSuchProcess:
        return
    with contextlib.suppress(psutil.NoSuchProcess):
        root.suspend()  # so that it starts no more
    found: list[psutil.Process] = []
    while new := [one for one in _descendants(root) if one not in found]:
        found += new
        for one in new:
            _kill(one)
    _kill(root)


def give_way(process: int, *, last: bool = False) -> None:
    """Let a process, and those it starts from now on, compute where others leave a processor free.

    With `last` it also gives way to those that give way.
    """
    # Windows has classes in place of numbers.
    low: int = getattr(
        psutil, "IDLE_PRIORITY_CLASS" if last else "BELOW_NORMAL_PRIORITY_CLASS", _LAST if last else _POLITE
    )
    with contextlib.suppress(psutil.Error):
        psutil.Process(process).nice(low)


def _descendants(root: psutil.Process) -> list[psutil.Process]:
    try:
        return root.children(recursive=True)
    except psutil.NoSuchProcess:
        return []


def _kill(process: psutil.Process) -> None:
    with contextlib.suppress(psutil.NoSuchProcess):
        process.kill()
