"""Load of the motor and its driver: springs at the stroke, and the study's task by torque, heat, speed and voltage.

The motor turns the housing against the joint's torque and moves `driven_inertia` besides. The torque of a sine is the
sum of both amplitudes, which are not in phase: an upper bound.
"""

import numpy as np

from tvimdesign.device.core.motor_choice import WITH_DRIVER, WITH_MOTOR
from tvimdesign.device.core.task import WITH_ARM
from tvimdesign.device.table import Module, QuantityGroup, Scalar, at_least
from tvimdesign.physics.layers import driven

quantities = QuantityGroup("Task", (*WITH_MOTOR, *WITH_ARM))
springs = QuantityGroup("Hold", WITH_MOTOR)
supplies = QuantityGroup("Layout", WITH_DRIVER)
drivers = QuantityGroup("Task", (*WITH_DRIVER, *WITH_ARM))

_TOO_WEAK = "the motor cannot for long turn the springs alone by the stroke"


@springs.output("N*m", advice=(at_least(0.0, _TOO_WEAK),))
def motor_torque_margin(m: Module) -> Scalar:
    """Continuous torque of the motor less what turns the springs alone by the stroke; zero without a motor."""
    return m.drive_motor.continuous_torque - m.spring_stiffness * m.stroke


@quantities.helper(per_point=True)
def motor_on_trajectory(m: Module) -> list[Scalar]:
    """Torque of the motor after each step of the trajectory [N*m]."""
    if isinstance(m.trajectory, str):
        return []
    accelerations = m.trajectory.sampled()[3][1:]
    return [
        m.driven_inertia * acceleration - torque
        for acceleration, torque in zip(accelerations, m.trajectory_states[0], strict=True)
    ]


@quantities.helper(per_point=True)
def motor_in_sine(m: Module) -> Scalar:
    """Largest amplitude of the motor's torque in the sine [N*m]."""
    return m.sine_torque + m.driven_inertia * m.sine_amplitude * (2.0 * np.pi * m.sine_to) ** 2


@quantities.output("N*m", per_point=True)
def motor_torque(m: Module) -> Scalar:
    """Largest torque of the motor in its task by pose, sine and trajectory."""
    return np.fmax(m.pose_torque + m.motor_in_sine, driven.largest(m.motor_on_trajectory))


@quantities.output("A", per_point=True)
def motor_current(m: Module) -> Scalar:
    """Rms current that the motor's driver gives at that torque."""
    return m.motor_torque / m.drive_motor.torque_constant


@quantities.output("N*m", per_point=True)
def motor_rms_torque(m: Module) -> Scalar:
    """Root of the mean square of the motor's torque: of the pose with the sine, or of the trajectory over and over."""
    swinging = np.sqrt(m.pose_torque**2 + 0.5 * m.motor_in_sine**2)
    torques = m.motor_on_trajectory
    squares: Scalar = sum(torque**2 for torque in torques)
    return np.fmax(swinging, np.sqrt(squares / max(len(torques), 1)))


@quantities.output("W", per_point=True)
def motor_heat(m: Module) -> Scalar:
    """Loss of the motor's winding, cold, at that torque: of three phases, each half the resistance of two terminals."""
    current = m.motor_rms_torque / m.drive_motor.torque_constant
    return 1.5 * m.drive_motor.winding_resistance * current**2


@quantities.output("rad/s")
def task_speed(m: Module) -> Scalar:
    """Largest speed of the housing, and so of the motor, in sine and trajectory."""
    sine = m.sine_amplitude * 2.0 * np.pi * m.sine_to
    return sine if isinstance(m.trajectory, str) else np.fmax(sine, driven.largest(m.trajectory.sampled()[2]))


_TORQUE = "the motor's peak torque does not reach that of its task"


@quantities.output("N*m", advice=(at_least(0.0, _TORQUE),))
def motor_peak_margin(m: Module) -> Scalar:
    """Peak torque of the motor beyond that of its task, soft and frozen."""
    return m.drive_motor.peak_torque - np.fmax(m.motor_torque_at_hot, m.motor_torque_at_cold)


_HEAT = "the motor's winding gets too hot in its task"


@quantities.output("N*m", advice=(at_least(0.0, _HEAT),))
def motor_heat_margin(m: Module) -> Scalar:
    """Continuous torque of the motor beyond the rms torque of its task, soft and frozen."""
    return m.drive_motor.continuous_torque - np.fmax(m.motor_rms_torque_at_hot, m.motor_rms_torque_at_cold)


_SPEED = "the task is faster than the motor at its rated speed"


@quantities.output("rad/s", advice=(at_least(0.0, _SPEED),))
def motor_speed_margin(m: Module) -> Scalar:
    """Rated speed of the motor beyond that of its task."""
    return m.drive_motor.rated_speed - m.task_speed


@supplies.output("g")
def motor_driver_mass(m: Module) -> Scalar:
    """Mass of the motor's driver, which stands beside the module; `module_mass` leaves it out."""
    return m.motor_driver.value("mass")


_SUPPLY = "the supply is outside the range of the motor's driver"


@supplies.output("V", advice=(at_least(0.0, _SUPPLY),))
def motor_driver_supply_margin(m: Module) -> Scalar:
    """Distance of the supply from the nearer end of the driver's range."""
    least, most = m.motor_driver.value("supply_voltage_min"), m.motor_driver.value("supply_voltage_max")
    return np.fmin(m.motor_supply_voltage - least, most - m.motor_supply_voltage)


_PEAK_CURRENT = "the motor's driver does not give the peak current of the task"


@drivers.output("A", advice=(at_least(0.0, _PEAK_CURRENT),))
def motor_driver_peak_margin(m: Module) -> Scalar:
    """Largest current of the motor's driver beyond that of the task, amplitudes of a phase, soft and frozen."""
    return m.motor_driver_peak_current - np.sqrt(2.0) * np.fmax(m.motor_current_at_hot, m.motor_current_at_cold)


_CURRENT = "the motor's driver gets too hot in the task"


@drivers.output("A", advice=(at_least(0.0, _CURRENT),))
def motor_driver_current_margin(m: Module) -> Scalar:
    """Continuous current of the motor's driver beyond the rms over the task, amplitudes of a phase, soft and frozen."""
    torque = np.fmax(m.motor_rms_torque_at_hot, m.motor_rms_torque_at_cold)
    return m.motor_driver_current - np.sqrt(2.0) * torque / m.drive_motor.torque_constant


@quantities.output("V")
def motor_voltage(m: Module) -> Scalar:
    """Largest voltage between two terminals of the motor in its task, as if largest speed and current met.

    Back-EMF of its speed and drop of its current, cold, both amplitudes; its inductance is left out.
    """
    back_emf = np.sqrt(2.0 / 3.0) * m.drive_motor.torque_constant * m.task_speed
    current = np.fmax(m.motor_current_at_hot, m.motor_current_at_cold)
    return back_emf + np.sqrt(1.5) * m.drive_motor.winding_resistance * current


drivers.margins("motor_load")
