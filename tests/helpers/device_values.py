"""Inputs and quantities of a module that is the default one but for some inputs."""

from collections.abc import Iterable
from typing import Any

import numpy as np

from tvimdesign.device import table_for
from tvimdesign.study import given, read_study_text

SELF_CUT = {"thread_insert": "none", "link_bolt_ratio": 0.65, "retainer_screw": "iso_7380_m4"}
"""Screws that cut their threads in the printed plastic, an M4 for the retainer: what a few lines work out by hand."""


def inputs_of(mode: str = "shear", /, **module: Any) -> dict[str, Any]:
    """Return the inputs of a module; words are read as in a study ("2 mm", names of records), numbers are in SI."""
    words = "".join(f"  {name}: {value}\n" for name, value in module.items() if isinstance(value, str))
    study = read_study_text(f"mode: {mode}\n" + (f"module:\n{words}" if words else ""), "a test")
    numbers = {name: value for name, value in module.items() if not isinstance(value, str)}
    return given(study.model_copy(update={"module": {**study.module, **numbers}}))


def all_of(names: str | Iterable[str], mode: str = "shear", /, **module: Any) -> dict[str, Any]:
    """Return inputs of a module and quantities of it, as they are."""
    inputs = inputs_of(mode, **module)
    return {**inputs, **table_for(mode).evaluate(inputs, names.split() if isinstance(names, str) else list(names))}


def values_of(names: str | Iterable[str], mode: str = "shear", /, **module: Any) -> dict[str, Any]:
    """Return quantities of a module by name; `names` is a list, or one text with spaces between them."""
    wanted = names.split() if isinstance(names, str) else list(names)
    values = table_for(mode).evaluate(inputs_of(mode, **module), wanted)

    def is_number(value: Any) -> bool:
        return (
            isinstance(value, (int, float, np.generic, np.ndarray)) and np.ndim(value) == 0 and bool(np.isreal(value))
        )

    return {name: float(value) if is_number(value) else value for name, value in values.items()}
