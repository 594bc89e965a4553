"""Interrupts: SIGINT, SIGTERM and SIGHUP raised as KeyboardInterrupt, again where a library swallows the first, and
not before a module that is being imported is whole."""

import _thread
import signal
import sys
import threading
import time
from collections.abc import Callable, Collection, Iterator
from contextlib import contextmanager
from types import FrameType
from typing import Any, TextIO, cast

_SIGNALS = tuple(getattr(signal, name) for name in ("SIGINT", "SIGTERM", "SIGHUP") if hasattr(signal, name))
_TWICE = 1.0  # Seconds within which the same signal counts once: `timeout` sends it to the process and to its group
_received: list[int] = []
_times: dict[int, float] = {}
_LATER = 0.02  # Seconds after which a signal that came within an import is sent again
_heeding: list[int] = []
"""For each of the `interrupt_handler` that are entered and not yet left, how many imports were under way then."""


@contextmanager
def interrupt_handler(numbers: Collection[int] = _SIGNALS) -> Iterator[None]:
    """Raise every interrupt as KeyboardInterrupt, and keep it for `raise_pending`; only in the main thread.

    What an interrupted library raises instead is turned into the interrupt: CasADi says RuntimeError or SystemError.
    The warning that CasADi then prints on standard error is left out.
    Where compiled code cannot raise at all, Python tells the exception and goes on, and Cython prints it besides; an
    interrupt is kept without that.
    Within an import that began in here it is raised when that is through: an exception there ends VTK, which the CAD
    kernel loads, by SIGSEGV.
    A signal that is ignored, as SIGHUP under nohup, stays ignored.
    """
    every = {number: signal.getsignal(number) for number in numbers}
    before = {number: handler for number, handler in every.items() if handler not in (signal.SIG_IGN, None)}
    unraisable_hook, sys.unraisablehook = sys.unraisablehook, _without_interrupts(sys.unraisablehook)
    exception_hook, sys.excepthook = sys.excepthook, _not_printed(sys.excepthook)
    stderr, sys.stderr = sys.stderr, cast(TextIO, _WithoutWarnings(sys.stderr))
    _heeding.append(_imports(sys._getframe()))
    for number in before:
        signal.signal(number, _heed)
    try:
        yield
    except Exception as error:
        if _received:
            raise KeyboardInterrupt from error
        raise
    finally:
        _heeding.pop()  # first: what comes while the outermost is left ends nothing any more
        for number, handler in before.items():
            signal.signal(number, handler)
        sys.unraisablehook, sys.excepthook, sys.stderr = unraisable_hook, exception_hook, stderr
        if not _heeding:
            _received.clear()
            _times.clear()


class _WithoutWarnings:
    """Standard error without CasADi's warnings of an interrupt, which come in pieces."""

    def __init__(self, stream: TextIO) -> None:
        self._stream, self._within = stream, False

    def write(self, text: str) -> int:
        """Write it, or not."""
        if not (self._within or (_received and text.startswith("CasADi"))):
            return self._stream.write(text)
        self._within = not text.endswith("\n")
        return len(text)

    def __getattr__(self, name: str) -> Any:
        return getattr(self._stream, name)


def ignore_interrupts() -> None:
    """From here on interrupts do nothing: for a process whose work is done, and whose exit code says so.

    Python's own handler would end it by the signal while it takes itself down.
    """
    for number in _SIGNALS:
        signal.signal(number, signal.SIG_IGN)


def interrupt_came() -> bool:
    """Return whether an interrupt came, whether or not it was raised."""
    return bool(_received)


def raise_pending() -> None:
    """Raise KeyboardInterrupt where an interrupt came, whatever has become of the first one."""
    if _received:
        raise KeyboardInterrupt


def exit_code() -> int:
    """Return the exit code of an interrupted process: 128 and the signal's number."""
    return 128 + (_received[0] if _received else signal.SIGINT)


def _without_interrupts(report: Callable[[Any], Any]) -> Callable[[Any], Any]:
    """Wrap the hook for exceptions that cannot be raised; `raise_pending` raises an interrupt later."""

    def tell(unraisable: Any) -> None:
        if not (_received and issubclass(unraisable.exc_type, KeyboardInterrupt)):
            report(unraisable)

    return tell


def _not_printed(printed: Callable[..., Any]) -> Callable[..., Any]:
    """Wrap the hook for uncaught exceptions so that it does not print an interrupt."""

    def tell(kind: type[BaseException], error: BaseException, at: Any) -> None:
        if not (_received and issubclass(kind, KeyboardInterrupt)):
            printed(kind, error, at)

    return tell


def _heed(number: int, frame: FrameType | None) -> None:
    if not _heeding:
        return
    if _imports(frame) > _heeding[-1]:
        _thread.start_new_thread(_send_later, (number,))  # takes no lock that the interrupted code may hold
        return
    now = time.monotonic()
    again, _times[number] = now - _times.get(number, -_TWICE) < _TWICE, now
    if not again:
        _received.append(number)
        raise KeyboardInterrupt


def _imports(frame: FrameType | None) -> int:
    """Count the frames of the import system below a frame."""
    count = 0
    while frame is not None:
        count += frame.f_code.co_filename.startswith("<frozen importlib")
        frame = frame.f_back
    return count


def _send_later(number: int) -> None:
    time.sleep(_LATER)
    if not _heeding:
        return
    if hasattr(signal, "pthread_kill"):
        signal.pthread_kill(threading.main_thread().ident or 0, number)
    else:
        _thread.interrupt_main(signal.Signals(number))
