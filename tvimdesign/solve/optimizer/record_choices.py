"""The records and options a study lists to choose from, and the study with some of them chosen."""

from __future__ import annotations

import itertools
from collections.abc import Mapping

from tvimdesign.device import Input, Table
from tvimdesign.study import Options, Study


def listed_records(study: Study, table: Table) -> dict[str, list[str]]:
    """Return the records and options a study lists, by the choice's name."""
    return {
        name: [str(value) for value in vary.values]
        for name, vary in study.vary.items()
        if isinstance(vary, Options) and not isinstance(table.quantity(name), Input)
    }


def discrete_records(study: Study, table: Table) -> list[dict[str, str]]:
    """Return every combination of listed records and options; one empty combination if none is listed."""
    listed = listed_records(study, table)
    return [dict(zip(listed, combination, strict=True)) for combination in itertools.product(*listed.values())]


def with_records(study: Study, records: Mapping[str, str]) -> Study:
    """Return the study with some records chosen."""
    if not records:
        return study
    vary = {name: value for name, value in study.vary.items() if name not in records}
    return study.model_copy(update={"module": {**study.module, **records}, "vary": vary})
