"""Attacks on what a search answers, with none of its code: random search, differential evolution and COBYLA."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import differential_evolution, minimize

from tvimdesign.base.errors import SimulationError
from tvimdesign.device import Event, Input, Path, Steady, Table
from tvimdesign.simulation.working_cycle.cycle import Simulator
from tvimdesign.simulation.working_cycle.device_functions import resolve_study
from tvimdesign.solve.nlp.constraints import constraints_of
from tvimdesign.study import Study
from tvimdesign.study.study import Options, Range

RANDOM, EACH = 80, 5
"""Random designs of an attack, then generations of so many designs a variable."""
TRIED, SIMULATED = 6000, 150
"""Designs an attack tries at most, and those of them whose cycle it simulates, which takes a hundred times as long."""
STEPS, FIRST_STEP = 120, 0.01
"""Designs that COBYLA tries beside an optimum, and its first step as a share of each range."""
TOLERANCE = 1e-4
"""Share of a limit by which a design of an attack may break it; what is reported as optimal is re-checked to 2e-3."""
NO_MODULE = 100.0
"""The residual where no module can be built."""
Array = NDArray[np.float64]


class Attack:
    """Evaluates designs of a study, its variables as shares of their ranges."""

    def __init__(self, study: Study) -> None:
        """Compile the module."""
        self.study = study
        self.model = resolve_study(study).functions
        self.simulator = Simulator(self.model)
        self.limits = constraints_of(study, study.table, self.model.words)
        self.outputs = list(dict.fromkeys([limit.output for limit in self.limits]))
        behind = {name for name in self.outputs if study.table.behind_supplied & {name.partition("@")[0]}}
        self.at_once = [name for name in self.outputs if name not in behind]
        """What is limited and depends on no working cycle."""
        self.phases = phases_of([*behind, *study.minimize], study.table)
        self.must_end = ends_of([*behind, *study.minimize], study.table)
        """Events that a module must come to: of a phase that never ends nothing is known but what it has come to."""
        self.names = [name for name in study.vary if isinstance(study.table.quantity(name), Input)]
        self.ends = [
            (vary.lower, vary.upper) if isinstance(vary, Range) else (float(min(vary.values)), float(max(vary.values)))
            for vary in (study.vary[name] for name in self.names)
        ]
        self.sizes = [sorted(v.values) if isinstance(v := study.vary[name], Options) else [] for name in self.names]
        self.tried = self.simulated = 0
        self.least = np.inf
        """The residual of the best design so far; a feasible design has none above zero."""

    def shares(self, values: Mapping[str, float]) -> Array:
        """Return a design's variables as shares of their ranges."""
        return np.array(
            [(values[name] - low) / (high - low) for name, (low, high) in zip(self.names, self.ends, strict=True)]
        )

    def inputs(self, shares: Array) -> Array:
        """Return the inputs of a module; its listed numbers are the nearest sizes."""
        inputs: Array = self.model.start.copy()
        for name, share, (low, high), sizes in zip(self.names, shares, self.ends, self.sizes, strict=True):
            value = low + share * (high - low)
            nearest = min((float(size) for size in sizes), key=lambda size: abs(size - value), default=value)
            inputs[self.model.index[name]] = nearest
        return inputs

    def evaluated(self, shares: Array) -> dict[str, float] | None:
        """Return what is limited and minimised of a module; None where there is no such module."""
        inputs = self.inputs(shares)
        wanted = list(dict.fromkeys([*self.outputs, *self.study.minimize]))
        try:
            cycle = self.simulator.run(inputs, phases=self.phases).values
        except SimulationError:
            return None
        if not all(np.isfinite(cycle[event]) for event in self.must_end):
            return None
        return self.model.some_values(wanted, inputs, cycle)

    def residual(self, values: Mapping[str, float] | None) -> float:
        """Return the largest residual of the limits whose values are known."""
        if values is None:
            return NO_MODULE
        known = [limit for limit in self.limits if limit.output in values]
        residuals = [float(limit.residual(values[limit.output])) for limit in known]
        return NO_MODULE if any(np.isnan(residuals)) else min(max(residuals, default=-1.0), NO_MODULE)

    def worst(self, shares: Array) -> float:
        """Return the largest residual of any limit of the design at these shares.

        Where a limit that depends on no working cycle is violated, the cycle is not simulated. The residual is then
        more than that of any simulated design.
        """
        never = dict.fromkeys(self.model.switch_names, np.inf)
        residual = self.residual(self.model.some_values(self.at_once, self.inputs(shares), never))
        self.tried += 1
        self.simulated += residual <= 0.0
        residual = NO_MODULE + residual if residual > 0.0 else self.residual(self.evaluated(shares))
        self.least = min(self.least, residual)
        return residual

    def finds_a_design(self, seed: int) -> bool:
        """Return whether random search or differential evolution come to a design that meets every limit."""
        draw = np.random.default_rng(seed)
        for shares in draw.random((RANDOM, len(self.names))):
            if self.worst(shares) <= 0.0:
                return True
        differential_evolution(
            self.worst, [(0.0, 1.0)] * len(self.names), maxiter=TRIED, popsize=EACH, seed=seed, polish=False, tol=0.0,
            callback=lambda *_, **__: self._over,
        )  # fmt: skip
        return bool(self.least <= 0.0)

    @property
    def _over(self) -> bool:
        return bool(self.least <= 0.0 or self.tried >= TRIED or self.simulated >= SIMULATED)

    def improved(self, optimum: Mapping[str, float], reference: Mapping[str, float]) -> float:
        """Return the share by which COBYLA, started at an optimum, lowers the objective within the limits.

        Listed numbers stay as they are.
        """
        begin = self.shares(optimum)
        free = [i for i, sizes in enumerate(self.sizes) if not sizes]

        def moved(some: Array) -> Array:
            shares = begin.copy()
            shares[free] = np.clip(some, 0.0, 1.0)
            return shares

        weights = self.study.minimize
        best, first = np.inf, np.inf

        def tried(some: Array) -> tuple[float, float]:
            nonlocal best
            values = self.evaluated(moved(some))
            beyond = self.residual(values)
            objective = (
                sum(weight * values[name] / reference[name] for name, weight in weights.items()) if values else np.nan
            )
            if np.isfinite(objective) and beyond <= TOLERANCE:
                best = min(best, objective)
            return (objective if np.isfinite(objective) else 10.0 * first), beyond

        first = tried(begin[free])[0]
        known: dict[bytes, tuple[float, float]] = {}

        def once(some: Array) -> tuple[float, float]:
            key = some.tobytes()
            if key not in known:
                known[key] = tried(some)
            return known[key]

        if free:
            minimize(
                lambda some: once(some)[0] / first, begin[free], method="COBYLA",
                constraints=[{"type": "ineq", "fun": lambda some: -once(some)[1]}],
                options={"rhobeg": FIRST_STEP, "tol": 1e-5, "maxiter": STEPS},
            )  # fmt: skip
        return float(max(1.0 - best / first, 0.0)) if np.isfinite(best) else 0.0


def supplied_behind(names: Iterable[str], table: Table) -> list[Event | Path | Steady]:
    """Return the simulated quantities that these outputs depend on."""
    behind = {base for name in names for base in (name.partition("@")[0], *table.ancestors(name))}
    return [row for row in table.supplied if row.name in behind and isinstance(row, Event | Path | Steady)]


def phases_of(names: Iterable[str], table: Table) -> set[str]:
    """Return the phases of the working cycle on which these outputs depend."""
    return {row.phase for row in supplied_behind(names, table)}


def ends_of(names: Iterable[str], table: Table) -> set[str]:
    """Return the events that these outputs need: ends of their phases, and of those before."""
    rows = supplied_behind(names, table)
    before = [after for row in rows if (after := table.phase(row.phase).after)]
    return {table.phase(name).ends for name in (*(row.phase for row in rows if not isinstance(row, Event)), *before)}
