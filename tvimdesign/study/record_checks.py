"""What the records a study chooses say against themselves, or against what it asks of them."""

from __future__ import annotations

from tvimdesign.base.record import Record
from tvimdesign.base.units import format_quantity
from tvimdesign.device.core.heat.peltier_ratings import contradiction
from tvimdesign.study.resolve import given
from tvimdesign.study.study import Study


def record_checks(study: Study) -> list[str]:
    """A sentence for each chosen record that contradicts itself, and for one that is to cool and cannot."""
    values = given(study)
    records = [record for record in values.values() if isinstance(record, Record)]
    said = [said for record in records if record.category == "peltiers" and (said := contradiction(record))]
    if values["peltier_seebeck"] == 0.0 and values["cooling_current"] > 0.0:
        heats = format_quantity(values["cooling_current"], study.table.unit("cooling_current"))
        title = values["peltier_module"].title
        said.append(f"cooling_current of {heats} heats: {title} cannot cool; leave it out, and the air cools")
    return said
