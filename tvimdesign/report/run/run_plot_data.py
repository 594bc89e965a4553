"""Data of a run's figures: an answer's numbers in the units of the axes."""

from __future__ import annotations

import math
from bisect import bisect_left
from collections.abc import Callable
from typing import Any

from tvimdesign.base.units import from_si, pretty
from tvimdesign.device import Output, Table
from tvimdesign.report.output.numbers import axis_label, name_in_words
from tvimdesign.report.output.plot_process import Drawing
from tvimdesign.report.output.tables import NOTHING, margin_of
from tvimdesign.simulation.working_cycle.curves import PHASE_UNITS, Curves, torque_loop
from tvimdesign.solve.result import ConstraintCheck, StudyResult
from tvimdesign.study.design import Design

PLACES = {
    "hot_side": "pads, inner side", "near_face": "layer, near face", "far_face": "layer, far face",
    "cold_side": "pads, outer side",
}  # fmt: skip
"""Columns of temperatures that are drawn, and what a figure calls them."""
_PROFILES = 5


def drawings(answer: StudyResult, table: Table) -> list[Drawing]:
    """Return every figure of a run, with its data."""
    data = plot_data(answer, table)
    rooms = {
        "cycle": "cycle_figures", "stiffness_and_damping": "cycle_figures", "power_and_energy": "cycle_figures",
        "impedance": "design_figures", "torque": "design_figures", "mass": "design_figures", "bounds": "design_figures",
    }  # fmt: skip
    return [Drawing(name, f"{room}.{name}", data[name]) for name, room in rooms.items()]


def plot_data(answer: StudyResult, table: Table) -> dict[str, dict[str, Any]]:
    """Return data of every figure by the figure's name."""
    design = answer.design

    def shown(name: str) -> float:
        return from_si(design.value(name), table.unit(name))

    phases = {phase: _history(curves) for phase, curves in answer.histories.items()}
    labels = {name: axis_label(name, unit) for name, unit in PHASE_UNITS.items()}
    melting = [shown("pcl_melting_start"), shown("pcl_melting_end")]
    return {
        "cycle": {
            **phases,
            "labels": labels,
            "places": PLACES,
            "melting": melting,
            "soft": shown("soft_threshold"),
            "stiff": shown("stiff_threshold"),
            "target": shown("target_temperature"),
            "depths": depths(answer, table),
        },
        "stiffness_and_damping": {
            **phases,
            "labels": labels,
            "springs": shown("spring_stiffness"),
            "title": f"Heating at {shown('frequency@hot'):g} Hz, cooling at {shown('frequency@cold'):g} Hz",
        },
        "power_and_energy": {**phases, "labels": labels},
        "impedance": {
            "sweep": answer.sweep,
            "labels": {kind: axis_label(kind, PHASE_UNITS[f"joint_{kind}"]) for kind in ("stiffness", "damping")},
            "melting": melting,
            "frequency": shown("frequency@hot"),
            "springs": shown("spring_stiffness"),
        },
        "torque": _torque(design, shown),
        "mass": {"parts": _parts(design, table), "label": axis_label("mass", "g")},
        "bounds": {"free": free_rows(answer, table), "margins": margin_groups(answer, table)},
    }


def _history(curves: Curves) -> dict[str, Any]:
    """Return columns of a phase over its time, and the temperatures through the polymer at some moments."""
    time, through = curves["time"], through_the_layer(curves)
    moments = [min(bisect_left(time, time[-1] * i / (_PROFILES - 1)), len(time) - 1) for i in range(_PROFILES)]
    profiles = [{"time": time[at], "temperatures": [curves[name][at] for name in through]} for at in moments]
    return {name: curves[name] for name in (*PLACES, *PHASE_UNITS)} | {"profiles": profiles}


def through_the_layer(curves: Curves) -> list[str]:
    """Return columns with the temperatures through the polymer, from the pads on."""
    return ["near_face", *(name for name in curves if name.startswith("cell_")), "far_face"]


def depths(answer: StudyResult, table: Table) -> list[float]:
    """Return the depths [mm] from the Peltier side at which a profile has its temperatures."""
    depth = from_si(table.evaluate(answer.design.values, ["pcl_depth"])["pcl_depth"], "mm")
    cells = sum(name.startswith("cell_") for name in answer.histories["softening"])
    return [0.0, *((i + 0.5) / cells * depth for i in range(cells)), depth]


def _torque(design: Design, shown: Callable[[str], float]) -> dict[str, Any]:
    """Return torque over angle at every operating point, of the joint for small motions, and of its springs."""
    loops = []
    for point in design.study["operating_points"]:
        frequency, springs = design.value(f"frequency@{point}"), design.value("spring_stiffness")
        stiffness, damping = (design.value(f"joint_{kind}@{point}") for kind in ("stiffness", "damping"))
        angle, torque = torque_loop(stiffness, damping, frequency, design.value("stroke"))
        title = f"{name_in_words(point)}: {shown(f'temperature@{point}'):.0f} °C, {frequency:g} Hz"
        loops.append({"title": title, "angle": angle.tolist(), "torque": torque.tolist(),
                      "springs": (springs * angle).tolist()})  # fmt: skip
    contact = ", while the PCL is in contact" if design.value("parting_share") > 0.0 else ""
    return {
        "title": f"Torque that turns the joint through its stroke{contact}",
        "labels": {"angle": axis_label("angle", "rad"), "torque": axis_label("torque", "N*m")},
        "loops": loops,
    }


def _parts(design: Design, table: Table) -> dict[str, float]:
    """Return mass [g] of each part: the rows the module's mass is the sum of."""
    total = table.quantity("module_mass")
    assert isinstance(total, Output)
    return {name_in_words(name.removesuffix("_mass")): from_si(design.value(name), "g") for name in total.needs}


_NEAR = 0.25
"""Margin below which a rule of the machine is worth a bar."""
_SHARE = "%"
_ENDLESS = 1e9
"""Stand-in for an infinite margin: a bar ends long before."""


def free_rows(answer: StudyResult, table: Table) -> list[dict[str, Any]]:
    """Return every free variable: where it began and where it is, as shares of its range; none where nothing varies."""
    if answer.solution is None:
        return []
    rows = []
    for name, begin in answer.solution.starts[0].begin.items():
        vary, value = answer.design.study["vary"][name], answer.design.value(name)
        lower, upper = (vary["lower"], vary["upper"]) if "lower" in vary else (min(vary["values"]), max(vary["values"]))
        width = (upper - lower) or 1.0
        unit = table.unit(name)
        low, high = (f"{from_si(end, unit):.4g}" for end in (lower, upper))
        text = f"{from_si(value, unit):.4g} {pretty(unit)}".rstrip() + f"  ({low} to {high})"
        share, start = (value - lower) / width, (begin - lower) / width
        rows.append({"name": name_in_words(name), "share": share, "start": start, "text": text})
    return rows


def margin_groups(answer: StudyResult, table: Table) -> list[dict[str, Any]]:
    """Return the study's limits, the machine's where they are near, and the advice the design does not follow.

    A limit that has a size of its own is drawn in percent of it, one that has none in its quantity's unit.
    """
    near = [check for check in answer.checks if check.origin == "require" or check.margin < _NEAR]
    groups: dict[str, list[dict[str, Any]]] = {}
    for check in (*near, *answer.warnings):
        unit = _unit(check, table)
        groups.setdefault(unit, []).append(_row(check, unit, table, advice=check not in answer.checks))
    return [
        {
            "unit": unit,
            "title": "What must hold" if unit == _SHARE else f"What must hold, where the limit is 0 {unit}".rstrip(),
            "label": "Margin, of the limit (%)" if unit == _SHARE else f"Margin ({unit or '–'})",
            "rows": rows,
        }
        for unit, rows in sorted(groups.items(), key=lambda item: item[0] != _SHARE)
    ]


def _unit(check: ConstraintCheck, table: Table) -> str:
    return pretty(margin_of(check, table)[1]) if check.absolute else _SHARE


def _row(check: ConstraintCheck, unit: str, table: Table, *, advice: bool) -> dict[str, Any]:
    margin = check.margin if abs(check.margin) > NOTHING else 0.0
    own = table.unit(check.output)
    own = "K" if own == "degC" else own
    kind = "advice" if advice else "broken" if not check.kept else "kept" if margin else "binds"
    finite = math.isfinite(margin)
    size = (100.0 if unit == _SHARE else from_si(check.scale, own)) if finite else 0.0
    text = (
        f"{from_si(margin * check.scale, own):+.3g} {pretty(own)}".rstrip()
        if finite
        else "never"
        if margin < 0.0
        else "ample"
    )
    words = check.text.replace(check.output, name_in_words(check.output), 1).replace(">=", "≥").replace("<=", "≤")
    drawn = margin * size if finite else math.copysign(_ENDLESS, margin)
    text = text.replace("-", "−") if margin else f"0 {pretty(own)}"
    return {"name": words, "margin": drawn, "finite": finite, "kind": kind, "text": text}
