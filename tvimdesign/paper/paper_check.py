"""The paper against its own numbers: what it states (`paper_claims.yaml`), what its formulas give here, the verdict.

The paper is T. Exley et al., "TVIM: Thermo-Active Variable Impedance Module: Evaluating Shear-Mode Capabilities of
Polycaprolactone".
"""

import json
import math
from collections.abc import Callable
from dataclasses import asdict, dataclass
from functools import cache

import numpy as np

from tvimdesign.base.units import from_si
from tvimdesign.paper import paper_case, paper_rows
from tvimdesign.paper.paper_case import (
    claims,
    cycle_values,
    from_paper,
    instrument,
    published_model,
    published_module,
    published_rate,
    published_values,
)
from tvimdesign.physics import spring
from tvimdesign.physics.layers import layer
from tvimdesign.report.output.numbers import label, listed
from tvimdesign.report.output.page_sections import grid
from tvimdesign.report.output.terminal import print_grid, wide_console
from tvimdesign.study import standard_tolerances


def _area() -> str:
    answer = published_values()
    area = from_si(answer["pcl_area"], "mm^2")
    thickness = from_si(answer["pcl_thickness"], "mm")
    strain = answer["layer_strain"]
    return (
        f"four arcs of 26 to 40 mm radius and 49 degrees give {area:.1f} mm²; K, b and heating time all hang on the "
        f"thickness, assumed here as {thickness:g} mm: then the melt is sheared by {strain:.0%} at full stroke"
    )


def _response() -> str:
    stated = from_paper("response_time")
    thickness, simulate = _switches()
    now, insulated = simulate({}), simulate(_INSULATED)

    def late(trial: float) -> float:
        return simulate({**_INSULATED, "pcl_thickness": trial})["far_face_time"] - stated

    reached = _bisect(late, 0.2 * thickness, 4.0 * thickness)
    return (
        f"at 1.5 A with a flexible Peltier (assumed) and {thickness * 1e3:g} mm of PCL: far face "
        f"{now['far_face_time']:.0f} s, near face {now['near_face_time']:.0f} s, impedance soft after "
        f"{now['softening_time']:.0f} s, since a plastic rotor takes more heat than the layer; with a rotor that "
        f"takes none, far face {insulated['far_face_time']:.0f} s, and {stated:g} s at {reached * 1e3:.2f} mm"
    )


_TIMES = ("near_face_time", "far_face_time", "softening_time")
_INSULATED = {"rotor_contact": 1e-3}
"""A rotor behind no thermal contact at all: the other end of what the paper leaves open."""


def _switches() -> tuple[float, Callable[[dict[str, float]], dict[str, float]]]:
    """Return the paper's assumed thickness [m], and a function from changed inputs to the values of one switch."""
    from tvimdesign.simulation.working_cycle.cycle import Simulator

    model = published_model()
    simulator = Simulator(model)

    def simulate(changes: dict[str, float]) -> dict[str, float]:
        inputs = model.start.copy()
        for name, value in changes.items():
            inputs[model.index[name]] = value
        return simulator.run(inputs, phases=list(model.phases)[:1], wanted=_TIMES).values

    return float(model.start[model.index["pcl_thickness"]]), simulate


def _bisect(function: Callable[[float], float], low: float, high: float, steps: int = 12) -> float:
    """Find by bisection where a rising function passes zero, to a 4000th of the interval."""
    for _ in range(steps):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if function(middle) < 0.0 else (low, middle)
    return 0.5 * (low + high)


def _creep() -> str:
    first, second = from_paper("recovery_methods"), from_paper("recovery_results")
    return f"two different times for one test: {first:g} s and {second:g} s, a factor of {second / first:g}"


def _parallel_springs() -> str:
    values = published_values()
    springs = float(spring.output_stiffness(from_paper("springs"), published_rate(), 0.0, 1.0, 0.0))
    cold, hot = values["pcl_stiffness@cold"], values["pcl_stiffness@hot"]
    shown = values["joint_stiffness@cold"]
    return (
        f"at 30 °C a layer of {values['pcl_thickness'] * 1e3:g} mm has G J/t = {cold:.3g} N·m/rad, "
        f"{cold / springs:,.0f} times the springs' {springs:.2f}; at 100 °C and 1 Hz {hot:.2f} N·m/rad, and only then "
        f"are springs the stiffer. What the joint shows at 30 °C is its structure, {shown:.0f} N·m/rad as drawn here"
    )


def _release() -> str:
    values, angle = published_values(), from_paper("release_angle")
    torque = values["joint_stiffness@cold"] * angle
    strain = layer.shear_strain(values["pcl_outer_radius"], angle, values["pcl_thickness"])
    modulus = values["pcl_stiffness@cold"] * values["pcl_thickness"] / values["layer_polar_moment"]
    yielding = values["pcl_tensile_yield"] / math.sqrt(3.0) / modulus
    held = values["holding_torque"]
    return (
        f"{torque:.0f} N·m against the structure as drawn here, which holds {held:.1f} N·m, reached at "
        f"{held / values['joint_stiffness@cold']:.4f} rad; with a rigid structure it would be {strain:.0%} of strain "
        f"of a solid that yields at {yielding:.1%} (tensile yield over the square root of 3, over G)"
    )


def _housing() -> str:
    values, material = published_values(), published_module().values["structure_material"]
    service = material.entry("service_temperature")
    ends = (service.value, service.low or service.value, service.high or service.value)
    shown = [from_si(end, "degC") for end in ends]
    peaks = [from_si(values[name], "degC") for name in ("peak_heater_temperature", "peak_rotor_temperature")]
    return (
        f"{material.title}: {shown[0]:.0f} °C in continuous service ({shown[1]:.0f} to {shown[2]:.0f}, "
        f"{service.status}), with a glass transition at 75-85 °C; with the far face of the PCL at 100 °C the pads have "
        f"{peaks[0]:.0f} °C and the rotor plate {peaks[1]:.0f} °C, {peaks[1] - shown[0]:.0f} K above its service"
    )


def _torque_sensor() -> str:
    values, angle, sensor = published_values(), from_paper("release_angle"), instrument("torque_error")
    frozen, springs = (values[name] * angle for name in ("joint_stiffness@cold", "spring_stiffness"))
    shares = [f"{100.0 * error * frozen / springs:.0f}" for error in (sensor.value, sensor.low, sensor.high)]
    return (
        f"a release from {angle:g} rad asks for {frozen:.0f} N·m frozen, for {springs:.2f} N·m of the springs alone. A "
        f"sensor for the first, off by {sensor.value:.1%} of its range ({sensor.low:.1%} to {sensor.high:.1%}, "
        f"{sensor.status}), is off by {shares[0]} % ({shares[1]} to {shares[2]}) of the second"
    )


_SMALL = 0.045  # Width [m] of a small joint


def _small_joint() -> str:
    from tvimdesign.simulation.working_cycle.device_functions import resolve_study
    from tvimdesign.solve.nlp.constraints import constraints_of

    module, factor = published_module(), _SMALL / published_values()["envelope_diameter"]
    shrunk = {row.name: factor * module.values[row.name] for row in module.table.inputs if row.unit == "mm"}
    study = module.study.model_copy(update={"module": {**module.study.module, **shrunk}})
    small = resolve_study(study)
    values = cycle_values(small.functions)
    limits = [limit for limit in constraints_of(study, small.table, small.values) if limit.output in values]
    violated = [label(limit.output) for limit in limits if not limit.keeps(np.array(values[limit.output]))]
    spread = from_si(standard_tolerances(small.table)["pcl_thickness"].plus_minus or 0.0, "mm")
    return (
        f"every length times {factor:.2f} makes it {_SMALL * 1e3:g} mm wide: {values['holding_torque']:.2f} N·m "
        f"frozen, {values['spring_stiffness']:.2f} N·m/rad of springs, {values['pcl_thickness'] * 1e3:.2f} mm of PCL "
        f"between printed faces that vary by {spread:g} mm; violated: {listed(violated)}"
    )


@dataclass(frozen=True)
class PaperFinding:
    """One row of the paper check."""

    claim: str
    where: str
    computed: str
    verdict: str


def computed(row: str) -> str:
    """Return the sentence of a row, by the function of its name."""
    functions = {**vars(paper_case), **vars(paper_rows), **globals()}
    return str(functions[f"_{row}"]())


@cache
def findings() -> tuple[PaperFinding, ...]:
    """Compute every row of the paper check."""
    return tuple(
        PaperFinding(claim=row["claim"], where=row["where"], computed=computed(row["row"]), verdict=row["verdict"])
        for row in claims()["rows"]
    )


def print_paper_check(as_json: bool) -> None:
    """Print the paper check for people or for scripts."""
    rows = findings()
    if as_json:
        print(json.dumps([asdict(row) for row in rows], indent=2, ensure_ascii=False))
        return
    rows_of_text = [(f"{row.claim} ({row.where})", row.computed, row.verdict) for row in rows]
    heads = ("the paper says", "computed here", "verdict")
    print_grid(grid("The paper against its own numbers", heads, rows_of_text, code=()), wide_console(), lines=True)
