"""What the records a study chooses say against themselves: a data sheet whose ratings do not agree."""

from __future__ import annotations

from tvimdesign.base.record import Record
from tvimdesign.device.core.peltier_ratings import contradiction
from tvimdesign.study.resolve import given
from tvimdesign.study.study import Study


def record_checks(study: Study) -> list[str]:
    """A sentence for each chosen record that contradicts itself."""
    records = [record for record in given(study).values() if isinstance(record, Record)]
    return [said for record in records if record.category == "peltiers" and (said := contradiction(record))]
