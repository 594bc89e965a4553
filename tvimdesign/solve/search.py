"""Searches a study's design space: every start, what is listed by branch and bound, the best accounted for."""

import math
from collections import Counter
from collections.abc import Callable, Iterable, Sequence
from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING

from tvimdesign.base.deadline import Deadline
from tvimdesign.base.errors import TimeOverError
from tvimdesign.base.interrupts import interrupt_came
from tvimdesign.solve.discrete.branch_and_bound import BranchAndBound
from tvimdesign.solve.discrete.combinations import ExactCombinations, Trees, every_combination, refuse_too_many
from tvimdesign.solve.discrete.discrete_choices import Box, discrete_sizes
from tvimdesign.solve.discrete.record_families import families_of
from tvimdesign.solve.discrete.relaxation import Relaxation, order
from tvimdesign.solve.infeasibility.conflict_set import find_conflicts, tried_with_margins
from tvimdesign.solve.infeasibility.early_checks import refuse_infeasible, refuse_unreachable
from tvimdesign.solve.nlp import solver_run
from tvimdesign.solve.nlp.constraints import on_cycle
from tvimdesign.solve.nlp.solution import Choosing, ConflictSet, Solution, SolverEffort, Standard, Start, YieldReached
from tvimdesign.solve.nlp.solver_run import Progress, Run
from tvimdesign.solve.optimizer.optimizer import Optimizer
from tvimdesign.solve.optimizer.refinements import ending_in_time, put_at_bounds
from tvimdesign.solve.optimizer.verify_optimum import verify_optimum
from tvimdesign.study import SolverOptions, Study
from tvimdesign.study.written_studies import started_at

if TYPE_CHECKING:
    from tvimdesign.solve.uncertainty.robust import Candidate


class SearchInterrupted(KeyboardInterrupt):
    """A search that was interrupted."""

    def __init__(self, best: Study | None = None) -> None:
        """`best` is the study started at the best design so far; None if there is none yet."""
        super().__init__()
        self.best = best


def best_so_far(study: Study, trees: Sequence[Relaxation]) -> Study | None:
    """Return the study started at the best design its problems have reached; None if there is none yet."""
    bests = [(order(tree.best), tree.place, tree) for tree in trees if tree.best is not None]
    if not bests:
        return None
    tree = min(bests)[-1]
    assert tree.best is not None
    values = dict(zip(tree.optimizer.model.names, tree.best.inputs.tolist(), strict=True))
    return started_at(study, values, tree.best.start.choices)


Keep = Callable[[Optimizer, list[Run]], None]
Search = Callable[[Study, Progress, dict[str, float] | None, Keep, Sequence[str]], Solution]
"""What finds the best design of a study, as `optimize` does."""
_TO_VERIFY, _OVER_SET_UP, _LEAST_OVER_SET_UP = 0.05, 3.0, 4.0
"""What a search leaves of its time to what follows: a twentieth of the limit, or three times what setting up its
first problem took, if that is longer. Verifying and reporting a design takes twice that. A search with less than four
times that is not started, as its solver takes as long to build as its problem."""
_Runs = dict[tuple[int, Box], Run]
"""Designs of single combinations: the place of their tree, their sizes, the run that found them."""


def optimize(
    study: Study,
    progress: Progress = lambda _: None,
    reference: dict[str, float] | None = None,
    keep: Keep = lambda *_: None,
    objectives: Sequence[str] = (),
    deadline: Deadline | None = None,
    checked: bool = False,
    eases: bool = False,
) -> Solution:
    """Find the best design of a study: every start, every listed choice. Raises InputError, InfeasibleError.

    `reference` are the values the minimised outputs are divided by: those of the study's start unless given.
    `keep` is handed the problem, with its solvers, that the best design came from, and the runs of its starts; outputs
    that are `traded` can be weighed and bounded with it afterwards. An interrupt comes out as SearchInterrupted, which
    has the best design so far.
    A study that is `checked` has passed `refuse_infeasible` and `refuse_unreachable`, which are not asked again.
    A search that `eases` seeks, where a yield is missed, the requirement that stands in its way, and tries with margins
    where conflicting limits must move to; either takes as long as the search.
    The search ends in time for its design to be verified before the `deadline`: the study's time limit from now on
    unless given. Raises TimeOverError where there is no time to search.
    """
    trees: list[Relaxation] = []
    try:
        whole = deadline or Deadline(study.solver.time_limit)
        if not checked:
            refuse_unreachable(study, whole.leaving(_TO_VERIFY * whole.seconds))
        return _optimize(study, progress, reference, keep, objectives, trees, whole, checked, eases)
    except (KeyboardInterrupt, Exception) as error:
        if isinstance(error, KeyboardInterrupt) or interrupt_came():  # a library raises something else for one
            raise SearchInterrupted(best_so_far(study, trees)) from error
        raise


def _optimize(
    study: Study,
    progress: Progress,
    reference: dict[str, float] | None,
    keep: Keep,
    objectives: Sequence[str],
    trees: list[Relaxation],
    whole: Deadline,
    checked: bool,
    eases: bool,
) -> Solution:
    """Optimise up to a deadline; fill `trees` with the problems of the search."""
    deadline = whole.leaving(_TO_VERIFY * whole.seconds)
    sizes, families = discrete_sizes(study, study.table), families_of(study)
    refuse_too_many(families, sizes)
    combinations = sizes.count * sum(family.count for family in families)
    building = Trees(study, reference, progress, objectives, deadline, sizes)
    trees += building.of(families)
    _leave_time(deadline, trees[0].optimizer.seconds["set_up"])
    listed = any(relaxation.sizes.names for relaxation in trees)
    start_infeasible = all(relaxation.start_infeasible() for relaxation in trees)
    free = _free_runs(trees, 1 if start_infeasible else None, deadline)
    in_time = _in_time(study, free, deadline)
    search = BranchAndBound(trees, study.solver.alternatives)
    if listed and in_time is None:
        search.run()
    choosing: Choosing | None = None
    designs, shown, exact = free, list[tuple[Relaxation, Run]](), building.exact()
    if listed and in_time is None:
        choosing, designs, shown = _choose(search, exact, combinations, study.solver)
        in_time = _in_time(study, designs, deadline)
    elif combinations > 1:
        choosing, shown = _chosen(free, combinations, study.solver)
    if in_time is not None:
        progress("the switch of the best design ends beyond `horizon`: searching for one that ends in time")
        trees.clear()
        return _optimize(in_time, progress, reference, keep, objectives, trees, whole, checked, eases)
    relaxation, run = min(designs, key=lambda pair: order(pair[1]))
    recorded = [*free, *(designs if listed else [])]
    nominal = run
    if study.robust and run.start.converged:
        robust = deadline.attempt(solver_run.MARGINS, partial(_robust, designs, eases))
        relaxation, nominal, run = robust or (relaxation, nominal, run)
        if study.robust.share is None:
            recorded = [(entry[0], run) if entry[1] is nominal else entry for entry in recorded]
    margined = study.robust is not None and study.robust.share is not None and run is not nominal
    run, conflict_set = _reconciled(
        relaxation, run, [candidate for other, candidate in recorded if other is relaxation], progress
    )
    if conflict_set and eases:
        again = partial(optimize, progress=progress, deadline=Deadline(deadline.remaining), checked=True)
        # Each trial is a whole search: only the limit that is easiest to move is tried.
        tried = [tried_with_margins(study, side, again, progress) for side in conflict_set.sides[:1]]
        conflict_set = replace(conflict_set, sides=(*tried, *conflict_set.sides[1:]))
    if start_infeasible and conflict_set is None and not (checked or run.start.converged or deadline.passed):
        refuse_infeasible(study, deadline)
    settled = put_at_bounds(relaxation.optimizer, run)
    recorded, run = [(entry[0], settled) if entry[1] is run else entry for entry in recorded], settled
    if run.start.converged and all(run is not other for _, other in recorded):
        recorded.append((relaxation, run))
    _number(entry for _, entry in recorded)
    keep(relaxation.optimizer, [candidate for other, candidate in recorded if other is relaxation])
    starts = tuple(other.start for _, other in recorded if not (margined and other is run))  # those without margins
    solution = replace(
        _account(trees, relaxation, run, nominal, starts),
        choosing=choosing and _with_alternatives(choosing, trees, exact, shown),
        conflict_set=conflict_set,
        out_of_time=whole.seconds if deadline.met else None,
        left_out=tuple(whole.left_out),
    )
    return replace(solution, status=_status(study, solution, no_combination=listed and search.start_infeasible))


def _number(runs: Iterable[Run]) -> None:
    for number, run in enumerate(runs):
        run.start = replace(run.start, number=number)


def _leave_time(deadline: Deadline, set_up: float) -> None:
    """Leave time for what follows the search. Raises TimeOverError where there is no time to search, then."""
    deadline.leave(_OVER_SET_UP * set_up)
    if deadline.whole.remaining < _LEAST_OVER_SET_UP * set_up:
        raise TimeOverError("the search could start", deadline.seconds)


def _account(
    trees: Sequence[Relaxation], relaxation: Relaxation, run: Run, nominal: Run, starts: tuple[Start, ...]
) -> Solution:
    """Return the best design verified, with the rest of its account as far as time allows."""
    seconds = {
        key: sum(relaxation.optimizer.seconds[key] for relaxation in trees) for key in trees[0].optimizer.seconds
    }
    passed_over = sum((Counter(relaxation.optimizer.multistart.passed_over) for relaxation in trees), Counter[str]())
    optimizer, robust = relaxation.optimizer, relaxation.optimizer.study.robust
    solution = replace(verify_optimum(optimizer, run, starts, seconds), passed_over=dict(passed_over))
    constant, late = relaxation.constant_current_optimum, optimizer.deadline.late
    if constant.best is not None:
        solution = replace(solution, constant=late.attempt("the comparison with constant currents", constant.optimum))
    if robust is not None and robust.share is not None and run.start.converged:
        account = partial(_yield_reached, optimizer, run, nominal, robust.share)
        solution = replace(solution, yield_reached=late.attempt("the yield that is asked for", account))
    return solution


def _status(study: Study, solution: Solution, *, no_combination: bool) -> str:
    """Return a solution's status that its check cannot know: a yield too low, or no design."""
    if solution.status == solver_run.OPTIMAL and study.robust is not None:
        if study.robust.share is None:
            return solver_run.BELOW_YIELD if solver_run.MARGINS in solution.left_out else solver_run.OPTIMAL
        return (
            solver_run.OPTIMAL if solution.yield_reached and solution.yield_reached.reached else solver_run.BELOW_YIELD
        )
    if solution.status == solver_run.OPTIMAL:
        return solver_run.OPTIMAL
    if solution.conflict_set:
        return "infeasible: this design violates its limits least"
    return solver_run.NO_COMBINATION if no_combination else solution.status


def _in_time(study: Study, designs: Sequence[tuple[Relaxation, Run]], deadline: Deadline) -> Study | None:
    """Return the study with limits on times, if the best design ends beyond the horizon and time is left."""
    relaxation, run = min(designs, key=lambda pair: order(pair[1]))
    return None if deadline.passed else ending_in_time(study, relaxation.optimizer, run)


def _robust(designs: Sequence[tuple[Relaxation, Run]], eases: bool) -> tuple[Relaxation, Run, Run]:
    """Return the best design that can be made robust: before, after, and as its start is reported."""
    from tvimdesign.solve.uncertainty.robust import Candidate, most_robust  # it loads the compiler

    ranked = sorted(designs, key=lambda pair: order(pair[1]))
    candidates = [Candidate(relaxation.optimizer, run, _sizes(relaxation, run)) for relaxation, run in ranked]
    place, run = most_robust(candidates, partial(_beside_sizes, ranked[0][0]), eases=eases)
    relaxation = ranked[place][0] if place < len(ranked) else ranked[0][0]
    optimizer, nominal, within, margins = candidates[place]
    if margins:
        reached, optimizer.margins = optimizer.margins, {}
        without = optimizer.solve(within, warm=nominal)
        without.start = replace(without.start, choices=nominal.start.choices)
        nominal, optimizer.margins = without if without.start.converged else nominal, reached
    run.start = replace(run.start, choices=nominal.start.choices, begin=nominal.start.begin)
    return relaxation, nominal, run


def _beside_sizes(relaxation: Relaxation) -> "list[Candidate]":
    """Return the designs at the sizes beside those of the robust optimum between them, those that bear most first.

    Each has as much as it bears of that optimum's margins. None where records are mixed: such modules cannot be drawn.
    """
    from tvimdesign.solve.uncertainty.robust import Candidate, settle

    sizes, optimizer, optima = relaxation.sizes, relaxation.optimizer, relaxation.optima
    if sizes.mixtures or not sizes.names or not optima:
        return []
    optimizer.margins, designs = {}, list[tuple[float, float, Candidate]]()
    between = settle(optimizer, optima[0], {})
    margins = {name: margin for name, margin in optimizer.margins.items() if margin > 0.0}
    for box in sizes.around(relaxation.values(between)):
        optimizer.margins, ends = {}, sizes.ends(box)
        run = optimizer.solve(ends, warm=between, moves=margins)
        if run.start.converged:
            run.start = replace(run.start, choices=relaxation.choices(box))
            borne = min((optimizer.margins[name] / margin for name, margin in margins.items()), default=1.0)
            design = Candidate(optimizer, run, ends, optimizer.margins)
            designs.append((-round(borne, 3), run.start.objective, design))
    return [design for *_, design in sorted(designs, key=lambda design: design[:2])]


def _sizes(relaxation: Relaxation, run: Run) -> dict[str, tuple[float, float]]:
    """Return the listed sizes of a run's combination, each as a pair of equal ends."""
    chosen = run.start.choices
    return {name: (float(chosen[name]), float(chosen[name])) for name in relaxation.sizes.names if name in chosen}


def _yield_reached(optimizer: Optimizer, run: Run, nominal: Run, share: float) -> YieldReached:
    """Draw modules of the best run at random and return their yield. Raises TimeOverError."""
    from tvimdesign.solve.uncertainty.yields import account_of_yield  # it loads the compiler

    optimizer.progress("computing the yield: simulating modules with random deviations")
    return account_of_yield(optimizer, run, nominal, share)


def _reconciled(
    relaxation: Relaxation, best: Run, tried: list[Run], progress: Progress
) -> tuple[Run, ConflictSet | None]:
    """Return the best run; if none converged, one that does after all, or that of least violation with its conflict."""
    if best.start.converged or relaxation.optimizer.deadline.passed:
        return best, None
    conflict_search = find_conflicts(relaxation.optimizer, tried, progress)
    if relaxation.optimizer.deadline.passed and not (conflict_search and conflict_search.run.start.converged):
        return best, None
    listed = any(isinstance(value, float) for value in best.start.choices.values())
    if conflict_search is None or (
        conflict_search.conflict_set is None and listed
    ):  # between the listed sizes there is one, at none of them
        return best, None
    conflict_search.run.start = replace(conflict_search.run.start, choices=best.start.choices)
    return conflict_search.run, conflict_search.conflict_set


def _free_runs(trees: Sequence[Relaxation], most: int | None, deadline: Deadline) -> list[tuple[Relaxation, Run]]:
    """Return the runs of each tree from every start, or `most` of them, with every size free."""
    free: list[tuple[Relaxation, Run]] = []
    for relaxation in trees:
        if not (free and deadline.passed):
            free += [(relaxation, run) for run in relaxation.starts(most)]
    for relaxation in trees:
        if not any(tree.optima for tree in trees) and not deadline.passed:
            free += [(relaxation, run) for run in relaxation.from_all_over()]
    for relaxation in trees:
        free += [(relaxation, run) for run in relaxation.from_other_records(trees)]
    return free


def _choose(
    search: BranchAndBound, exact: ExactCombinations, combinations: int, options: SolverOptions
) -> tuple[Choosing, list[tuple[Relaxation, Run]], list[tuple[Relaxation, Run]]]:
    """Return the best combinations, by branch and bound and on request by solving all.
    The answer holds the account, the designs, and those to report, which are not simulated yet.
    """
    trees = search.trees
    stopped = trees[0].optimizer.deadline.met
    solved, proof = dict(search.runs), SolverEffort()
    pruned, improved = search.pruned, 0.0
    if options.prove and not stopped:
        solved, proof = every_combination(trees, search.runs)
        pruned = 0
        improved = _improvement(search.runs, solved)
    ranked = sorted(solved, key=lambda key: (order(solved[key]), key))
    reported = [(trees[place], solved[place, box]) for place, box in ranked]
    best = exact.solved(trees[ranked[0][0]], ranked[0][1], solved[ranked[0]]) if ranked else None
    shown = [*([best] if best else []), *reported[1 : options.alternatives]]
    choosing = Choosing(
        combinations=combinations, solved=len(solved), pruned=pruned,
        without_design=0 if stopped else combinations - len(solved) - pruned,
        not_searched=combinations - len(solved) - pruned if stopped else 0,
        best=(), between=None, bound=_least(trees),
        proven=options.prove and not trees[0].optimizer.deadline.met, improved=improved, inside=search.inside,
        work=SolverEffort.total(relaxation.work for relaxation in trees), proof=proof,
    )  # fmt: skip
    others = [design for key, design in zip(ranked, reported, strict=True) if key in search.runs or design in shown]
    plain = [design for design in others[1:] if not design[0].sizes.mixtures]
    return choosing, [best, *plain] if best else [_closest(trees[0], exact)], shown


def _between(
    trees: Sequence[Relaxation], exact: ExactCombinations, best: Sequence[tuple[Relaxation, Run]]
) -> Standard | None:
    """Return the best design with every size free, with the best records if these are mixed."""
    if any(relaxation.sizes.mixtures for relaxation in trees):
        run = exact.between(*best[0]) if best else None
        return _standard(best[0][0], run) if run else None
    optima = [(relaxation, relaxation.optima[0]) for relaxation in trees if relaxation.optima]
    between = min(optima, key=lambda pair: order(pair[1]), default=None)
    return _standard(*between) if between else None


def _least(trees: Sequence[Relaxation]) -> float | None:
    """Objective below which no combination comes; None where no records are mixed."""
    if not any(relaxation.sizes.mixtures for relaxation in trees):
        return None
    return min((relaxation.optima[0].start.objective for relaxation in trees if relaxation.optima), default=None)


def _chosen(
    runs: Sequence[tuple[Relaxation, Run]], records: int, options: SolverOptions
) -> tuple[Choosing, list[tuple[Relaxation, Run]]]:
    """Return the account if only records of different structure are listed: each was searched from every start.

    With it the designs that are to be reported, which are not simulated yet.
    """
    best: dict[int, tuple[Relaxation, Run]] = {}
    stopped = any(relaxation.optimizer.deadline.met for relaxation, _ in runs)
    searched = len({relaxation.place for relaxation, _ in runs}) if stopped else records
    for relaxation, run in sorted(runs, key=lambda pair: order(pair[1])):
        if run.start.converged:
            best.setdefault(relaxation.place, (relaxation, run))
    choosing = Choosing(
        combinations=records, solved=len(best), pruned=0, without_design=searched - len(best),
        not_searched=records - searched,
        best=(), between=None, proven=True, improved=0.0, work=SolverEffort(), proof=SolverEffort(), inside=0.0,
    )  # fmt: skip
    return choosing, list(best.values())[: options.alternatives]


def _improvement(branched: _Runs, every: _Runs) -> float:
    """Share by which the best of all combinations is better than what branch and bound found."""
    best, least = (min((run.start.objective for run in runs.values()), default=None) for runs in (branched, every))
    if best is None or least is None:
        return 0.0 if least is None else 1.0
    return max(best - least, 0.0) / abs(best)


def _closest(relaxation: Relaxation, exact: ExactCombinations) -> tuple[Relaxation, Run]:
    """Return the solver's end at the sizes nearest to the best design between them, as no combination has a design."""
    whole = relaxation.sizes.whole
    optimum = relaxation.optima[0] if relaxation.optima else None
    values = relaxation.values(optimum) if optimum else relaxation.start_values
    return exact.closest(relaxation, relaxation.sizes.nearest(values, whole))


def _with_alternatives(
    choosing: Choosing, trees: Sequence[Relaxation], exact: ExactCombinations, best: Sequence[tuple[Relaxation, Run]]
) -> Choosing:
    """Return the account with the best combination simulated, and its alternatives as far as time allows."""
    standards = [_standard(*pair) for pair in best[:1]]
    for pair in best[1:]:
        optimizer = pair[0].optimizer
        optimizer.progress("simulating the next-best choice from the lists")
        if other := optimizer.deadline.late.attempt(solver_run.ALTERNATIVES, partial(_standard, *pair)):
            standards.append(other)
    between, late = None, trees[0].optimizer.deadline.late
    if any(tree.sizes.names for tree in trees) and (best or not late.passed):
        between = late.attempt(solver_run.BETWEEN, partial(_between, trees, exact, best))
    return replace(choosing, best=tuple(standards), between=between)


def _standard(relaxation: Relaxation, run: Run) -> Standard:
    """Return a simulated design for the report."""
    optimizer, minimized = relaxation.optimizer, list(relaxation.optimizer.study.minimize)
    if any(on_cycle(optimizer.table, name) for name in minimized):
        cycle = optimizer.simulator.run(run.inputs, run.current_profiles).values
    else:
        cycle = dict.fromkeys(optimizer.model.switch_names, math.inf)
    choices: dict[str, str | float] = {**relaxation.records, **relaxation.values(run)}
    if relaxation.sizes.mixtures:
        choices = run.start.choices
    return Standard(choices, run.start.objective, optimizer.model.some_values(minimized, run.inputs, cycle))
