"""Files whose quantities all modes share; each mode has a folder for its own."""

from __future__ import annotations

from tvimdesign.device.components import (
    axial_preload,
    bearing,
    cover,
    cutout,
    dowels,
    hard_stops,
    liner,
    mounting,
    preload_adjuster,
    process,
    screws,
    sensor_flange,
    tang,
)
from tvimdesign.device.core import clearances, layout, mass_properties, materials, motor_choice, shrinkage
from tvimdesign.device.core.heat import heater_form, softening, stiffening, thermal_stack
from tvimdesign.device.core.impedance import (
    creep_under_hold,
    joint_impedance,
    large_motion,
    lost_motion,
    structure_stiffness,
    warm_structure,
)
from tvimdesign.device.core.springs import spring_as_drawn, spring_holds, torsion_springs
from tvimdesign.device.motor import motor_clearances, motor_layout, motor_mass_properties

SHARED_FILES = (
    materials, layout, torsion_springs, spring_as_drawn, spring_holds, joint_impedance, lost_motion,
    structure_stiffness, warm_structure, large_motion, creep_under_hold, thermal_stack, softening, stiffening,
    mass_properties, clearances, shrinkage, process, heater_form, screws, tang, dowels, hard_stops, cutout, liner,
    bearing, axial_preload, preload_adjuster, cover, sensor_flange, mounting, motor_choice, motor_layout,
    motor_mass_properties, motor_clearances,
)  # fmt: skip
