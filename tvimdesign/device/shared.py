"""The rooms whose rows all modes share; what differs between modes stands in a folder for each."""

from __future__ import annotations

from tvimdesign.device.core import (
    clearances,
    creep_under_hold,
    joint_impedance,
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
    creep_under_hold,
    thermal_stack,
    softening,
    stiffening,
    mass_properties,
    clearances,
    process,
)
BOOKS = (
    materials.book,
    process.limits,
    *(room.book for room in ROOMS[1:]),
    *screws.books,
    *bearing.books,
    *preload_adjuster.books,
    *cover.books,
    *sensor_flange.books,
    motor_choice.book,
    motor_layout.book,
    motor_mass_properties.book,
    *motor_clearances.books,
    driven_inertia.book,
)
