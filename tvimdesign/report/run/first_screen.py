"""The first screen of a run: verdict, requirements, facts and warnings in 16 lines; and summary.txt with all tables."""

from collections.abc import Sequence

from rich.console import Console

from tvimdesign.base.results_folder import ResultsFolder
from tvimdesign.report.output import terminal
from tvimdesign.report.page.blocks import Facts, Warned
from tvimdesign.report.page.page_file import FILE as PAGE
from tvimdesign.report.run.answered_study import AnsweredStudy
from tvimdesign.report.run.blocks.facts import Fact, main_facts, study_fact
from tvimdesign.report.run.blocks.more_facts import chosen_fact, front_fact, more_facts
from tvimdesign.report.run.blocks.requirements import HEADS, Requirement, requirements
from tvimdesign.report.run.blocks.sections import text_sections
from tvimdesign.report.run.blocks.verdict import Verdict, starts_in_words, verdict
from tvimdesign.report.run.blocks.warnings import SHOWN, RunWarning
from tvimdesign.solve.nlp.solver_run import BELOW_YIELD

FILE = "summary.txt"
LINES, NARROW_LINES = 16, 24  # Lines of the screen from 100 columns on, and below
_WIDE = 100
_LEAST = 4  # Lines of the requirements, with their heads and the others, for which the last facts make room
_FILE_WIDTH = 120
_COLOURS = {"red": r"\bviolated by\b.*", "yellow": r"at the limit|^Warning:", "bold": r"^[A-Z][a-z ]+:"}
_OF_TONE = {"good": "bold green", "warn": "bold yellow", "bad": "bold red", "": "bold"}


def verdict_of(answered: AnsweredStudy) -> Verdict:
    """Return the verdict on an answered study."""
    return verdict(answered.result, answered.uncertainty, answered.warnings)


def first_screen(answered: AnsweredStudy, width: int, seconds: float | None = None) -> list[str]:
    """Return the screen's lines but the last, `look_first`; none is wider than `width` unless a name is.

    `seconds` is how long the run took; a file is the same every time without it.
    """
    answer = answered.result
    parts = [verdict_of(answered).text, f"{answer.design.name} ({answer.design.mode})"]
    more = [*starts_in_words(answer), *([] if seconds is None else [f"{seconds:.{1 if seconds < 10.0 else 0}f} s"])]
    head, first = _as_fit(terminal.joined(parts, width), more, width), warning_lines(answered.warnings, width, 1)
    facts: list[list[str]] = []
    room = (LINES if width >= _WIDE else NARROW_LINES) - len(head) - 1
    if answer.has_design:
        extra = [*front_fact(answer, answered.front.front), *chosen_fact(answer)]
        facts = [_fact_lines(fact, width) for fact in (*main_facts(answer, answered.uncertainty), *extra)]
        while extra and sum(map(len, facts)) > room - len(first) - _LEAST:
            extra, facts = extra[:-1], facts[:-1]
    left = room - sum(map(len, facts))
    rows, met = requirements(answer, answered.uncertainty), "met"
    if answer.has_design and answer.design.status == BELOW_YIELD:
        met = "met at nominal sizes"
    table = requirement_lines(rows, width, left - len(first), met)
    counts = [count for count in range(SHOWN, 0, -1)
              if len(table) + len(warning_lines(answered.warnings, width, count)) <= left]  # fmt: skip
    lines = [line for fact in facts for line in fact]
    return [*head, *table, *lines, *warning_lines(answered.warnings, width, counts[0] if counts else 1)]


def _as_fit(lines: Sequence[str], more: Sequence[str], width: int) -> list[str]:
    """Return lines, the last one with as many of `more` behind it as have a place."""
    last = lines[-1]
    for part in more:
        last = f"{last}{terminal.DOT}{part}" if len(last) + len(terminal.DOT) + len(part) <= width else last
    return [*lines[:-1], last]


def _fact_lines(fact: Fact, width: int) -> list[str]:
    """Return a fact in as few lines as hold it; a listing in one, with the number of parts that do not fit."""
    first = f"{fact.label}: {fact.parts[0]}"
    lines = terminal.joined([first, *fact.parts[1:]], width, "  ")
    if len(lines) == 1 or not fact.listing:
        return _as_fit(lines, fact.note.split(terminal.DOT) if fact.note else [], width)
    return _listing(fact.label, fact.parts, width, 1)


def _listing(label: str, parts: Sequence[str], width: int, most: int) -> list[str]:
    """Return as many parts as fit in at most `most` lines, with the number of the others."""
    first = f"{label}: {parts[0]}"
    for count in range(len(parts), 0, -1):
        more = [f"{len(parts) - count} more"] if count < len(parts) else []
        lines = terminal.joined([first, *parts[1:count], *more], width, "  ")
        if len(lines) <= most:
            return lines
    return terminal.wrapped(first, width, indent="  ")


def requirement_lines(rows: Sequence[Requirement], width: int, most: int, met: str = "met") -> list[str]:
    """Return the requirements, those most in doubt in at most `most` lines with one on the others."""
    by_doubt = sorted(rows, key=lambda row: row.doubt)
    for count in range(len(rows), 0, -1):
        first, others = by_doubt[:count], by_doubt[count:]
        lines = _fitting([HEADS, *(row.cells for row in rows if row in first)], width)
        lines += _others(others, "others", met, width) if others else []
        if len(lines) <= most and (count > 1 or not others or by_doubt[0].met_in is None):
            return lines
    return _others(by_doubt, "requirements", met, width, most) if rows else []


def _others(rows: Sequence[Requirement], what: str, met: str, width: int, most: int = 1) -> list[str]:
    """Return a line that names what is violated or open of some requirements, else the most in doubt of them."""
    missed = [row.cells[0] for row in rows if row.stands.startswith(("violated", "open"))]
    if missed:
        return _fact_lines(Fact(f"{len(missed)} of {len(rows)} {what} not met", missed, listing=True), width)
    count = f"1 {what[:-1]} is {met}" if len(rows) == 1 else f"{len(rows)} {what} are {met}"
    if rows[0].met_in in (None, 1.0):
        title, limit, got, *_ = rows[0].cells
        tightest = ", the tightest" if len(rows) > 1 else ""
        return terminal.wrapped(f"{count}{tightest}: {title} {got}, asked {limit}", width, indent="  ")
    listed = [f"{row.cells[0]} {row.got} ({row.requested}) in {_in_share(row)}" for row in rows]
    lines = _listing(f"{count}; over plausible cases", listed, width, most)
    if what == "others" or len(lines) <= most:
        return lines
    return terminal.wrapped(
        f"{count}; {rows[0].cells[0]} met in {_in_share(rows[0])} of plausible cases", width, indent="  "
    )


def _in_share(row: Requirement) -> str:
    """Return the share of the plausible cases that meet a requirement."""
    return "all" if row.met_in in (None, 1.0) else f"{int(100.0 * (row.met_in or 0.0))} %"


def _fitting(cells: Sequence[Sequence[str]], width: int) -> list[str]:
    """Return a table that is no wider than the screen: without ranges, or names on their own lines, if need be."""
    filled = [column for column in zip(*cells, strict=True) if any(column[1:])]
    lines = terminal.columns(list(zip(*filled, strict=True)), right=(2,))
    if max(map(len, lines)) > width:
        lines = terminal.columns([(*row[:3], *row[4:]) for row in cells], right=(2,))
    if max(map(len, lines)) <= width:
        return lines
    figures = terminal.columns([row[1:] for row in cells], right=(1,))
    return [line for row, own in zip(cells, figures, strict=True) for line in (row[0], f"  {own}") if line]


def warning_lines(warnings: Sequence[RunWarning], width: int, count: int) -> list[str]:
    """Return the first `count` warnings, each with the line to write, and how many more there are."""
    lines = [line for warning in warnings[:count] for line in _warning(warning, width)]
    more = f"{len(warnings) - count} more: {FILE}"
    if len(warnings) <= count:
        return lines
    if len(lines[-1]) + len(terminal.DOT) + len(more) <= width:
        return [*lines[:-1], f"{lines[-1]}{terminal.DOT}{more}"]
    return [*lines, f"{'':9}{more}"]


def _warning(warning: RunWarning, width: int) -> list[str]:
    """Return what is wrong, and on the same line what cures it if it fits: what is to be copied stays in one piece."""
    indent, cure = " " * 9, warning.cure
    if not cure.startswith(("write ", "may help: ")):
        return terminal.wrapped(f"Warning: {'; '.join(filter(None, (warning.text, cure)))}", width, indent=indent)
    lines = terminal.wrapped(f"Warning: {warning.text};", width, indent=indent)
    if len(lines[-1]) + len(cure) + 1 <= width:
        return [*lines[:-1], f"{lines[-1]} {cure}"]
    return [
        *lines,
        *([f"{indent}{cure}"] if len(indent) + len(cure) <= width else terminal.wrapped(cure, width, indent, indent)),
    ]


def print_first_screen(answered: AnsweredStudy, console: Console, seconds: float | None = None) -> None:
    """Print the first screen."""
    lines = first_screen(answered, console.width, seconds)
    first = {_OF_TONE[verdict_of(answered).tone]: r"^.*?(?= · |$)"}
    terminal.print_lines(lines[:1], console, first)
    terminal.print_lines(lines[1:], console, _COLOURS)


def print_everything(answered: AnsweredStudy, console: Console, seconds: float | None = None) -> None:
    """Print the first screen and every table."""
    print_first_screen(answered, console, seconds)
    answer = answered.result
    if answer.has_design:
        console.print()
        facts = [*study_fact(answer), *more_facts(answer, answered.uncertainty, answered.front.front)]
        terminal.print_block(Facts([(fact.label, fact.text) for fact in facts]), console)
        terminal.print_block(Warned([warning[:2] for warning in answered.warnings]), console)
    for section in text_sections(answered):
        terminal.print_section(section, console)


def write_summary(answered: AnsweredStudy, folder: ResultsFolder) -> None:
    """Write summary.txt: the first screen and every table; without seconds, so that it is the same every time."""
    text = terminal.plain_text(lambda console: print_everything(answered, console), _FILE_WIDTH)
    folder.write(FILE, text.replace(f" more: {FILE}", " more below"))


def look_first(folder: str, width: int, parts: str = "") -> list[str]:
    """Return where to look first: the page of the folder, what the `parts` passed, and the tables if they fit."""
    passed = [f"parts: {parts}"] if parts else []
    lines = _as_fit([f"Look first: {folder}/{PAGE}"], [*passed, f"tables: {FILE}"], width)
    return lines if parts in lines[0] else [*lines, *terminal.wrapped(f"Parts: {parts}", width, indent="  ")]
