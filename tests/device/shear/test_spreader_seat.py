"""Way of the frozen torque through seats of spreaders, and through pads: strength by hand, and what limits it."""

from __future__ import annotations

import numpy as np
import pytest
from device_values import inputs_of, values_of

from tvimdesign.device import table_for

MM = 1e-3
TABLE = table_for("shear")
TILES = {
    "peltier_module": "ma10_063_05_1", "tiles_per_arc": 2.0, "arc_count": 3.0, "arc_span": 1.7,
    "floor_thickness": 6.5 * MM,
}  # fmt: skip


@pytest.mark.parametrize(("process", "strength"), [("machine_6061", 24e6), ("print_petg", 6e6)])
def test_a_seat_bears_what_its_adhesive_does_on_metal_or_plastic(process: str, strength: float) -> None:
    names = "outer_seat_holding_torque inner_seat_holding_torque seat_path pcl_outer_radius"
    values = values_of(names, **TILES, process=process)
    # T = tau 2 pi s r^2 t of the share that the rim takes, by `holding_safety` of 1.25.
    area = 3 * 1.7 * 40 * MM * 1 * MM
    expected = strength / 1.25 * area * 40 * MM / (1.0 - values["seat_path"].inward)
    assert values["outer_seat_holding_torque"] == pytest.approx(expected, rel=1e-6)
    assert values["inner_seat_holding_torque"] > values["outer_seat_holding_torque"]


def test_thin_spreaders_and_pads_limit_what_the_joint_holds() -> None:
    thin = values_of("holding_torque outer_seat_holding_torque", **TILES, spreader_thickness=0.2 * MM)
    assert thin["holding_torque"] == thin["outer_seat_holding_torque"]
    assert TABLE.output("holding_torque").least_of.count("outer_seat_holding_torque") == 1
    record = inputs_of()["heater_shear_limit"]
    values = values_of("heater_holding_torque layer_holding_torque pcl_bond_strength")
    assert values["heater_holding_torque"] == pytest.approx(values["layer_holding_torque"] * record / 2e6)
    assert values_of("holding_torque", heater_shear_limit=0.0)["holding_torque"] == 0.0


def test_a_spreader_leaks_heat_and_bends_as_a_strip() -> None:
    # k/g t L of the rims, slots of air at the ends, in series with the way along the spreader.
    known = inputs_of(**TILES)
    values = TABLE.evaluate(known, ["pad_edge", "heater_along"])
    rims, ends = 3 * 1.7 * (26 + 40) * MM, 6 * 14 * MM
    contact = (0.2 / (0.5 * MM) * rims + known["pad_edge_contact"] * ends) * 1 * MM
    assert values["pad_edge"] == pytest.approx(1.0 / (1.0 / contact + 1.0 / values["heater_along"]), rel=1e-6)
    # Roark, table 8.1: simply supported, evenly loaded, mean deflection q w^4/(120 D).
    rigidity = 71.7e9 * MM**3 / 12 / (1 - (71.7 / 2 / 26.9 - 1) ** 2)
    x = np.linspace(0.0, 1.0, 2001)
    mean = float(np.trapezoid((x - 2 * x**3 + x**4) / 24.0, x)) * (14 * MM) ** 4 / rigidity
    assert TABLE.evaluate(known, ["pad_foundation"])["pad_foundation"] == pytest.approx(1.0 / mean, rel=1e-4)
