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


LENGTHS = (
    "core_radius", "link_bottom_level", "rotor_top_level", "rotor_thickness", "pcl_inner_radius",
    "pcl_outer_radius", "placement_radius", "floor_thickness", "mount_boss_radius", "mount_hole", "foot_height",
    "arc_count", "arc_span", "floor_web", "pcl_thickness", "peltier_thickness", "window_ledge", "vane_count",
    "vane_height", "vane_thickness", "block_height", "block_width", "slot_web", "housing_vane_thickness",
    "flange_bore_radius", "flange_outer_radius",
)  # fmt: skip
"""What the closed forms are held against FE by, in mm, counts and rad."""


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

LEFT_OUT = {"rigid_modules", "ankle", "elbow_machined", "elbow_printed", "finger_stock", "finger"}
"""Shipped studies without FE: it has no modules below a spreader yet, and no design whose spring is a record."""


def design_rows(study: str, values: dict[str, float]) -> list[Row]:
    """Value (SI) of each quantity that a study varies, of a design of its."""
    return [Row(study, name, "SI", values[name]) for name in sorted(read_study(ROOT / f"studies/{study}.yaml").vary)]


def case_of(study: str, inputs: dict[str, Any], found: dict[str, float]) -> dict[str, Any]:
    """A case of shipped.yaml: lengths of the drawn parts, moduli of what they are made of, and what FE found."""
    mm, values = inputs["mm"], inputs["values"]
    case = {
        "mode": inputs["mode"],
        "youngs_modulus": values["structure_youngs_modulus"] * 1e-9,
        "poissons_ratio": values["structure_poissons_ratio"],
        "pad_shear_modulus": values["peltier_shear_modulus"] * 1e-9,
        "feet": round(mm["spring_count"]),
        "mm": {name: float(f"{mm[name]:.5g}") for name in LENGTHS if mm.get(name)},
        "found": found,
    }
    names = {"compression": {"block_stiffness": "frozen_block_stiffness"},
             "shear": {"frozen_shear_modulus": "frozen_shear_modulus"}}[inputs["mode"]]  # fmt: skip
    varied = {row.quantity: row.model for row in design_rows(study, values)}
    table, given_here = table_for(inputs["mode"]), {**given(read_study(ROOT / f"studies/{study}.yaml")), **varied}
    for name, output in names.items():
        scale = 1e-9 if name == "frozen_shear_modulus" else 1e-3
        case[name] = float(f"{float(table.evaluate(given_here, [output])[output]) * scale:.4g}")
    return case


def fe_values(found: dict[str, float]) -> dict[str, float]:
    """What FE finds, by the names of the model: vanes with what they stand on, the core where its stress is highest."""
    values = {name: found[name] for name in ("hub", "core", "plate", "housing", "spring_rate") if name in found}
    if "rotor_vanes" in found:
        values["rotor_vanes_and_plate"] = structure.series(found["rotor_vanes"], values.pop("plate"))
        values["housing_vanes_and_floor"] = structure.series(found["housing_vanes"], values.pop("housing"))
    values["core_stress"] = max(found["core_mises"], found["foot_highest"])
    if "edge_highest" in found:
        values["edge_traction"] = found["edge_highest"]
    return values


def model_values(study: str, varied: dict[str, float]) -> dict[str, tuple[str, float]]:
    """Unit and value by the model, of a study with the values (SI) of what it varies."""
    read = read_study(ROOT / f"studies/{study}.yaml")
    inputs: dict[str, Any] = {**given(read), **DRAWN, **varied}
    blocks = read.mode == "compression"
    names = ["spring_rate", "structure_stiffness", "pcl_stiffness@cold", "core_holding_torque", "cold_layer_strength",
             "core_stiffness", "plate_stiffness", "floor_stiffness"]  # fmt: skip
    names += ["rotor_vane_stiffness", "housing_vane_stiffness"] if blocks else ["layer_edge_traction", "holding_torque"]
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
    stress = {"core_stress": found["cold_layer_strength"] / yields * 1e-6}
    if not blocks:
        stress["edge_traction"] = found["layer_edge_traction"] / found["holding_torque"] * 1e-6
    per_torque = {name: ("MPa/(N*m)", float(value)) for name, value in stress.items()}
    return {name: ("N*m/rad", float(value)) for name, value in stiffness.items()} | per_torque
