"""Files that define quantities: those that all modes share, and those of each mode."""

from types import ModuleType

from tvimdesign.device.components import (
    axial_preload,
    bearing,
    cost,
    cover,
    dowels,
    hard_stops,
    heater_adhesive,
    liner,
    preload_adjuster,
    process,
    screws,
    tang,
)
from tvimdesign.device.compression import (
    block_impedance,
    ring_heat,
    vane_clearances,
    vane_heat,
    vane_layout,
    vane_tiles,
)
from tvimdesign.device.core import clearances, duty_and_control, layout, mass_properties, materials, motor_choice, task
from tvimdesign.device.core.heat import heater_form, softening, thermal_stack
from tvimdesign.device.core.impedance import (
    joint_impedance,
    large_motion,
    lost_motion,
    structure_stiffness,
    warm_structure,
)
from tvimdesign.device.core.springs import spring_as_drawn, torsion_springs
from tvimdesign.device.lock import free_joint
from tvimdesign.device.motor import motor_layout, motor_load, motor_mass_properties
from tvimdesign.device.shear import (
    arcs,
    floor_heat,
    keys,
    layer_end,
    layer_heat,
    layer_impedance,
    leads,
    melt_lip,
    pad_layout,
    spreader_seat,
)

SHARED_FILES = (
    materials, layout, torsion_springs, spring_as_drawn, joint_impedance, lost_motion, structure_stiffness,
    warm_structure, large_motion, thermal_stack, softening, mass_properties, clearances, axial_preload,
    process, heater_form, screws, tang, dowels, hard_stops, heater_adhesive, liner, bearing, preload_adjuster, cover,
    motor_choice, motor_layout, motor_mass_properties, task, motor_load, cost,
    duty_and_control,
)  # fmt: skip
FILES_OF_MODE: dict[str, tuple[ModuleType, ...]] = {
    "shear": (
        pad_layout, layer_impedance, layer_heat, layer_end, melt_lip, floor_heat, arcs, leads, keys,
        spreader_seat,
    ),
    "compression": (
        vane_layout, block_impedance, ring_heat, vane_heat, vane_clearances, vane_tiles,
    ),
    "lock": (free_joint,),
}  # fmt: skip
