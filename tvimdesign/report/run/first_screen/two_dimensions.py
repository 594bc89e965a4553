"""What a softening time of one dimension may be in two, by how far the shipped studies were off."""

from __future__ import annotations

import math
from functools import cache
from importlib import resources

import yaml

from tvimdesign.study.design import Design

WITH_CUT_PADS = "flexible"


@cache
def _off() -> dict[str, list[float]]:
    """Least and largest difference from two dimensions [%] by mode."""
    file = resources.files("tvimdesign.report.run.first_screen").joinpath("two_dimensions.yaml")
    found: dict[str, list[float]] = yaml.safe_load(file.read_text("utf-8"))
    return found


def in_two_dimensions(design: Design) -> tuple[float, float] | None:
    """Least and largest softening time [s] that two dimensions may find; None where nobody has looked."""
    time = design.values["softening_time"]
    foil = design.values.get("peltier_seebeck") == 0.0
    if not math.isfinite(time) or foil or design.choices.get("heater_form", WITH_CUT_PADS) != WITH_CUT_PADS:
        return None
    low, high = _off()[design.mode]
    return time / (1.0 + high / 100.0), time / (1.0 + low / 100.0)
