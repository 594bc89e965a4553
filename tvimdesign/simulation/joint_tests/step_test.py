"""Steps: of the angle, and of the impedance itself while the link bears a load."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from tvimdesign.physics.polymers.polymer import ZERO_CELSIUS
from tvimdesign.simulation.joint_tests.case import (
    Case,
    cases,
    contact_columns,
    findings_at,
    notes_for,
    overload_notes,
    with_paper_points,
)
from tvimdesign.simulation.joint_tests.load_through_cycle import (
    Carried,
    SliceHistory,
    carry,
    changing,
    slice_histories,
    support_of,
)
from tvimdesign.simulation.link_motion import link
from tvimdesign.simulation.link_motion.sampled_motion import OneSided, doubling
from tvimdesign.simulation.trial import Column, CurveTable, Finding, Panel, PlottedLine, Trial
from tvimdesign.simulation.working_cycle.resolved_module import ResolvedModule

RISE = 0.01  # s
WATCHED = 100.0  # s
FIRST_STEP = 1e-4  # s
HALF_MOLTEN = 0.5
LOADED = "step_of_impedance"


def step(
    resolved: ResolvedModule, history: SliceHistory | None = None, rise: float = RISE, load: float | None = None
) -> Trial:
    """Turn the link to its stroke in `rise` seconds and watch the torque relax; then switch the layer under a load.

    The load [N*m] is the one that turns the joint by its stroke on its springs alone, if none is given; the layer goes
    through the working cycle, softening and stiffening, or through the given history.
    """
    resolved = with_paper_points(resolved)
    motions = [(case, _turned(resolved, case, rise)) for case in cases(resolved)]
    shown = [(case, moved) for case, moved in motions if case.history.shown]
    history = history or slice_histories(resolved)
    weight = float(resolved.quantity("spring_stiffness") * resolved.quantity("stroke")) if load is None else load
    carried = carry(changing(resolved, history), support_of(resolved), weight, history.times)
    return Trial(
        test="step",
        title=f"Steps: of the angle, and of the impedance under {weight:.3g} N·m",
        sheets=(*(_sheet(case, moved) for case, moved in shown), _loaded_sheet(carried, history)),
        panels=(
            Panel("Step of the angle", "Time (s)", "Torque (N·m)", log_x=True, log_y=True, lines=tuple(
                PlottedLine(f"step_{case.name}", "time", "holding_torque", case.label) for case, _ in shown)),
            Panel("Layer over the cycle", "Time (s)", "Temperature (°C)", lines=tuple(
                PlottedLine(LOADED, "time", f"{place}_slice", f"{place} slice")
                for place in ("near", "middle", "far"))),
            Panel("Angle under load", "Time (s)", "Angle (rad)", lines=(PlottedLine(LOADED, "time", "angle", "link"),)),
        ),
        findings=(*_relaxed(resolved, motions), *_yielded(carried, weight, one_sided=motions[0][0].one_sided)),
        notes=(
            f"Angle: to the stroke at a steady speed in {rise:g} s, then held for {WATCHED:g} s; the torque is what "
            "holds the module, without the link's inertia.",
            f"Impedance: {weight:.3g} N·m are put on the link at time 0 and stay; the link follows without inertia. "
            "What freezes joins free of stress, what melts loses its stress.",
            "Temperatures of the cycle do not depend on the load; a heated layer melts along its nominal curve, a "
            "cooled one freezes with the nominal kinetics.",
            *notes_for([case for case, _ in motions]),
            *overload_notes(resolved, [(case, float(np.max(np.abs(moved.motion.torque)))) for case, moved in motions]),
            *_never_soft(history),
        ),
    )  # fmt: skip


def _never_soft(history: SliceHistory) -> tuple[str, ...]:
    """Return a sentence on a cycle that does not melt the layer; nothing otherwise."""
    if float(np.min(history.fractions)) < HALF_MOLTEN:
        return ()
    hottest = float(np.max(history.temperatures)) - ZERO_CELSIUS
    return (f"At this current the layer does not melt: its hottest slice comes to {hottest:.0f} °C.",)


def _turned(resolved: ResolvedModule, case: Case, rise: float) -> OneSided:
    stretches = doubling(min(FIRST_STEP, rise), WATCHED)
    return link.turned(case.plant, float(resolved.quantity("stroke")), rise, stretches)


def _sheet(case: Case, motion: OneSided) -> CurveTable:
    moved = motion.motion
    return CurveTable(f"step_{case.name}", (
        Column("time", "s", moved.times), Column("angle", "rad", moved.angle),
        Column("holding_torque", "N*m", -moved.torque), *contact_columns(case, motion),
    ))  # fmt: skip


def _loaded_sheet(carried: Carried, history: SliceHistory) -> CurveTable:
    slices = history.temperatures
    return CurveTable(LOADED, (
        Column("time", "s", carried.times),
        Column("angle", "rad", carried.angle),
        Column("layer_torque", "N*m", carried.layer_torque),
        Column("near_slice", "degC", slices[0]),
        Column("middle_slice", "degC", slices[len(slices) // 2]),
        Column("far_slice", "degC", slices[-1]),
        Column("mean_solid_fraction", "1", np.mean(history.fractions, axis=0)),
        Column("stored_energy", "J", carried.energy),
    ))  # fmt: skip


def _relaxed(resolved: ResolvedModule, motions: Sequence[tuple[Case, OneSided]]) -> list[Finding]:
    numbers: list[Finding] = []
    for point in resolved.points:
        holding = [-moved.motion.torque for case, moved in motions if case.point == point]
        numbers += findings_at(point, (
            ("step_peak_torque", "N*m", "Highest torque of the step", [float(np.max(torque)) for torque in holding]),
            ("step_final_torque", "N*m", f"Torque after {WATCHED:g} s", [float(torque[-1]) for torque in holding]),
        ))  # fmt: skip
    return numbers


def _yielded(carried: Carried, load: float, one_sided: bool) -> list[Finding]:
    """Return findings on the loaded link; springs turn it back from blocks, which only push and leave a gap."""
    first, last = float(carried.angle[0]), float(carried.angle[-1])
    way = np.abs(carried.angle - first)
    half = float(np.interp(0.5 * np.max(way), np.maximum.accumulate(way), carried.times))
    spent = load * (last - first) - float(carried.energy[-1] - carried.energy[0])
    return [
        Finding("loaded_angle_start", first, "rad", "Angle right after the load is put on"),
        Finding("loaded_angle_end", last, "rad", "Angle under load at the end of the cycle"),
        Finding("loaded_half_way_time", half, "s", "Time at which the link has gone half its way"),
        Finding(
            "loaded_layer_share", float(carried.layer_torque[-1]) / load, "1", "Share of the load the layer bears last"
        ),
        Finding("loaded_energy_dissipated", spent, "J", "Energy the layer turned into heat on the way"),
        Finding("unloaded_angle", 0.0 if one_sided else carried.unloaded_angle, "rad",
                "Angle at which the link balances right after the load is taken off at the end"),
        Finding("unloaded_backlash", max(carried.set_angle, 0.0) if one_sided else 0.0, "rad",
                "Angle over which nothing but the springs acts then"),
    ]  # fmt: skip
