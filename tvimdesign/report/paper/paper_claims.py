"""What the paper states, from `paper_claims.yaml`: numbers with units, and the places where they stand."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from importlib import resources
from typing import Any

from tvimdesign.base.units import to_si
from tvimdesign.base.yaml_data import plain_data


@cache
def claims() -> dict[str, Any]:
    """What the paper states: values with units, and the places."""
    text = resources.files("tvimdesign.report.paper").joinpath("paper_claims.yaml").read_text(encoding="utf-8")
    loaded: dict[str, Any] = plain_data(text)
    return loaded


def from_paper(name: str) -> float:
    """SI value of a number the paper states."""
    entry = claims()["numbers"][name]
    return to_si(float(entry["value"]), entry["unit"])


@dataclass(frozen=True)
class Instrument:
    """What a measuring instrument can do, with its range [SI], and where that comes from."""

    value: float
    low: float
    high: float
    status: str
    source: str


def instrument(name: str) -> Instrument:
    """A limit of the paper's rheometer [SI]."""
    entry = claims()["instrument"][name]
    value, low, high = (to_si(float(entry[key]), entry["unit"]) for key in ("value", "low", "high"))
    return Instrument(value, low, high, entry["status"], entry["source"])
