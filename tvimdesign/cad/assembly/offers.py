"""Offers for bought parts: number, pack and dated price, where a public list gives them; of others one asks a quote."""

from __future__ import annotations

import math
import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from functools import cache
from pathlib import Path
from typing import Any, NamedTuple

from tvimdesign.base.units import parse_quantity
from tvimdesign.base.yaml_data import plain_data

_OFFERS = Path(__file__).with_name("offers.yaml")
QUOTE = "quote"
"""Price of what no dated list was read for."""


@dataclass(frozen=True)
class Offer:
    """An entry of the data file; a price is that of a pack [USD]."""

    supplier: str
    pack: int
    source: str
    number: str = ""
    pattern: str = ""
    """Of the number, where the title has it."""
    record: str = ""
    kind: str = ""
    size: str = ""
    link: str = ""
    note: str = ""
    date: str = ""
    price: float | None = None
    high: float | None = None
    voltage: float = math.inf
    current: float = math.inf

    @property
    def in_words(self) -> str:
        """Price of the pack, and its date."""
        return f"{self.price:.2f} USD a pack of {self.pack} ({self.date})" if self.price is not None else QUOTE


@cache
def offers() -> tuple[Offer, ...]:
    """Return the offers of the data file, the first choice first."""
    entries = plain_data(_OFFERS.read_text("utf-8"))["offers"]
    units = {"voltage": "V", "current": "A"}
    return tuple(Offer(**{key: _plain(key, value, units) for key, value in entry.items()}) for entry in entries)


def _plain(key: str, value: Any, units: Mapping[str, str]) -> Any:
    """Return a field of an entry: a date as it is written, a rating in SI."""
    if key in units:
        return parse_quantity(value, units[key])
    return str(value) if key == "date" else value


def offer_for(kind: str, record: str, title: str, volts: float = 0.0, amperes: float = 0.0) -> Offer | None:
    """Return the first offer for a line of the list of parts; supplies and drivers must give `volts` and `amperes`."""
    for offer in offers():
        is_it = offer.record in ("", record) and offer.kind in ("", kind)
        named = re.search(offer.pattern, title)
        if is_it and named and offer.size in f"{title} " and offer.voltage >= volts and offer.current >= amperes:
            return replace(offer, number=named[0]) if offer.pattern else offer
    return None


class Total(NamedTuple):
    """Sum of the lines that have a price, for whole packs [USD]."""

    low: float
    high: float
    priced: int
    lines: int


def total(lines: Iterable[tuple[Offer | None, int]]) -> Total:
    """Add up what bought lines cost, each with its offer and the quantity wanted."""
    low = high = 0.0
    priced = count = 0
    for offer, quantity in lines:
        count += 1
        if offer is None or offer.price is None:
            continue
        packs = math.ceil(quantity / offer.pack)
        low, high, priced = low + packs * offer.price, high + packs * (offer.high or offer.price), priced + 1
    return Total(low, high, priced, count)
