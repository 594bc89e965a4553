"""Tables of choices from lists: the best combinations, the cost of standard sizes, and the proof of the choice."""

from collections.abc import Mapping
from typing import Any

from tvimdesign.base.units import format_quantity, from_si
from tvimdesign.device import Table
from tvimdesign.report.output.numbers import number_entry
from tvimdesign.solve.nlp.solution import Choosing, Standard
from tvimdesign.solve.result import StudyResult

_NEAR = 1e-4  # Share within which a number in between is the listed size
_BETTER = 1e-5  # Share by which a design must be better to count as better


def price_in_words(choosing: Choosing, table: Table, own: Mapping[str, str | float] | None = None) -> str:
    """Return what standard sizes cost against the best design in between; empty where none is known.

    `own` are the design's choices where it was chosen with margins: its combination need not be the best of those that
    were ranked without. Both sides are without margins, so the price is that of the sizes alone.
    """
    if choosing.between is None or not choosing.best:
        return ""
    between, margins = choosing.between, "" if own is None else " (both without margins)"
    best = _own(choosing, own)
    if best is None:
        chosen = ", ".join(
            f"{name} {choice_text(name, own[name], table)}" for name in between.choices if own and name in own
        )
        return f"The price of listed sizes is not known of {chosen}, which margins led to: it is not among the best."
    moved = []
    for name, free in between.choices.items():
        value = best.choices[name]
        if isinstance(value, str) and value != free:
            moved.append(f"{name} {value} instead of {free}")
        elif isinstance(value, float) and isinstance(free, float) and abs(value - free) > _NEAR * abs(value):
            shown = f"{from_si(free, table.unit(name)):.4g}"
            moved.append(f"{name} {choice_text(name, value, table)} instead of {shown}")
    if not moved:
        return "Listed sizes cost nothing: the best design has listed sizes anyway."
    cost = ", ".join(f"{name} {share:+.1%}" for name, share in shares(best, between).items())
    whole = best.objective / between.objective - 1.0
    return f"The price of listed sizes: {', '.join(moved)}: {cost}; objective {whole:+.1%}{margins}."


def _own(choosing: Choosing, own: Mapping[str, str | float] | None) -> Standard | None:
    """Return the combination that the design has: the best, or the one of the best that margins led to."""
    return next((combination for combination in choosing.best if own is None or _same(combination.choices, own)), None)


def _same(choices: Mapping[str, str | float], own: Mapping[str, str | float]) -> bool:
    """Return whether a combination is the design's own."""
    return all(
        value == own.get(name, value)
        if isinstance(value, str) or isinstance(own.get(name, value), str)
        else abs(value - float(own.get(name, value))) <= _NEAR * abs(value)
        for name, value in choices.items()
    )


def own_choices(answer: StudyResult) -> dict[str, str | float]:
    """Return the design's own choices from lists; empty where nothing is listed."""
    choosing, design = answer.solution.choosing if answer.solution else None, answer.design
    return {
        name: design.choices.get(name, word) if isinstance(word, str) else design.values.get(name, word)
        for name, word in (choosing.best[0].choices if choosing and choosing.best else {}).items()
    }


def choices_with_margins(answer: StudyResult) -> dict[str, str | float] | None:
    """Return the design's own choices from lists, if margins may have led to another than the best combination."""
    return own_choices(answer) or None if answer.design.study.get("robust") else None


def tally_in_words(choosing: Choosing) -> str:
    """Return how many combinations there are, what became of them, and how far that can be trusted."""
    runs = choosing.work.warm + choosing.work.cold
    fates = [f"{choosing.solved} solved in {_count(runs, 'run')} of the solver"]
    fates += [f"{choosing.pruned} ruled out by their bounds"] if choosing.pruned else []
    fates.append(f"{choosing.without_design} without a design that satisfies the limits")
    fates += [f"{choosing.not_searched} left as the time was over"] if choosing.not_searched else []
    tally = f"{_count(choosing.combinations, 'combination')}: {', '.join(fates)}."
    if not runs:
        return tally
    if not choosing.proven:
        trust = "By their bounds the others are no better; `--prove` solves every combination."
    elif choosing.improved > _BETTER:
        trust = (
            f"Every combination was then solved, and one is {choosing.improved:.2%} better than branch and bound "
            "found: it is the answer. More `solver.starts` make branch and bound better."
        )
    else:
        trust = "Every combination was then solved: the same best."
    return f"{tally} {trust}"


def choosing_data(
    choosing: Choosing | None, table: Table, own: Mapping[str, str | float] | None = None
) -> dict[str, Any] | None:
    """Return the account as plain data; None where nothing is listed. `own`: as of `price_in_words`."""
    if choosing is None:
        return None
    best, between = _own(choosing, own), choosing.between
    costs = shares(best, between) if best and between else {}
    return {
        "combinations": choosing.combinations, "solved": choosing.solved, "pruned_by_bound": choosing.pruned,
        "without_design": choosing.without_design, "not_searched": choosing.not_searched, "proven": choosing.proven,
        "better_by_proof": choosing.improved, "better_than_bound": choosing.inside,
        "objective_of_mixture": choosing.bound, "ruled_out_by_arithmetic": choosing.work.screened,
        "runs": choosing.work.warm + choosing.work.cold,
        "iterations": choosing.work.warm_iterations + choosing.work.cold_iterations,
        "best": [_plain(combination, table) for combination in choosing.best],
        "between_sizes": _plain(between, table) if between else None,
        "cost_of_standard_sizes": costs
        | ({"objective": best.objective / between.objective - 1.0} if best and between else {}),
    }  # fmt: skip


def _plain(standard: Standard, table: Table) -> dict[str, Any]:
    def numbers(values: Mapping[str, str | float]) -> dict[str, str | dict[str, Any]]:
        return {
            name: value if isinstance(value, str) else number_entry(value, table.unit(name))
            for name, value in values.items()
        }

    return {"choices": numbers(standard.choices), "objective": standard.objective, "outputs": numbers(standard.values)}


def shares(standard: Standard, other: Standard) -> dict[str, float]:
    """Return how much more of each minimised output a design has than another, as a share."""
    return {name: value / other.values[name] - 1.0 for name, value in standard.values.items()}


def choice_text(name: str, word: str | float, table: Table) -> str:
    """Return a record's name as it is, a listed size in its unit."""
    return word if isinstance(word, str) else format_quantity(word, table.unit(name))


def _count(number: int, what: str) -> str:
    return f"{number} {what}" if number == 1 else f"{number} {what}s"
