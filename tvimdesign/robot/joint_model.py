"""The joint of a design as simulators take it: rigid bodies, state at each operating point, and time step."""

import json
import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from math import sqrt
from pathlib import Path

import numpy as np

from tvimdesign.base.errors import InputError
from tvimdesign.cad.cad_report import CadReport
from tvimdesign.cad.jobs.rigid_bodies import BASE, BODIES, MESHES, MOVING
from tvimdesign.cad.make import make_cad
from tvimdesign.device.core.motor_choice import WITHOUT
from tvimdesign.physics.motions.motion import Modes
from tvimdesign.physics.polymers.polymer import ZERO_CELSIUS
from tvimdesign.simulation.joint_tests.case import Case, cases
from tvimdesign.simulation.joint_tests.release import ANGLE
from tvimdesign.simulation.link_motion.sampled_motion import RIGID, in_series
from tvimdesign.simulation.working_cycle.device_functions import ResolvedModule

STEP_SHARE = 0.02
"""The time step times the joint's quickest angular frequency: first-order steps keep a release within 0.6 % then."""
ONE_SIDED_SHARE = 0.005  # Error of blocks that only push, whose frozen releases swing on for long: within 0.5 %


@dataclass(frozen=True)
class JointState:
    """The joint at one operating point; angles in rad, torques in N*m."""

    point: str
    temperature: float  # [K]
    frequency: float  # At which `stiffness` and `damping` hold [Hz]
    stiffness: float  # Of the whole joint at the frequency [N*m/rad]
    damping: float  # Of the whole joint at the frequency [N*m*s/rad]
    springs: float  # Of the springs alone [N*m/rad]
    friction: float  # Torque of the springs' legs on their pins [N*m]
    inertia: float  # Of all that moves, the load on the bench counted [kg*m^2]
    one_sided: bool  # True if the PCL only pushes: blocks against either sense, with `modes` each
    hold: float  # How long the link is held before a release [s]
    modes: Modes
    """Maxwell elements between link and housing: relaxation time [s], stiffness [N*m/rad]; the slowest first."""

    @property
    def plain(self) -> dict[str, float]:
        """The numbers that files for simulators list."""
        names = ("temperature", "frequency", "stiffness", "damping", "springs", "friction")
        return {name: getattr(self, name) for name in names}

    @property
    def stiffest(self) -> float:
        """Stiffness before anything relaxes [N*m/rad]."""
        return self.springs + float(sum(stiffness for _, stiffness in self.modes))


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


@dataclass(frozen=True)
class RigidBody:
    """Rigid body for a simulator, in the module's coordinates: the rotor's axis is z."""

    name: str
    mass: float  # [kg]
    centre: tuple[float, float, float]  # Centre of mass [m]
    inertia: tuple[tuple[float, float, float], ...]  # Tensor about the centre of mass [kg*m^2], three rows
    mesh: str  # File in metres, relative to the folder of the model

    @property
    def moments(self) -> dict[str, float]:
        """The six entries of the tensor that differ, by their names in model files."""
        (xx, xy, xz), (_, yy, yz), (_, _, zz) = self.inertia
        return {"ixx": xx, "ixy": xy, "ixz": xz, "iyy": yy, "iyz": yz, "izz": zz}

    def about_axis(self) -> float:
        """Return the moment of inertia about the rotor's axis [kg*m^2], by the parallel axes."""
        return self.inertia[2][2] + self.mass * (self.centre[0] ** 2 + self.centre[1] ** 2)


def make_bodies(
    design: Path, folder: Path, progress: Callable[[str], None] = lambda _: None
) -> tuple[RigidBody, RigidBody, CadReport]:
    """Make what stands and what turns of a design.json, with their meshes in the folder. Raises GeometryError."""
    report = make_cad(design, folder, progress, job="tvimdesign.cad.jobs.rigid_bodies")
    data = json.loads((folder / BODIES).read_text())
    base, moving = (RigidBody(name=name, mesh=f"{MESHES}/{name}.stl", **data[name]) for name in (BASE, MOVING))
    return base, moving, report


@dataclass(frozen=True)
class JointModel:
    """A joint for simulators."""

    name: str
    base: RigidBody
    moving: RigidBody
    states: tuple[JointState, ...]
    stroke: float  # To either side [rad]
    stop_angle: float  # Angle of the hard stops to either side [rad]
    holding_torque: float  # Torque that the frozen joint bears [N*m]
    step: float  # Time step [s]
    left_out: tuple[str, ...]  # Properties of the joint that no file has, a sentence each

    @property
    def slug(self) -> str:
        """Its name for formats that take words: letters, digits and underscores."""
        return re.sub(r"\W+", "_", self.name, flags=re.ASCII).strip("_").lower() or "joint"

    @property
    def released_from(self) -> float:
        """Angle of the keyframe [rad]: the virtual test's, or the stroke where that is less."""
        return min(ANGLE, self.stroke)

    @property
    def count(self) -> int:
        """Return how many Maxwell elements every state has, idle ones counted."""
        return max(len(state.modes) for state in self.states)

    @property
    def load(self) -> float:
        """Inertia of the load on the bench about the axis [kg*m^2]: what moves, less the module's own parts."""
        return self.states[0].inertia - self.moving.about_axis()

    @property
    def quickest(self) -> float:
        """Largest speed of a release from the end of the stroke [rad/s]: w phi at the stiffest state."""
        return self.stroke * max(sqrt(state.stiffest / state.inertia) for state in self.states)


def joint_model(resolved: ResolvedModule, base: RigidBody, moving: RigidBody, step: float | None = None) -> JointModel:
    """Put the model of a module together; a time step [s] that suits the bench's load unless given."""
    # Where history matters, the PCL has come to each operating point on heating.
    shown = [case for case in cases(resolved) if case.history.name in ("", "nominal") and case.history.shown]
    states = tuple(_state(resolved, case) for case in shown)
    return JointModel(
        name=resolved.study.name,
        base=base,
        moving=moving,
        states=states,
        stroke=float(resolved.quantity("stroke")),
        stop_angle=float(resolved.quantity("stop_angle")),
        holding_torque=float(resolved.quantity("holding_torque")),
        step=step or usual_step(states),
        left_out=_left_out(resolved),
    )


def refuse_step(step: float | None) -> None:
    """Raise InputError for a time step [s] that is none."""
    if step is not None and not 0.0 < step <= 0.1:
        raise InputError(f"--timestep {step:g} s: must be above 0 and at most 0.1 s")


def _left_out(resolved: ResolvedModule) -> tuple[str, ...]:
    """Return what the models leave out, and how much that is."""
    holds = float(resolved.quantity("holding_torque"))
    springs: tuple[str, ...] = ()
    if middle := float(resolved.quantity("spring_stiffness")):
        end = float(resolved.quantity("spring_stiffness_full_stroke"))
        share = f"{100.0 * (end / middle - 1.0):+.1f} %"
        springs = (f"The springs are linear; drawn, their stiffness changes by {share} to the end of the stroke.",)
    return (
        *springs,
        f"The PCL neither yields nor slips: the joint bears {holds:.3g} N·m frozen, and the model bears any torque.",
        "Temperatures do not change in a model: each state is one temperature, reached on heating. Going from one to "
        "another takes the time that results.csv has as softening_time and stiffening_time; joint.fmu has the heat.",
        "The housing is rigid; what it gives is in the elements of the joint.",
        *(("The motor stands still: it is part of the base.",) if resolved.values["motor"] != WITHOUT else ()),
    )


def header(model: JointModel, state: JointState) -> list[str]:
    """Return what a file of a state says of itself, line by line."""
    return [
        f"{model.name}, {state.point}: {state.temperature - ZERO_CELSIUS:.4g} degC. Written by tvimdesign robot.",
        "SI units: m, kg, s, rad, N. The joint's axis is z; a positive angle turns counter-clockwise seen from +z.",
        f"At {state.frequency:g} Hz the joint has {state.stiffness:.5g} N.m/rad and {state.damping:.5g} N.m.s/rad; "
        f"the springs alone have {state.springs:.5g} N.m/rad.",
        "Left out:",
        *(f"- {sentence}" for sentence in model.left_out),
    ]
