"""The perturbation test: the link held off its rest and let go, at each temperature."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from tvimdesign.device.table.quantity import TOUCHING
from tvimdesign.physics.motions.one_sided import Touching
from tvimdesign.simulation.joint_tests.case import (
    Case,
    by_point,
    cases,
    contact_columns,
    event_sheets,
    findings_at,
    notes_for,
    one_sided,
    with_paper_points,
)
from tvimdesign.simulation.link_motion import link
from tvimdesign.simulation.link_motion.sampled_motion import TURNS_OF_A_SWING, Array, Motion, OneSided, turns_of
from tvimdesign.simulation.trial import Column, CurveTable, Finding, Panel, PlottedLine, Trial
from tvimdesign.simulation.working_cycle.device_functions import ResolvedModule

ANGLE = 0.1  # rad, the paper's perturbation
ANGLE_PANEL = "Released"  # How the titles of the panels begin that show the angle over time
SETTLED = 0.05  # share of the angle within which the link counts as back


@dataclass(frozen=True)
class Simple:
    """A release with one spring and one dashpot (Kelvin-Voigt), at the times of the full model."""

    angle: Array
    torque: Array
    settling: float
    difference: float
    """Root mean square over time of the angle's difference from the full model's, over that of its angle."""


@dataclass(frozen=True)
class Released:
    """One release with what is read off it."""

    case: Case
    response: OneSided
    slip: float  # Angle by which the layer slipped, or yielded, while the link was held [rad]
    backlash: float  # Angle over which nothing touches right after the hold [rad]
    frequency: float
    damping_ratio: float
    settling: float
    simple: Simple | None

    @property
    def motion(self) -> Motion:
        """The motion itself."""
        return self.response.motion

    @property
    def contact_lost(self) -> float:
        """Share of the first swing in which nothing touches."""
        return self.response.lost_share(0.0, self.response.first_swing())


def release(
    resolved: ResolvedModule, angle: float = ANGLE, hold: float | None = None, kelvin_voigt: bool = True
) -> Trial:
    """Hold the link at an angle [rad] for `hold` seconds, else `hold_time`, let go, and follow it.

    Gives angle and torque over time and the torque-angle loop at every operating point; with `kelvin_voigt` also those
    of one spring and one dashpot, stiffness and damping as at the point's frequency, where the layer is bonded. Blocks
    that only push are left and met on the way.
    """
    hold = float(resolved.quantity("hold_time")) if hold is None else hold
    resolved = with_paper_points(resolved)
    releases = [_released(resolved, case, angle, hold, kelvin_voigt) for case in cases(resolved)]
    shown = [swing for swing in releases if swing.case.history.shown]
    return Trial(
        test="release",
        title=f"Released from {angle:g} rad",
        sheets=tuple(sheet for swing in shown for sheet in _sheets(swing)),
        panels=(
            *(Panel(f"{ANGLE_PANEL}, {point}", "Time after release (s)", "Angle (rad)", _lines(here, "time", "angle"),
                    log_x=True) for point, here in by_point(shown)),
            *(Panel(f"First swing, {point}", "Angle (rad)", "Torque on the link (N·m)",
                    _lines(here, "angle", "torque")) for point, here in by_point(shown)),
        ),
        findings=tuple(_findings(releases)),
        notes=(
            f"The PCL was free of strain, was turned to {angle:g} rad at once and held there for {hold:g} s: of a hold "
            "of seconds the melt keeps nothing, frozen PCL nearly all.",
            *_notes(resolved, releases),
        ),
    )  # fmt: skip


def _notes(resolved: ResolvedModule, releases: Sequence[Released]) -> list[str]:
    """Return sentences on friction, slip, what is assumed, and links that were not followed until they settle."""
    notes = ["Torque is that of the module on the link, friction of the springs' legs on their pins counted."]
    friction = max(released.case.friction for released in releases)
    if friction:
        band = friction / releases[0].case.joint.spring_stiffness
        notes.append(
            f"Friction of {1e3 * friction:.3g} mN.m is a constant torque against the motion: the loop is twice that "
            f"wide, and the springs alone leave the link up to {1e3 * band:.3g} mrad off its rest."
        )
    slips = {swing.case.point: abs(swing.slip) for swing in releases if swing.slip}
    if slips:
        notes.append(
            f"At {' and '.join(slips)} the joint bears {float(resolved.quantity('holding_torque')):.3g} N·m and no "
            "more: the weakest on its way (see the run's table of frozen torque) slips or yields by "
            f"{1e3 * max(slips.values()):.3g} mrad while the link is held, and the link stays turned."
        )
    notes += notes_for(resolved, [(swing.case, float(abs(swing.motion.torque[0]))) for swing in releases])
    points = dict.fromkeys(released.case.point for released in releases if not np.isfinite(released.settling))
    if points:
        notes.append(
            f"At {' and '.join(points)} the link still swings where its curve ends: it settles later, if it does."
        )
    return notes


def contact_seen(resolved: ResolvedModule) -> dict[str, tuple[float, float, float]]:
    """Return nominal, least and largest value of every quantity of a first swing, after `hold_time`."""
    if not one_sided(resolved):
        values = _rows_of_a_swing(resolved, Touching(1.0, 1.0))
        return {f"{name}@{point}": (float(x),) * 3 for point in resolved.points for name, x in values.items()}
    seen: dict[str, list[float]] = {}
    for case in cases(resolved):
        internal = link.held(case.plant, ANGLE, float(resolved.quantity("hold_time")))
        motion = link.released(case.plant, ANGLE, internal, case.friction, TURNS_OF_A_SWING)
        instants = _rows_of_a_swing(resolved, Touching(*motion.touching.astype(float)))
        for name, values in instants.items():
            mean = motion.average(values, 0.0, motion.first_swing())
            seen.setdefault(f"{name}@{case.point}", []).append(mean)
    return {name: (means[0], min(means), max(means)) for name, means in seen.items()}


def _rows_of_a_swing(resolved: ResolvedModule, touching: Touching) -> dict[str, Any]:
    """Evaluate every quantity that a swing shows, where the blocks touch as given; a bonded layer always does."""
    names = [row.name for row in resolved.table.first_oscillations]
    return resolved.table.evaluate_instant({**resolved.values, TOUCHING: touching}, names)


def _released(resolved: ResolvedModule, case: Case, angle: float, hold: float, kelvin_voigt: bool) -> Released:
    internal, slip = link.held(case.plant, angle, hold), 0.0
    if not case.one_sided:
        internal, slip = link.slipped(case.plant, angle, internal, float(resolved.quantity("holding_torque")))
    motion = link.released(case.plant, angle, internal, case.friction)
    # Friction holds the link off its old rest: it settles where it stays.
    settling = motion.settling_time(SETTLED)
    if case.one_sided:
        return Released(case, motion, 0.0, case.plant.gap(internal), *_first_ringing(motion), settling, None)
    swings = link.swings(case.joint, case.modes, angle, internal)
    if slip:
        settling = swings.ringing_time(SETTLED)
    elif not np.isfinite(settling):
        settling = swings.fading_time(SETTLED * abs(angle))
    simple = _simple(resolved, case, angle, motion.motion) if kelvin_voigt else None
    return Released(case, motion, slip, 0.0, *swings.ringing(), settling, simple)


def _first_ringing(motion: OneSided) -> tuple[float, float]:
    """Return frequency [Hz] and equivalent damping ratio of the first swing; 0 and 1 if there is none.

    From the decrement d of one period: z = d/sqrt(4 pi^2 + d^2) (textbook).
    """
    moved = motion.motion
    turns = turns_of(moved.speed)
    if len(turns) < TURNS_OF_A_SWING:
        return 0.0, 1.0
    left = abs(moved.angle[turns[TURNS_OF_A_SWING - 1]] / moved.angle[0])
    decrement = -np.log(max(left, np.finfo(float).tiny))
    return 1.0 / motion.first_swing(), float(decrement / np.hypot(2.0 * np.pi, decrement))


def _simple(resolved: ResolvedModule, case: Case, angle: float, moved: Motion) -> Simple:
    rows = case.rows(resolved, ("joint_damping", "joint_stiffness"))
    damping, stiffness = float(rows["joint_damping"]), float(rows["joint_stiffness"])
    other, torque = link.kelvin_voigt(case.joint, damping, stiffness, angle, moved)
    apart = np.trapezoid((moved.angle - other) ** 2, moved.times) / np.trapezoid(moved.angle**2, moved.times)
    swings = link.kelvin_voigt_swings(case.joint, damping, stiffness, angle)
    return Simple(other, torque, swings.fading_time(SETTLED * abs(angle)), float(np.sqrt(apart)))


def _sheets(released: Released) -> tuple[CurveTable, ...]:
    name, moved = f"release_{released.case.name}", released.motion
    columns = [
        Column("time", "s", moved.times),
        Column("angle", "rad", moved.angle),
        Column("torque", "N*m", moved.torque),
        Column("stored_energy", "J", moved.energy),
        *contact_columns(released.case, released.response),
    ]
    if released.simple:
        columns += [
            Column("angle_kelvin_voigt", "rad", released.simple.angle),
            Column("torque_kelvin_voigt", "N*m", released.simple.torque),
        ]
    events = event_sheets(name, released.response)
    # The first swing alone shows loss and backlash; later ones lie over it.
    count = int(np.searchsorted(moved.times, released.response.first_swing(), side="right"))
    first = tuple(replace(column, values=column.values[:count]) for column in columns)
    return (CurveTable(name, tuple(columns)), CurveTable(f"{name}_first_swing", first), *events)


def _lines(releases: Sequence[Released], x: str, y: str) -> tuple[PlottedLine, ...]:
    lines = []
    for released in releases:
        sheet = f"release_{released.case.name}" + ("_first_swing" if x == "angle" else "")
        lines.append(PlottedLine(sheet, x, y, released.case.label))
        if released.simple and not released.case.history.name:
            across = "angle_kelvin_voigt" if x == "angle" else x
            lines.append(
                PlottedLine(sheet, across, f"{y}_kelvin_voigt", f"{released.case.point}, Kelvin-Voigt", dashed=True)
            )
    return tuple(lines)


def _findings(releases: Sequence[Released]) -> list[Finding]:
    numbers: list[Finding] = []
    for point, here in by_point(releases):
        energies = [released.motion.energy for released in here]
        rows = [
            ("held_torque", "N*m", "Torque that holds the link just before it is let go",
             [abs(float(released.motion.torque[0])) for released in here]),
            ("backlash", "rad", "Angle over which nothing but the springs acts right after the hold",
             [released.backlash for released in here]),
            ("contact_lost", "1", "Share of the first swing, up to its second turn, in which no PCL is in contact",
             [released.contact_lost for released in here]),
            ("ringing_frequency", "Hz", "Frequency at which the link swings; 0 where it creeps back",
             [released.frequency for released in here]),
            ("ringing_damping_ratio", "1", "Damping ratio of that swing; 1 where it creeps back",
             [released.damping_ratio for released in here]),
            ("settling_time", "s", f"Time until the link is within {100 * SETTLED:g} % of its angle from its rest",
             [released.settling for released in here]),
            ("rest_angle", "rad", "Angle at which friction holds the link in the end, or at which its curve ends",
             [abs(float(released.motion.angle[-1])) for released in here]),
            ("energy_dissipated", "J", "Energy that PCL and friction turned into heat over the motion shown",
             [float(energy[0] - energy[-1]) for energy in energies]),
            ("energy_gain", "1", "Largest growth of the stored energy over its start; rounding",
             [max(0.0, float(np.max(np.diff(energy)) / energy[0])) for energy in energies]),
        ]  # fmt: skip
        simple = [released.simple for released in here if released.simple]
        if simple:
            rows += [
                ("kelvin_voigt_settling_time", "s", "The same time in the Kelvin-Voigt model",
                 [released.settling for released in simple]),
                ("kelvin_voigt_difference", "1", "Its angle against the full model's, rms over rms; near 1 and above it"
                 " says nothing", [released.difference for released in simple]),
            ]  # fmt: skip
        numbers += findings_at(point, rows)
    return numbers
