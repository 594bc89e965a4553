"""Standard output and error of a command: letters that an encoding lacks, and a disk that is full."""

from __future__ import annotations

import codecs
import io
import os
import sys

from tvimdesign.base.errors import OutputError

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
