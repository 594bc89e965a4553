"""Sizes thermo-active variable impedance modules: a study file in, a module that can be made out.

`import tvimdesign as tvim`, then `tvim.load("study.yaml").run()`; docs/python.md has it all on a page. For type
checkers the names stand in `__init__.pyi`.
"""

from importlib import import_module
from typing import Any

__version__ = "0.1.0"

_PUBLIC = {
    "pint": ("Quantity",),
    "tvimdesign.api.measured": ("Fitted", "fit"),
    "tvimdesign.api.result": ("NoDesignError", "Parts", "Reasons", "Result"),
    "tvimdesign.api.study": ("Study", "example", "load", "size"),
    "tvimdesign.api.sweep": ("Cell", "Sweep"),
    "tvimdesign.base.errors": (
        "CatalogError", "GeometryError", "InfeasibleError", "InputError", "SimulationError",
        "TvimError", "UnitError",
    ),
    "tvimdesign.study.design": ("Design", "read_design"),
    "tvimdesign.study.text.mistakes": ("StudyError",),
}  # fmt: skip
"""Public names by the module that has them; a module is loaded when one of its names is first asked for."""
_MODULE_OF = {name: module for module, names in _PUBLIC.items() for name in names}

__all__ = ["__version__"]
__all__ += list(_MODULE_OF)


def __getattr__(name: str) -> Any:
    """Load what is asked for (PEP 562), so that `import tvimdesign` and the command line's help take no time."""
    if name not in _MODULE_OF:
        raise AttributeError(f"module 'tvimdesign' has no attribute {name!r}")
    return getattr(import_module(_MODULE_OF[name]), name)


def __dir__() -> list[str]:
    return sorted(__all__)
