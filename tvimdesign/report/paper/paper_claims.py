"""What the paper states, from `paper_claims.yaml`: numbers with units, and the places where they stand."""

from __future__ import annotations

from functools import cache
from importlib import resources
from typing import Any

import yaml

from tvimdesign.base.units import to_si


@cache
def claims() -> dict[str, Any]:
    """What the paper states: values with units, and the places."""
    text = resources.files("tvimdesign.report.paper").joinpath("paper_claims.yaml").read_text(encoding="utf-8")
    loaded: dict[str, Any] = yaml.safe_load(text)
    return loaded


def from_paper(name: str) -> float:
    """SI value of a number the paper states."""
    entry = claims()["numbers"][name]
    return to_si(float(entry["value"]), entry["unit"])
