"""Runs the command line: every error is a message and an exit code, every warning a plain line."""

from __future__ import annotations

import gc
import sys
import warnings
from collections.abc import Callable
from typing import Any

import typer

from tvimdesign.base.errors import InputError, RenamedWarning, TvimError
from tvimdesign.cli.commands import app

INTERRUPTED = 130
_STOPPED = "interrupted; what was finished is kept\n"


def main() -> None:
    """Run the command line; every error is a message and an exit code, never a traceback."""
    warnings.showwarning = _show_warning
    gc.set_threshold(200_000, 20, 20)  # a command makes many objects and keeps most: looking for garbage costs 5 %
    code = _guarded(lambda: app(standalone_mode=False))
    gc.freeze()  # or the interpreter looks through all of them once more on its way out, for nothing: 5 %
    sys.exit(code)


def _show_warning(message: Warning | str, category: type[Warning], *_: object, **__: object) -> None:
    """What a user can act on, in plain words; libraries' own warnings are for developers and stay unsaid."""
    if issubclass(category, RenamedWarning):
        sys.stderr.write(f"Warning: {message}\n")


def _guarded(command: Callable[[], Any]) -> int:
    try:
        code = command()
        if code == INTERRUPTED:
            sys.stderr.write(_STOPPED)
        return code if isinstance(code, int) else 0
    except TvimError as error:
        sys.stderr.write(f"{error}\n")
        if "--json" in sys.argv and error.exit_code == InputError.exit_code:
            _print_error(error)
        return error.exit_code
    except (KeyboardInterrupt, typer.Abort):
        sys.stderr.write(_STOPPED)
        return INTERRUPTED
    except BrokenPipeError:
        sys.stderr.close()
        return 0
    except Exception as error:
        # Typer's usage errors can show themselves; their common base has no public name.
        show = getattr(error, "show", None)
        if show is None:
            raise
        show()
        return InputError.exit_code


def _print_error(error: TvimError) -> None:
    """The error as JSON on standard output: the message, and each problem of a study with its place."""
    import json
    from dataclasses import asdict

    problems = [asdict(problem) for problem in getattr(error, "problems", ())]
    typer.echo(json.dumps({"error": str(error), "problems": problems}, indent=2))
