"""The link turned to and fro as a sine: the module's torque, its loop, and stiffness and damping read off in time."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from tvimdesign.solve import link
from tvimdesign.solve.bench import Case, cases, finding, notes_for, overload_notes, with_paper_points
from tvimdesign.solve.link import Array, Motion
from tvimdesign.solve.rig import Rig
from tvimdesign.solve.trial import Column, Finding, Line, Panel, Sheet, Trial

PERIODS = 10
SAMPLES = 240  # of one period


@dataclass(frozen=True)
class Swung:
    """One sine with what its last period shows."""

    case: Case
    frequency: float
    motion: Motion
    stiffness: float
    damping: float
    dissipated: float
    apart: float
    """Distance of the complex stiffness from the frequency domain's, over its magnitude."""


def sine(rig: Rig, periods: int = PERIODS) -> Trial:
    """Turn the link as a sine of the stroke's amplitude at each point's frequency, from rest."""
    rig = with_paper_points(rig)
    found = [_swung(rig, case, periods) for case in cases(rig)]
    shown = [one for one in found if one.case.history.shown]
    frequencies = ", ".join(dict.fromkeys(f"{one.frequency:g} Hz" for one in found))
    return Trial(
        test="sine",
        title=f"Turned as a sine of {float(rig.row('stroke')):g} rad ({frequencies})",
        sheets=tuple(sheet for one in shown for sheet in _sheets(one)),
        panels=(
            Panel("Angle", "time, s", "angle, rad", _lines(shown, "", "time", "angle")),
            Panel("Torque", "time, s", "torque over its highest", _lines(shown, "", "time", "torque_share")),
            Panel("Torque over angle", "angle, rad", "torque over its highest",
                  _lines(shown, "_loop", "angle", "torque_share")),
        ),
        findings=tuple(_findings(rig, found)),
        notes=(
            "The angle is prescribed, so the link's inertia takes no part; torque is that of the module on the link.",
            f"The layer is free of strain at first; the loops and numbers are those of period {periods}.",
            *notes_for([one.case for one in found]),
            *overload_notes(rig, [(one.case, float(np.max(np.abs(one.motion.torque)))) for one in found]),
        ),
    )  # fmt: skip


def _swung(rig: Rig, case: Case, periods: int) -> Swung:
    frequency = float(rig.row(f"frequency@{case.point}"))
    moved = link.swung(case.joint, case.modes, float(rig.row("stroke")), frequency, periods, SAMPLES)
    complex_stiffness = complex_stiffness_of(moved, frequency, SAMPLES)
    rows = case.rows(rig, ("joint_stiffness", "joint_damping"))
    omega = 2.0 * np.pi * frequency
    expected = complex(rows["joint_stiffness"], omega * rows["joint_damping"])
    loop = slice(-SAMPLES - 1, None)
    return Swung(
        case, frequency, moved,
        stiffness=complex_stiffness.real,
        damping=complex_stiffness.imag / omega,
        dissipated=-float(np.trapezoid(moved.torque[loop], moved.angle[loop])),
        apart=abs(complex_stiffness - expected) / abs(expected),
    )  # fmt: skip


def complex_stiffness_of(moved: Motion, frequency: float, samples: int) -> complex:
    """Complex stiffness [N*m/rad] from the first harmonics of torque and angle over the last period."""
    wave: Array = np.exp(-2j * np.pi * frequency * moved.times[-samples:])
    return complex(-(moved.torque[-samples:] @ wave) / (moved.angle[-samples:] @ wave))


def _sheets(one: Swung) -> tuple[Sheet, Sheet]:
    moved = one.motion
    columns = (
        ("time", "s", moved.times),
        ("angle", "rad", moved.angle),
        ("torque", "N*m", moved.torque),
        ("torque_share", "1", moved.torque / np.max(np.abs(moved.torque))),
    )
    name = f"sine_{one.case.name}"
    return (
        Sheet(name, tuple(Column(*column) for column in columns)),
        Sheet(f"{name}_loop", tuple(Column(title, unit, values[-SAMPLES - 1 :]) for title, unit, values in columns)),
    )


def _lines(found: Sequence[Swung], part: str, x: str, y: str) -> tuple[Line, ...]:
    def label(one: Swung) -> str:
        highest = f" ({np.max(np.abs(one.motion.torque)):.3g} N·m)" if y == "torque_share" else ""
        return one.case.label + highest

    return tuple(Line(f"sine_{one.case.name}{part}", x, y, label(one)) for one in found)


def _findings(rig: Rig, found: Sequence[Swung]) -> list[Finding]:
    numbers = []
    for point in rig.points:
        here = [one for one in found if one.case.point == point]
        for name, unit, meaning, values in (
            ("stiffness", "N*m/rad", "Stiffness of the joint, from its motion", [one.stiffness for one in here]),
            ("damping", "N*m*s/rad", "Damping of the joint, from its motion", [one.damping for one in here]),
            ("cycle_energy", "J", "Energy turned into heat in one cycle", [one.dissipated for one in here]),
            ("frequency_domain_difference", "1", "Complex stiffness, time domain against frequency domain, of its size",
             [one.apart for one in here]),
        ):  # fmt: skip
            numbers.append(finding(f"{name}@{point}", unit, meaning, values))
    return numbers
