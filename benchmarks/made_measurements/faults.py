"""Faults that real measurements have, put into made data: a tail beyond the law, flagged rows, drift, a slow start."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np

from made_measurements.made import Array
from tvimdesign.simulation.measurement.reading.data_file import Block, read_data_file
from tvimdesign.simulation.measurement.reading.headings import unit_of

_MEASURED = (
    "storage_modulus", "loss_modulus", "viscosity", "relaxation_modulus", "specific_heat_flow", "hot_temperature",
    "cold_temperature", "far_face_temperature", "rotor_temperature", "voltage",
)  # fmt: skip
"""Columns that err, beside the kind's own."""
_OF_KIND = {
    "torque_angle": ("angle",), "release": ("angle",), "sine": ("torque",), "frozen_torque": ("torque",),
    "creep": ("strain",),
}  # fmt: skip
_TAIL, _BENT = 0.2, 0.3
_OFFSET = 2e-3
"""Of a relaxation, over its first modulus: what a transducer's zero leaves at late times."""
_DRIFT = 0.05
_FLAGGED, _WRONG = 0.2, 1e3
_LAG = 0.03
"""Share of a record's length in which a slow start is over, by 63 %."""


def _columns(kind: str, block: Block) -> list[str]:
    return [name for name in _OF_KIND.get(kind, _MEASURED) if name in block.columns]


def _changed(block: Block, changes: dict[str, Array]) -> Block:
    columns = {name: replace(block.columns[name], values=values) for name, values in changes.items()}
    return replace(block, columns={**block.columns, **columns})


def tail(kind: str, blocks: Sequence[Block], noise: np.random.Generator) -> list[Block]:
    """Bend the last fifth of the rows away from the law, by 30 % at the end: of moduli the storage modulus alone.

    A relaxation ends at the zero of its transducer, which is off.
    """
    del noise
    bent = []
    for block in blocks:
        count = len(next(iter(block.columns.values())).values)
        away = np.maximum(np.linspace(0.0, 1.0, count) - 1.0 + _TAIL, 0.0) / _TAIL
        moved = {}
        for name in [name for name in _columns(kind, block) if name != "loss_modulus"]:
            values = block.values(name)
            if name == "relaxation_modulus":
                moved[name] = values + _OFFSET * values[0]
                continue
            size = values if name.endswith(("modulus", "viscosity")) else np.full(count, float(np.ptp(values)))
            moved[name] = values - _BENT * away**2 * size
        bent.append(_changed(block, moved))
    return bent


def drift(kind: str, blocks: Sequence[Block], noise: np.random.Generator) -> list[Block]:
    """Let every sensor drift evenly by 5 % of its range, or of its value, over the time of the test, or its rows."""
    drifted = []
    for block in blocks:
        moved = {}
        over = (
            block.values("time") if "time" in block.columns else np.arange(float(block.lines[1] - block.lines[0] + 1))
        )
        course = (over - over[0]) / (over[-1] - over[0])
        for name in _columns(kind, block):
            values = block.values(name)
            way = _DRIFT * float(noise.choice([-1.0, 1.0])) * course
            relative = name.endswith(("modulus", "viscosity"))
            moved[name] = values * (1.0 + way) if relative else values + way * float(np.ptp(values))
        drifted.append(_changed(block, moved))
    return drifted


def flagged(kind: str, blocks: Sequence[Block], noise: np.random.Generator) -> list[Block]:
    """Write wrong values into a fifth of the rows, flag them as an instrument does, and read the file."""
    with TemporaryDirectory() as place:
        read: list[Block] = []
        for i, block in enumerate(blocks):
            names = list(block.columns)
            rows = np.column_stack([block.values(name) for name in names])
            bad = noise.random(len(rows)) < _FLAGGED
            for name in _columns(kind, block):
                rows[bad, names.index(name)] *= _WRONG
            heads = [f"{name} [{_UNITS.get(name, unit_of(name))}]" for name in names]
            lines = [";".join([*(f"{value:.9g}" for value in row), "ME-" if flag else "Dy_auto"])
                     for row, flag in zip(rows, bad, strict=True)]  # fmt: skip
            path = Path(place) / f"{i}.csv"
            path.write_text("\n".join([";".join([*heads, "Status"]), *lines]))
            read += read_data_file(path).blocks
    return read


_KELVINS = ("temperature", "hot_temperature", "cold_temperature", "far_face_temperature", "rotor_temperature")
_UNITS = {**dict.fromkeys(_KELVINS, "K"), "angle": "rad", "specific_heat_flow": "W/kg"}


def slow(kind: str, blocks: Sequence[Block], noise: np.random.Generator) -> list[Block]:
    """Let what is applied, or the instrument, follow slowly at the start of a test in time."""
    del noise
    late = []
    for block in blocks:
        if "time" not in block.columns:
            late.append(block)
            continue
        time = block.values("time") - block.values("time")[0]
        over = _LAG * float(time[-1])
        if kind == "relaxation" or (kind == "melt" and "relaxation_modulus" in block.columns):
            over = 0.02
            rise = 1.0 - np.exp(-block.values("time") / over)
            late.append(_changed(block, {"relaxation_modulus": block.values("relaxation_modulus") * rise}))
        elif kind == "creep" or (kind == "melt" and "strain" in block.columns):
            inert = 1.0 - np.exp(-((block.values("time") / 0.01) ** 2))
            late.append(_changed(block, {"strain": block.values("strain") * inert}))
        else:
            follow = {name: _lagging(time, block.values(name), over) for name in _columns(kind, block)}
            late.append(_changed(block, follow))
    return late


def _lagging(time: Array, values: Array, over: float) -> Array:
    """Return the answer of a first order that follows values with a lag."""
    after = values.copy()
    for i in range(1, len(values)):
        share = np.exp(-(time[i] - time[i - 1]) / over)
        after[i] = values[i] + (after[i - 1] - values[i]) * share
    return after


IN_TIME = ("release", "sine", "creep", "relaxation", "melt", "dsc", "heating_log")
"""Kinds whose tests may start slowly."""
FAULTS: dict[str, Callable[[str, Sequence[Block], np.random.Generator], list[Block]]] = {
    "tail": tail, "flagged": flagged, "drift": drift, "slow": slow,
}  # fmt: skip
