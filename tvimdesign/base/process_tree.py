"""Ends a process with all that it has started: psutil knows the tree on systems without process groups, too."""

from __future__ import annotations

import contextlib

import psutil


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


def _descendants(root: psutil.Process) -> list[psutil.Process]:
    try:
        return root.children(recursive=True)
    except psutil.NoSuchProcess:
        return []


def _kill(process: psutil.Process) -> None:
    with contextlib.suppress(psutil.NoSuchProcess):
        process.kill()
