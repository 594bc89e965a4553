"""What the unknowns and rows of a built problem are, in the order it has them: names for people instead of places."""

from __future__ import annotations

from tvimdesign.solve.nlp.problem import Problem


def unknown_names(problem: Problem) -> list[str]:
    """A name for every unknown; the states of a phase share one."""
    names = [free.name for free in problem.free]
    for block in problem.blocks:
        names += [f"heat during {block.phase.phase.name}, to {block.event}"] * (block.unknowns.numel() - 1)
        names.append(f"length of {block.phase.phase.name}, to {block.event}")
    for current in problem.free_currents:
        names += [f"{current.row} during {current.phase}"] * current.nodes
    for balance in problem.balances:
        names += [f"steady state after {balance.phase}"] * balance.unknowns.numel()
    return names + list(problem.peaks)


def row_names(problem: Problem) -> list[str]:
    """A name for every row; the equations of a phase share one."""
    names: list[str] = []
    for block in problem.blocks:
        names += [f"heat equation of {block.phase.phase.name}, to {block.event}"] * (block.equations.numel() - 1)
        names.append(f"{block.event} ends {block.phase.phase.name}")
    for balance in problem.balances:
        names += [f"steady state after {balance.phase}"] * balance.equations.numel()
    names += [limit.name for limit in problem.limits]
    names += [f"bound {i + 1} on what is traded" for i in range(len(problem.objectives))]
    names += ["slew of the supply"] * problem.slope_count
    return names + ["samples below their peak"] * problem.peak_count
