"""The environment that the package runs in: threads of linear algebra, and extras that are installed."""

import os
from importlib.util import find_spec

from tvimdesign.base.errors import InputError

NAMES = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS")
"""Variables of the environment that libraries read when they are loaded."""


def ask_for_one_thread() -> None:
    """Set the variables for libraries that are loaded from now on, here and in children.

    Two threads double the CPU time of systems as small as here and gain nothing; to start one takes numpy half of its
    time to load.
    """
    for name in NAMES:
        os.environ.setdefault(name, "1")


MODULES = {"cad": ("cadquery", "ezdxf", "trimesh", "vtkmodules")}
"""What each extra brings, by the modules that are imported."""


def how_to_install(extra: str) -> str:
    """Return which module of an extra is missing and the command that installs it; empty if none is."""
    missing = next((module for module in MODULES[extra] if find_spec(module) is None), "")
    return f"{missing} is not installed: pip install 'tvimdesign[{extra}]'" if missing else ""


def require_extra(extra: str, what: str) -> None:
    """Raise InputError where an extra is missing; `what` needs it."""
    missing = how_to_install(extra)
    if missing:
        raise InputError(f"{what}: {missing}")
