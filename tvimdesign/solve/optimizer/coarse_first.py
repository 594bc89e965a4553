"""Searches of a problem with as few points of time as it can have, whose optima lead to those of the problem itself.

An iteration of the coarse problem takes a third to six tenths of the time, and most iterations are for where to begin.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace

from tvimdesign.solve.nlp.coarse_to_fine import on_finer_grid
from tvimdesign.solve.nlp.objective import Objective
from tvimdesign.solve.nlp.solution import Start, same_optimum
from tvimdesign.solve.nlp.solver_run import Array, Ends, Run
from tvimdesign.solve.nlp.transcription import ORDER
from tvimdesign.solve.optimizer.optimizer import Optimizer
from tvimdesign.solve.optimizer.statuses import NO_DESIGN

FEWEST = 1
"""Elements of a phase; a freezing one has more (`Problem.elements`)."""
LOWEST = 2
"""Points of an element where currents are free, and each of their pieces is an element."""


def coarse_of(optimizer: Optimizer) -> Optimizer | None:
    """The coarse problem; None where it would have more than half of the points, or other unknowns than states."""
    problem = optimizer.problem
    phases = [block.phase.phase.name for block in problem.blocks]
    order = LOWEST if optimizer.currents else ORDER
    few, every = (sum(problem.elements(name, asked) for name in phases) for asked in (FEWEST, None))
    if problem.balances or 2 * few * order > every * ORDER:
        return None
    return optimizer.on_grid(FEWEST, order)


def first_optimum(grids: Sequence[Optimizer], solve: Callable[[Optimizer], Run]) -> tuple[Run, Optimizer]:
    """The run of the first problem that comes to an optimum, else of the last, and the problem; told with all work."""
    runs: list[Run] = []
    for grid in grids:
        runs.append(solve(grid))
        if runs[-1].start.converged:
            break
    last, grid = runs[-1], grids[len(runs) - 1]
    iterations, seconds = (sum(getattr(run.start, work) for run in runs) for work in ("iterations", "seconds"))
    last.start = replace(last.start, iterations=iterations, seconds=seconds)
    return last, grid


def refined(optimizer: Optimizer, coarse: Optimizer, run: Run, objective: Objective | None = None) -> Run:
    """The optimum that one of the coarse problem leads to, as one run with the work of both.

    Where it leads to none from the states there, the search begins afresh at its numbers.
    """
    unknowns = on_finer_grid(run.unknowns, coarse.problem, optimizer.problem, run.inputs)
    fine = optimizer.solve(
        run.within, begin=run.inputs, objective=objective, unknowns=unknowns, beginning="refined"
    )  # fmt: skip
    if not (fine.start.converged or optimizer.deadline.passed):
        fine = optimizer.solve(run.within, begin=run.inputs, objective=objective)
    fine.start = replace(
        run.start, status=fine.start.status, converged=fine.start.converged, objective=fine.start.objective,
        end=fine.start.end, iterations=run.start.iterations + fine.start.iterations,
        seconds=run.start.seconds + fine.start.seconds,
    )  # fmt: skip
    return fine


def all_refined(optimizer: Optimizer, coarse: Optimizer, runs: Sequence[Run]) -> list[Run]:
    """The same for several runs; the same optimum is refined once."""
    found: list[tuple[Run, Run]] = []
    for run in runs:
        same = (fine for one, fine in found if same_optimum(one.start, run.start) and fine.start.converged)
        if not run.start.converged:
            fine = run
        elif (known := next(same, None)) is None:
            fine = refined(optimizer, coarse, run)
        else:
            ended = known.start
            start = replace(run.start, objective=ended.objective, end=ended.end, status=ended.status)
            fine = replace(known, start=start)
        found.append((run, fine))
    return [fine for _, fine in found]


def search_from(
    optimizer: Optimizer, begin: Array, within: Mapping[str, Ends] | None = None, objective: Objective | None = None,
    *, certain: bool = True,
) -> Run:  # fmt: skip
    """The optimum from a start, with some numbers `within` ends: by the coarse problem, where there is one.

    Where nothing brings the limits of that nearer, the problem itself is asked from there. What need not be `certain`
    is let go: the run is the coarse one then, which did not converge.
    """
    coarse = coarse_of(optimizer)
    if coarse is None:
        return optimizer.solve(within, begin=begin, objective=objective)
    run = coarse.solve(within, begin=begin, objective=objective)
    if run.start.converged:
        return refined(optimizer, coarse, run, objective)
    if run.start.status != NO_DESIGN:
        fine, begun = optimizer.solve(within, begin=begin, objective=objective), run.start.begin
    elif certain:
        unknowns = on_finer_grid(run.unknowns, coarse.problem, optimizer.problem, run.inputs)
        fine = optimizer.solve(within, begin=run.inputs, objective=objective, unknowns=unknowns)
        begun = optimizer.vector.free_values(begin)
    else:
        return run
    fine.start = _after(run.start, replace(fine.start, begin=begun))
    return fine


def coarse_search_from(optimizer: Optimizer, begin: Array, within: Mapping[str, Ends]) -> Run:
    """The optimum that the coarse problem leads to from a start, where there is one; else the coarse run as it ended.

    For a search that is of use only if it finds something.
    """
    coarse = coarse_of(optimizer)
    run = (coarse or optimizer).solve(within, begin=begin)
    return refined(optimizer, coarse, run) if coarse and run.start.converged else run


def _after(coarse: Start, fine: Start) -> Start:
    """A run that another one led to, with the work of both."""
    return replace(fine, iterations=coarse.iterations + fine.iterations, seconds=coarse.seconds + fine.seconds)
