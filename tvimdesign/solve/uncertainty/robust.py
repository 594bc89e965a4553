"""A robust optimum: how far within its limits a design must stay so that modules that spread keep them.

By deviations: the spread of what the limits are on comes from exact derivatives at the optimum found, to second order
for what needs no working cycle; the optimum is then sought again. By a yield: see `yield_search`.
"""

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import replace
from types import MappingProxyType
from typing import NamedTuple

from tvimdesign.base.deadline import Deadline
from tvimdesign.base.errors import InfeasibleError, TimeOverError
from tvimdesign.base.units import format_quantity
from tvimdesign.device import Table
from tvimdesign.simulation.working_cycle.device_functions import ResolvedModule
from tvimdesign.solve.nlp import spread
from tvimdesign.solve.nlp.constraints import Constraint, in_words, make_constraint, on_cycle
from tvimdesign.solve.nlp.problem_parts import Objective
from tvimdesign.solve.nlp.solution import EasedRequirement, same_optimum
from tvimdesign.solve.nlp.solver_run import MARGINS, Ends, Run
from tvimdesign.solve.nlp.spread import moments_at
from tvimdesign.solve.optimizer.optimizer import Optimizer
from tvimdesign.solve.uncertainty.design_uncertainty import UncertaintyModel
from tvimdesign.solve.uncertainty.output_sensitivity import output_sensitivities
from tvimdesign.solve.uncertainty.uncertain_inputs import contributors_of, judges_modules
from tvimdesign.solve.uncertainty.yield_search import MANY_SHAKES, PRESSING, Robust, pressing, reach_yield, tightened
from tvimdesign.study import ProfileOptions, Requirement, Study
from tvimdesign.study import Robust as RobustOptions

ROUNDS, _PLAUSIBLE_ROUNDS = 6, 4
_SETTLED = 1e-3  # Change of a margin, as a share of its limit's scale, below which it is settled
_STARTS, SIGMA = 3, 2.5
"""Of a search for a least value, and the standard deviations that a dozen active limits need for a yield of 95 %."""
MOST_TRIED = 3  # Designs that are tried, the best first
_PRESSED = 0.1  # Share of the highest price of a requirement from which another is eased, too
_MOVES = (1.0, 0.6, 0.3, 0.15, 0.07, 0.03)  # Shares of its scale by which it is eased
_GAIN = 1e-4  # Share of the objective by which another design must be better to be drawn
_NEAR = 0.1  # Yield from which a better design that misses the target is tried once more, where another reaches it


class Candidate(NamedTuple):
    """A design that is not robust: its problem, its run, the sizes it is kept at, the margins it was found with."""

    optimizer: Optimizer
    run: Run
    within: Mapping[str, Ends]
    margins: Mapping[str, float] = MappingProxyType({})


def most_robust(
    candidates: list[Candidate], beside: Callable[[], list[Candidate]] = list, *, eases: bool = False
) -> tuple[int, Run]:
    """Return the place of the best of some designs with what the study asks for, and its robust run.

    Once one reaches it, the others are first solved with its margins: one that is no better there is left. Where none
    does, designs `beside` are added and tried; then those that miss it are tried once more, unless a better one reaches
    it. Where none does, the one that comes nearest is returned; with `eases` its problem has the requirement in the
    way, eased.

    Raises TimeOverError where the time is over before any is known to come near.
    """
    tried: list[tuple[int, Robust]] = []
    _try(candidates, _worth_trying(candidates), tried)
    if not any(robust.reached for _, robust in tried):
        count = len(candidates)
        candidates += candidates[0].optimizer.deadline.attempt(MARGINS, beside) or []
        _try(candidates, range(len(candidates))[count : count + MOST_TRIED], tried)
    for place, missed in sorted(tried, key=_rank):
        _, best = min(tried, key=_rank)
        better = missed.share > _NEAR and missed.run.start.objective < best.run.start.objective * (1.0 - _GAIN)
        if not (missed.reached or candidates[place][0].deadline.passed) and (better or not best.reached):
            tried.append((place, _once_more(candidates[place], missed)))
    place, robust = min(tried, key=_rank)
    candidates[place][0].margins = robust.margins
    if eases and not robust.reached:
        candidates[place][0].eased = _eased(candidates[place], robust.run)
    return place, robust.run


def _try(candidates: Sequence[Candidate], places: Iterable[int], tried: list[tuple[int, Robust]]) -> None:
    """Seek a robust design from some candidates; add each to those `tried`."""
    for place in places:
        optimizer, run, within, margins = candidates[place]
        if tried and optimizer.deadline.passed:
            break
        _, best = min(tried, key=_rank, default=(0, None))
        optimizer.margins = dict(margins)
        if best is not None and best.reached and best.plausible:
            run = _with_margins(optimizer, run, within, best)
            if not run.start.converged or run.start.objective > best.run.start.objective * (1.0 - _GAIN):
                continue
        try:
            tried.append((place, _robust(optimizer, run, within, None)))
        except TimeOverError:
            if not tried:
                raise
            optimizer.deadline.leave_out(MARGINS)
            break


def _once_more(candidate: Candidate, missed: Robust) -> Robust:
    """Seek a yield again from a design that misses it, and is stuck there: from many designs beside it."""
    optimizer, _, within, _ = candidate
    optimizer.margins = dict(missed.margins)
    try:
        return _robust(optimizer, missed.run, within, None, shakes=MANY_SHAKES)
    except TimeOverError:
        optimizer.deadline.leave_out(MARGINS)
        return missed


def _eased(candidate: Candidate, missed: Run) -> EasedRequirement | None:
    """Return a requirement and a value of it, alone, from which on a search reaches the yield; None if none is found.

    The costliest is tried first: far off, then nearer, as long as the yield is reached.
    """
    optimizer, run, within, _ = candidate
    options, deadline = optimizer.study.robust, Deadline(optimizer.deadline.remaining)
    if options is None or options.share is None:
        return None
    for requirement in _in_the_way(optimizer, missed):
        suffices = None
        for move in _MOVES:
            moved = _moved(requirement, move, optimizer.table)
            words = format_quantity(moved.limit, optimizer.table.unit(moved.output), 3)
            optimizer.progress(f"yield missed: trying {moved.output} {moved.sense} {words}")
            require = tuple(moved if each is requirement else each for each in optimizer.study.require)
            study = optimizer.study.model_copy(update={"require": require})
            other = Optimizer(study, optimizer.reference, deadline=deadline, mixtures=optimizer.mixtures)
            optimum = other.solve(within, begin=run.inputs, near=True)
            try:
                if not (optimum.start.converged and reach_yield(other, optimum, within, options.share).reached):
                    break
            except TimeOverError:
                return suffices
            suffices = EasedRequirement(f"{requirement.output} {requirement.text}", moved.limit)
        if suffices:
            return suffices
    return None


def _in_the_way(optimizer: Optimizer, run: Run) -> list[Requirement]:
    """Return the requirements that cost a design most, the costliest first."""
    costs: dict[tuple[str, str], float] = {}
    prices = pressing(optimizer, run)
    for limit in optimizer.problem.limits:
        for name in (limit.output, limit.part_of):
            key = (name, limit.sense)
            costs[key] = max(costs.get(key, 0.0), prices.get(limit.name, 0.0))
    stated = {each: costs.get((each.output, each.sense), 0.0) for each in optimizer.study.require}
    least = _PRESSED * max(stated.values(), default=0.0)
    return sorted((each for each, cost in stated.items() if cost > least), key=lambda each: -stated[each])


def _moved(requirement: Requirement, move: float, table: Table) -> Requirement:
    """Return a requirement that is easier by a share of its scale."""
    limit = make_constraint(table, requirement.output, requirement.sense, requirement.limit, "require")
    sign = 1.0 if requirement.sense == "<=" else -1.0
    return requirement.model_copy(update={"limit": limit.limit + sign * move * limit.scale})


def _rank(tried: tuple[int, Robust]) -> tuple[bool, bool, float]:
    """Rank designs that reach what is asked by their objectives, then the others by how near they come."""
    robust = tried[1]
    return not robust.reached, not robust.plausible, robust.run.start.objective if robust.reached else -robust.share


def _with_margins(optimizer: Optimizer, run: Run, within: Mapping[str, Ends], other: Robust) -> Run:
    """Return the optimum of one design with the margins of another; the run itself where it cannot be better."""
    if run.start.objective >= other.run.start.objective:
        return run
    optimizer.margins = dict(other.margins)
    return optimizer.solve(within, begin=run.inputs, unknowns=run.unknowns, near=True)


def _worth_trying(candidates: Sequence[Candidate]) -> list[int]:
    """Return the places of the best design and of others that converged, each at an optimum of its own."""
    places = [0]
    for place, (_, run, *_) in enumerate(candidates[1:], start=1):
        tried = any(same_optimum(run.start, candidates[i][1].start) for i in places)
        if run.start.converged and not tried and len(places) < MOST_TRIED:
            places.append(place)
    return places


def settle(optimizer: Optimizer, run: Run, within: Mapping[str, Ends], objective: Objective | None = None) -> Run:
    """Seek the optimum `within` ends again until limits on what the cycle supplies are kept as robustly as the others,
    or, if a yield is requested, until that share of modules is feasible.

    Returns the last run, converged or not; without such limits, the run as it is.
    """
    return _robust(optimizer, run, within, objective).run


def _robust(
    optimizer: Optimizer, run: Run, within: Mapping[str, Ends], objective: Objective | None, **search: int
) -> Robust:
    options = optimizer.study.robust
    assert options is not None
    if options.share is None:
        run = _settled(optimizer, run, within, objective)
    elif run.start.converged:
        optimizer.floors = {}
        robust = reach_yield(optimizer, run, within, options.share, objective, **search)
        return _plausible(optimizer, robust, within, options, objective)
    return Robust(run, optimizer.margins, 0.0, reached=options.share is None)


def _plausible(
    optimizer: Optimizer, robust: Robust, within: Mapping[str, Ends], options: RobustOptions,
    objective: Objective | None,
) -> Robust:  # fmt: skip
    """Seek a design again whose limits are met in enough of the plausible cases; as near to it as a yield allows."""
    if options.plausible is None or options.share is None:
        return robust
    model = UncertaintyModel(_resolved(optimizer, robust.run), (), [free.name for free in optimizer.free])
    part = 1.0
    for _ in range(_PLAUSIBLE_ROUNDS):
        needed = model.margins(_resolved(optimizer, robust.run), options.plausible) if robust.reached else {}
        robust = replace(robust, plausible=robust.reached and not needed)
        if not needed:
            break
        optimizer.progress("adding margins for the assumed values")
        optimizer.margins = dict(robust.margins)
        short = {name: margin - robust.margins.get(name, 0.0) for name, margin in needed.items()}
        moves = {name: part * margin for name, margin in short.items() if margin > 0.0}
        run = tightened(optimizer, robust.run, within, objective, moves) if moves else None
        optimizer.floors = {**robust.margins, **{name: optimizer.margins[name] for name in moves}} if run else {}
        after = reach_yield(optimizer, run, within, options.share, objective, shakes=0) if run else robust
        if run and after.reached:
            robust = after
        else:
            part *= 0.5
    optimizer.margins = robust.margins
    return robust


def _resolved(optimizer: Optimizer, run: Run) -> ResolvedModule:
    model = optimizer.model
    numbers = {name: float(run.inputs[i]) for name, i in model.index.items()}
    return ResolvedModule(optimizer.study, {**numbers, **model.words}, run.current_profiles)


def _settled(optimizer: Optimizer, run: Run, within: Mapping[str, Ends], objective: Objective | None) -> Run:
    """By deviations: margins of the limits on what the cycle supplies."""
    sigma = optimizer.study.robust.sigma if optimizer.study.robust else None
    assert sigma is not None
    for _ in range(ROUNDS):
        if not run.start.converged:
            return run
        try:
            margins = margins_at(optimizer, run, sigma)
        except TimeOverError:
            optimizer.deadline.leave_out(MARGINS)
            return run
        before = optimizer.margins
        optimizer.margins = margins
        _report_unmargined(optimizer, margins)
        if all(abs(value - before.get(name, 0.0)) < _SETTLED for name, value in margins.items()):
            return run
        optimizer.progress("adding margins to the limits on times")
        optimum = optimizer.solve(within, warm=run, objective=objective)
        if not optimum.start.converged:
            optimum = optimizer.solve(within, begin=run.inputs, objective=objective)
        if not optimum.start.converged and optimizer.deadline.passed:
            optimizer.deadline.leave_out(MARGINS)
            optimizer.margins = before
            return run
        run = optimum
    return run


def _report_unmargined(optimizer: Optimizer, margins: dict[str, float]) -> None:
    """Report the limits whose spread is unknown: they are satisfied as drawn, without a margin."""
    timed = (limit for limit in optimizer.problem.limits if on_cycle(optimizer.table, limit.output))
    names = [limit.name for limit in timed if limit.name not in margins]
    if names:
        optimizer.progress(f"not robust, as a current follows a profile: {', '.join(names)}")


def margins_at(optimizer: Optimizer, run: Run, sigma: float) -> dict[str, float]:
    """Return the margins of `sigma` deviations within its limits at a run's design [shares of each limit's scale]."""
    timed: list[Constraint] = []
    algebraic: list[Constraint] = []
    for limit in (each for each in optimizer.problem.limits if judges_modules(each, optimizer.study.tolerances)):
        (timed if on_cycle(optimizer.table, limit.output) else algebraic).append(limit)
    margins = {}
    if algebraic:
        names, scales = [limit.output for limit in algebraic], [limit.scale for limit in algebraic]
        shift, deviation = moments_at(optimizer.model, optimizer.study.tolerances, names, scales, run.inputs)
        for i, limit in enumerate(algebraic):
            moved = shift[i] if limit.sense == "<=" else -shift[i]
            margins[limit.name] = float(moved + sigma * deviation[i]) / limit.scale
    if timed:
        deviations = _deviations(optimizer, run, list(dict.fromkeys(limit.output for limit in timed)))
        margins |= {
            limit.name: sigma * deviations[limit.output] / limit.scale for limit in timed if limit.output in deviations
        }
    return margins


def _deviations(optimizer: Optimizer, run: Run, wanted: list[str]) -> dict[str, float]:
    """Standard deviations of what follows from the working cycle, by output."""
    resolved = _resolved(optimizer, run)
    contributors = contributors_of(resolved)
    names = [contributor.name for contributor in contributors]
    exact = output_sensitivities(resolved, wanted, names)
    known = [contributors[names.index(name)] for name in exact.variables]
    return dict(zip(exact.outputs, spread.shares(known, exact.derivatives)[0].tolist(), strict=True))


class Extreme(NamedTuple):
    """Least or largest value of an output, and the limits and ranges that hold it there, the costliest first."""

    value: float
    held_by: tuple[str, ...]


def least_with_margins(study: Study, output: str, weight: float = 1.0, *, margins: bool = True) -> Extreme | None:
    """Return the least value of an output that the arithmetic limits allow, with margins for the study's tolerances.

    With a negative weight it is the largest. Limits on the output itself are left out; None if no start gets there.
    """
    normal = {"distribution": "normal", "sigma": SIGMA}  # a uniform one ends at its plus-minus value
    tolerances = {
        name: tolerance if tolerance.distribution == "normal" else tolerance.model_copy(update=normal)
        for name, tolerance in study.tolerances.items()
    }
    update = {
        "tolerances": tolerances, "minimize": {output: weight},
        "robust": RobustOptions(sigma=SIGMA) if margins else None,
        "require": tuple(limit for limit in study.require if limit.output != output),
        "profile": ProfileOptions(), "solver": study.solver.model_copy(update={"starts": _STARTS if margins else 1}),
    }  # fmt: skip
    try:
        optimizer = Optimizer(study.model_copy(update=update), without_cycle=True)
    except InfeasibleError:
        return None
    for begin in optimizer.multistart.points():
        run = optimizer.solve(begin=begin)
        run = settle(optimizer, run, {}) if margins and run.start.converged else run
        if run.start.converged:
            value = run.start.objective * optimizer.reference[output] / weight
            return Extreme(value, _held_by(optimizer, run))
    return None


def _held_by(optimizer: Optimizer, run: Run) -> tuple[str, ...]:
    """Return the active limits and the ranges at whose ends an optimum lies, the costliest first."""
    limits = {limit.name: in_words(limit, optimizer.table) for limit in optimizer.problem.limits}
    costs = {limits[name]: cost for name, cost in pressing(optimizer, run).items()}
    for free, cost in zip(optimizer.free, run.bound_multipliers.tolist(), strict=False):  # without nodes of currents
        costs[f"the range of {free.name}"] = abs(cost)
    return tuple(sorted((name for name, cost in costs.items() if cost > PRESSING), key=lambda name: -costs[name]))
