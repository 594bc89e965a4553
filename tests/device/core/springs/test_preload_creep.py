"""Preload that a printed and a milled module lose, by hand and by its directions."""

from typing import Any

import numpy as np
import pytest
from device_values import all_of

ROWS = ["preload_loss", "preload_margin", "crept_preload_margin", "preload_angle", "spring_rate",
        "coil_end_level", "helix_slope", "leg_arm", "rotor_top_level", "tang_length", "tang_lever", "wire_diameter",
        "part_temperatures@hot"]  # fmt: skip


def module(mode: str = "shear", process: str = "print_petg", **changes: Any) -> dict[str, Any]:
    return all_of(ROWS, mode, process=process, **changes)


@pytest.mark.parametrize("mode", ["shear", "compression"])
def test_printed_module_loses_preload_as_pin_and_floor_creep(mode: str) -> None:
    found = module(mode)
    height = found["coil_end_level"] + found["helix_slope"] * found["leg_arm"] - found["rotor_top_level"]
    shear = 2.1e9 / 2.76
    pin = height**3 / (3.0 * 2.1e9 * np.pi * 2e-3**4 / 4.0) + height / (0.9 * shear * np.pi * 2e-3**2)
    pin = (pin + height**2 * 3.0 * 0.62 / (8.0 * shear * 2e-3**3)) / found["leg_arm"] ** 2
    tang = (1.0 + found["tang_lever"] / found["leg_arm"]) ** 2
    tang /= 4.0 * np.pi * shear * (0.5 * found["wire_diameter"]) ** 2 * found["tang_length"]
    rate, wound = found["spring_rate"], found["preload_angle"]

    def hasty(kelvin: float) -> float:
        return float(np.exp(150e3 / 8.314462618 * (1.0 / 296.15 - 1.0 / kelvin)))

    warm = found["part_temperatures@hot"]
    on_pin, in_floor = (0.1 * (1000.0 * hasty(295.15) + hasty(kelvin)) ** 0.2 for kelvin in (warm.beside, warm.floor))
    at_once = wound / (1.0 + rate * (pin + tang))
    later = wound / (1.0 + rate * (pin * (1.0 + on_pin) + tang * (1.0 + in_floor)))
    assert found["preload_loss"] == pytest.approx(at_once - later, rel=1e-6)
    assert found["crept_preload_margin"] == pytest.approx(found["preload_margin"] - found["preload_loss"], rel=1e-9)
    assert 0.005 < found["preload_loss"] / wound < 0.3


def test_creep_grows_with_time_and_heat_and_spares_milled_modules() -> None:
    plain = module()["preload_loss"]
    assert module(rest_time=3.6e7)["preload_loss"] > plain
    assert module(hot_time=3.6e5)["preload_loss"] > plain
    found = module(hot_time=1e8, **{"temperature@hot": 473.15})
    assert plain < found["preload_loss"] < found["preload_angle"]
    found = module(process="machine_6061")
    assert found["preload_loss"] == 0.0
