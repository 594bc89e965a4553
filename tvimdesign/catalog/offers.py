"""Offers for bought parts: number, pack and dated price, where a public list gives them; of others one asks a quote."""

import math
import re
from collections import Counter
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from functools import cache
from typing import Any, NamedTuple

from tvimdesign.base.record import Entry, own_data
from tvimdesign.base.units import ZERO_CELSIUS, parse_quantity

QUOTE = "quote"  # Price of what no dated list was read for


@dataclass(frozen=True)
class Offer:
    """An entry of the data file; a price is that of a pack [USD]."""

    supplier: str
    pack: int
    source: str
    number: str = ""
    pattern: str = ""  # Of the number, where the title has it
    record: str = ""
    kind: str = ""
    size: str = ""
    link: str = ""
    note: str = ""
    inputs: str = ""  # By which inputs a controller sets a driver
    date: str = ""
    price: float | None = None
    high: float | None = None
    to_order: bool = False  # True where nobody has it in stock
    like: str = ""  # Number of the neighbour whose price per piece was taken
    voltage: float = math.inf
    current: float = math.inf
    temperature: float = math.inf  # It bears that much [K]

    @property
    def in_words(self) -> str:
        """Price of the pack or its interval, its date, and the neighbour it is of."""
        if self.price is None:
            return QUOTE
        dated = f"{self.date}, of {self.like}" if self.like else self.date
        return f"{between(self.price, self.high or self.price)} a pack of {self.pack} ({dated})"


def between(low: float, high: float) -> str:
    """Return a price or an interval of prices in words."""
    return f"{low:.2f} USD" if low == high else f"{low:.2f} to {high:.2f} USD"


@cache
def offers() -> tuple[Offer, ...]:
    """Return the offers of the data file, the first choice first, each with its own or its neighbour's price."""
    data = own_data(__file__, "offers.yaml")
    references, own = (_offers(data[key]) for key in ("references", "offers"))
    priced = {offer.number: offer for offer in (*references, *own) if offer.price is not None}
    spread = float(data["spread"]["value"])
    return tuple(_like(offer, priced[offer.like], spread) if offer.like else offer for offer in own)


def _offers(entries: Iterable[Mapping[str, Any]]) -> list[Offer]:
    units = {"voltage": "V", "current": "A", "temperature": "degC"}
    return [Offer(**{key: _plain(key, value, units) for key, value in entry.items()}) for entry in entries]


def _like(offer: Offer, neighbour: Offer, spread: float) -> Offer:
    """Return the offer with the neighbour's price per piece, over and times the spread of such prices."""
    packs, least = offer.pack / neighbour.pack, neighbour.price or 0.0
    low, high = packs * least / spread, packs * (neighbour.high or least) * spread
    return replace(offer, price=low, high=high, date=neighbour.date)


def _plain(key: str, value: Any, units: Mapping[str, str]) -> Any:
    """Return a field of an entry: a date as it is written, a rating in SI."""
    if key in units:
        return parse_quantity(value, units[key])
    return str(value) if key == "date" else value


def offer_for(kind: str, record: str, title: str, volts: float = 0.0, amperes: float = 0.0) -> Offer | None:
    """Return the first offer for a line of the list of parts; supplies and drivers must give `volts` and `amperes`.

    A title with "for 120 °C" asks what bears that.
    """
    needed = re.search(r"for (\d+) °C", title)
    kelvin = ZERO_CELSIUS + float(needed[1]) if needed else 0.0
    for offer in offers():
        is_it = offer.record in ("", record) and offer.kind in ("", kind) and offer.size in f"{title} "
        bears = offer.voltage >= volts and offer.current >= amperes and offer.temperature >= kelvin
        named = re.search(offer.pattern, title)
        if is_it and bears and named:
            return replace(offer, number=named[0]) if offer.pattern else offer
    return None


def piece_price(record: str, title: str) -> Entry | None:
    """Return what one piece of a record costs, whatever its size: the geometric mean of least and largest price.

    An offer of the record's own comes before a neighbour's, and that before one for all that its title names. None
    where no list gives a price.
    """
    priced = [offer for offer in offers() if offer.price is not None]
    own = [offer for offer in priced if offer.record == record]
    alike = [offer for offer in priced if not (offer.record or offer.kind) and offer.size in f"{title} "]
    listed = [offer for offer in own if not offer.like] or own or alike
    if not listed:
        return None
    low = min((offer.price or 0.0) / offer.pack for offer in listed)
    high = max((offer.high or offer.price or 0.0) / offer.pack for offer in listed)
    ends = f"{low:.3g}" if low == high else f"{low:.3g} to {high:.3g}"
    dates = sorted({offer.date for offer in listed})
    when = dates[0] if len(dates) == 1 else f"{dates[0]} to {dates[-1]}"
    return Entry(math.sqrt(low * high), "USD", f"offers: {ends} USD a piece, {when}", "handbook")


class Total(NamedTuple):
    """Sum of the lines that have a price, for whole packs [USD]."""

    low: float
    high: float
    priced: int
    lines: int


def total(lines: Iterable[tuple[Offer | None, int]]) -> Total:
    """Add up what bought lines cost, each with its offer and the quantity wanted; lines of one number share packs."""
    wanted: Counter[Offer] = Counter()
    priced = count = 0
    for offer, quantity in lines:
        count += 1
        if offer is not None and offer.price is not None:
            wanted[offer] += quantity
            priced += 1
    packs = {offer: math.ceil(quantity / offer.pack) for offer, quantity in wanted.items()}
    low = sum(number * (offer.price or 0.0) for offer, number in packs.items())
    high = sum(number * (offer.high or offer.price or 0.0) for offer, number in packs.items())
    return Total(low, high, priced, count)
