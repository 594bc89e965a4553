"""Hardware for the study of a joint from a few numbers: what fits with margins, else the nearest numbers that do."""

import math
from collections.abc import Callable, Iterator
from dataclasses import replace
from typing import Any, NamedTuple

from tvimdesign.base.errors import InputError
from tvimdesign.base.units import parse_quantity
from tvimdesign.solve.infeasibility.early_checks import cures_of
from tvimdesign.solve.uncertainty.robust import Extreme, least_with_margins
from tvimdesign.study import given, read_study_text
from tvimdesign.study.sizing import (
    LARGEST,
    STROKE,
    JointTask,
    diameters,
    hardware_by_fit,
    records_of,
    study_text,
    with_free_stroke,
)

Progress = Callable[[str], None]

_CANDIDATES = 3  # Sets of hardware that are tried, the best fit first
_SEEDS = (1, 2)  # Of the starts of a search that decides on hardware
_BESIDE = 2  # Sets of hardware that are tried with other numbers
_WIDER, _ROOM = (1.1, 1.25), 1.03
"""Factors on a diameter that are tried, and room over the least: ranges follow the diameter, and must allow it."""
_MORE_FRICTION = 1.0
"""Friction over the springs' torque at full stroke where less is not to be had: they still bring the joint back."""
_SHARES = (1.0, 0.9, 0.75, 0.5)  # Of the largest torque or stroke that a search finds, which are tried
_USUAL, _LESSER = 8.0 / 0.07**3, (1.0, 0.5, 0.25, 0.1)
"""Torque that usual joints hold over the cube of their diameter [N/m^2], and shares of it that are tried."""
_AN_EIGHTH = 0.125  # Usual stiffness [N*m/rad] over the torque


class NoHardware(NamedTuple):
    """Refusal of a joint that no hardware fits, with the nearest numbers that were tried and have some."""

    longest: Extreme | None  # Largest stroke [rad] at the diameter, if that is too short
    least: Extreme | None  # Least diameter [m] of the next larger hardware
    ways: list[dict[str, str]]  # Options of `size` with which hardware fits
    tried_down_to: float = _LESSER[-1]  # Share of the torque usual at the diameter


def sized_texts(choose: Callable[[bool], str]) -> Iterator[tuple[str, bool]]:
    """Yield the studies of a joint that are to be tried until one reaches its yield, each with whether it has room.

    The first has room for the assumed values if some hardware does; `choose` returns a study with room or without.
    """
    for room in (True, False):
        text = choose(room)
        robust = read_study_text(text).robust
        cautious = robust is not None and robust.plausible is not None
        yield text, cautious
        if not cautious:
            return


def find_hardware(
    task: JointTask, name: str, progress: Progress = lambda _: None, *, room: bool = True
) -> str | NoHardware:
    """Return the study of a joint, with the first hardware whose limits can hold with margins for its tolerances.

    Hardware with `room` for the assumed values comes first.
    """
    more_friction = replace(task, friction=_MORE_FRICTION)
    if longest := _too_long(more_friction):
        return nearest(task, name, math.inf, progress, longest)
    for allowed, words in (
        *([(replace(task, cautious=True), ", with room for the assumed values")] if room else []), (task, ""),
        (more_friction, f", friction up to {_MORE_FRICTION:g} of the springs' torque"),
    ):  # fmt: skip
        progress(f"choosing the hardware{words}")
        if hardware := _hardware(allowed):
            return study_text(allowed, hardware, name)
    changed = _with_another_record(task, name, progress)
    if changed and changed[0] <= task.diameter:
        return changed[1]
    return nearest(task, name, changed[0] if changed else math.inf, progress)


def roomy_diameter(task: JointTask) -> str:
    """Return the next diameter, as an option of `size`, that has room for the assumed values; empty without one."""
    roomy, _ = _wider(replace(task, cautious=True, diameter=_ROOM * task.diameter))
    return roomy.options()["diameter"] if roomy else ""


def nearest(
    task: JointTask, name: str, least_changed: float, progress: Progress, longest: Extreme | None = None
) -> NoHardware:
    """Return why there is no study of a joint, and what to ask for instead.

    `least_changed` is the least diameter [m] with another record in a set of hardware; `longest` the largest stroke
    that it can have, if that is too short.
    """
    progress("looking for the nearest diameter that fits")
    wider, least = _wider(task)
    nearer = replace(task, diameter=1e-3 * math.ceil(_ROOM * min(least_changed, LARGEST) / 1e-3))
    if nearer.diameter < (wider.diameter if wider else LARGEST):
        changed = _with_another_record(nearer, name, progress)
        wider, least = (nearer, None) if changed and changed[0] <= nearer.diameter else (wider, least)
    progress(f"looking for another {'torque' if task.assumes_stroke else 'stroke'} or stiffness that fits")
    return NoHardware(longest, least, _nearest(task, wider))


def _with_another_record(task: JointTask, name: str, progress: Progress) -> tuple[float, str] | None:
    """Return the least diameter [m] of the sets of hardware with one record replaced, and the study; None without."""
    fitting: list[tuple[float, str]] = []
    for hardware in hardware_by_fit(task)[:_BESIDE]:
        progress(f"trying other screws, pins and springs in the hardware for {1e3 * diameters()[hardware]:.0f} mm")
        try:
            cures = cures_of(read_study_text(study_text(task, hardware)))
        except InputError:  # no module at the start of the ranges
            continue
        for record in cures.items():
            text = study_text(task, hardware, name, record)
            least = least_with_margins(read_study_text(text), "envelope_diameter")
            if record[0] in records_of(hardware) and least:
                fitting.append((least.value, text))
        if fitting and min(fitting)[0] <= task.diameter:
            break
    return min(fitting, default=None)


def _hardware(task: JointTask, *, margins: bool = True) -> str:
    """Return the best set of hardware with which the limits can hold; empty if none does."""
    return next((name for name in hardware_by_fit(task)[:_CANDIDATES] if _least(task, name, margins=margins)), "")


def _least(task: JointTask, hardware: str, *, margins: bool = True) -> Extreme | None:
    """Return the least diameter, for ranges that suit the one asked for; None if that is not enough."""
    least = _extreme(task, hardware, "envelope_diameter", margins=margins)
    return least if least and least.value <= task.diameter else None


def _extreme(
    task: JointTask, hardware: str, output: str, weight: float = 1.0, *, margins: bool = True
) -> Extreme | None:
    """Return the least value of an output that the other limits allow; with a negative weight the largest."""
    try:
        study = read_study_text(study_text(task, hardware))
    except InputError:  # no module at the start of the ranges
        return None
    beyond = 0.0
    if output == "stroke":
        study, output, beyond = with_free_stroke(study), "stop_angle", given(study)["stop_margin"]
    for seed in _SEEDS:
        seeded = study.model_copy(update={"solver": study.solver.model_copy(update={"seed": seed})})
        if extreme := least_with_margins(seeded, output, weight, margins=margins):
            return extreme._replace(value=extreme.value - beyond)
    return None


def _nearest(task: JointTask, wider: JointTask | None) -> list[dict[str, str]]:
    """Return options of `size` with which hardware fits: changed alone, else with a stiffness."""
    changed = [wider, _less(task)]
    changed += [] if any(changed) else [_other_stiffness(task)]
    changed = [way for way in changed if way] or [_less_of_all(task)]
    own = task.options()
    return [{name: text for name, text in way.options().items() if text != own[name]} for way in changed if way]


def _wider(task: JointTask) -> tuple[JointTask | None, Extreme | None]:
    """Return the task with the smallest diameter that some hardware bears, in whole millimetres, and what ends it."""
    for wider, hardware in _wider_ones(task):
        if _least(wider, hardware, margins=False) and (least := _least(wider, hardware)):
            snug = replace(task, diameter=1e-3 * math.ceil(max(_ROOM * least.value, task.diameter) / 1e-3))
            return snug if snug.diameter < wider.diameter and _hardware(snug) else wider, least
    return None, None


def _wider_ones(task: JointTask) -> Iterator[tuple[JointTask, str]]:
    """Yield the task with larger and larger diameters, each with the hardware that suits it."""
    own = hardware_by_fit(task)[0]
    yield from ((replace(task, diameter=factor * task.diameter), own) for factor in _WIDER
                if task.diameter * factor <= LARGEST and task.diameter >= diameters()[own] / factor)  # fmt: skip
    for hardware, diameter in diameters().items():
        if diameter > task.diameter:
            yield replace(task, diameter=diameter), hardware


def _other_stiffness(task: JointTask) -> JointTask | None:
    """Return the task with the nearest stiffness that hardware of its diameter has."""
    for hardware in hardware_by_fit(task)[:_BESIDE]:
        for weight in (1.0, -1.0):
            end = _extreme(task, hardware, "joint_stiffness@hot", weight, margins=False)
            beyond = end and weight * end.value > weight * task.stiffness[weight > 0.0]
            if end and beyond and _hardware(other := task.with_stiffness(_down(end.value))):
                return other
    return None


def _less(task: JointTask) -> JointTask | None:
    """Return the task with the largest stroke, or torque where none was given, that hardware of its diameter has."""
    option, output = ("torque", "holding_torque") if task.assumes_stroke else ("stroke", "stroke")
    requested, most = getattr(task, option), _most(task, output)
    values: list[Any] = [_down(share * min(most.value if most else requested, requested)) for share in _SHARES]
    lesser = (replace(task, **{option: value}) for value in values)
    return next((other for other in lesser if other != task and _hardware(other)), None)


def _most(task: JointTask, output: str, *, margins: bool = True) -> Extreme | None:
    """Return the largest value of an output that hardware for a diameter allows; None if no search finds one."""
    values = [
        _extreme(task, hardware, output, -1.0, margins=margins) for hardware in hardware_by_fit(task)[:_CANDIDATES]
    ]
    return max((most for most in values if most), default=None)


def _too_long(task: JointTask) -> Extreme | None:
    """Return the largest stroke of a diameter if the one asked for is beyond it, without margins even."""
    longest = None if task.assumes_stroke else _most(task, "stroke", margins=False)
    if longest is None or longest.value >= task.stroke:
        return None
    return None if _hardware(task, margins=False) else longest


def _less_of_all(task: JointTask) -> JointTask | None:
    """Return the task with less torque, its usual stiffness and at most the usual stroke, which fit together."""
    torques = [_down(share * min(task.torque, _USUAL * task.diameter**3)) for share in _LESSER]
    stroke = min(task.stroke, parse_quantity(STROKE, "rad"))
    lesser = (replace(task, torque=each, stroke=stroke).with_stiffness(_down(_AN_EIGHTH * each)) for each in torques)
    return next((other for other in lesser if _hardware(other)), None)


def _down(value: float) -> float:
    """Return a number rounded down to two digits."""
    digits = 10.0 ** (math.floor(math.log10(value)) - 1) if value > 0.0 else 1.0
    return math.floor(value / digits) * digits
