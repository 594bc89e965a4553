"""Closed forms of springs, links and joints for the parts that finite elements looked at; the tables are stored."""

from __future__ import annotations

import csv
from collections.abc import Mapping
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import yaml
from fe_structure.models import DESIGN, designed, model_values

from tvimdesign.physics import spring
from tvimdesign.physics.solids import structure

Values = Mapping[str, Any]
VALIDATION = Path(__file__).resolve().parents[1]


@cache
def _stored(name: str) -> Any:
    return yaml.safe_load((VALIDATION / name).read_text(encoding="utf-8"))


def springs(_: Values) -> Values:
    """Rate [N*m/rad] and stress per F a [MPa/(N*m)] at fibre, coil and bend of the drawn springs."""
    stored = _stored("fe_spring/results.yaml")
    results: dict[str, list[float]] = {"rate": [], "fibre": [], "bend": [], "coil": []}
    for case in stored["springs"].values():
        wire, coil, pitch, arm = (1e-3 * case[name] for name in ("wire_diameter", "coil_diameter", "pitch", "arm"))
        shape = spring.DrawnSpring(
            wire, coil, 2.0 * np.pi * case["turns"], pitch, arm, (case["bend_ratio"] + 0.5) * wire
        )
        coils = spring.bending_length(shape, stored["poissons_ratio"]) / (np.pi * shape.coil_diameter)
        straight = spring.bending_stress(1.0, wire, 1.0) * 1e-6
        factor = spring.inner_fibre_factor(coil / wire)
        results["rate"].append(spring.rate(case["modulus"] * 1e9, wire, coil, coils))
        results["fibre"].append(straight * factor * (1.0 + 0.5 * coil / arm))
        if case["bend_ratio"] >= 1.0:
            results["bend"].append(straight * spring.bend_stress_factor(shape))
        if "coil" in case:
            results["coil"].append(straight * spring.coil_stress_factor(shape, factor))
    return results


def links(_: Values) -> Values:
    """Stiffness [N*m/rad] of links clamped on their cores."""
    results = []
    for case in _stored("fe_link/results.yaml").values():
        mm, youngs = case["mm"], case["youngs_modulus"] * 1e9
        shear = structure.shear_modulus(youngs, case["poissons_ratio"])
        size = (2.0 * mm["link_half_width"], mm["link_thickness"], mm["link_length"], mm["core_radius"])
        results.append(structure.lever_stiffness(youngs, shear, *(1e-3 * length for length in size)))
    return {"stiffness": results}


@cache
def _joints() -> Mapping[str, Mapping[str, float]]:
    """Evaluate today's model for every design in the table, by study and quantity."""
    with (VALIDATION / "fe_structure/results.csv").open(newline="", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    designs: dict[str, dict[str, float | str]] = {row["study"]: {} for row in rows}
    for row in rows:
        if row["unit"] in DESIGN:
            designs[row["study"]][row["quantity"]] = designed(row["model"], row["unit"])
    return {
        study: {name: value for name, (_, value) in model_values(study, design).items()}
        for study, design in designs.items()
    }


def joints(inputs: Values) -> Values:
    """Return a quantity of every study solved by FE, in the order of the table."""
    name = inputs["quantity"]
    return {name: [values[name] for _, values in sorted(_joints().items()) if name in values]}


def tables(inputs: Values) -> Values:
    """Return a column of a stored table for the requested rows."""
    with (VALIDATION / inputs["table"]).open(newline="", encoding="utf-8") as file:
        rows = [row for row in csv.DictReader(file) if all(row[key] == value for key, value in inputs["where"].items())]
    return {"value": [float(row[inputs["found"]]) for row in rows]}
