"""The working cycle on the page: curves with a cursor of time, and the temperatures through the layer at it."""

from __future__ import annotations

from typing import Any

from tvimdesign.device import Table
from tvimdesign.page.blocks import Drawn, Section
from tvimdesign.report.run.run_plot_data import PLACES, plot_data, through_the_layer
from tvimdesign.simulation.working_cycle.curves import Curves
from tvimdesign.solve.result import StudyResult

FIGURE = "cycle"
_PHASES = ("softening", "stiffening")
_COLUMNS = ("current", "electrical_power", "joint_impedance", "joint_stiffness", "joint_damping")
_DIGITS = 5


def cycle_section(answer: StudyResult, table: Table) -> Section:
    """Softening, then stiffening, on one axis of time."""
    says = (
        "The working cycle, simulated: temperatures, current and power, impedance, and the temperatures through the "
        "layer at the cursor. Softening first, then stiffening."
    )
    return Section(
        "cycle", "Cycle", [Drawn(FIGURE, "cycle.js", says, cycle_data(answer, table), libraries=["echarts"])]
    )


def cycle_data(answer: StudyResult, table: Table) -> dict[str, Any]:
    """Each phase's columns over its own time, with what stands beside them."""
    beside = plot_data(answer, table)["cycle"]
    return {
        "phases": [_phase(name, answer.histories[name]) for name in _PHASES if name in answer.histories],
        "labels": beside["labels"],
        "depths": _rounded(beside["depths"]),
        **{name: beside[name] for name in ("places", "melting", "soft", "stiff")},
    }


def _phase(name: str, curves: Curves) -> dict[str, Any]:
    """A phase: `through` has the temperatures through the layer, a row for each moment."""
    through = zip(*(curves[column] for column in through_the_layer(curves)), strict=True)
    columns = {column: _rounded(curves[column]) for column in (*PLACES, *_COLUMNS)}
    return {"name": name, "time": _rounded(curves["time"]), **columns, "through": [_rounded(row) for row in through]}


def _rounded(values: Any) -> list[float]:
    """Numbers in as many digits as a screen shows."""
    return [float(f"{value:.{_DIGITS}g}") for value in values]
