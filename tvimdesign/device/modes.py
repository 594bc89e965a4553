"""Modes that a module can have, each with its table."""

from collections.abc import Iterable
from dataclasses import replace
from functools import cache
from types import ModuleType

from tvimdesign.base.errors import InputError
from tvimdesign.device.table import Module, Scalar
from tvimdesign.device.table.quantity import PHASES, Output, Quantity
from tvimdesign.device.table.quantity_group import gather, with_parts
from tvimdesign.device.table.table import Table

LOCK = "lock"
MODES = ("shear", "compression", LOCK)  # The modes a study may name


@cache
def _files() -> dict[str, tuple[ModuleType, ...]]:
    """Load the files that define quantities: those that all modes share, and those of each mode."""
    from tvimdesign.device import lock
    from tvimdesign.device.components import (
        axial_preload,
        bearing,
        cost,
        cover,
        dowels,
        hard_stops,
        housing_base,
        liner_and_adhesive,
        preload_adjuster,
        process,
        screws,
        spigot,
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
    from tvimdesign.device.core import (
        clearances,
        heater_form,
        layout,
        mass_properties,
        motor_choice,
        softening,
        spring_as_drawn,
        task,
        thermal_stack,
        torsion_springs,
    )
    from tvimdesign.device.core.impedance import (
        joint_impedance,
        large_motion,
        lost_motion,
        structure_stiffness,
        warm_structure,
    )
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

    shared = (
        layout, torsion_springs, spring_as_drawn, joint_impedance, lost_motion, structure_stiffness,
        warm_structure, large_motion, thermal_stack, softening, mass_properties, clearances, axial_preload,
        process, heater_form, screws, tang, dowels, spigot, hard_stops, liner_and_adhesive, bearing, preload_adjuster,
        cover, housing_base, motor_choice, motor_layout, motor_mass_properties, task, motor_load, cost,
    )  # fmt: skip
    of_mode = {
        "shear": (
            pad_layout, layer_impedance, layer_heat, layer_end, melt_lip, floor_heat, arcs, leads, keys,
            spreader_seat,
        ),
        "compression": (
            vane_layout, block_impedance, ring_heat, vane_heat, vane_clearances, vane_tiles,
        ),
        "lock": (lock,),
    }  # fmt: skip
    return {"shared": shared, **of_mode}


@cache
def table_for(mode: str) -> Table:
    """Return the table of a mode; raises InputError for a mode that does not exist."""
    if mode not in MODES:
        raise InputError(f"mode {mode!r} is not one of: {', '.join(MODES)}")
    files = _files()
    of_mode = ("shear", LOCK) if mode == LOCK else (mode,)
    gathered: Iterable[Quantity] = gather((*files["shared"], *files[of_mode[0]]), of_mode)
    if mode == LOCK:
        gathered = without_springs(gathered, gather(files[LOCK], ()))
    table = Table(with_parts(gathered), PHASES)
    object.__setattr__(table, "mode", mode)
    return table


def without_springs(quantities: Iterable[Quantity], own: Iterable[Quantity]) -> tuple[Quantity, ...]:
    """Return the quantities of a mode without springs; its own are in place of those of the same name, or follow.

    Outputs of springs that others read are constants. Inputs and choices go if only what is of springs reads them.
    """
    instead = {quantity.name: quantity for quantity in own}
    listed = [instead.pop(quantity.name, quantity) for quantity in quantities]
    listed += instead.values()
    sprung = [quantity for quantity in listed if isinstance(quantity, Output) and quantity.sprung]
    read = _read_by(quantity for quantity in listed if isinstance(quantity, Output) and not quantity.sprung)
    gone = {quantity.name for quantity in sprung} - read
    idle = _read_by(sprung) - read
    given = [quantity for quantity in listed if not isinstance(quantity, Output)]
    sources = {quantity.name: quantity.record[0] for quantity in given if quantity.record}
    while (
        more := {quantity.name for quantity in given if quantity.name in idle}
        - gone
        - {source for name, source in sources.items() if name not in gone}
    ):
        gone |= more
        idle |= {sources[name] for name in more if name in sources} - read
    return tuple(_constant(quantity) for quantity in listed if quantity.name not in gone)


def _read_by(outputs: Iterable[Output]) -> set[str]:
    """Return the names of what outputs read."""
    return {need.partition("@")[0] for output in outputs for need in output.needs}


def _constant(quantity: Quantity) -> Quantity:
    """Return the default of an output of springs as an output without limits; other quantities as they are."""
    if not (isinstance(quantity, Output) and quantity.sprung):
        return quantity
    default = quantity.default

    def constant(_: Module) -> Scalar:
        return default

    return replace(
        quantity, function=constant, requires=(), rules=(), advice=(), ratings=(), headline=False,
        least_of=(), also_limited=(), parts_differ_with=None,
    )  # fmt: skip
