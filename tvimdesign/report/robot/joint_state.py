"""The joint at each operating point as a simulator takes it: springs, Maxwell elements, friction, and a time step."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from tvimdesign.physics.motions.motion import Modes
from tvimdesign.simulation.joint_tests.case import Case, cases
from tvimdesign.simulation.link_motion.sampled_motion import RIGID, in_series
from tvimdesign.simulation.working_cycle.resolved_module import ResolvedModule

STEP_SHARE = 0.02
"""The time step times the joint's quickest angular frequency: first-order steps keep a release within 0.6 % then."""
ONE_SIDED_SHARE = 0.005
"""The same of blocks that only push, whose frozen releases swing on for long: within 0.5 %."""


@dataclass(frozen=True)
class JointState:
    """The joint at one operating point; angles in rad, torques in N*m."""

    point: str
    temperature: float
    """[K]."""
    frequency: float
    """At which `stiffness` and `damping` hold [Hz]."""
    stiffness: float
    """Of the whole joint at the frequency [N*m/rad]."""
    damping: float
    """Of the whole joint at the frequency [N*m*s/rad]."""
    springs: float
    """Of the springs alone [N*m/rad]."""
    friction: float
    """Torque of the springs' legs on their pins [N*m]."""
    inertia: float
    """Of all that moves, the load on the bench counted [kg*m^2]."""
    one_sided: bool
    """Whether the PCL only pushes: blocks against either sense, with `modes` each."""
    hold: float
    """How long the link is held before a release [s]."""
    modes: Modes
    """Maxwell elements between link and housing: relaxation time [s], stiffness [N*m/rad]; the slowest first."""

    @property
    def stiffest(self) -> float:
        """Stiffness before anything relaxes [N*m/rad]."""
        return self.springs + float(sum(stiffness for _, stiffness in self.modes))


def joint_states(resolved: ResolvedModule) -> list[JointState]:
    """Return the joint at every operating point, its PCL come there on heating where history matters."""
    shown_cases = [case for case in cases(resolved) if case.history.name in ("", "nominal") and case.history.shown]
    return [_state(resolved, case) for case in shown_cases]


def _state(resolved: ResolvedModule, case: Case) -> JointState:
    rows = case.rows(resolved, ("joint_stiffness", "joint_damping"))
    modes: Modes = case.modes
    if case.joint.structure_stiffness < RIGID:
        modes = in_series(modes, case.joint.structure_stiffness, [])
    return JointState(
        point=case.point,
        temperature=case.temperature,
        frequency=float(resolved.quantity(f"frequency@{case.point}")),
        stiffness=float(rows["joint_stiffness"]),
        damping=float(rows["joint_damping"]),
        springs=float(case.joint.spring_stiffness),
        friction=case.friction,
        inertia=float(case.joint.inertia),
        one_sided=case.one_sided,
        hold=float(resolved.quantity("hold_time")),
        modes=sorted(modes, reverse=True),
    )


def usual_step(states: Sequence[JointState]) -> float:
    """Return a time step [s] that gives every state's release with the bench's load to 1 %: 1, 2 or 5 of a decade."""
    quickest = max(np.sqrt(state.stiffest / state.inertia) for state in states)
    least = (ONE_SIDED_SHARE if states[0].one_sided else STEP_SHARE) / quickest
    decade = 10.0 ** np.floor(np.log10(least))
    return float(max(digit * decade for digit in (1.0, 2.0, 5.0) if digit * decade <= least))
