"""Times of a switch of studies, simulated as the product does, and what the paper's module does."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache
from typing import Any

from fe_structure.models import study_file

from tvimdesign.paper.paper_case import published_module, published_values
from tvimdesign.simulation.working_cycle.cycle import Simulator
from tvimdesign.simulation.working_cycle.device_functions import resolve_study
from tvimdesign.study import read_study

Values = Mapping[str, Any]


@cache
def _times(study: str) -> Mapping[str, float]:
    """Values of one working cycle of a study as it starts, its melt without memory, as the plane's is."""
    read = read_study(study_file(study))
    model = resolve_study(read).functions
    values = model.start.copy()
    if "melt_memory" in model.index:
        values[model.index["melt_memory"]] = 1.0
    return Simulator(model).run(values).values


def starts(inputs: Values) -> Values:
    """Times [s] of rows of study and time, as the studies start."""
    return {"time": [_times(study)[time] for study, time in inputs["times"]]}


def published_times(inputs: Values) -> Values:
    """Times [s] of the paper's module with what the case changes, to the temperature that its paper states."""
    model = published_module().functions
    values = model.start.copy()
    for name, value in inputs["changes"].items():
        values[model.index[name]] = value
    results = Simulator(model).run(values).values
    return {time: results[time] for time in ("near_face_time", "mean_time", "far_face_time")}


def published_sizes(_: Values) -> Values:
    """Contact area [mm^2] and inertia-free figures of the paper's module."""
    values = published_values()
    return {"area": values["pcl_area"] * 1e6}
