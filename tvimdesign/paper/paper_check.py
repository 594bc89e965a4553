"""The paper against its own numbers: what it states (`paper_claims.yaml`), what its formulas give here, the verdict.

The paper is T. Exley et al., "TVIM: Thermo-Active Variable Impedance Module: Evaluating Shear-Mode Capabilities of
Polycaprolactone".
"""

import json
import math
from collections.abc import Callable
from functools import cache

import numpy as np

from tvimdesign.base.units import from_si
from tvimdesign.paper import paper_case, paper_rows
from tvimdesign.paper.paper_case import Values, claims, ends, from_paper, published_module, published_values
from tvimdesign.physics import spring
from tvimdesign.physics.layers import layer
from tvimdesign.report.output.numbers import label, listed
from tvimdesign.report.output.page_sections import grid
from tvimdesign.report.output.terminal import print_grid, wide_console
from tvimdesign.study import standard_tolerances


def _area() -> Values:
    values = published_values()
    area, thickness = from_si(values["pcl_area"], "mm^2"), from_si(values["pcl_thickness"], "mm")
    return {"area": area, "thickness": thickness, "strain": values["layer_strain"]}


def _response() -> Values:
    from scipy.optimize import bisect

    stated = from_paper("response_time")
    thickness, simulate = _switches()

    def late(trial: float) -> float:
        return simulate({**_INSULATED, "pcl_thickness": trial})["far_face_time"] - stated

    return {
        "thickness": thickness * 1e3, "now": simulate({}), "insulated": simulate(_INSULATED), "stated": stated,
        "reached": bisect(late, 0.2 * thickness, 4.0 * thickness, xtol=1e-3 * thickness) * 1e3,
    }  # fmt: skip


_TIMES = ("near_face_time", "far_face_time", "softening_time")
_INSULATED = {"rotor_contact": 1e-3}
"""A rotor behind no thermal contact at all: the other end of what the paper leaves open."""


def _switches() -> tuple[float, Callable[[dict[str, float]], dict[str, float]]]:
    """Return the paper's assumed thickness [m], and a function from changed inputs to the values of one switch."""
    from tvimdesign.simulation.working_cycle.cycle import Simulator

    model = published_module().functions
    simulator = Simulator(model)

    def simulate(changes: dict[str, float]) -> dict[str, float]:
        inputs = model.start.copy()
        for name, value in changes.items():
            inputs[model.index[name]] = value
        return simulator.run(inputs, phases=list(model.phases)[:1], wanted=_TIMES).values

    return float(model.start[model.index["pcl_thickness"]]), simulate


def _creep() -> Values:
    first, second = from_paper("recovery_methods"), from_paper("recovery_results")
    return {"first": first, "second": second, "factor": second / first}


def _parallel_springs() -> Values:
    values = published_values()
    springs = float(spring.output_stiffness(from_paper("springs"), paper_case.published_rate(), 0.0, 1.0, 0.0))
    cold, hot, shown = (values[name] for name in ("pcl_stiffness@cold", "pcl_stiffness@hot", "joint_stiffness@cold"))
    return {
        "thickness": values["pcl_thickness"] * 1e3, "cold": cold, "hot": hot, "springs": springs,
        "times": cold / springs, "shown": shown,
    }  # fmt: skip


def _release() -> Values:
    values, angle = published_values(), from_paper("release_angle")
    modulus = values["pcl_stiffness@cold"] * values["pcl_thickness"] / values["layer_polar_moment"]
    return {
        "torque": values["joint_stiffness@cold"] * angle, "held": values["holding_torque"],
        "reached": values["holding_torque"] / values["joint_stiffness@cold"],
        "strain": layer.shear_strain(values["pcl_outer_radius"], angle, values["pcl_thickness"]),
        "yielding": values["pcl_tensile_yield"] / math.sqrt(3.0) / modulus,
    }  # fmt: skip


def _housing() -> Values:
    values, material = published_values(), published_module().values["structure_material"]
    service = material.entry("service_temperature")
    shown = [from_si(end, "degC") for end in ends(service)]
    pads, rotor = (from_si(values[name], "degC") for name in ("peak_heater_temperature", "peak_rotor_temperature"))
    return {
        "title": material.title, "shown": shown, "status": service.status, "pads": pads, "rotor": rotor,
        "above": rotor - shown[0],
    }  # fmt: skip


def _torque_sensor() -> Values:
    values, angle, sensor = published_values(), from_paper("release_angle"), paper_case.instrument("torque_error")
    frozen, springs = (values[name] * angle for name in ("joint_stiffness@cold", "spring_stiffness"))
    return {
        **vars(sensor), "angle": angle, "frozen": frozen, "springs": springs,
        "shares": [100.0 * error * frozen / springs for error in ends(sensor)],
    }  # fmt: skip


_SMALL = 0.045  # Width [m] of a small joint


def _small_joint() -> Values:
    from tvimdesign.simulation.working_cycle.device_functions import resolve_study
    from tvimdesign.solve.nlp.constraints import constraints_of

    module, factor = published_module(), _SMALL / published_values()["envelope_diameter"]
    shrunk = {row.name: factor * module.values[row.name] for row in module.table.inputs if row.unit == "mm"}
    study = module.study.model_copy(update={"module": {**module.study.module, **shrunk}})
    small = resolve_study(study)
    values = paper_case.cycle_values(small.functions)
    limits = [limit for limit in constraints_of(study, small.table, small.values) if limit.output in values]
    violated = [label(limit.output) for limit in limits if not limit.keeps(np.array(values[limit.output]))]
    spread = from_si(standard_tolerances(small.table)["pcl_thickness"].plus_minus or 0.0, "mm")
    return {
        "factor": factor, "width": _SMALL * 1e3, "held": values["holding_torque"],
        "springs": values["spring_stiffness"], "layer": values["pcl_thickness"] * 1e3, "spread": spread,
        "violated": listed(violated),
    }  # fmt: skip


def computed(row: str) -> str:
    """Return the sentence of a row, with the numbers of the function of its name."""
    functions = {**vars(paper_case), **vars(paper_rows), **globals()}
    sentence: str = next(entry["computed"] for entry in claims()["rows"] if entry["row"] == row)
    return sentence.format(**functions[f"_{row}"]())


@cache
def findings() -> tuple[dict[str, str], ...]:
    """Compute every row of the paper check: claim, where it stands, what is computed here, and the verdict."""
    parts = ("claim", "where", "computed", "verdict")
    return tuple({name: {**row, "computed": computed(row["row"])}[name] for name in parts} for row in claims()["rows"])


def print_paper_check(as_json: bool) -> None:
    """Print the paper check for people or for scripts."""
    rows = findings()
    if as_json:
        print(json.dumps(rows, indent=2, ensure_ascii=False))
        return
    rows_of_text = [(f"{row['claim']} ({row['where']})", row["computed"], row["verdict"]) for row in rows]
    heads = ("the paper says", "computed here", "verdict")
    print_grid(grid("The paper against its own numbers", heads, rows_of_text, code=()), wide_console(), lines=True)
