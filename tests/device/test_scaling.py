"""A module built twice as large from the same materials: every output scales as its unit says."""

from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from stiff_when_warm import STIFF_WHEN_WARM

from tvimdesign.device import MODES, Input, Supplied, Table, table_for

# Power of the length with which a number in this unit scales; materials, angles, temperatures and frequencies stay, so
# that heat of a motion is a torque's.
POWERS = {
    "mm": 1, "mm^2": 2, "mm^3": 3, "cm^3": 3, "m^4": 4, "g": 3, "kg*mm^2": 5, "N*m": 3, "N*m/rad": 3, "N*m*s/rad": 3,
    "Hz": -1, "N": 2, "W": 3, "K*mm^2/W": 1,
}  # fmt: skip
# The layer's damping belongs to a fixed frequency, that of the free swing falls as the module grows.
# Surface tension holds the edge of a thin layer at a larger strain, with the root of its thickness.
# Gravity does not grow with it: heads do, and melt runs the sooner.
SWINGS = {
    "damping_ratio": -1, "critical_damping": 4, "edge_fracture_angle": -0.5,
    "melt_head": 1, "melt_loss": 1, "melt_creep": 2, "layer_drawing_time": -1,
}  # fmt: skip
# Rows whose formulas hold a diameter in millimetres, strength and tolerance by size, lengths that are sold, or the one
# over which a corner's stress is a mean; and temperatures of parts that lose heat, with what these expand.
FIXED = {"spring_tensile_strength", "wire_range_margin", "coil_diameter_tolerance", "screw_length_misfit",
         "dowel_length_misfit", "core_foot_rise", "plate_temperature", "core_temperature", "expansion_travel",
         "layer_play"}  # fmt: skip
TEMPERATURES = {"plate_temperature", "core_temperature"}
TABLES = {mode: table_for(mode) for mode in MODES}


def _power(table: Table, name: str) -> float:
    row = table.quantity(name)
    if isinstance(row, Input) and row.unit == "Hz":
        return 0  # the frequency a modulus is stated at
    return SWINGS.get(row.name, POWERS.get(table.unit(name), 0))


def _scaled(table: Table, inputs: dict[str, Any], factor: float) -> dict[str, Any]:
    return {
        name: value * factor ** _power(table, name) if isinstance(value, float) else value
        for name, value in inputs.items()
    }


def _free_of_fixed_lengths(table: Table, name: str) -> bool:
    return name.partition("@")[0] not in FIXED and not (FIXED - TEMPERATURES) & set(table.ancestors(name))


@settings(max_examples=25, deadline=None)
@given(factor=st.floats(0.2, 5.0), transmission=st.sampled_from(["unity", "geometry"]), mode=st.sampled_from(MODES))
def test_outputs_scale_with_the_length_as_their_units_say(factor, transmission, mode, inputs, squeezed):
    table = TABLES[mode]
    wanted = [
        name
        for name in table.names(("cold", "hot"))
        if _free_of_fixed_lengths(table, name)
        and not any(isinstance(table.quantity(base), Supplied) for base in (name, *table.ancestors(name)))
    ]
    assert len(wanted) > 70
    # Where there are no adjusters and no cover their rules have a constant room, of no size.
    # Heat does not scale with the module, nor what it softens and makes creep.
    # The cut-out is bought in one size, inserts in few.
    has = {"preload_adjuster": "rotary", "cover": "plate", "heater_fuse": "none", "thread_insert": "none",
           **STIFF_WHEN_WARM, "structure_creep_energy": 0.0}  # fmt: skip
    module = {**(squeezed if mode == "compression" else inputs), "transmission": transmission, **has}
    module |= {"foot_pairs": 2.0, "turn_speed": 0.5, "axial_clearance": 5e-3} if mode == "lock" else {}
    module = {name: value for name, value in module.items() if name.partition("@")[0] in table.by_name}
    original, other = table.evaluate(module, wanted), table.evaluate(_scaled(table, module, factor), wanted)
    for name in wanted:
        expected = original[name] * factor ** _power(table, name)
        assert other[name] == pytest.approx(expected, rel=1e-9, abs=1e-12 * factor ** _power(table, name)), name
