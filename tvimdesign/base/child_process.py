"""Child processes of our own: `python -m tvimdesign.base.child_process MODULE [ARGUMENT...]`.

Each asks to end with its parent before the module is imported, which takes seconds where it draws or solves.
"""

import ctypes
import json
import os
import runpy
import signal
import subprocess
import sys
import threading
import warnings
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

from tvimdesign.base.errors import FolderWarning

PARENT, _ALIVE = "TVIMDESIGN_PARENT", "TVIMDESIGN_ALIVE"
"""Environment variables of a child: the parent's number; the pipe that ends with it, if the kernel does not signal its
end."""
_PR_SET_PDEATHSIG = 1


def own_processors() -> int:
    """Return how many processors this process may use: one in a child process, which shares them with others."""
    return 1 if PARENT in os.environ else os.cpu_count() or 1


def start_child(module: str, arguments: Sequence[str] = (), **options: Any) -> subprocess.Popen[Any]:
    """Start a module of this package as a process that speaks UTF-8 and ends with this one; `options` are Popen's."""
    here = str(Path(__file__).parents[2])
    paths = [here, *filter(None, [os.environ.get("PYTHONPATH")])]
    own = {"PYTHONPATH": os.pathsep.join(paths), "PYTHONIOENCODING": "utf-8", PARENT: str(os.getpid())}
    environment = {**os.environ, **own}
    if sys.platform != "linux" and os.name == "posix":
        pipe = _pipe_of_this_process()
        environment[_ALIVE] = str(pipe)
        options["pass_fds"] = (pipe,)
    command = [sys.executable, "-X", "utf8", "-m", "tvimdesign.base.child_process", module, *arguments]
    return subprocess.Popen(command, env=environment, **options)


def line_writer() -> Callable[[Any], None]:
    """Return what writes data to standard output, a line of JSON each; what a library prints goes to standard error."""
    answers = os.fdopen(os.dup(1), "w", encoding="utf-8")
    os.dup2(2, 1)

    def write(data: Any) -> None:
        answers.write(json.dumps(data) + "\n")
        answers.flush()

    return write


def read_lines(process: subprocess.Popen[str], put: Callable[[str | None], object]) -> None:
    """Hand on every line that a child says on standard output, as it comes, from a thread; None once it has ended."""

    def listen() -> None:
        assert process.stdout is not None
        with process.stdout:
            for line in process.stdout:
                put(line)
        put(None)

    threading.Thread(target=listen, daemon=True).start()


def follow_parent(parent: int | None = None) -> None:
    """End this process when its parent ends: the one that started it, or `parent` where this one was forked."""
    expected = parent or int(os.environ.get(PARENT, "0"))
    if sys.platform == "linux":
        ctypes.CDLL(None).prctl(_PR_SET_PDEATHSIG, signal.SIGKILL)
    elif parent is None and _ALIVE in os.environ:
        threading.Thread(target=_wait_for_end, args=(int(os.environ[_ALIVE]),), daemon=True).start()
    if expected and hasattr(os, "getppid") and os.getppid() != expected:
        os._exit(1)  # it ended before this process could watch it


_pipe: list[int] = []


def _pipe_of_this_process() -> int:
    """Return the read end of a pipe whose other end this process alone holds."""
    if not _pipe:
        _pipe.extend(os.pipe())  # neither is inherited unless it is handed on
    return _pipe[0]


def _wait_for_end(pipe: int) -> None:
    os.read(pipe, 1)
    os._exit(1)


def main() -> None:
    """Follow the parent, then be the module."""
    follow_parent()
    warnings.simplefilter("ignore", FolderWarning)  # the parent reports it
    del sys.argv[0]
    runpy.run_module(sys.argv[0], run_name="__main__", alter_sys=True)


if __name__ == "__main__":
    main()
