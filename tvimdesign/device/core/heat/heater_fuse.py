"""Which thermal cut-out of a table goes into the leads of a heater: one that opens before anything is too hot."""

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
    """What bears less than it opens at: names of the ratings, the least first; none where it saves everything."""


def heater_fuse(record: Record, hottest: float, current: float, ratings: Mapping[str, float]) -> HeaterFuse:
    """The type of a record for a heater whose highest temperature [K] and current [A] are known.

    A type does not open in work where the least temperature at which it may open is a margin above the heater's
    highest. Of these the highest type that opens at or below the least of the `ratings` [K]; where all open above it,
    the lowest. Raises InputError where no type opens so high, or bears the current.
    """
    margin, band = record.value("working_margin"), record.value("opening_band")
    stays = [one for one in record.table("types") if one["functioning_temperature"] - band >= hottest + margin]
    if not stays:
        most = max(one["functioning_temperature"] for one in record.table("types")) - band - margin
        held, asked = (f"{one - ZERO_CELSIUS:.4g} degC" for one in (most, hottest))
        raise InputError(f"{record.title}: no type stays closed at the heater's {asked}, the highest at {held}")
    bears = record.value("high_rated_current" if record.has("high_rated_current") else "rated_current")
    if current > bears:
        raise InputError(f"{record.title}: no type bears the heater's {current:.3g} A, the strongest {bears:.3g} A")
    least = min(ratings.values())
    saving = [one for one in stays if one["functioning_temperature"] <= least]
    one = (max if saving else min)(saving or stays, key=lambda row: row["functioning_temperature"])
    high = "H" if current > record.value("rated_current") else "0"
    opens = one["functioning_temperature"]
    name = record.words["designation"].format(**{"model": f"{round(one['model']):03d}", "class": high})
    above = tuple(sorted((what for what in ratings if ratings[what] < opens), key=lambda what: ratings[what]))
    return HeaterFuse(name, opens - band, opens, one["holding_temperature"], above)
