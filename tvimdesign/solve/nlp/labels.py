"""Labels of the unknowns and rows of a problem, in its order."""

from __future__ import annotations

from tvimdesign.solve.nlp.problem import Problem


def unknown_names(problem: Problem) -> list[str]:
    """Return a name for every unknown."""
    names = [free.name for free in problem.free]
    for current in problem.free_currents:
        names += [f"{current.row} during {current.phase}"] * current.nodes + [f"length of {current.phase}"]
    return names + [peak.row.name for peak in problem.peaks]


def row_names(problem: Problem) -> list[str]:
    """Return a name for every row."""
    names = [f"end of {current.phase}" for current in problem.free_currents]
    names += [f"shares of {mixture.name}" for mixture in problem.mixtures]
    names += [limit.name for limit in problem.limits]
    names += [f"bound {i + 1} on what is traded" for i in range(len(problem.objectives))]
    names += ["slew of the supply"] * problem.slope_count
    names += [f"{event} within the horizon" for event in problem.unlimited]
    return names + ["samples below their peak"] * problem.sample_count
