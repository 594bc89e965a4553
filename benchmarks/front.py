"""A front of thirty designs by tvimdesign and by pymoo's NSGA-II, side by side in one run, by hypervolume.

Both get the study `reference.yaml` and the same compiled equations. NSGA-II evaluates a whole generation at once
through the compiled kernels, as a good user of it would do, with pymoo's own handling of the limits; its
best generation counts, and has more designs in it than the front it is compared with. One run of it simulates its
switches one by one instead, by LSODA. Hypervolumes are of outputs between the ends of tvimdesign's front, up to a tenth
beyond the far ends, and of both by the kernels' own values. Beside them stand thirty single solves: the goals of the
front's own points, each sought cold from the study's start.
"""

from __future__ import annotations

import argparse
import time
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from contenders import lsoda
from numpy.typing import NDArray
from quick import Quick
from reference_problem import LONGEST, Reference, study

from tvimdesign.solve.batch.batch_model import kernel_of
from tvimdesign.solve.batch.cycle_kernel import CycleKernel, Pace
from tvimdesign.solve.nlp.solver_run import Run
from tvimdesign.solve.optimizer.optimizer import Optimizer
from tvimdesign.solve.pareto.front import Front, trace_front
from tvimdesign.solve.pareto.tradeoff import Tradeoff
from tvimdesign.solve.search import optimize

Array = NDArray[np.float64]
OUTPUTS = (("response_time", "module_mass"), ("response_time", "module_mass", "envelope_volume"))
POINTS = 30
BEYOND = 0.1
"""How far beyond the far ends of the front the corner lies that hypervolumes are measured from."""
SHARES = (0.95, 0.99, 1.0)
"""Of tvimdesign's hypervolume: the table shows when NSGA-II comes to each."""
LOOKS = 1.02
"""Growth of the count of generations from one look at the hypervolume to the next; looking is not timed."""


class ManyDesigns:
    """Outputs and residuals of whole generations, one column a design, by the compiled kernels."""

    def __init__(self, reference: Reference, outputs: tuple[str, ...], pace: float) -> None:
        """Compile. `pace` is about how long a good switch takes [s]: NSGA-II gets what only an optimiser knows."""
        model, names = reference.model, [free.name for free in reference.free]
        self.count = len(outputs)
        self._limits = reference.limits
        wanted = [*outputs, *(limit.output for limit in reference.limits)]
        self._arithmetic = kernel_of(model, wanted, names, [reference.event])
        self._switch = CycleKernel(model, names, [reference.event])
        self._pace = Pace({"softening": pace}, {})

    def __call__(self, designs: Array) -> tuple[Array, Array]:
        """Outputs and residuals; a switch that never ends takes as long as is simulated, and violates a limit."""
        times = self._switch(designs, self._pace)
        rows = self._arithmetic(np.concatenate([designs, np.minimum(times, LONGEST)]))
        residuals = [limit.residual(row) for limit, row in zip(self._limits, rows[self.count :], strict=True)]
        residuals.append(np.where(np.isfinite(times[0]), -1.0, 1.0))
        return rows[: self.count], np.nan_to_num(np.array(residuals), nan=10.0, posinf=10.0)


class OneByOne:
    """Evaluation with each switch by LSODA with the exact Jacobian, as without kernels."""

    def __init__(self, reference: Reference, outputs: tuple[str, ...]) -> None:
        """Compile nothing that the reference problem has not compiled."""
        self.count = len(outputs)
        self._reference, self._event = reference, outputs.index(reference.event)
        self._others = Quick(reference.model.outputs([name for name in outputs if name != reference.event]))
        self._switch = lsoda(1e-6)

    def __call__(self, designs: Array) -> tuple[Array, Array]:
        """Outputs and residuals."""
        rows = [self._outputs_and_residuals(design) for design in designs.T]
        return np.array([row[0] for row in rows]).T, np.array([row[1] for row in rows]).T

    def _outputs_and_residuals(self, design: Array) -> tuple[Array, Array]:
        rows = self._reference.rows(design, LONGEST)[1:]
        if not np.all(np.isfinite(rows)):  # no such module
            return np.full(self.count, LONGEST), np.full(len(rows) + 1, 10.0)
        seconds = self._switch(self._reference, design)
        others = self._others(self._reference.inputs(design), np.ones(len(self._reference.model.switch_names)))
        outputs = np.insert(others, self._event, seconds)
        return outputs, np.append(self._reference.rows(design, seconds)[1:], -1.0 if seconds < LONGEST else 1.0)


@dataclass(frozen=True)
class Ours:
    """Result of tvimdesign."""

    front: Front
    designs: Array
    """The points' variables, one column each."""
    optimum: float
    """Processor time of building the problem and finding the weighted optimum [s]."""
    seconds: float
    """Of the front after that."""
    single: float
    """Of as many solves from the study's start."""
    checked: float
    """Of those with each design simulated, as every point of the front is."""
    failed: int
    """Points of those without a design."""


def ours(reference: Reference, outputs: tuple[str, ...], points: int) -> Ours:
    """Seek the front as `tvimdesign run` does, and its points' goals one by one from the study's start."""
    sought, built = study(), []

    def keep(optimizer: Optimizer, runs: list[Run]) -> None:
        built.append((optimizer, runs))

    began = time.process_time()
    solution = optimize(sought, keep=keep, objectives=outputs)
    solved_at = time.process_time()
    optimizer, runs = built[0]
    front = trace_front(Tradeoff(sought, solution, optimizer, runs), outputs, points)
    done = time.process_time()
    alone = [optimizer.solve(begin=optimizer.model.start, objective=point.objective) for point in front.points]
    last = time.process_time()
    for run in alone:
        optimizer.simulator.run(run.inputs, run.current_profiles)
    checked = time.process_time()
    designs = np.array([[point.values[free.name] for free in reference.free] for point in front.points]).T
    return Ours(front, np.ascontiguousarray(designs), solved_at - began, done - solved_at, last - done,
                checked - done, sum(not run.start.converged for run in alone))  # fmt: skip


class Volume:
    """The hypervolume of outputs between the ends of a front."""

    def __init__(self, ends: Array) -> None:
        """`ends` holds the front's outputs, one row a point."""
        from pymoo.indicators.hv import HV

        self._least, most = ends.min(axis=0), ends.max(axis=0)
        self._range = most - self._least
        self._indicator = HV(ref_point=np.full(ends.shape[1], 1.0 + BEYOND))

    def __call__(self, outputs: Array) -> float:
        """Of some designs' outputs, one row each."""
        return float(self._indicator((outputs - self._least) / self._range)) if len(outputs) else 0.0


@dataclass
class Evolution:
    """Progress of NSGA-II, look by look."""

    seconds: list[float]
    evaluations: list[int]
    volumes: list[float]

    def reached(self, volume: float) -> tuple[float, int] | None:
        """Processor time [s] and evaluations to a hypervolume; None where it was stopped before."""
        for seconds, evaluations, covered in zip(self.seconds, self.evaluations, self.volumes, strict=True):
            if covered >= volume:
                return seconds, evaluations
        return None


def nsga2(
    reference: Reference,
    many: ManyDesigns | OneByOne,
    volume: Volume,
    population: int,
    seed: int,
    longest: float,
    enough: float,
) -> Evolution:
    """Let NSGA-II run until it has `enough` hypervolume or has used `longest` seconds of the processor."""
    from pymoo.algorithms.moo.nsga2 import NSGA2
    from pymoo.core.problem import Problem
    from pymoo.termination import get_termination

    class Module(Problem):
        def _evaluate(self, unknowns: Array, out: dict[str, Any], *_: Any, **__: Any) -> None:
            outputs, residuals = many(np.ascontiguousarray(np.exp(unknowns).T))
            out["F"], out["G"] = outputs.T, residuals.T

    low, high = np.log(reference.lower), np.log(reference.upper)
    problem = Module(n_var=len(low), n_obj=many.count, n_ieq_constr=len(reference.limits) + 1, xl=low, xu=high)
    algorithm = NSGA2(pop_size=population)
    algorithm.setup(problem, termination=get_termination("n_gen", 10**9), seed=seed, verbose=False)
    evolution, best, spent = Evolution([], [], []), 0.0, 0.0
    looks = _looks()
    look, generation = next(looks), 0
    while spent < longest:
        began = time.process_time()
        algorithm.next()
        spent += time.process_time() - began
        generation += 1
        if generation < look and spent < longest:
            continue
        look = next(looks)
        evolution.seconds.append(spent)
        evolution.evaluations.append(algorithm.evaluator.n_eval)
        feasible = algorithm.pop.get("CV").ravel() <= 0.0
        best = max(best, volume(algorithm.pop.get("F")[feasible]))
        evolution.volumes.append(best)
        if evolution.volumes[-1] >= enough:
            break
    return evolution


def _looks() -> Iterator[int]:
    look = 10.0
    while True:
        yield int(look)
        look = max(look + 1.0, look * LOOKS)


def compare(outputs: tuple[str, ...], populations: list[int], seeds: int, longest: float, points: int) -> str:
    """Compare tvimdesign, single solves, and NSGA-II with several populations and seeds, for one set of outputs."""
    reference = Reference(study())
    mine = ours(reference, outputs, points)
    shown = mine.front
    fastest = min(point.values[reference.event] for point in shown.points)
    many = ManyDesigns(reference, outputs, fastest)
    values = many(mine.designs)[0].T
    volume = Volume(values)
    whole = volume(values)
    lines = [
        f"### {', '.join(outputs)}", "",
        f"{len(shown.points)} points, {len(shown.failures)} failed; "
        f"{'; '.join(shown.notes) if shown.notes else 'no notes'}.", "",
        "| | processor time, s | over tvimdesign's | evaluations | share of its hypervolume |", "|---|---|---|---|---|",
    ]  # fmt: skip

    def row(name: str, seconds: float, evaluations: str, share: float | str, more: str = "") -> None:
        part = share if isinstance(share, str) else f"{100.0 * share:.2f} %"
        lines.append(f"| {name} | {more}{seconds:.2f} | {more}{seconds / mine.seconds:.3g} | {evaluations} | {part} |")
        print(lines[-1], flush=True)

    row("tvimdesign, the front", mine.seconds, f"{shown.sought} solves", 1.0)
    row("building the problem and its weighted optimum, before that", mine.optimum, "", "")
    row("the same goals one by one, each from the study's start", mine.single,
        f"{len(shown.points)} solves, {mine.failed} failed", "")  # fmt: skip
    row("and simulated, as every point of the front is", mine.checked, "", "")

    def evolved(name: str, many: ManyDesigns | OneByOne, population: int, seeds: int) -> None:
        runs = [nsga2(reference, many, volume, population, seed, longest, whole) for seed in range(1, seeds + 1)]
        for share in SHARES:
            there = sorted(reached_at for run in runs if (reached_at := run.reached(share * whole)))
            reported = f"{name} to {share:.0%}, {len(there)} of {seeds} seeds there"
            if len(there) > seeds // 2:  # the middle one of all seeds, whether they came to it or not
                seconds, evaluations = there[seeds // 2]
                row(reported, seconds, f"{evaluations}", share)
            else:
                stopped = sorted((run.volumes[-1], run.seconds[-1], run.evaluations[-1]) for run in runs)[seeds // 2]
                row(reported, stopped[1], f"{stopped[2]}", stopped[0] / whole, "more than ")

    for population in populations:
        evolved(f"NSGA-II of {population}", many, population, seeds)
    evolved(f"NSGA-II of {populations[0]}, switches by LSODA", OneByOne(reference, outputs), populations[0], 1)
    return "\n".join(lines)


def main() -> None:
    """Print the tables; with --out write them too."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--populations", type=int, nargs="+", default=[100, 400], help="of NSGA-II")
    parser.add_argument("--seeds", type=int, default=3, help="runs of NSGA-II with each population")
    parser.add_argument("--longest", type=float, default=60.0, help="seconds after which a run of NSGA-II is stopped")
    parser.add_argument("--points", type=int, default=POINTS, help="designs on the front")
    parser.add_argument("--of", type=int, nargs="+", default=[2, 3], help="counts of outputs that are traded")
    parser.add_argument("--out", type=Path, help="Markdown file to write the tables to")
    chosen = parser.parse_args()
    comparisons = []
    for outputs in (chosen_outputs for chosen_outputs in OUTPUTS if len(chosen_outputs) in chosen.of):
        comparisons.append(compare(outputs, chosen.populations, chosen.seeds, chosen.longest, chosen.points))
        print("\n" + comparisons[-1] + "\n", flush=True)
    if chosen.out:
        chosen.out.write_text("\n\n".join(comparisons) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
