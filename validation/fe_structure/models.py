"""Model values of the designs solved by FE: the same quantities, by the same names."""

from __future__ import annotations

from pathlib import Path
from typing import Any, NamedTuple

from tvimdesign.cad.fe import model_comparison as comparison
from tvimdesign.device import table_for
from tvimdesign.simulation.working_cycle.device_functions import ResolvedModule
from tvimdesign.study import given, read_study

ROOT = Path(__file__).resolve().parents[2]
STRESSES = ("core_stress", "edge_traction", "seat_traction")
NOT_KEPT = ("coil_stress", "tang_stress", "link", "link_in_play", "natural_frequency")
"""Rows that other folders of validation hold against FE."""

LENGTHS = (
    "core_radius", "link_bottom_level", "rotor_top_level", "rotor_thickness", "rotor_rim", "pcl_inner_radius",
    "pcl_outer_radius", "placement_radius", "floor_thickness", "mount_boss_radius", "mount_hole", "foot_height",
    "arc_count", "arc_span", "floor_web", "pcl_thickness", "heater_thickness", "window_ledge", "vane_count",
    "vane_height", "vane_thickness", "block_height", "block_width", "slot_web", "housing_vane_thickness",
    "spreader_depth", "spreader_gap",
    "block_depth", "slot_count", "liner_thickness", "liner_depth",
    "adjuster_radius", "adjuster_thickness", "slip_clearance", "foot_fillet",
    "tile_radius", "heater_count", "heater_length", "heater_width",
    "link_screw_hole", "link_screw_depth", "link_bolt_circle_radius",
    "link_dowel_count", "link_dowel_diameter", "link_dowel_depth", "link_dowel_circle_radius",
)  # fmt: skip
"""Inputs of the comparison of closed forms with FE, in mm, counts and rad."""


class Row(NamedTuple):
    """One line of results.csv: a design variable, or a quantity of the model beside that of FE."""

    study: str
    quantity: str
    unit: str
    model: float | str
    fe: float | None = None

    def cells(self) -> list[str]:
        """As text; a ratio where there are both."""
        if self.fe is None or isinstance(self.model, str):
            return [self.study, self.quantity, self.unit, str(self.model), "", ""]
        return [
            self.study,
            self.quantity,
            self.unit,
            f"{self.model:.4g}",
            f"{self.fe:.4g}",
            f"{self.model / self.fe:.3f}",
        ]


BEYOND = {("wrist_compression", "housing_vanes_and_floor")}
"""Studies and quantities beyond the tenth, each with the figure in README.md."""
PAST = Path(__file__).with_name("studies")
"""Studies that are no longer shipped, whose parts FE has solved."""
LEFT_OUT = {
    "driven_joint", "elbow_of_polycarbonate", "fast_switch", "finger_of_stock_springs",
    *(path.stem for path in PAST.glob("*_own_pins.yaml")),
}  # fmt: skip
"""Studies not in the table, with the reason in README.md."""
FOLDERS = (PAST, ROOT / "studies", ROOT / "tests/studies")
DESIGN = ("SI", "record")
"""Units of a table's rows that tell the design."""


def study_file(study: str) -> Path:
    """Return the file of a study: shipped, of the tests, or past."""
    return next(path for folder in FOLDERS if (path := folder / f"{study}.yaml").exists())


def design_rows(study: str, values: dict[str, float], choices: dict[str, str]) -> list[Row]:
    """Value (SI) or chosen record of each quantity that a study varies, of a design of its."""
    varied = sorted(read_study(study_file(study)).vary)
    return [
        Row(study, name, "record", choices[name]) if name in choices else Row(study, name, "SI", values[name])
        for name in varied
    ]


def designed(cell: str, unit: str) -> float | str:
    """Read a cell of the design."""
    return cell if unit == "record" else float(cell)


def case_of(study: str, inputs: dict[str, Any], varied: dict[str, float | str], results: Any) -> dict[str, Any]:
    """Return a case of shipped.yaml: lengths of the drawn parts, moduli of their materials, and results of FE."""
    mm, values = inputs["mm"], inputs["values"]
    if not mm.get("spreader_depth"):
        mm = {**mm, "spreader_gap": 0.0}
    case = {
        "mode": inputs["mode"],
        "youngs_modulus": values["structure_youngs_modulus"] * 1e-9,
        "poissons_ratio": values["structure_poissons_ratio"],
        "pad_shear_modulus": values["heater_shear_modulus"] * 1e-9,
        "feet": round(mm["spring_count"]),
        "mm": {name: float(f"{mm[name]:.5g}") for name in LENGTHS if mm.get(name)},
        "found": results,
    }
    if values.get("heater_bulk_modulus"):
        case["pad_bulk_modulus"] = values["heater_bulk_modulus"] * 1e-9
    if mm.get("spreader_depth") and inputs["mode"] == "shear":
        case["spreader_shear_modulus"] = values["spreader_shear_modulus"] * 1e-9
        poisson = values["heater_adhesive_poissons_ratio"]
        case["adhesive_shear_modulus"] = values["heater_adhesive_youngs_modulus"] * 0.5e-9 / (1.0 + poisson)
    if mm.get("liner_depth") and inputs["mode"] == "shear":
        case["liner_shear_modulus"] = values["liner_youngs_modulus"] * 0.5e-9 / (1.0 + values["liner_poissons_ratio"])
    table, given_here = table_for(inputs["mode"]), {**given(read_study(study_file(study))), **varied}
    frozen = float(table.evaluate(given_here, ["frozen_shear_modulus"])["frozen_shear_modulus"])
    return case | {"frozen_shear_modulus": float(f"{frozen * 1e-9:.4g}")}


def fe_values(joint: dict[str, float], spring: dict[str, float]) -> dict[str, float]:
    """Return the results of FE by the names of the model."""
    return {**comparison.joint_rows(joint), "spring_rate": spring["rate"]}


def model_values(study: str, varied: dict[str, float | str]) -> dict[str, tuple[str, float]]:
    """Unit and value by the model, of a study with the values (SI) and records of what it varies."""
    read = read_study(study_file(study))
    rows = comparison.model_values(ResolvedModule(read, {**given(read), **varied}))
    selected = {name: value for name, value in rows.items() if name not in NOT_KEPT}
    return {name: ("MPa/(N*m)" if name in STRESSES else "N*m/rad", float(value)) for name, value in selected.items()}
