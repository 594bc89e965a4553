"""Results of finite elements and planes, read from the tables in validation/."""

from __future__ import annotations

import csv
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import yaml

Values = Mapping[str, Any]
VALIDATION = Path(__file__).resolve().parents[1]


def springs(_: Values) -> Values:
    """Rate and stresses of the drawn springs; the whole coil was looked at in some.

    Bends count that the product draws: an inside radius of a wire's diameter or more.
    """
    stored = yaml.safe_load((VALIDATION / "fe_spring/results.yaml").read_text(encoding="utf-8"))["springs"]
    names = ("rate", "fibre", "bend", "coil")
    labels = {name: [spring for spring, case in stored.items() if name in case] for name in names}
    labels["bend"] = [spring for spring in labels["bend"] if stored[spring]["bend_ratio"] >= 1.0]
    return {**{name: [stored[spring][name] for spring in labels[name]] for name in names}, "labels": labels}


def links(_: Values) -> Values:
    """Stiffness of links as drawn."""
    stored = yaml.safe_load((VALIDATION / "fe_link/results.yaml").read_text(encoding="utf-8"))
    return {"stiffness": [case["link"] for case in stored.values()], "labels": {"stiffness": list(stored)}}


def joints(inputs: Values) -> Values:
    """Return a quantity of every shipped study, by FE."""
    with (VALIDATION / "fe_structure/results.csv").open(newline="", encoding="utf-8") as file:
        rows = [row for row in csv.DictReader(file) if row["quantity"] == inputs["quantity"] and row["fe"]]
    rows.sort(key=lambda row: row["study"])
    name = inputs["quantity"]
    return {name: [float(row["fe"]) for row in rows], "labels": {name: [row["study"] for row in rows]}}


def tables(inputs: Values) -> Values:
    """Another column of the same rows of a stored table."""
    with (VALIDATION / inputs["table"]).open(newline="", encoding="utf-8") as file:
        rows = [row for row in csv.DictReader(file) if all(row[key] == value for key, value in inputs["where"].items())]
    return {"value": [float(row[inputs["expected"]]) for row in rows]}


def plane_times(inputs: Values) -> Values:
    """Times [s] that the plane in two dimensions takes, of rows of study and time, as the studies start."""
    with (VALIDATION / "heat_sector/results.csv").open(newline="", encoding="utf-8") as file:
        rows = [row for row in csv.DictReader(file) if row["design"] == "start"]
    times = {(row["study"], row["time"]): float(row["plane [s]"]) for row in rows}
    labels = [f"{study}, {time.removesuffix('_time')}" for study, time in inputs["times"]]
    return {"time": [times[study, time] for study, time in inputs["times"]], "labels": {"time": labels}}
