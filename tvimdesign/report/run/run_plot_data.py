"""Data of a run's figures: an answer's numbers in the units of the axes."""

from bisect import bisect_left
from collections.abc import Callable
from typing import Any

from tvimdesign.base.units import from_si
from tvimdesign.device import Table
from tvimdesign.report.output.numbers import axis_label, name_in_words
from tvimdesign.report.output.plot_process import Drawing
from tvimdesign.simulation.working_cycle.curves import PHASE_UNITS, Curves, torque_loop
from tvimdesign.solve.result import StudyResult
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
    names = ("cycle", "stiffness_and_damping", "power_and_energy", "impedance", "torque")
    return [Drawing(name, f"design_figures.{name}", data[name]) for name in names]


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
        swing = design.value("stroke")
        if not springs:  # a lock turns far, but frozen not beyond what it holds
            swing = min(swing, design.value("holding_torque") / stiffness)
        angle, torque = torque_loop(stiffness, damping, frequency, swing)
        title = f"{name_in_words(point)}: {shown(f'temperature@{point}'):.0f} °C, {frequency:g} Hz"
        loops.append({"title": title, "angle": angle.tolist(), "torque": torque.tolist(),
                      "springs": (springs * angle).tolist()})  # fmt: skip
    contact = ", while the PCL is in contact" if design.value("parting_share") > 0.0 else ""
    return {
        "title": f"Torque that turns the joint through its stroke{contact}",
        "stop_angle": design.value("stop_angle"),
        "labels": {"angle": axis_label("angle", "rad"), "torque": axis_label("torque", "N*m")},
        "loops": loops,
    }
