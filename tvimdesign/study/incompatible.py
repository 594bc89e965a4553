"""Contradictions in a study that no number can resolve, refused before anything is evaluated."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from tvimdesign.base.errors import InputError
from tvimdesign.base.units import format_quantity
from tvimdesign.study.study import Range, Study


def refuse_incompatible(study: Study, values: Mapping[str, Any]) -> None:
    """Raise InputError where a study asks for a current that cools of a heater that only heats.

    `values` are those of the study's start. A heater that the study chooses from several may be another one, and a
    current that may be zero will be.
    """
    if values.get("peltier_seebeck") != 0.0 or {"peltier_module", "peltier_seebeck"} & study.vary.keys():
        return
    least = _least(study, "cooling_current")
    if least > 0.0:
        heater = values["peltier_module"]
        asked = format_quantity(least, study.table.unit("cooling_current"))
        raise InputError(
            f"cooling_current of {asked} and peltier_module {heater.name} cannot stand together: {heater.title} "
            "has no Peltier effect, so any current heats; leave cooling_current out, and the air cools, or choose a "
            "Peltier module"
        )


def _least(study: Study, name: str) -> float:
    """Return the least value that a study sets or allows for a number; zero if the default applies."""
    allowed = study.vary.get(name)
    if isinstance(allowed, Range):
        return allowed.lower
    if allowed is not None:
        return min(float(value) for value in allowed.values)
    return float(study.module.get(name, 0.0))
