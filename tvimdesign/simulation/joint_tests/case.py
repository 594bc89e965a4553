"""Shared parts of the motion tests: the joint at each temperature and history, and numbers with their interval."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from typing import Any, Protocol, TypeVar

import numpy as np

from tvimdesign.physics.motions import motion
from tvimdesign.physics.motions.one_sided import Blocks
from tvimdesign.physics.polymers.polymer import ZERO_CELSIUS
from tvimdesign.simulation.link_motion.course import Plant
from tvimdesign.simulation.link_motion.sampled_motion import OneSided, with_loss
from tvimdesign.simulation.trial import Column, CurveTable, Finding
from tvimdesign.simulation.working_cycle.curves import fractions_at, left_at
from tvimdesign.simulation.working_cycle.device_functions import ResolvedModule
from tvimdesign.study import STANDARD_POINTS

LINEAR = (
    "The PCL is linear at every strain: it does not soften with strain, and yields only where a note says so. The "
    "structure loses the same share at every pace, exactly that of the operating point at its frequency; it is the "
    "stiffer the quicker."
)
PUSHES = (
    "Blocks push and never pull: those ahead act against positive angles, those behind against negative ones, and the "
    "springs alone act where neither touches."
)
HISTORY = (
    "Inside the melting range the PCL's history decides: low is cooled from the melt and still liquid, nominal is "
    "the equilibrium on heating, high is heated with the record's highest melting range; "
    "a finding's ends are the least and the most between low and high."
)
_ROUNDING = 1.0 + 1e-9
MELTING_POINT = {"temperature": 333.15, "frequency": 1.0}
"""The paper's third temperature, 60 degC, which joins cold and hot where a study names no points of its own."""
BETWEEN = 3  # Solid fractions between the least and the most that are tried for a finding's interval, and not shown


@dataclass(frozen=True)
class History:
    """One way to have come to a temperature, with its solid fraction; not shown, it counts in intervals only."""

    name: str
    label: str
    fraction: float
    shown: bool = True


@dataclass(frozen=True)
class Case:
    """The joint at one operating point, with one history of its layer."""

    point: str
    temperature: float
    history: History
    joint: motion.Joint
    one_sided: bool  # True if the polymer only pushes: blocks against either sense, of `modes` each
    modes: motion.Modes
    friction: float = 0.0  # Torque by which the legs' friction on their pins resists the link [N*m]

    @property
    def plant(self) -> Plant:
        """The link with its layer, or with the blocks on either side, which are alike."""
        return Plant(self.joint, Blocks(self.modes, self.modes) if self.one_sided else self.modes)

    @property
    def name(self) -> str:
        """The point's name, with the history's where there is more than one."""
        return "_".join(part for part in (self.point, self.history.name) if part)

    @property
    def label(self) -> str:
        """The name for people."""
        place = f"{self.point}, {self.temperature - ZERO_CELSIUS:.0f} °C"
        return f"{place}, {self.history.label}" if self.history.label else place

    def rows(self, resolved: ResolvedModule, names: Sequence[str]) -> dict[str, Any]:
        """Return rows of the table at this point, as this history leaves it, by plain name."""
        nominal = fractions_at(resolved, self.temperature).nominal
        values = left_at(resolved.values, self.point, self.history.fraction, nominal)
        values_by_name = resolved.table.evaluate(values, [f"{name}@{self.point}" for name in names])
        return {name: values_by_name[f"{name}@{self.point}"] for name in names}


def joint_of(resolved: ResolvedModule, point: str) -> motion.Joint:
    """Return inertia, springs and structure of the module on the bench, warm as at an operating point."""
    names = ("moving_inertia", "spring_stiffness", f"elastic_support@{point}")
    return motion.Joint(*(float(resolved.quantity(name)) for name in names))


def with_paper_points(resolved: ResolvedModule) -> ResolvedModule:
    """Return the rig, with the paper's third temperature where the study has only the standard points."""
    if dict(resolved.study.operating_points) != STANDARD_POINTS:
        return resolved
    cold, hot = STANDARD_POINTS["cold"], STANDARD_POINTS["hot"]
    study = resolved.study.model_copy(update={"operating_points": {"cold": cold, "melting": MELTING_POINT, "hot": hot}})
    added = {f"{name}@melting": value for name, value in MELTING_POINT.items()}
    return replace(resolved, study=study, values={**resolved.values, **added})


def histories_at(resolved: ResolvedModule, temperature: float) -> tuple[History, ...]:
    """Return the ways to have come to a temperature [K], nominal first; one where they are all the same."""
    low, nominal, high = fractions_at(resolved, temperature)
    if low == high:
        return (History("", "", nominal),)
    return (
        History("nominal", "heated, equilibrium", nominal),
        History("low", "cooled from the melt", low),
        History("high", "heated, melting late", high),
        *(History("", "", float(x), shown=False) for x in np.linspace(low, high, BETWEEN + 2)[1:-1]),
    )


def one_sided(resolved: ResolvedModule) -> bool:
    """Return whether the polymer only pushes."""
    return float(resolved.quantity("parting_share")) > 0.0


def cases(resolved: ResolvedModule) -> list[Case]:
    """Return the joint at every operating point, once for each history that matters there, the nominal one first."""
    pushes = one_sided(resolved)
    friction = float(resolved.quantity("pin_friction_torque"))
    cases_tested = []
    for point in resolved.points:
        _, loss = resolved.quantity(f"support@{point}")
        joint, temperature = joint_of(resolved, point), float(resolved.quantity(f"temperature@{point}"))
        for history in histories_at(resolved, temperature):
            case = Case(point, temperature, history, joint, pushes, (), friction)
            modes = [(float(time), float(k)) for time, k in case.rows(resolved, ("pcl_modes",))["pcl_modes"]]
            lossy = with_loss(joint, modes, float(loss), float(resolved.quantity(f"frequency@{point}")))
            cases_tested.append(replace(case, joint=lossy[0], modes=lossy[1]))
    return cases_tested


class _HasCase(Protocol):
    @property
    def case(self) -> Case: ...


_Tested = TypeVar("_Tested", bound=_HasCase)


def by_point(results: Sequence[_Tested]) -> list[tuple[str, list[_Tested]]]:
    """Return the tested cases by operating point."""
    points = dict.fromkeys(result.case.point for result in results)
    return [(point, [result for result in results if result.case.point == point]) for point in points]


def findings_at(point: str, rows: Iterable[tuple[str, str, str, Sequence[float]]]) -> list[Finding]:
    """Return findings of a point from rows of name, unit, meaning and the numbers of its histories.

    The nominal number comes first; where there are several, the others make an interval.
    """
    findings = []
    for name, unit, meaning, numbers in rows:
        ends = (min(numbers), max(numbers)) if len(numbers) > 1 else (None, None)
        findings.append(Finding(f"{name}@{point}", numbers[0], unit, meaning, *ends))
    return findings


def contact_columns(case: Case, course: OneSided) -> tuple[Column, ...]:
    """Return which blocks touch at each sample; nothing where none can part."""
    if not case.one_sided:
        return ()
    ahead, behind = course.touching.astype(float)
    return Column("ahead_touches", "1", ahead), Column("behind_touches", "1", behind)


def event_sheets(name: str, course: OneSided) -> tuple[CurveTable, ...]:
    """Return the moments at which a block was left or met, as a sheet of its own; none where none was."""
    if not course.events:
        return ()
    rows = np.array([[event.time, float(event.side == 0), float(event.touching)] for event in course.events]).T
    names = (("time", "s"), ("block_ahead", "1"), ("touches_from_here", "1"))
    columns = (Column(title, unit, values) for (title, unit), values in zip(names, rows, strict=True))
    return (CurveTable(f"{name}_events", tuple(columns)),)


def notes_for(resolved: ResolvedModule, torques: Sequence[tuple[Case, float]]) -> tuple[str, ...]:
    """Return the notes on cases, and on the points where a test asks more torque [N*m] of a joint than it bears."""
    pushes = (PUSHES,) if any(case.one_sided for case, _ in torques) else ()
    history = (HISTORY,) if any(case.history.name for case, _ in torques) else ()
    most = float(resolved.quantity("holding_torque"))
    beyond = " and ".join(dict.fromkeys(case.point for case, torque in torques if torque > _ROUNDING * most))
    overload = (
        f"At {beyond} the test asks for more torque than the {most:.3g} N·m the joint bears: there the curves are "
        "those of a joint that does not break, to be read as shares.",
    )
    return (LINEAR, *pushes, *history, *(overload if beyond else ()))
