"""A design as a comparison needs it: from the answer of a study, or from the folder of a finished run."""

from __future__ import annotations

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from tvimdesign.base.errors import InputError
from tvimdesign.device import Table
from tvimdesign.report.output.thresholds import soft_in_words
from tvimdesign.report.run.why import PRICE_SHOWN
from tvimdesign.study.design import Design, read_design

MOST_ACTIVE = 3
"""Active constraints of a design that a comparison reports, the costliest."""


def compared_design(design: Design, results: Mapping[str, Any], table: Table) -> dict[str, Any]:
    """Return a design with its violated limits, warnings, active constraints and search; `results` as results.json."""
    search = results.get("starts") or {"count": 0, "converged": 0, "optima": []}
    solution = results.get("solution") or {"active_constraints": []}
    active = [entry for entry in solution["active_constraints"] if (entry["shadow_price"] or 0.0) > PRICE_SHOWN]
    return {
        "design": design.model_dump(mode="json"),
        "broken": [check["limit"] for check in results.get("checks", ()) if not check["kept"]],
        "warnings": [
            {"output": check["output"], "value": check["si"]["value"], "because": check["origin"]}
            for check in results.get("warnings", ())
        ],
        "above_rating": list(design.above_rating),
        "accepting": list(design.accepting),
        "soft": soft_in_words(design, table),
        "active_constraints": [
            {"limit": entry["text"], "because": entry["origin"], "shadow_price": entry["shadow_price"]}
            for entry in sorted(active, key=lambda entry: -entry["shadow_price"])[:MOST_ACTIVE]
        ],
        "starts": search["count"],
        "converged": search["converged"],
        "optima": [{"objective": entry["objective"], "variables": entry["at"]} for entry in search["optima"]],
    }  # fmt: skip


def finished_run(source: Path, table: Table) -> dict[str, Any]:
    """Return what a comparison needs of a finished run, by its design.json. Raises InputError."""
    design = read_design(source)
    path = source.parent / "results.json"
    try:
        results = json.loads(path.read_bytes()) if source.name == "design.json" else {}
    except FileNotFoundError:
        results = {}
    except (OSError, ValueError) as error:
        raise InputError(f"{path}: cannot be read: {error}") from error
    which = "optimised" if design.study["vary"] else "drawn"
    return {**nothing_found(), which: compared_design(design, results or {"solution": design.solution}, table)}


def nothing_found() -> dict[str, Any]:
    """Return what a comparison has of a study before anything is computed."""
    return {"fronts": [], "seconds": {}, "release": {}, "heat": {}, "troubles": []}
