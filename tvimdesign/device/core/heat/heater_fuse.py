"""Which thermal cut-out of a maker's table goes into the leads of a heater: the first that the heater does not open."""

from __future__ import annotations

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


def heater_fuse(record: Record, hottest: float, current: float) -> HeaterFuse:
    """The lowest type of a record that holds the heater's highest temperature [K], for a current [A].

    At its holding temperature a cut-out carries its rated current without opening, by the maker's sheet. Raises
    InputError where no type holds so much, or bears the current.
    """
    types = [one for one in record.table("types") if one["holding_temperature"] >= hottest]
    if not types:
        most = max(one["holding_temperature"] for one in record.table("types"))
        held, asked = (f"{one - ZERO_CELSIUS:.4g} degC" for one in (most, hottest))
        raise InputError(f"{record.title}: no type holds the heater's {asked}, the highest {held}")
    if current > record.value("high_rated_current"):
        bears = record.value("high_rated_current")
        raise InputError(f"{record.title}: no type bears the heater's {current:.3g} A, the strongest {bears:.3g} A")
    one = min(types, key=lambda row: row["functioning_temperature"])
    high = "H" if current > record.value("rated_current") else "0"
    opens = one["functioning_temperature"]
    name = record.words["designation"].format(**{"model": f"{round(one['model']):03d}", "class": high})
    return HeaterFuse(name, opens - record.value("opening_band"), opens, one["holding_temperature"])
