"""One thread for linear algebra, unless the user's environment says otherwise."""

from __future__ import annotations

import os

NAMES = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS")
"""Variables of the environment that libraries read when they are loaded."""


def ask_for_one_thread() -> None:
    """Set the variables for libraries that are loaded from now on, here and in children.

    Two threads double the CPU time of systems as small as here and gain nothing; to start one takes numpy half of its
    time to load.
    """
    for name in NAMES:
        os.environ.setdefault(name, "1")
