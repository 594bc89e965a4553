"""Loads the CAD kernel without the whole of VTK, a fifth of the time that it takes.

OCP's bridge to VTK imports all 150 modules of it, where it finds one called `vtk`. Nothing here crosses that bridge:
pictures are rendered from triangles, with the few modules of VTK that this takes.
"""

from __future__ import annotations

import sys
from importlib import import_module
from types import ModuleType

_BRIDGED = "vtk"
KERNEL = "cadquery"


def load_kernel() -> None:
    """Import CadQuery; who imports `vtk` afterwards gets it whole."""
    if KERNEL in sys.modules or _BRIDGED in sys.modules:
        import_module(KERNEL)
        return
    sys.modules[_BRIDGED] = ModuleType(_BRIDGED)
    try:
        import_module(KERNEL)
    finally:
        del sys.modules[_BRIDGED]
