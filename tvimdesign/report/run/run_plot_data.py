"""What the figures are drawn from: an answer's numbers in the units of the axes."""

from __future__ import annotations

import math
from bisect import bisect_left
from typing import Any

from tvimdesign.base.units import from_si, pretty
from tvimdesign.device import Output, Table
from tvimdesign.report.output.tables import margin_text
from tvimdesign.simulation.curves import Curves
from tvimdesign.solve.result import StudyResult
from tvimdesign.study.design import Design

_OVER_TIME = ("time", "hot_side", "near_face", "far_face", "cold_side", "joint_impedance", "current")
_PROFILES = 5
_NEAR = 0.25
"""Margin below which a rule of the machine is worth a bar."""


def plot_data(answer: StudyResult, table: Table) -> dict[str, Any]:
    """Data of every figure by the figure's name."""
    design = answer.design

    def shown(name: str) -> float:
        return from_si(design.value(name), table.unit(name))

    melting = [shown("pcl_melting_start"), shown("pcl_melting_end")]
    return {
        "cycle": {
            **{phase: _history(curves) for phase, curves in answer.histories.items()},
            "melting": melting,
            "soft": shown("soft_threshold"),
            "stiff": shown("stiff_threshold"),
            "target": shown("target_temperature"),
            "depths": _depths(answer, table),
        },
        "impedance": {
            "sweep": answer.sweep,
            "melting": melting,
            "frequency": shown("frequency@hot"),
            "springs": shown("spring_stiffness"),
        },
        "mass": {"parts": _parts(design, table)},
        "bounds": {"free": _free(answer, table), "limits": _limits(answer, table)},
    }


def _history(curves: Curves) -> dict[str, Any]:
    """What is drawn of a phase: columns over its time, and the temperatures through the polymer at some moments."""
    time, through = curves["time"], ["near_face", *(name for name in curves if name.startswith("cell_")), "far_face"]
    moments = [min(bisect_left(time, time[-1] * i / (_PROFILES - 1)), len(time) - 1) for i in range(_PROFILES)]
    profiles = [{"time": time[at], "temperatures": [curves[name][at] for name in through]} for at in moments]
    return {name: curves[name] for name in _OVER_TIME} | {"profiles": profiles}


def _depths(answer: StudyResult, table: Table) -> list[float]:
    """Depths [mm] from the Peltier side at which a profile has its temperatures: both faces, the cells between them."""
    depth = from_si(table.evaluate(answer.design.values, ["pcl_depth"])["pcl_depth"], "mm")
    cells = sum(name.startswith("cell_") for name in answer.histories["softening"])
    return [0.0, *((i + 0.5) / cells * depth for i in range(cells)), depth]


def _parts(design: Design, table: Table) -> dict[str, float]:
    """Mass [g] of each part: the rows the module's mass is the sum of."""
    total = table.quantity("module_mass")
    assert isinstance(total, Output)
    return {name.removesuffix("_mass"): from_si(design.value(name), "g") for name in total.needs}


def _free(answer: StudyResult, table: Table) -> list[dict[str, Any]]:
    if answer.solution is None:
        return []
    rows = []
    for name, begin in answer.solution.starts[0].begin.items():
        vary, value = answer.design.study["vary"][name], answer.design.value(name)
        lower, upper = (vary["lower"], vary["upper"]) if "lower" in vary else (min(vary["values"]), max(vary["values"]))
        width = (upper - lower) or 1.0
        unit = table.unit(name)
        text = f"{from_si(value, unit):.4g} {pretty(unit)}"
        rows.append({"name": name, "share": (value - lower) / width, "start": (begin - lower) / width, "text": text})
    return rows


def _limits(answer: StudyResult, table: Table) -> list[dict[str, Any]]:
    """The study's limits, the machine's where they are near, and the advice the design does not follow."""
    near = [check for check in answer.checks if check.origin == "require" or check.margin < _NEAR]
    return [
        {
            "name": check.text if check in answer.checks else f"advice: {check.text}",
            "margin": check.margin if math.isfinite(check.margin) else -1.0,
            "kept": check.kept,
            "text": margin_text(check, table),
        }
        for check in (*near, *answer.warnings)
    ]
