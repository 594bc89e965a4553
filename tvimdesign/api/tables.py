"""Numbers of an answer as quantities of pint, and its tables as data frames of pandas."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache
from typing import TYPE_CHECKING, Any

from tvimdesign.base.units import from_si
from tvimdesign.report.output.tables import NOTHING
from tvimdesign.report.run.answered_study import AnsweredStudy
from tvimdesign.simulation.working_cycle.curves import PHASE_UNITS, Curves
from tvimdesign.study import Design, Study

if TYPE_CHECKING:
    import pandas as pd
    from pint import Quantity


def quantity(value_si: float, unit: str) -> Quantity[float]:
    """Return a number in SI as a quantity of pint's application registry, in `unit`.

    Units are written in the table's order, N·m: in pint's own, by the alphabet, m·N reads as millinewton. An order that
    the user has set stays.
    """
    import pint  # takes a tenth of a second, which no command pays

    formatter = pint.application_registry.formatter
    if formatter.default_sort_func is _pint_order():
        formatter.default_sort_func = None
    if "USD" in unit and not hasattr(pint.application_registry, "USD"):
        pint.application_registry.define("dollar = [currency] = USD")  # pint itself knows no money
    return pint.Quantity(from_si(value_si, unit), unit)


@cache
def _pint_order() -> Any:
    import pint

    return pint.UnitRegistry(None).formatter.default_sort_func


def value_table(answered: AnsweredStudy, match: str = "") -> pd.DataFrame:
    """Return every value by full name, with unit, meaning and status; infinite where something never happens."""
    import pandas as pd

    design, study = answered.result.design, answered.study
    stands = _stands(answered)
    rows = []
    for name, entry in answered.reported["values"].items():
        if match.lower() not in f"{name} {entry['description']}".lower():
            continue
        rows.append({
            "name": name,
            "value": float("inf") if entry["value"] is None else entry["value"],
            "unit": entry["unit"],
            "meaning": entry["description"],
            "status": stands.get(name) or _status(name, design, study),
            "low": entry.get("low"),
            "high": entry.get("high"),
            "group": entry["group"],
        })  # fmt: skip
    columns = ["name", "value", "unit", "meaning", "status", "low", "high", "group"]
    return pd.DataFrame(rows, columns=columns).astype({"low": float, "high": float}).set_index("name")


def cycle_table(histories: Mapping[str, Curves]) -> pd.DataFrame:
    """Return the curves of all phases one below the other, with the units of the columns in `attrs`."""
    import pandas as pd

    phases = {phase: pd.DataFrame(curves) for phase, curves in histories.items()}
    frame = pd.concat(phases, names=["phase"]).reset_index(level="phase").reset_index(drop=True)
    frame.attrs["units"] = {name: PHASE_UNITS.get(name, "degC") for name in frame.columns[1:]}
    return frame


def interval_table(intervals: Mapping[str, dict[str, Any]]) -> pd.DataFrame:
    """Return what each output may be, by name: all together and one at a time; infinite where it may never happen."""
    import pandas as pd

    def ends(entry: dict[str, Any], before: str = "") -> dict[str, float]:
        return {f"{before}{end}": _never(entry[end]) for end in ("low", "high")}

    rows = {
        name: {
            "value": _never(interval["value"]), **ends(interval), **ends(interval["one_at_a_time"], "alone_"),
            "unit": interval["unit"], "measure_first": next(iter(interval["shares"]), ""),
            "share": next(iter(interval["shares"].values()), 0.0),
            "to_halve": ", ".join(interval["to_halve"]),
            **(ends(interval["before"], "before_") if interval["before"] else {}),
        }
        for name, interval in intervals.items()
    }  # fmt: skip
    return pd.DataFrame.from_dict(rows, orient="index").rename_axis("name")


def _never(number: float | None) -> float:
    """Return infinity for null: in JSON what never happens is null."""
    return float("inf") if number is None else number


def _stands(answered: AnsweredStudy) -> dict[str, str]:
    """Return how each output stands that the study limits: `violated`, `active` or `met`, the worst of its limits."""
    order = ("met", "active", "violated")
    states: dict[str, str] = {}
    for check in answered.result.checks:
        if check.origin != "require":
            continue
        stand = "violated" if not check.met else "active" if check.margin <= NOTHING else "met"
        states[check.output] = max(stand, states.get(check.output, "met"), key=order.index)
    for limit in answered.study.require:  # a limit on what is the least of several is put on each of them
        also = answered.study.limited_with(limit.output)
        parts = answered.study.table.output(limit.output).least_of or ((limit.output, *also) if also else ())
        several = [states[name] for name in parts if name in states]
        states |= {limit.output: max(several, key=order.index)} if several else {}
    return states


def _status(name: str, design: Design, study: Study) -> str:
    """Return what a value is: found by the optimiser, set by the study, a default, or computed."""
    base, _, point = name.partition("@")
    if not any(row.name == base for row in study.table.inputs):
        return "computed"
    if base in design.study["vary"]:
        return "found"
    return "set" if base in design.study["module"] or point else "default"
