"""The link turned to and fro as a sine: the module's torque, its loop, and stiffness and damping read off in time."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from tvimdesign.simulation.joint_tests.case import (
    Case,
    by_point,
    cases,
    contact_columns,
    event_sheets,
    findings_at,
    notes_for,
    with_paper_points,
)
from tvimdesign.simulation.link_motion import link
from tvimdesign.simulation.link_motion.sampled_motion import Array, Motion, OneSided
from tvimdesign.simulation.trial import Column, CurveTable, Finding, Panel, PlottedLine, Trial
from tvimdesign.simulation.working_cycle.device_functions import ResolvedModule

PERIODS = 10
SAMPLES = 240  # of one period
ROUNDING = 1e-9
"""Share of a period by which its first sample may be early, and of a stiffness below which its phase is none."""


@dataclass(frozen=True)
class Swung:
    """One sine with what its last period shows."""

    case: Case
    frequency: float
    response: OneSided
    stiffness: float
    damping: float
    dissipated: float
    apart: float  # Distance of the complex stiffness from the frequency domain's, over its magnitude
    contact_lost: float  # Share of the last period in which nothing touches

    @property
    def motion(self) -> Motion:
        """The motion itself."""
        return self.response.motion


def sine(resolved: ResolvedModule, periods: int = PERIODS) -> Trial:
    """Turn the link as a sine of the stroke's amplitude at each point's frequency, from rest."""
    resolved = with_paper_points(resolved)
    swings = [_swung(resolved, case, periods) for case in cases(resolved)]
    shown = [swing for swing in swings if swing.case.history.shown]
    frequencies = ", ".join(dict.fromkeys(f"{swing.frequency:g} Hz" for swing in swings))
    return Trial(
        test="sine",
        title=f"Turned as a sine of {float(resolved.quantity('stroke')):g} rad ({frequencies})",
        sheets=tuple(sheet for swing in shown for sheet in _sheets(swing)),
        panels=tuple(
            Panel(f"{place}, {point}", label, "Torque on the link (N·m)", _lines(here, x))
            for x, label, place in (("time", "Time (s)", "Last period"), ("angle", "Angle (rad)", "Loop"))
            for point, here in by_point(shown)
        ),
        findings=tuple(_findings(swings)),
        notes=(
            "The angle is prescribed, so the link's inertia takes no part; torque is that of the module on the link.",
            f"The PCL is free of strain at first; the loops and numbers are those of period {periods}.",
            *notes_for(resolved, [(swing.case, float(np.max(np.abs(swing.motion.torque)))) for swing in swings]),
        ),
    )


def _swung(resolved: ResolvedModule, case: Case, periods: int) -> Swung:
    frequency = float(resolved.quantity(f"frequency@{case.point}"))
    motion = link.swung(case.plant, float(resolved.quantity("stroke")), frequency, periods, SAMPLES)
    moved = motion.motion
    complex_stiffness = complex_stiffness_of(moved, frequency)
    lossy = complex_stiffness.imag
    rows = case.rows(resolved, ("joint_stiffness", "joint_damping"))
    omega = 2.0 * np.pi * frequency
    expected = complex(rows["joint_stiffness"], omega * rows["joint_damping"])
    loop = last_period(moved, frequency)
    return Swung(
        case, frequency, motion,
        stiffness=complex_stiffness.real,
        damping=lossy / omega if abs(lossy) > ROUNDING * abs(complex_stiffness) else 0.0,
        dissipated=-float(np.trapezoid(moved.torque[loop], moved.angle[loop])),
        apart=abs(complex_stiffness - expected) / abs(expected),
        contact_lost=motion.lost_share(float(moved.times[loop][0]), float(moved.times[-1])),
    )  # fmt: skip


def last_period(moved: Motion, frequency: float) -> slice:
    """Return samples of the last period, both its ends included; more than elsewhere where blocks are left and met."""
    begin = moved.times[-1] - (1.0 + ROUNDING) / frequency
    return slice(int(np.searchsorted(moved.times, begin)), None)


def complex_stiffness_of(moved: Motion, frequency: float) -> complex:
    """Return the complex stiffness [N*m/rad] from the first harmonics of torque and angle over the last period."""
    loop = last_period(moved, frequency)
    times = moved.times[loop]
    wave: Array = np.exp(-2j * np.pi * frequency * times)
    torque, angle = (np.trapezoid(values[loop] * wave, times) for values in (moved.torque, moved.angle))
    return complex(-torque / angle)


def _sheets(swung: Swung) -> tuple[CurveTable, ...]:
    moved = swung.motion
    columns = (
        Column("time", "s", moved.times),
        Column("angle", "rad", moved.angle),
        Column("torque", "N*m", moved.torque),
        *contact_columns(swung.case, swung.response),
    )
    name, loop = f"sine_{swung.case.name}", last_period(moved, swung.frequency)
    return (
        CurveTable(name, columns),
        CurveTable(f"{name}_loop", tuple(replace(column, values=column.values[loop]) for column in columns)),
        *event_sheets(name, swung.response),
    )


def _lines(swings: Sequence[Swung], x: str) -> tuple[PlottedLine, ...]:
    """Return the torque of the last period; all before it are like it once the layer has forgotten how it began."""
    return tuple(PlottedLine(f"sine_{swing.case.name}_loop", x, "torque", swing.case.label) for swing in swings)


def _findings(swings: Sequence[Swung]) -> list[Finding]:
    numbers: list[Finding] = []
    for point, here in by_point(swings):
        numbers += findings_at(point, (
            ("stiffness", "N*m/rad", "Stiffness of the joint, from its motion", [swing.stiffness for swing in here]),
            ("damping", "N*m*s/rad", "Damping of the joint, from its motion", [swing.damping for swing in here]),
            ("contact_lost", "1", "Share of the last period in which no PCL is in contact",
             [swing.contact_lost for swing in here]),
            ("cycle_energy", "J", "Energy turned into heat in one cycle", [swing.dissipated for swing in here]),
            ("frequency_domain_difference", "1", "Complex stiffness as seen against that of small motions, of its size",
             [swing.apart for swing in here]),
        ))  # fmt: skip
    return numbers
