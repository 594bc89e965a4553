"""Designs: resolved for tests, turned into dimensions for parts and into a study."""

from __future__ import annotations

import json
import random
from functools import cache
from pathlib import Path
from typing import Any

from fuzzing.kind import ROOT, Drawn, Kind
from fuzzing.mutations import encoded, mutated_data, mutated_text, paths
from tvimdesign.cad.geometry.dimensions import dimensions
from tvimdesign.device import table_for
from tvimdesign.simulation.working_cycle.device_functions import resolve_design
from tvimdesign.study.design import read_design
from tvimdesign.study.written_studies import result_text


@cache
def _designs() -> list[tuple[str, list[tuple[object, ...]], list[tuple[object, ...]]]]:
    """Text of each released design, its places, and those that are not one of its thousand values."""
    texts = []
    for path in sorted((ROOT / "cad").glob("*/design.json")):
        plain = _of_today(json.loads(path.read_text()))
        text = json.dumps(plain, indent=2)
        every = [place for place in paths(plain) if place[0] != "solution"]
        texts.append((text, every, [place for place in every if place[0] != "values"]))
    return texts


def _of_today(plain: dict[str, Any]) -> dict[str, Any]:
    """Give a released design a value of every quantity that is newer than it, so that it is read."""
    table = table_for(plain["mode"])
    values = dict.fromkeys(table.names(tuple(plain["study"]["operating_points"])), 1.0)
    values |= {row.name: row.default for row in table.inputs if row.default is not None and not row.per_point}
    choices = {row.name: row.default for row in table.choices}
    return {**plain, "values": values | plain["values"], "choices": choices | plain["choices"]}


def _design(draw: random.Random) -> Drawn:
    text, every, few = draw.choice(_designs())
    if draw.random() < 0.2:
        return Drawn("input.json", mutated_text(text, draw))
    changed = mutated_data(text, every if draw.random() < 0.3 else few, draw)
    return Drawn("input.json", encoded(json.dumps(changed, indent=2 if draw.random() < 0.05 else None)))


def _use(path: Path) -> None:
    """Do what `simulate`, `cad` and `new --from` do first with a design."""
    design = read_design(path)
    resolve_design(design)
    dimensions(design)
    result_text(design, path.name, path.parent)


DESIGNS = Kind(_design, _use)
