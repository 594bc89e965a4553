"""What the model says of the designs that FE is held against: the same quantities, by the same names."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any, NamedTuple

from tvimdesign.device import table_for
from tvimdesign.study import given, read_study

ROOT = Path(__file__).resolve().parents[2]
DRAWN = {"leg_model": "bending", "transmission": "geometry"}
"""Idealisations that the drawn parts do not have."""
PARTS = {"core": "core_stiffness", "plate": "plate_stiffness", "housing": "floor_stiffness"}


class Row(NamedTuple):
    """One line of results.csv: a design variable, or a quantity of the model beside that of FE."""

    study: str
    quantity: str
    unit: str
    model: float
    fe: float | None = None

    def cells(self) -> list[str]:
        """As text; a ratio where there are both."""
        if self.fe is None:
            return [self.study, self.quantity, self.unit, repr(self.model), "", ""]
        return [
            self.study,
            self.quantity,
            self.unit,
            f"{self.model:.4g}",
            f"{self.fe:.4g}",
            f"{self.model / self.fe:.3f}",
        ]


def design_rows(study: str, values: dict[str, float]) -> list[Row]:
    """Value (SI) of each quantity that a study varies, of a design of its."""
    return [Row(study, name, "SI", values[name]) for name in sorted(read_study(ROOT / f"studies/{study}.yaml").vary)]


def model_values(study: str, varied: dict[str, float]) -> dict[str, tuple[str, float]]:
    """Unit and value by the model, of a study with the values (SI) of what it varies."""
    read = read_study(ROOT / f"studies/{study}.yaml")
    inputs: dict[str, Any] = {**given(read), **DRAWN, **varied}
    shear = read.mode == "shear"
    names = ["spring_rate", "structure_stiffness", "elastic_support", "pcl_stiffness@cold", "core_holding_torque",
             "structure_layer_strength", "holding_safety", *PARTS.values()]  # fmt: skip
    names += [] if shear else ["rotor_vane_stiffness", "housing_vane_stiffness", "volume_stiffness"]
    found = {**inputs, **table_for(read.mode).evaluate(inputs, names)}
    stiffness = {name: float(found[row]) for name, row in PARTS.items()}
    stiffness["hub"] = 1.0 / (1.0 / found["pcl_stiffness@cold"] + 1.0 / found["structure_stiffness"])
    if not shear:
        stiffness["rotor_vanes_and_plate"] = 1.0 / (1.0 / found["rotor_vane_stiffness"] + 1.0 / stiffness["plate"])
        stiffness["housing_vanes_and_floor"] = 1.0 / (
            1.0 / found["housing_vane_stiffness"] + 1.0 / stiffness["housing"]
        )
    held = found["core_holding_torque"] * found["holding_safety"]
    stress = found["structure_layer_strength"] / held * 1e-6
    quantities = {name: ("N*m/rad", value) for name, value in stiffness.items()}
    quantities["spring_rate"] = ("N*m/rad", float(found["spring_rate"]))
    quantities["core_stress"] = ("MPa/(N*m)", float(stress))
    assert all(math.isfinite(value) for _, value in quantities.values())
    return quantities
