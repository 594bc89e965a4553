"""Signals that a shell has what it starts in the background ignore."""

from __future__ import annotations

import signal


def follow_signals() -> None:
    """Follow SIGINT and SIGHUP where they are ignored, as nohup and a shell's `&` have it; children inherit that."""
    for name, usual in (("SIGINT", signal.default_int_handler), ("SIGHUP", signal.SIG_DFL)):
        number = getattr(signal, name, None)
        if number is not None and signal.getsignal(number) is signal.SIG_IGN:
            signal.signal(number, usual)
