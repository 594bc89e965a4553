"""The paper's 70 s in shear and 140 s in compression: a calibrated pair of modules, and what their ratio hangs on.

The pair and the ranges of what is assumed stand in `paper_case.yaml`, and in the records of the catalogue; all times
are simulated when they are asked for.

The paper's claims, and its module reconstructed with this package's layout where the paper gives no dimension.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache
from importlib import resources
from typing import TYPE_CHECKING, Any

import numpy as np

from tvimdesign.base.record import Entry, Record
from tvimdesign.base.units import from_si, pretty, to_si
from tvimdesign.base.yaml_data import plain_data
from tvimdesign.device import Input, table_for
from tvimdesign.simulation.working_cycle.device_functions import DeviceFunctions
from tvimdesign.solve.sensitivity.response_times import Array, Influence, Pair, Span, ratio
from tvimdesign.study import given, read_study_text

if TYPE_CHECKING:
    from tvimdesign.simulation.working_cycle.resolved_module import ResolvedModule
    from tvimdesign.study import Study

SHOWN = 0.01  # of the ratio: inputs that move it by less have no bar in the figure


@dataclass(frozen=True)
class Alternative:
    """The paper's pair with another choice: its label, and both times [s]."""

    label: str
    times: Array


@cache
def case() -> dict[str, Any]:
    """Return the pair, the ranges and the choices as they stand in the file."""
    text = resources.files("tvimdesign.report.paper").joinpath("paper_case.yaml").read_text(encoding="utf-8")
    loaded: dict[str, Any] = plain_data(text)
    return loaded


def _model(mode: str, **choices: str) -> DeviceFunctions:
    study = read_study_text(case()["studies"][mode], f"the calibrated {mode} module")
    study = study.model_copy(update={"module": {**study.module, **choices}})
    table = table_for(mode)
    return DeviceFunctions(table, given(study), tuple(study.operating_points), study.solver.cells)


@cache
def pair(**choices: str) -> Pair:
    """Return the shear and the compression module, compiled; `choices` changes words of both."""
    return Pair(_model("shear", **choices), _model("compression", **choices))


def _row(name: str) -> Input:
    mode = "shear" if name in pair().models[0].index else "compression"
    row = table_for(mode).quantity(name)
    assert isinstance(row, Input)
    return row


@cache
def ranges() -> dict[str, Entry]:
    """Return the assumed values of the case and their ranges [SI]: this case's own, then those of the records."""
    own_ranges = {name: _entry(given) | {"value": pair().value(name)} for name, given in case()["ranges"].items()}
    entries = {name: Entry(**fields) for name, fields in own_ranges.items()}
    for model in pair().models:
        needed = model.table.ancestors(case()["event"])
        for row in model.table.inputs:
            if row.record and row.name in needed:
                record = model.words[row.record[0]]  # a word where there is none; a pad cut to its arc has no sides
                entry = record.entries.get(row.record[1]) if isinstance(record, Record) else None
                if entry is not None and entry.low is not None:
                    entries[row.name] = entry
    return entries


def _entry(record: dict[str, Any]) -> dict[str, Any]:
    """Return the fields of a range in SI."""
    ends = {end: to_si(float(record[end]), record["unit"]) for end in ("low", "high")}
    return {"unit": record["unit"], "source": record["source"], "status": record["status"], **ends}


@cache
def influences() -> tuple[Influence, ...]:
    """Return what each assumed input does to both times through its range; first what moves their ratio most."""
    spans = (Span(name, float(entry.low or 0.0), float(entry.high or 0.0)) for name, entry in ranges().items())
    influence_list = [pair().influence(case()["event"], span) for span in spans]
    # What only freezing asks for is assumed too, and changes nothing here.
    moving = (influence for influence in influence_list if np.any(influence.at_low != influence.at_high))
    return tuple(sorted(moving, key=lambda influence: -influence.reach))


@cache
def alternatives() -> tuple[Alternative, ...]:
    """Return the pair with its thermometer elsewhere, and made of something else."""
    places = [Alternative(f"a thermometer at the {_place(name)}", pair().times(name)) for name in case()["places"]]
    others = [pair(structure_material=name) for name in case()["materials"]]
    materials = [
        Alternative(f"structures of {other.models[0].words['structure_material'].title}", other.times(case()["event"]))
        for other in others
    ]
    return (*places, *materials)


def _place(event: str) -> str:
    return {"near_face_time": "near face", "mean_time": "mean", "far_face_time": "far face"}[event]


def sentence() -> str:
    """Return the row of the paper check: what the pair takes, what else it could be read as, what carries the ratio."""
    event = case()["event"]
    times = pair().times(event)
    others = "; ".join(f"with {alternative.label}: {_both(alternative.times)}" for alternative in alternatives())
    most = influences()[0]
    ends = [end for influence in influences() for end in influence.ratios]
    stated = [from_paper(name) for name in ("response_time", "response_time_compression")]
    inputs = f"{len(influences())} assumed inputs, each alone through its range"
    return (
        f"a pair calibrated to it (studies/calibrated_*.yaml): {_place(event)} of the PCL at 100 °C after "
        f"{times[0]:.1f} s in shear and {times[1]:.1f} s in compression, a ratio of {ratio(times):.2f} against "
        f"{ratio(stated):g}. Otherwise: {others}. Of {inputs}, `{most.span.name}` "
        f"carries the ratio most: {_through(most.ratios)}; over all of them it lies between "
        f"{min(ends):.2f} and {max(ends):.2f}"
    )


def _both(times: Array) -> str:
    return f"{times[0]:.0f} and {times[1]:.0f} s ({ratio(times):.2f})"


def _through(ends: tuple[float, float]) -> str:
    low, high = sorted(ends)
    return f"{low:.2f} to {high:.2f}"


def table_rows() -> Iterator[dict[str, str | float]]:
    """Yield every assumed input with its range, both times and their ratio at its ends, and the elasticities."""
    event = case()["event"]
    for influence in influences():
        name = influence.span.name
        entry, unit = ranges()[name], _row(name).unit
        first, second = pair().output_sensitivities(event, name)
        low, high = influence.ratios
        yield {
            "input": name, "value": from_si(influence.value, unit), "low": from_si(influence.span.low, unit),
            "high": from_si(influence.span.high, unit), "unit": unit,
            "calibrated": "yes" if name in case()["solved"] else "no", "status": entry.status, "source": entry.source,
            "shear time at low [s]": influence.at_low[0], "shear time at high [s]": influence.at_high[0],
            "compression time at low [s]": influence.at_low[1], "compression time at high [s]": influence.at_high[1],
            "ratio at low": low, "ratio at high": high, "elasticity of shear time": first,
            "elasticity of compression time": second, "elasticity of ratio": second - first,
        }  # fmt: skip


def alternative_rows() -> Iterator[dict[str, str | float]]:
    """Yield the pair as calibrated, and with each other choice."""
    event = case()["event"]
    for other in (
        Alternative(f"as calibrated: {_place(event)} of the PCL", pair().times(event)),
        *alternatives(),
    ):
        yield {"choice": other.label, "shear time [s]": other.times[0], "compression time [s]": other.times[1],
               "ratio": ratio(other.times)}  # fmt: skip


def figure_data() -> dict[str, Any]:
    """Return plain data of the tornado: a bar for each input and each choice that moves the ratio."""
    nominal = ratio(pair().times(case()["event"]))
    bars = [_bar(influence) for influence in influences() if influence.reach - 1.0 > SHOWN]
    choices = [{"label": alternative.label, "ratio": ratio(alternative.times)} for alternative in alternatives()]
    return {"ratio": nominal, "bars": bars, "choices": choices}


def _bar(influence: Influence) -> dict[str, Any]:
    """Return one input's bar: the ratio at either end, and what the ends are."""
    row, span = _row(influence.span.name), influence.span
    label = re.split("[,:]", row.description)[0]
    return {
        "label": label if row.unit == "1" else f"{label} ({pretty(row.unit)})",
        "ends": [f"{from_si(end, row.unit):.4g}" for end in (span.low, span.high)],
        "ratios": [value if np.isfinite(value) else None for value in influence.ratios],
    }


@cache
def claims() -> dict[str, Any]:
    """Return what the paper states: values with units, and the places."""
    text = resources.files("tvimdesign.report.paper").joinpath("paper_claims.yaml").read_text(encoding="utf-8")
    loaded: dict[str, Any] = plain_data(text)
    return loaded


def from_paper(name: str) -> float:
    """Return the SI value of a number the paper states."""
    entry = claims()["numbers"][name]
    return to_si(float(entry["value"]), entry["unit"])


@dataclass(frozen=True)
class Instrument:
    """Measuring instrument: its abilities with their range [SI], and where they come from."""

    value: float
    low: float
    high: float
    status: str
    source: str


def instrument(name: str) -> Instrument:
    """Return a limit of the paper's rheometer [SI]."""
    entry = claims()["instrument"][name]
    value, low, high = (to_si(float(entry[key]), entry["unit"]) for key in ("value", "low", "high"))
    return Instrument(value, low, high, entry["status"], entry["source"])


def _study() -> Study:
    from tvimdesign.study import read_study_text

    return read_study_text(claims()["study"], "the paper's module")


@cache
def published_model() -> DeviceFunctions:
    """Return the module's table and working cycle as functions."""
    return published_module().functions


@cache
def published_module() -> ResolvedModule:
    """Return the module with a value for every input, and the records it chose."""
    from tvimdesign.simulation.working_cycle.resolved_module import resolve_study

    return resolve_study(_study())


@cache
def published_values() -> dict[str, float]:
    """Return the values of the module [SI], one working cycle simulated."""
    from tvimdesign.simulation.working_cycle.cycle import Simulator

    model = published_model()
    numbers = dict(zip(model.names, model.start.tolist(), strict=True))
    return {**numbers, **model.values(model.start, Simulator(model).run(model.start).values)}


def spring_rate(wire_diameter: float, youngs_modulus: float | None = None) -> float:
    """Rate of the paper's spring by the paper's formula [N*m/rad], with another wire [m] or modulus [Pa]."""
    from tvimdesign.physics.springs import spring

    modulus = from_paper("youngs_modulus") if youngs_modulus is None else youngs_modulus
    return float(spring.rate(modulus, wire_diameter, from_paper("coil_diameter"), from_paper("coil_count")))


def published_rate() -> float:
    """Rate of the paper's spring by the paper's formula and table [N*m/rad]."""
    return spring_rate(from_paper("wire_diameter"))
