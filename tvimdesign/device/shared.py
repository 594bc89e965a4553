"""The rooms whose quantities all modes share; what differs between modes stands in a folder for each."""

from __future__ import annotations

from tvimdesign.device.components import (
    axial_preload,
    bearing,
    cover,
    cutout,
    dowels,
    drilled_holes,
    liner,
    mounting,
    preload_adjuster,
    process,
    screws,
    sensor_flange,
    tang,
)
from tvimdesign.device.core import clearances, layout, mass_properties, materials, molten, motor_choice, shrinkage
from tvimdesign.device.core.heat import heater_form, layer_heater, softening, stiffening, thermal_stack, viscous_heating
from tvimdesign.device.core.impedance import (
    creep_under_hold,
    joint_impedance,
    large_motion,
    lost_motion,
    structure_stiffness,
    warm_structure,
)
from tvimdesign.device.core.springs import (
    preload_creep,
    spring_as_drawn,
    spring_holds,
    spring_safety,
    stock_spring,
    torsion_springs,
)
from tvimdesign.device.motor import driven_inertia, motor_clearances, motor_layout, motor_mass_properties

ROOMS = (
    materials,
    layout,
    torsion_springs,
    stock_spring,
    spring_as_drawn,
    spring_holds,
    spring_safety,
    joint_impedance,
    lost_motion,
    structure_stiffness,
    warm_structure,
    preload_creep,
    large_motion,
    creep_under_hold,
    thermal_stack,
    viscous_heating,
    softening,
    stiffening,
    mass_properties,
    clearances,
    shrinkage,
    process,
    drilled_holes,
)
SHARED_GROUPS = (
    materials.quantities,
    process.limits,
    *(room.quantities for room in ROOMS[1:]),
    *heater_form.groups,
    *layer_heater.groups,
    *molten.groups,
    *screws.groups,
    *tang.groups,
    *dowels.groups,
    *cutout.groups,
    *liner.groups,
    *bearing.groups,
    *axial_preload.groups,
    *preload_adjuster.groups,
    *cover.groups,
    *sensor_flange.groups,
    *mounting.groups,
    motor_choice.quantities,
    motor_layout.quantities,
    motor_mass_properties.quantities,
    *motor_clearances.groups,
    driven_inertia.quantities,
)
