"""Runs a command in a group of processes that ends with whoever asked for it: `run_watched.py PIPE COMMAND...`.

PIPE is the number of a pipe's end to read, whose other end the asking process alone holds. A compiler has processes of
its own, which the kernel does not end with it. Run as a file, as it needs nothing of the package.
"""

import os
import signal
import subprocess
import sys
import threading


def _end_with(pipe: int) -> None:
    os.read(pipe, 1)
    os.killpg(0, signal.SIGKILL)


if __name__ == "__main__":
    threading.Thread(target=_end_with, args=(int(sys.argv[1]),), daemon=True).start()
    sys.exit(subprocess.call(sys.argv[2:]))
