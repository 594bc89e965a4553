"""The joint's task: an arm with a payload that it holds, swings, follows a trajectory with, or that something strikes.

The arm is fixed to the link, the drive turns the housing. Gravity's moment is added to the torque of a motion: it
changes slowly against what the joint answers. Friction and stops are left out; `impact_stop_margin` shows whether
the stops are met.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np

from tvimdesign.device.table import Feature, Module, QuantityGroup, Scalar
from tvimdesign.physics.layers import driven, lasting_load
from tvimdesign.physics.motions.motion import Joint

GROUP = "Task"
WITHOUT = "none"
ARM = "arm"
WITH_ARM = (Feature("task", WITHOUT),)
SAMPLES = 120  # Equal steps in which a trajectory is followed
CONTACT_STEPS = 16  # Steps up to the largest force of a body on an arm that does not give
CONTACTS = 8  # So many times as long contacts are followed: a frozen joint has then stopped a body heavier than its arm
SWING_STEPS = 36  # Steps of a link that swings with what has struck it
SWING = 0.6
"""Share of the swing's period that is followed; the first peak is at a quarter, later only where nothing rings."""
SPECTRUM = 5  # Frequencies of the band at which a sine is looked at, besides the resonance

quantities = QuantityGroup(GROUP, WITH_ARM)
quantities.choices("task")
quantities.inputs()


class Trajectory(NamedTuple):
    """Angles of the housing over time; `at_rest` if it starts and ends so, else at constant speed."""

    moments: tuple[float, ...]  # [s], rising
    angles: tuple[float, ...]  # [rad]
    at_rest: bool = True
    name: str = "given"

    def sampled(self) -> tuple[float, Any, Any, Any]:
        """Return the step [s]; angles [rad], speeds [rad/s], accelerations [rad/s^2] of a cubic spline at each."""
        from scipy.interpolate import CubicSpline

        spline = CubicSpline(self.moments, self.angles, bc_type="clamped" if self.at_rest else "natural")
        times = np.linspace(self.moments[0], self.moments[-1], SAMPLES + 1)
        return float(times[1] - times[0]), spline(times), spline(times, 1), spline(times, 2)


@quantities.output("kg*mm^2")
def task_inertia(m: Module) -> Scalar:
    """Inertia about the axis of arm, payload and the module's own moving parts."""
    arm = m.arm_mass * m.arm_inertia_share + m.payload
    return m.parts_inertia + arm * m.arm_length**2


@quantities.helper()
def gravity_moment(m: Module) -> Scalar:
    """Torque of gravity on the horizontal arm [N*m]."""
    return m.gravity * m.arm_length * (m.arm_mass * m.arm_centre_share + m.payload)


@quantities.output("N*m", headline=True)
def pose_torque(m: Module) -> Scalar:
    """Torque of gravity on arm and payload in the pose."""
    return m.gravity_moment * np.fabs(np.sin(m.gravity_angle + m.pose_angle))


@quantities.helper(per_point=True)
def task_stiffness(m: Module) -> driven.Stiffness:
    """Complex stiffness of the joint at any angular frequency."""
    return driven.complex_stiffness(m.spring_stiffness, m.support, 2.0 * np.pi * m.frequency, m.pcl_modes)


@quantities.helper(per_point=True)
def task_joint(m: Module) -> Joint:
    """Joint that carries the arm."""
    return Joint(m.task_inertia, m.spring_stiffness, m.elastic_support)


@quantities.helper(per_point=True)
def task_swing(m: Module) -> Callable[[Joint], tuple[Joint, Scalar, Scalar]]:
    """Joint with its structure as at the pace of its own swing [rad/s], that pace, and the structure's damping."""
    at_point, support = 2.0 * np.pi * m.frequency, m.support
    stiffness = m.task_stiffness

    def swing(joint: Joint) -> tuple[Joint, Scalar, Scalar]:
        angular = driven.settled_frequency(driven.magnitude, stiffness, joint.inertia, at_point)
        factor = driven.stiffening(support, angular / at_point)
        return joint._replace(structure_stiffness=factor * support[0]), angular, factor * support[1] / angular

    return swing


@quantities.output("rad", per_point=True)
def sag_angle(m: Module) -> Scalar:
    """Angle by which gravity has turned the joint at the end of `pose_time`, without its stops."""
    slow = driven.stiffening(m.support, 1.0 / (2.0 * np.pi * m.frequency * m.pose_time))
    structure = slow * m.elastic_support
    return lasting_load.held(m.pose_torque, m.pose_time, m.spring_stiffness, structure, m.pcl_modes).angle


@quantities.output("mm", per_point=True, headline=True)
def sag(m: Module) -> Scalar:
    """Way by which the arm's end has sunk at the end of `pose_time`, along its circle."""
    return m.sag_angle * m.arm_length


@quantities.helper(per_point=True)
def sine_states(m: Module) -> list[tuple[Scalar, tuple[Scalar, Scalar]]]:
    """Deflection [rad] and complex stiffness [N*m/rad] at frequencies of the band and at the resonance in it."""
    spread = [(m.sine_to / m.sine_from) ** (i / (SPECTRUM - 1)) for i in range(SPECTRUM)]
    ends = [2.0 * np.pi * frequency for frequency in (m.sine_from, m.sine_to)]
    swinging = driven.resonance(m.task_stiffness, m.task_inertia, 2.0 * np.pi * m.frequency)
    frequencies = [*(ends[0] * share for share in spread), np.fmin(np.fmax(swinging, ends[0]), ends[1])]
    states = [(angular, m.task_stiffness(angular)) for angular in frequencies]
    return [
        (driven.deflection(m.sine_amplitude, angular, stiffness, m.task_inertia), stiffness)
        for angular, stiffness in states
    ]


@quantities.output("rad", per_point=True)
def sine_deflection(m: Module) -> Scalar:
    """Largest amplitude of the joint's angle while the housing swings as a sine, over the band."""
    return driven.largest([deflection for deflection, _ in m.sine_states])


@quantities.output("N*m", per_point=True)
def sine_torque(m: Module) -> Scalar:
    """Largest amplitude of the joint's torque while the housing swings as a sine, over the band."""
    return driven.largest([deflection * driven.magnitude(stiffness) for deflection, stiffness in m.sine_states])


@quantities.output("J", per_point=True)
def sine_energy(m: Module) -> Scalar:
    """Largest heat in the joint in one period of the sine, over the band."""
    return driven.largest([np.pi * stiffness[1] * deflection**2 for deflection, stiffness in m.sine_states])


@quantities.output("Hz", per_point=True)
def bandwidth(m: Module) -> Scalar:
    """Frequency up to which the arm follows the housing by more than 71 % (-3 dB)."""
    return driven.bandwidth(m.task_stiffness, m.task_inertia, 2.0 * np.pi * m.frequency) / (2.0 * np.pi)


@quantities.helper(per_point=True)
def trajectory_states(m: Module) -> tuple[list[Scalar], list[Scalar]]:
    """Torques [N*m] and angles [rad] of the joint after each step in which the housing follows the trajectory."""
    if isinstance(m.trajectory, str):
        return [], []
    step, angles, _, accelerations = m.trajectory.sampled()
    joint, _, damping = m.task_swing(m.task_joint)
    base = list(accelerations)
    motion = driven.followed(joint, m.pcl_modes, step, SAMPLES, base=base, structure_damping=damping)
    moments = [m.gravity_moment * np.sin(m.gravity_angle + angle) for angle in angles[1:]]
    torques = [torque - moment for torque, moment in zip(motion.torques, moments, strict=True)]
    turned = [angle - moment / m.joint_stiffness for angle, moment in zip(motion.angles, moments, strict=True)]
    return torques, turned


@quantities.output("N*m", per_point=True)
def trajectory_torque(m: Module) -> Scalar:
    """Largest torque in the joint while the housing follows the trajectory, gravity counted; 0 without one."""
    return driven.largest(m.trajectory_states[0])


@quantities.output("rad", per_point=True)
def trajectory_deflection(m: Module) -> Scalar:
    """Largest angle of the joint while the housing follows the trajectory, gravity counted; 0 without one."""
    return driven.largest(m.trajectory_states[1])


@quantities.helper()
def impact_step(m: Module) -> Scalar:
    """Step in time of a contact [s]."""
    return 0.5 * np.pi * np.sqrt(m.impact_mass / m.impact_stiffness) / CONTACT_STEPS


@quantities.helper(per_point=True)
def impact_forces(m: Module) -> list[Scalar]:
    """Forces of the contacts [N] after each step."""
    striker = driven.Striker(m.impact_mass, m.impact_speed, m.arm_length, m.impact_stiffness)
    joint, _, damping = m.task_swing(m.task_joint)
    count = CONTACTS * CONTACT_STEPS
    return driven.followed(joint, m.pcl_modes, m.impact_step, count, striker=striker, structure_damping=damping).forces


@quantities.output("N", per_point=True)
def impact_force(m: Module) -> Scalar:
    """Largest force as a body strikes the arm's end, by the contact's stiffness, the arm's inertia and the joint."""
    return driven.largest(m.impact_forces)


@quantities.output("1", per_point=True)
def head_injury(m: Module) -> Scalar:
    """Head Injury Criterion (HIC15) of the body that strikes, if it is a head and the contact its skull."""
    return driven.head_injury(m.impact_forces, m.impact_mass, m.impact_step)


@quantities.helper(per_point=True)
def caught(m: Module) -> driven.Followed:
    """Swing of the arm with the body that has struck it and stays at its end."""
    joint = m.task_joint._replace(inertia=m.task_inertia + m.impact_mass * m.arm_length**2)
    speed = m.impact_mass * m.impact_speed * m.arm_length / joint.inertia
    joint, angular, damping = m.task_swing(joint)
    step = 2.0 * np.pi / angular * SWING / SWING_STEPS
    return driven.followed(joint, m.pcl_modes, step, SWING_STEPS, speed, structure_damping=damping)


@quantities.output("N*m", per_point=True)
def impact_torque(m: Module) -> Scalar:
    """Largest torque in the joint after a body has struck the arm's end and stays there."""
    return driven.largest(m.caught.torques)


@quantities.output("rad", per_point=True)
def impact_deflection(m: Module) -> Scalar:
    """Largest angle of the joint after a body has struck the arm's end and stays there."""
    return driven.largest(m.caught.angles)


quantities.margins("task")


@quantities.output("N*m", per_point=True, headline=True)
def task_torque(m: Module) -> Scalar:
    """Largest torque in the joint by pose, sine and trajectory; an impact has `impact_torque`."""
    return np.fmax(m.pose_torque + m.sine_torque, m.trajectory_torque)
