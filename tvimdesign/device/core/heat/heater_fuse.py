"""Choice of a thermal cut-out for a heater's leads: it opens before anything is too hot."""

from __future__ import annotations

from collections.abc import Mapping
from typing import NamedTuple

from tvimdesign.base.errors import InputError
from tvimdesign.base.record import Record
from tvimdesign.base.units import ZERO_CELSIUS


class HeaterFuse(NamedTuple):
    """One cut-out: how it is ordered, between which temperatures [K] it opens, and what it holds for good."""

    designation: str
    opens_from: float
    opens_at: float
    holds: float
    above: tuple[str, ...]
    """Names of the ratings below its opening temperature, the least first; empty if it saves everything."""


def heater_fuse(record: Record, hottest: float, current: float, ratings: Mapping[str, float]) -> HeaterFuse:
    """Return the type of a record for a heater whose highest temperature [K] and current [A] are known.

    A type does not open in work where the least temperature at which it may open is a margin above the heater's
    highest. Of these the highest type that opens at or below the least of the `ratings` [K]; where all open above it,
    the lowest. Raises InputError where no type opens so high, or bears the current.
    """
    margin, band = record.value("working_margin"), record.value("opening_band")
    stays = [kind for kind in record.table("types") if kind["functioning_temperature"] - band >= hottest + margin]
    if not stays:
        most = max(kind["functioning_temperature"] for kind in record.table("types")) - band - margin
        held, asked = (f"{kelvin - ZERO_CELSIUS:.4g} degC" for kelvin in (most, hottest))
        raise InputError(f"{record.title}: no type stays closed at the heater's {asked}, the highest at {held}")
    bears = record.value("high_rated_current" if record.has("high_rated_current") else "rated_current")
    if current > bears:
        raise InputError(f"{record.title}: no type bears the heater's {current:.3g} A, the strongest {bears:.3g} A")
    least = min(ratings.values())
    saving = [kind for kind in stays if kind["functioning_temperature"] <= least]
    kind = (max if saving else min)(saving or stays, key=lambda row: row["functioning_temperature"])
    high = "H" if current > record.value("rated_current") else "0"
    opens = kind["functioning_temperature"]
    name = record.words["designation"].format(**{"model": f"{round(kind['model']):03d}", "class": high})
    above = tuple(sorted((what for what in ratings if ratings[what] < opens), key=lambda what: ratings[what]))
    return HeaterFuse(name, opens - band, opens, kind["holding_temperature"], above)
