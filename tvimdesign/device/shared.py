"""The rooms whose quantities all modes share; what differs between modes stands in a folder for each."""

from __future__ import annotations

from tvimdesign.device.core import (
    clearances,
    creep_under_hold,
    joint_impedance,
    large_motion,
    layout,
    mass_properties,
    materials,
    motor_choice,
    softening,
    stiffening,
    thermal_stack,
    torsion_springs,
)
from tvimdesign.device.fixtures import bearing, cover, preload_adjuster, process, screws, sensor_flange
from tvimdesign.device.motor import driven_inertia, motor_clearances, motor_layout, motor_mass_properties

ROOMS = (
    materials,
    layout,
    torsion_springs,
    joint_impedance,
    large_motion,
    creep_under_hold,
    thermal_stack,
    softening,
    stiffening,
    mass_properties,
    clearances,
    process,
)
BOOKS = (
    materials.quantities,
    process.limits,
    *(room.quantities for room in ROOMS[1:]),
    *screws.groups,
    *bearing.groups,
    *preload_adjuster.groups,
    *cover.groups,
    *sensor_flange.groups,
    motor_choice.quantities,
    motor_layout.quantities,
    motor_mass_properties.quantities,
    *motor_clearances.groups,
    driven_inertia.quantities,
)
