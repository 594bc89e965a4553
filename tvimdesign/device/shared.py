"""The rooms whose quantities all modes share; what differs between modes stands in a folder for each."""

from __future__ import annotations

from tvimdesign.device.core import (
    clearances,
    creep_under_hold,
    joint_impedance,
    large_motion,
    layout,
    lost_motion,
    mass_properties,
    materials,
    motor_choice,
    shrinkage,
    softening,
    spring_as_drawn,
    spring_safety,
    stiffening,
    structure_stiffness,
    thermal_stack,
    torsion_springs,
)
from tvimdesign.device.fixtures import (
    axial_preload,
    bearing,
    cover,
    dowels,
    preload_adjuster,
    process,
    screws,
    sensor_flange,
    tang,
)
from tvimdesign.device.motor import driven_inertia, motor_clearances, motor_layout, motor_mass_properties

ROOMS = (
    materials,
    layout,
    torsion_springs,
    spring_as_drawn,
    spring_safety,
    joint_impedance,
    lost_motion,
    structure_stiffness,
    large_motion,
    creep_under_hold,
    thermal_stack,
    softening,
    stiffening,
    mass_properties,
    clearances,
    shrinkage,
    process,
)
BOOKS = (
    materials.quantities,
    process.limits,
    *(room.quantities for room in ROOMS[1:]),
    *screws.groups,
    *tang.groups,
    *dowels.groups,
    *bearing.groups,
    *axial_preload.groups,
    *preload_adjuster.groups,
    *cover.groups,
    *sensor_flange.groups,
    motor_choice.quantities,
    motor_layout.quantities,
    motor_mass_properties.quantities,
    *motor_clearances.groups,
    driven_inertia.quantities,
)
