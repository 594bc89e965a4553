"""The extras of the package, and the message if one is missing."""

from __future__ import annotations

from importlib.util import find_spec

from tvimdesign.base.errors import InputError

MODULES = {
    "cad": ("cadquery", "ezdxf", "trimesh", "vtkmodules"),
    "cluster": ("distributed",),
    "parquet": ("pyarrow",),
}
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
