"""Ends a process with all that it has started, or lets it wait for others: psutil does so on every system."""

from __future__ import annotations

import contextlib
from enum import IntEnum

import psutil


class Niceness(IntEnum):
    """Niceness of a process; on Linux each step is a fifth less of a processor that two processes want."""

    LOW = 5
    SOME = 10
    FAR = 14


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
    killed: list[psutil.Process] = []
    while new := [child for child in _descendants(root) if child not in killed]:
        killed += new
        for child in new:
            _kill(child)
    _kill(root)


def set_low_priority(process: int, behind: Niceness = Niceness.SOME) -> None:
    """Let a process, and those it starts from now on, compute where others leave a processor free."""
    with contextlib.suppress(psutil.Error):  # Windows has classes in place of numbers
        psutil.Process(process).nice(int(getattr(psutil, "BELOW_NORMAL_PRIORITY_CLASS", behind)))


def set_lower_priority(process: int) -> None:
    """Lower the priority of a process at `Niceness.LOW` to `FAR`; leave others unchanged."""
    with contextlib.suppress(psutil.Error):
        if psutil.Process(process).nice() == Niceness.LOW:
            set_low_priority(process, Niceness.FAR)


def _descendants(root: psutil.Process) -> list[psutil.Process]:
    try:
        return root.children(recursive=True)
    except psutil.NoSuchProcess:
        return []


def _kill(process: psutil.Process) -> None:
    with contextlib.suppress(psutil.NoSuchProcess):
        process.kill()
