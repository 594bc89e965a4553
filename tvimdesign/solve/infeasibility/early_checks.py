"""Checks of a study before its search starts, by arithmetic alone: conflicting limits, and impedances out of reach.

The limits that depend on no cycle are a problem of a dozen unknowns. It is solved from several starts; where none of
them satisfies the limits, no start of the whole problem does, and the elastic problem says which limits conflict.
Then records of the catalogue are tried, as far as arithmetic can, with which conflicting limits hold.
"""

from collections import Counter
from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from tvimdesign.base.deadline import Deadline
from tvimdesign.base.errors import InfeasibleError, InputError, TimeOverError, TvimError
from tvimdesign.base.units import format_quantity
from tvimdesign.device import Choice, Table
from tvimdesign.simulation.working_cycle.symbols import ca
from tvimdesign.solve.infeasibility.conflict_set import conflict_in_words, find_conflicts, with_margins_in_words
from tvimdesign.solve.nlp.constraints import refuse_impossible
from tvimdesign.solve.nlp.mixture import discrete_records, with_records
from tvimdesign.solve.nlp.solution import ConflictSet, Side
from tvimdesign.solve.nlp.solver_run import Run
from tvimdesign.solve.optimizer.optimizer import Optimizer
from tvimdesign.solve.uncertainty.robust import SIGMA, least_with_margins
from tvimdesign.study import ProfileOptions, Study, brought_along_by, given

_TRIED = 3
"""Records of a choice with which a design is sought: those that violate all limits least at the nearest design."""
_PROMISING = 0.7  # Share of the way that conflicting limits must move which a record has to go at the nearest design


def curing_records(optimizer: Optimizer, nearest: Run, conflict_set: ConflictSet) -> dict[str, str]:
    """Return, by choice, a record in place of the chosen one with which all limits of the problem can hold.

    Parameters
    ----------
    optimizer : Optimizer
        The problem whose limits conflict, without the working cycle.
    nearest : Run
        Its design of least violation.
    conflict_set : ConflictSet
        The limits that conflict. Only choices that they depend on are tried.
    """
    cures: dict[str, str] = {}
    now = _values(optimizer, optimizer.study, nearest)
    for choice in _behind(optimizer, conflict_set):
        promising: list[tuple[float, str, Study]] = []
        for name in optimizer.study.catalog.names(str(choice.category)):
            module = {**optimizer.study.module, choice.name: name}
            study = optimizer.study.model_copy(update={"module": module})
            values = _values(optimizer, study, nearest)
            if values and _way(optimizer, conflict_set, now, values) >= _PROMISING:
                broken = (float(limit.residual(values[limit.output])) for limit in optimizer.problem.limits)
                promising.append((sum(max(by, 0.0) for by in broken), name, study))
        for _, name, study in sorted(promising, key=lambda record: record[:2])[:_TRIED]:
            if not optimizer.deadline.passed and _has_design(study, optimizer, nearest):
                cures[choice.name] = name
                break
    return cures


def _behind(optimizer: Optimizer, conflict_set: ConflictSet) -> list[Choice]:
    """Return the choices of bought parts and materials that the limits depend on and the study does not vary.

    Those that bring the fewest numbers along come first: they change the module least.
    """
    table, words = optimizer.table, optimizer.model.words
    behind = set().union(*(table.ancestors(side.text.split(" ")[0]) for side in conflict_set.sides))
    behind |= {row.record[0] for row in table.inputs if row.record and row.name in behind}
    records = [
        row for row in table.choices
        if row.name in behind and row.category and row.name not in optimizer.study.vary
        and not (row.record or row.stock_record or words[row.name] in row.options)
    ]  # fmt: skip
    brought = Counter(row.record[0] for row in table.inputs if row.record)
    return sorted(records, key=lambda row: brought[row.name])


def _values(optimizer: Optimizer, study: Study, nearest: Run) -> dict[str, float]:
    """Return what is limited at the nearest design in a study with another record; empty if there is no module."""
    limits = optimizer.problem.limits
    names = dict.fromkeys(name for limit in limits for name in (limit.output, limit.part_of) if name)
    free = {free.name: float(nearest.inputs[optimizer.model.index[free.name]]) for free in optimizer.free}
    try:
        with np.errstate(all="ignore"):
            return dict(optimizer.table.evaluate({**given(study), **free}, list(names)))
    except (TvimError, ArithmeticError):
        return {}


def _way(
    optimizer: Optimizer, conflict_set: ConflictSet, now: Mapping[str, float], values: Mapping[str, float]
) -> float:
    """Return how much of the move that conflicting limits need some values make up for, to first order."""
    limits = {f"{limit.part_of or limit.output} {limit.sense}": limit.limit for limit in optimizer.problem.limits}
    way = 0.0
    for side in conflict_set.sides:
        name, sense = side.text.split(" ")[:2]
        if side.move_to is not None:
            way += (values[name] - now[name]) / (limits[f"{name} {sense}"] - side.move_to)
    return way


def _has_design(study: Study, optimizer: Optimizer, nearest: Run) -> bool:
    """Return whether a design satisfies all limits, sought from the nearest one with another record."""
    try:
        other = Optimizer(study, without_cycle=True, deadline=optimizer.deadline)
    except TvimError:  # no module at its start, or a limit that nothing free can mend
        return False
    return other.solve(unknowns=nearest.unknowns, feasible=True).start.converged


_ENDS = {
    "soft": ("joint_impedance@hot", 1.0, "softening_band"),
    "stiff": ("joint_impedance@cold", -1.0, "stiffening_band"),
}
"""For each target: the impedance it is compared with, whether its least or largest value counts, and its band."""


def refuse_unreachable(study: Study, deadline: Deadline | None = None) -> None:
    """Raise InputError, with what would be reachable, for a stated target that no design within the ranges has."""
    if study.module.get("impedance_targets") != "stated":
        return
    for word, (row, sign, band) in _ENDS.items():
        reached = _extreme(study, row, sign, deadline)
        target, factor = (_given(study, study.table, name) for name in (f"{word}_impedance", band))
        limit = target * factor if sign > 0.0 else target / factor
        if reached is not None and sign * (reached - limit) > 0.0:
            end, most = ("softest", "least") if sign > 0.0 else ("stiffest", "largest")
            unit = study.table.unit(row)
            wanted, has, possible = (
                format_quantity(value, unit) for value in (target, reached, reached / factor**sign)
            )
            raise InputError(
                f"{word}_impedance {wanted} cannot be reached: the {end} joint within the ranges under `vary` and the "
                f"machine's rules has {has}; the {most} target is {possible}"
            )


def _extreme(study: Study, row: str, sign: float, deadline: Deadline | None) -> float | None:
    """Least or largest value of a row within the ranges and the machine's rules; None where none is found in time."""
    extreme = study.model_copy(
        update={
            "module": {**study.module, "impedance_targets": "operating_points"},
            "require": (),
            "minimize": {row: sign},
            "profile": ProfileOptions(),
        }
    )
    try:
        optimizer = Optimizer(extreme, deadline=deadline)
    except (InfeasibleError, TimeOverError):
        return None
    run = optimizer.solve()
    if not run.start.converged:
        return None
    return optimizer.model.values(run.inputs, optimizer.multistart.cycle)[row]


def _given(study: Study, table: Table, name: str) -> float:
    value = study.module.get(name, getattr(table.quantity(name), "default", None))
    assert isinstance(value, float | int)
    return float(value)


_STARTS = 5
_MOST_RECORDS = 20  # Combinations of records beyond which the search itself shall tell


def refuse_infeasible(study: Study, deadline: Deadline | None = None) -> None:
    """Raise InfeasibleError, naming the limits and the ranges' ends, where no start keeps the arithmetic limits."""
    records = discrete_records(study, study.table)
    if not study.vary or len(records) > _MOST_RECORDS:
        return
    messages: list[str] = []
    for chosen in records:
        reported = _conflict(with_records(study, chosen), deadline, advises=not messages)
        if not reported:
            return
        messages.append(reported)
    also = f"\nSo it is with every listed {' and '.join(records[0])}." if records[0] else ""
    raise InfeasibleError(f"{study.name}: {messages[0]}{also}")


def cures_of(study: Study) -> dict[str, str]:
    """Return, by choice, a record with which the arithmetic limits of a study hold that conflict; else empty."""
    try:
        conflict = _conflict_search(study, None)
    except InfeasibleError:
        return {}
    return curing_records(*conflict) if conflict else {}


def _conflict(study: Study, deadline: Deadline | None, *, advises: bool) -> str:
    """Report the limits that conflict, with the next step; empty if a start satisfies all, or the time is over."""
    try:
        conflict = _conflict_search(study, deadline)
    except InfeasibleError as error:  # a limit that nothing free can mend
        return str(error)
    if conflict is None:
        return ""
    optimizer, nearest, conflict_set = conflict
    if not advises:
        return "\n".join(conflict_in_words(conflict_set))
    lines = conflict_in_words(_with_margins(study, conflict_set))
    cures = curing_records(optimizer, nearest, conflict_set)
    if cures:
        records = " or ".join(f"`{choice}: {record}`" for choice, record in cures.items())
        lines.append(
            f"At nominal sizes they hold by arithmetic with {records} under `module`, each tried alone: a run decides."
        )
    fixed = _fixed(optimizer, conflict_set)
    ways = f"Ease a limit, widen a range, or {fixed}." if fixed else "Ease a limit, or widen a range."
    return "\n".join([*lines, ways])


def _conflict_search(study: Study, deadline: Deadline | None) -> tuple[Optimizer, Run, ConflictSet] | None:
    """Return the problem without its cycle, the nearest design and the limits that conflict; None if none do.

    Raises InfeasibleError for a limit that nothing free can satisfy.
    """
    update = {
        "minimize": {},
        "solver": study.solver.model_copy(update={"starts": max(_STARTS, study.solver.starts)}),
        "profile": ProfileOptions(), "robust": None,
    }  # fmt: skip
    optimizer = Optimizer(study.model_copy(update=update), without_cycle=True, deadline=deadline)
    if not optimizer.free or not optimizer.problem.limits:
        return None
    runs = []
    for begin in optimizer.multistart.points():
        runs.append(optimizer.solve(begin=begin, feasible=True))
        if runs[-1].start.converged:
            return None
    search = find_conflicts(optimizer, runs, lambda _: None)
    if search is None or search.conflict_set is None or optimizer.deadline.passed:
        return None
    return optimizer, search.run, search.conflict_set


def _with_margins(study: Study, conflict_set: ConflictSet) -> ConflictSet:
    """Return the conflict with what each limit would have to move to for a robust design, where the study asks one."""
    if not study.robust:
        return conflict_set

    def moved(side: Side) -> str:
        output, sense = side.text.split(" ")[:2]
        least = least_with_margins(study, output, 1.0 if sense == "<=" else -1.0) if side.move_words else None
        if least is None:
            return side.move_words
        robust = format_quantity(least.value, study.table.unit(output))
        return with_margins_in_words(side.move_words, f"{sense} {robust}", SIGMA)

    return replace(conflict_set, sides=tuple(replace(side, move_words=moved(side)) for side in conflict_set.sides))


def _fixed(optimizer: Optimizer, conflict_set: ConflictSet) -> str:
    """Return advice on the fixed number that moves the only limit's output most per hundredth; empty if there is none.

    An input that could be varied, or the record bought whole that brings it along.
    """
    if len(conflict_set.sides) != 1:
        return ""
    model, table = optimizer.model, optimizer.table
    output = conflict_set.sides[0].text.split(" ")[0]
    inputs = ca.SX.sym("inputs", len(model.names))
    cycle = np.full(len(model.switch_names), np.nan)  # read by none of the arithmetic outputs
    value = model.outputs([output]).call([inputs, cycle], True, False)[0]
    slopes = np.asarray(ca.Function("slopes", [inputs], [ca.gradient(value, inputs)])(model.start)).ravel()
    moved = dict(zip(model.names, np.abs(slopes * model.start), strict=True))
    free = [number.name for number in optimizer.free]
    could = {row.name for row in table.inputs if row.variable}
    most = max((name for name in moved if name in could or name in free), key=moved.__getitem__)
    if most in free:
        return ""
    brought = brought_along_by(optimizer.study)
    if most in brought:
        return f"choose another `{brought[most]}`: its {most} moves it more than all that is varied"
    value = format_quantity(float(model.start[model.index[most]]), table.unit(most))
    return f"vary {most} ({value}), which moves it more than all that is varied"


def refuse_what_cannot_be(study: Study, *, proof: bool = True, deadline: Deadline | None = None) -> Study:
    """Return the study. Raises InputError for requirements that no module can meet, InfeasibleError for conflicts.

    With `proof`, a study that optimises is also refused for conflicts that arithmetic alone shows, which takes a fifth
    of a second, and for stated target impedances out of reach, which takes a second where there are such.
    """
    refuse_impossible(study)
    if proof and study.task == "optimize":
        refuse_infeasible(study, deadline)
        refuse_unreachable(study, deadline)
    return study
