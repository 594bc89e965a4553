"""The paper against its own numbers: each row says what the paper states, what its formulas give here, the verdict.

The paper is T. Exley et al., "TVIM: Thermo-Active Variable Impedance Module: Evaluating Shear-Mode Capabilities of
Polycaprolactone". What it states stands in `paper_claims.yaml`; every other number is computed when the paper check is.
"""

from __future__ import annotations

import json
import math
from collections.abc import Callable
from dataclasses import asdict, dataclass
from functools import cache
from typing import TYPE_CHECKING

from tvimdesign.base.units import from_si, to_si
from tvimdesign.physics import dynamics, layer, spring, transmission
from tvimdesign.report.paper.paper_claims import claims, from_paper

if TYPE_CHECKING:
    from tvimdesign.simulation.working_cycle.device_functions import DeviceFunctions


@dataclass(frozen=True)
class PaperFinding:
    """One row of the paper check."""

    claim: str
    where: str
    computed: str
    verdict: str


def _spring_rate(wire_diameter: float) -> float:
    coil_diameter, count = from_paper("coil_diameter"), from_paper("coil_count")
    return float(spring.rate(from_paper("youngs_modulus"), wire_diameter, coil_diameter, count))


def _torsion_rate() -> str:
    rate, stated = _spring_rate(from_paper("wire_diameter")), from_paper("torsion_rate")
    inch_pounds = rate / (to_si(1.0, "lbf") * to_si(1.0, "in"))
    needed = from_paper("wire_diameter") * (stated / rate) ** 0.25
    return (
        f"E d^4/(64 D n) = {rate:.4f} N·m/rad = {inch_pounds:.2f} in·lbf/rad, which is {stated / rate:.2f} times less; "
        f"{from_si(stated, 'N*m/rad'):g} N·m/rad needs d = {from_si(needed, 'mm'):.2f} mm"
    )


def _output_stiffness() -> str:
    rate = _spring_rate(from_paper("wire_diameter"))
    count, stroke = from_paper("springs"), from_paper("stroke")
    unity = transmission.output_stiffness(count, rate, 0.0, 1.0, 0.0)
    return (
        f"N·m/rad on the left, N·m·rad on the right; the paper's own energy line gives K_s = 4 k (alpha/theta)^2 = "
        f"{unity:.2f} N·m/rad, not {count * rate * stroke**2:.4f} at {stroke:g} rad"
    )


def _inertia() -> str:
    inertia = from_paper("inertia")
    stiffness = 4.0 * _spring_rate(from_paper("wire_diameter"))
    return (
        f"{inertia:.3e} kg·m² as kg·mm²; on springs of {stiffness:.2f} N·m/rad that rings at "
        f"{dynamics.natural_frequency(stiffness, inertia):.1f} Hz"
    )


def _motion() -> str:
    stiffness, inertia = 4.0 * _spring_rate(from_paper("wire_diameter")), from_paper("inertia")
    growth = math.sqrt(stiffness / inertia)
    return (
        f"with K on the wrong side the springs push away from rest: a deflection would grow as exp({growth:.0f} t/s); "
        f"I theta'' + b theta' + K theta = T rings, and is critically damped at b = "
        f"{dynamics.critical_damping(stiffness, inertia):.4f} N·m·s/rad"
    )


def _creep() -> str:
    first, second = from_paper("recovery_methods"), from_paper("recovery_results")
    return f"two different times for one test: {first:g} s and {second:g} s, a factor of {second / first:g}"


def _area() -> str:
    answer = _published()
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


_INSULATED = {"rotor_contact": 1e-3}
"""A rotor behind no thermal contact at all: the other end of what the paper leaves open."""


@cache
def published_model() -> DeviceFunctions:
    """The paper's module as published, compiled."""
    from tvimdesign.simulation.working_cycle.device_functions import DeviceFunctions
    from tvimdesign.study import given, read_study_text

    study = read_study_text(claims()["study"], "the paper's module")
    table = study.table
    return DeviceFunctions(table, given(study), tuple(study.operating_points), study.solver.cells)


def _switches() -> tuple[float, Callable[[dict[str, float]], dict[str, float]]]:
    """The paper's thickness as assumed here [m], and a function from changed inputs to the values of one switch."""
    from tvimdesign.simulation.working_cycle.cycle import Simulator

    model = published_model()
    simulator = Simulator(model)

    def simulate(changes: dict[str, float]) -> dict[str, float]:
        inputs = model.start.copy()
        for name, value in changes.items():
            inputs[model.index[name]] = value
        return simulator.run(inputs).values

    return float(model.start[model.index["pcl_thickness"]]), simulate


def _bisect(function: Callable[[float], float], low: float, high: float, steps: int = 12) -> float:
    """Where a rising function passes zero, to a 4000th of the interval."""
    for _ in range(steps):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if function(middle) < 0.0 else (low, middle)
    return 0.5 * (low + high)


def _case() -> str:
    from tvimdesign.report.paper.paper_case import sentence

    return sentence()


def _ratio() -> str:
    place, rate = from_paper("placement_radius"), _spring_rate(from_paper("wire_diameter"))
    pins = (0.5 * place, 38e-3)
    stiffness = [
        transmission.output_stiffness(4, rate, 0.0, transmission.leg_ratio(pin, place, 0.0, 0.0), 0.0) for pin in pins
    ]
    strain = layer.shear_strain(40e-3, from_paper("stroke"), 1e-3)
    return (
        f"alpha/theta = p/(r - p) for a pin at radius p: one only at p = {pins[0] * 1e3:.1f} mm "
        f"(K_s {stiffness[0]:.2f}), K_s = {stiffness[1]:.1f} N·m/rad at p = 38 mm; "
        f"a layer of 1 mm is sheared by {strain:.0%} at r = 40 mm"
    )


@cache
def _published() -> dict[str, float]:
    """Values of the paper's module as published, one switch simulated."""
    from tvimdesign.solve.result import answer
    from tvimdesign.study import read_study_text

    study = read_study_text(claims()["study"], "the paper's module")
    return answer(study).design.values


_COMPUTED: dict[str, Callable[[], str]] = {
    "torsion_rate": _torsion_rate,
    "output_stiffness": _output_stiffness,
    "inertia": _inertia,
    "motion": _motion,
    "creep": _creep,
    "area": _area,
    "response": _response,
    "case": _case,
    "ratio": _ratio,
}


def findings() -> list[PaperFinding]:
    """Compute every row of the paper check."""
    return [
        PaperFinding(claim=row["claim"], where=row["where"], computed=_COMPUTED[row["row"]](), verdict=row["verdict"])
        for row in claims()["rows"]
    ]


def print_paper_check(as_json: bool) -> None:
    """Print the paper check for people or for scripts."""
    rows = findings()
    if as_json:
        print(json.dumps([asdict(row) for row in rows], indent=2, ensure_ascii=False))
        return
    from rich.table import Table as Grid

    from tvimdesign.report.output.progress import wide_console

    grid = Grid(title="The paper against its own numbers", title_justify="left", show_lines=True)
    for column, share in (("the paper says", 3), ("computed here", 5), ("verdict", 3)):
        grid.add_column(column, ratio=share)
    for row in rows:
        grid.add_row(f"{row.claim}\n[dim]{row.where}[/dim]", row.computed, row.verdict)
    wide_console().print(grid)
