"""Warnings about the chosen records: contradictions, missing limits, and tasks they cannot do."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from tvimdesign.base.record import Record
from tvimdesign.base.units import format_quantity
from tvimdesign.catalog.inherited_laws import inherited_law_warnings
from tvimdesign.device.core.heat.heater_form import CUT, contradiction
from tvimdesign.study.resolve import given
from tvimdesign.study.study import Study


def record_checks(study: Study) -> list[str]:
    """Return a warning for each chosen record that contradicts itself, has another material's law, cannot do its task,
    or names no limit."""
    values = given(study)
    records = [record for record in values.values() if isinstance(record, Record)]
    messages = [contradiction(record) for record in records if record.category == "peltiers"]
    if values["peltier_seebeck"] == 0.0 and values["cooling_current"] > 0.0:
        heats = format_quantity(values["cooling_current"], study.table.unit("cooling_current"))
        title = values["peltier_module"].title
        messages.append(f"cooling_current of {heats} heats: {title} cannot cool; leave it out, and the air cools")
    messages += [warning for record in records for warning in inherited_law_warnings(record)]
    return [message for message in messages if message] + _pressed(study, values)


def _pressed(study: Study, values: Mapping[str, Any]) -> list[str]:
    """Return a warning if blocks press on rigid modules whose record has no pressure limit."""
    limit = "heater_pressure_limit"
    pressed = limit in values and values["heater_form"] != CUT
    module = values["peltier_module"]
    if not pressed or limit in study.module or "max_pressure" in module.entries:
        return []
    bears = format_quantity(values[limit], study.table.unit(limit))
    return [
        f"{module.title}: its record does not say what pressure it bears; {bears} is assumed (makers mount modules "
        f"with 1 to 2.1 MPa). Ask the maker, and set {limit}."
    ]
