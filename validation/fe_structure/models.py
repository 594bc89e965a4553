"""What the model says of the designs that FE is held against: the same quantities, by the same names."""

from __future__ import annotations

from pathlib import Path
from typing import Any, NamedTuple

from tvimdesign.device import table_for
from tvimdesign.physics.solids import structure
from tvimdesign.study import given, read_study

ROOT = Path(__file__).resolve().parents[2]
DRAWN = {"leg_model": "bending", "transmission": "geometry"}
"""Idealisations that the drawn parts do not have."""


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


def fe_values(found: dict[str, float]) -> dict[str, float]:
    """What FE finds, by the names of the model: vanes with what they stand on, the core where its stress is highest."""
    values = {name: found[name] for name in ("hub", "core", "plate", "housing", "spring_rate") if name in found}
    if "rotor_vanes" in found:
        values["rotor_vanes_and_plate"] = structure.series(found["rotor_vanes"], values.pop("plate"))
        values["housing_vanes_and_floor"] = structure.series(found["housing_vanes"], values.pop("housing"))
    values["core_stress"] = max(found["core_mises"], found["foot_highest"])
    return values


def model_values(study: str, varied: dict[str, float]) -> dict[str, tuple[str, float]]:
    """Unit and value by the model, of a study with the values (SI) of what it varies."""
    read = read_study(ROOT / f"studies/{study}.yaml")
    inputs: dict[str, Any] = {**given(read), **DRAWN, **varied}
    blocks = read.mode == "compression"
    names = ["spring_rate", "structure_stiffness", "pcl_stiffness@cold", "core_holding_torque", "cold_layer_strength",
             "core_stiffness", "plate_stiffness", "floor_stiffness"]  # fmt: skip
    names += ["rotor_vane_stiffness", "housing_vane_stiffness", "volume_stiffness"] if blocks else []
    found = {name: float(value) for name, value in table_for(read.mode).evaluate(inputs, names).items()}
    hub = structure.series(found["pcl_stiffness@cold"], found["structure_stiffness"])
    stiffness = {"hub": hub, "core": found["core_stiffness"], "spring_rate": found["spring_rate"]}
    plate, floor = found["plate_stiffness"], found["floor_stiffness"]
    if blocks:
        stiffness["rotor_vanes_and_plate"] = structure.series(found["rotor_vane_stiffness"], plate)
        stiffness["housing_vanes_and_floor"] = structure.series(found["housing_vane_stiffness"], floor)
    else:
        stiffness |= {"plate": plate, "housing": floor}
    yields = found["core_holding_torque"] * float(inputs["holding_safety"])
    return {name: ("N*m/rad", float(value)) for name, value in stiffness.items()} | {
        "core_stress": ("MPa/(N*m)", found["cold_layer_strength"] / yields * 1e-6)
    }
