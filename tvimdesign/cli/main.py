"""Runs the command line: errors as a message and an exit code, warnings as a line, text that any terminal bears."""

import atexit
import codecs
import gc
import io
import os
import sys
import warnings
from collections.abc import Callable
from typing import Any

import typer

from tvimdesign.base import interrupts
from tvimdesign.base.environment import ask_for_one_thread
from tvimdesign.base.errors import FolderWarning, InputError, OutputError, TvimError
from tvimdesign.base.interrupts import ignore_interrupts, interrupt_handler, raise_pending
from tvimdesign.cli.commands import app

_STOPPED = "interrupted; what was finished is kept\n"


def main() -> None:
    """Run the command line; every error is a message and an exit code, never a traceback."""
    warnings.showwarning = _show_warning
    speak_plainly()
    ask_for_one_thread()  # before numpy is loaded, here and in the processes that a command starts
    gc.set_threshold(200_000, 20, 20)  # a command makes many objects and keeps most: looking for garbage costs 5 %
    atexit.register(ignore_interrupts)
    with interrupt_handler():
        code = _guarded(_command)
        drop_what_cannot_be_written()
    gc.freeze()  # or the interpreter looks through all of them once more on its way out, for nothing: 5 %
    sys.exit(code)


def _command() -> Any:
    with interrupt_handler():  # what an interrupted library raises is the interrupt
        code = app(standalone_mode=False)
    flush_output()
    return code


def _show_warning(message: Warning | str, category: type[Warning], *_: object, **__: object) -> None:
    """Show a warning that a user can act on, in plain words; hide libraries' warnings, which are for developers."""
    if issubclass(category, FolderWarning):
        sys.stderr.write(f"Warning: {message}\n")


def _guarded(command: Callable[[], Any]) -> int:
    try:
        code = command()
        raise_pending()
        return code if isinstance(code, int) else 0
    except TvimError as error:
        return _report_error(error)
    except (KeyboardInterrupt, typer.Abort):
        sys.stderr.write(_STOPPED)
        _forget_interrupt()
        return interrupts.exit_code()
    except BrokenPipeError:
        sys.stderr.close()
        return 0
    except (OSError, MemoryError) as error:
        return _report_error(OutputError(_of_the_machine(error)))
    except Exception as error:
        # Typer's usage errors can show themselves; their common base has no public name.
        show = getattr(error, "show", None)
        if show is None:
            raise
        show()
        return InputError.exit_code


def _forget_interrupt() -> None:
    """Run a string, so that CPython forgets an interrupt that came while it ran another one, as a dataclass does.

    It would end `python -m tvimdesign` by SIGINT, whatever the exit code (Python/pythonrun.c: run_eval_code_obj).
    """
    eval("None")


def _report_error(error: TvimError) -> int:
    sys.stderr.write(f"{error}\n")
    if "--json" in sys.argv and error.exit_code == InputError.exit_code:
        # Print the error as JSON on standard output: the message, and each problem of a study with its place.
        import json
        from dataclasses import asdict

        problems = [asdict(problem) for problem in getattr(error, "problems", ())]
        typer.echo(json.dumps({"error": str(error), "problems": problems}, indent=2))
    return error.exit_code


def _of_the_machine(error: OSError | MemoryError) -> str:
    """Describe in a line what the machine refuses: memory, descriptors, room on a disk."""
    if isinstance(error, MemoryError):
        return "there is not enough memory; close other programs, or ask for fewer `solver.cells`"
    named = f"{error.filename}: " if error.filename else ""
    return f"{named}{error.strerror or error}; what was finished is kept"


_PLAIN = {"·": ".", "²": "^2", "³": "^3", "°": "deg ", "Ω": "ohm", "µ": "u", "×": "x", "–": "-", "—": "-", "→": "->",
          "≤": "<=", "≥": ">=", "±": "+-", "…": "..."}  # fmt: skip
_HANDLER = "tvimdesign.plain"


def speak_plainly() -> None:
    """Let both streams write what their encoding lacks in plain letters, as `N.m` on an ASCII terminal."""
    codecs.register_error(_HANDLER, _in_plain_letters)
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):
            stream.reconfigure(errors=_HANDLER)


def _in_plain_letters(error: UnicodeError) -> tuple[str, int]:
    if not isinstance(error, UnicodeEncodeError):
        raise error
    text = "".join(_PLAIN.get(letter, "?") for letter in error.object[error.start : error.end])
    return text, error.end


def flush_output() -> None:
    """Write out what standard output still holds. Raises OutputError, as of a full disk; nobody who reads is no error.

    What cannot be written is dropped, or the interpreter would complain of it once more on its way out.
    """
    try:
        sys.stdout.flush()
    except BrokenPipeError:
        _drop()
    except OSError as error:
        _drop()
        raise OutputError(f"standard output cannot be written: {error.strerror}") from error


def drop_what_cannot_be_written() -> None:
    """Empty standard output after an error is printed: the interpreter would fail over what is left in it."""
    try:
        sys.stdout.flush()
    except OSError:
        _drop()


def _drop() -> None:
    nowhere = os.open(os.devnull, os.O_WRONLY)
    os.dup2(nowhere, sys.stdout.fileno())
    os.close(nowhere)
