"""How sure a study's designs are, as plain data: the yield, and the assumed inputs that requirements rest on."""

from __future__ import annotations

import time
from collections.abc import Sequence
from dataclasses import replace
from typing import Any

from tvimdesign.base.units import from_si, pretty
from tvimdesign.device import Table
from tvimdesign.simulation.working_cycle.resolved_module import ResolvedModule, resolve_design, resolve_study
from tvimdesign.solve.uncertainty.design_uncertainty import Swing, UncertaintyModel
from tvimdesign.study import Study, standard_tolerances
from tvimdesign.study.design import Design

MODULES = 1 << 12
"""Modules drawn for the yield."""
_NAMED = 3
"""Assumed inputs that are named for each output."""
_LEAST = 5e-3
"""Change of an output, as a share of it, below which it does not rest on an assumed input."""
TOLD = ("softening_time",)
"""Outputs whose assumptions are told whether or not the study requires anything of them."""


class Uncertainty:
    """The yield of a study's designs and what their requirements rest on, as plain data in the units people read.

    The tolerances are the study's, else the standard ones.
    """

    def __init__(self, study: Study) -> None:
        """Compile the module the study starts from, whose numbers under `vary` may change."""
        self.study, self.table = study, study.table
        self.own = bool(study.tolerances)
        self.asked = list(dict.fromkeys([*(one.output for one in study.require), *TOLD]))
        start = resolve_study(study)
        self.model = UncertaintyModel(self._tolerant(start), self.asked, list(study.vary))

    def _tolerant(self, resolved: ResolvedModule) -> ResolvedModule:
        """A module with the tolerances that count."""
        tolerances = resolved.study.tolerances if self.own else standard_tolerances(self.table)
        return replace(resolved, study=resolved.study.model_copy(update={"tolerances": tolerances}))

    def data(self, design: Design, modules: int = MODULES) -> dict[str, Any]:
        """What there is to say of one design; `yield` is None where no limit depends on what spreads."""
        began = time.perf_counter()
        resolved = self._tolerant(resolve_design(design))
        if not self.model.fits(resolved):  # another record was chosen
            self.model = UncertaintyModel(resolved, self.asked)
        found = self.model.at(resolved, modules)
        share = found.together
        return {
            "yield": None if share is None else {"share": share.share, "low": share.low, "high": share.high},
            "modules": modules,
            "limits": found.limits,
            "left_out": list(found.left_out),
            "tolerances": "study" if self.own else "standard",
            "assumptions": {name: _rows(name, found.swings.get(name, ()), design, self.table) for name in self.asked},
            "seconds": time.perf_counter() - began,
        }


def _rows(output: str, swings: Sequence[Swing], design: Design, table: Table) -> list[dict[str, Any]]:
    """The assumed inputs that an output rests on most, the most important first; none that hardly moves it."""
    rows = []
    size = abs(design.values.get(output, 0.0))
    for swing in swings[:_NAMED]:
        one, unit = swing.assumed, table.unit(swing.assumed.name)
        if swing.size < _LEAST * size:
            continue
        rows.append({
            "input": one.name, "unit": pretty(unit), "description": table.quantity(one.name).description,
            **{key: from_si(getattr(one, key), unit) for key in ("value", "low", "high")},
            "output_unit": pretty(table.unit(output)),
            "output_at_low": _finite(from_si(swing.at_low, table.unit(output))),
            "output_at_high": _finite(from_si(swing.at_high, table.unit(output))),
        })  # fmt: skip
    return rows


def _finite(value: float) -> float | None:
    return value if abs(value) < float("inf") else None
