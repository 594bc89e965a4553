"""Rows of cells as blocks: headings, units, numbers, and what the lines before them say."""

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

from tvimdesign.base.errors import InputError
from tvimdesign.simulation.measurement.reading.headings import Heading, heading, is_unit, known, plain, setting_name
from tvimdesign.simulation.measurement.reading.sheets import Row, Sheet

_LEAST_NUMBERS = 2
_HEADING_ROWS = 4
_MOST = 0.6
_MOST_COLUMNS = 100
_SIGNAL = re.compile(r"sig[0-9]+")
"""Lines before a table that name its columns, as in `Sig1 Time (min)` (TA Universal Analysis)."""
_PAIRS = re.compile(r"\s*([A-Za-z][\w ]*?)\s*=\s*([^;=]*);?")


@dataclass
class RawBlock:
    """A table as it stands in a file: headings over rows of text."""

    title: str
    headings: list[Heading]
    rows: list[Row]
    settings: dict[str, str] = field(default_factory=dict)
    skipped: list[int] = field(default_factory=list)
    """Lines between its rows in which a single cell stands, and no number: points that an instrument calls invalid."""


def blocks_of(sheet: Sheet, file: str, ending: str, *, by_place: bool = False) -> list[RawBlock]:
    """Return every table of a sheet; with `by_place` one may have no headings.

    Raises InputError, with the line, where rows and headings do not go together.
    """
    blocks: list[RawBlock] = []
    settings: dict[str, str] = {}
    titles, begin = [(0, sheet.title)], 0
    rows = sheet.rows
    while begin < len(rows):
        if not _begins(sheet, begin):
            setting_text = _setting_text(rows[begin], settings)
            titles += [(rows[begin].line, setting_text)] if setting_text else []
            begin += 1
            continue
        headings, head_line = _headings(sheet, begin, file, ending, settings, by_place=by_place)
        title = [text for line, text in titles if line < head_line][-1]
        end, skipped = _end(sheet, begin, file)
        data_rows = [row for row in rows[begin:end] if row.line not in skipped]
        for row in data_rows:
            if any(row.cells[len(headings) :]):
                raise InputError(
                    f"{file}:{row.line}: {sum(map(bool, row.cells))} cells, but {len(headings)} headings; "
                    f"{row.cells[len(headings)][:20]!r} has none"
                )
        blocks += _divided(RawBlock(title, headings, data_rows, dict(settings), skipped))
        titles, begin = [(0, sheet.title)], end
    return blocks


def _is_data(sheet: Sheet, row: Row) -> bool:
    return sheet.numbers(row) >= _LEAST_NUMBERS


def _end(sheet: Sheet, begin: int, file: str) -> tuple[int, list[int]]:
    """Find where the numbers that begin at a row end, and the lines among them to leave out."""
    rows, skipped, end = sheet.rows, [], begin
    while end < len(rows) and not rows[end].empty:
        row = rows[end]
        if sheet.numbers(row) == 0:
            goes_on = end + 1 < len(rows) and _is_data(sheet, rows[end + 1])
            if not goes_on or any(heading(cell).quantity for cell in row.cells):
                break
            if row.filled > 1:
                raise InputError(f"{file}:{row.line}: no number in this row, though numbers stand above and below it")
            skipped.append(row.line)
        end += 1
    return end, skipped


def _begins(sheet: Sheet, at: int) -> bool:
    """Return whether a table's numbers begin here: two such rows, or one under headings."""
    rows = sheet.rows
    if not _is_data(sheet, rows[at]):
        return False
    if any(heading(cell).quantity for row in _rows_above(sheet, at) for cell in row.cells if cell):
        return True
    return at + 1 < len(rows) and sheet.numbers(rows[at + 1]) >= 1


def _setting_text(row: Row, settings: dict[str, str]) -> str:
    """Note what a line says of the tables below it; returns the title in it, if it is one."""
    cells = [cell for cell in row.cells if cell]
    text = " ".join(cells)
    if "=" in text:
        settings.update({setting_name(name): value for name, value in _PAIRS.findall(text) if setting_name(name)})
        return ""
    pair = cells if len(cells) == 2 else re.split(r":\s*|\t", text, maxsplit=1)
    if len(pair) == 2:
        name, value = pair
        unit = re.search(r"/\s*(\w+)\s*:?$", name)
        key = setting_name(name) or setting_name(name[: unit.start()] if unit else name)
        key = plain(name) if _SIGNAL.fullmatch(plain(name)) else key
        if key:
            settings[key] = f"{value} {unit[1]}" if unit else value
        return value if plain(name) in {"step name", "test type", "action name"} else ""
    return text if len(cells) == 1 and re.search(r"[A-Za-z]{3}", text) and not text.startswith(("[", "#")) else ""


def _headings(
    sheet: Sheet, begin: int, file: str, ending: str, settings: Mapping[str, str], *, by_place: bool
) -> tuple[list[Heading], int]:
    """Return headings of the numbers that begin at a row, and the line where they begin.

    Names and units are from the rows above it, or the format's own.
    """
    rows = sheet.rows
    names, units = _names_and_units(_rows_above(sheet, begin), sheet.numbers(rows[begin]))
    default = known()["formats"].get(ending.lower(), [])
    heads = _aligned(names, units, rows[begin], sheet, default) if names else []
    width = sum(map(bool, rows[begin].cells))
    line = min((row.line for row in (names, units) if row), default=rows[begin].line)
    if default:  # by place, as the format has them, where the headings do not say it
        if not {column.quantity for column in heads} >= {name for name, _ in default}:
            heads = [heading(f"{name} [{unit}]") for name, unit in default]
        return heads + [Heading(f"column {i}", "", "") for i in range(len(heads) + 1, _MOST_COLUMNS)], line
    if not heads and "sig1" in settings:
        return [heading(settings.get(f"sig{i}", "")) for i in range(1, len(rows[begin].cells) + 1)], line
    if not heads and by_place:
        return [Heading(f"column {i}", "", "") for i in range(1, len(rows[begin].cells) + 1)], line
    if not heads:
        raise InputError(
            f"{file}:{rows[begin].line}: numbers without a row of headings above them; write one, such as "
            "'time [s]; angle [deg]', or say it by place in a file for --columns: "
            "{time: {column: 1, unit: s}, angle: {column: 2, unit: deg}}"
        )
    if sheet.separator == "blanks" and len(heads) != width:
        raise InputError(
            f"{file}:{rows[begin].line}: {width} numbers under {len(heads)} headings; where blanks separate, a heading "
            "is one word: separate by tabs or semicolons"
        )
    return heads, line


def _rows_above(sheet: Sheet, begin: int) -> list[Row]:
    """Return the rows with several cells and no number right above some numbers, nearest first.

    A blank line may stand between them and the numbers, as in NETZSCH's exports, where they name quantities.
    """
    above: list[Row] = []
    at = begin - 1
    blank = at > 0 and sheet.rows[at].empty
    if blank and sum(bool(heading(cell).quantity) for cell in sheet.rows[at - 1].cells) >= _LEAST_NUMBERS:
        at -= 1
    while at >= 0 and len(above) < _HEADING_ROWS:
        row = sheet.rows[at]
        if len(row.cells) < 2 if row.empty else sheet.numbers(row):  # a line of separators does not end them
            break
        above += [row] if row.filled > 1 else []
        at -= 1
    return above


def _names_and_units(above: Sequence[Row], enough: int) -> tuple[Row | None, Row | None]:
    """Return the row of names and that of units among the rows above the numbers, nearest first."""
    units = next((row for row in above if _are_units(row)), None)
    names = next((row for row in above if row is not units and row.filled >= enough), None)
    if names is None and units is not None and units.filled >= enough:
        return units, None
    return names, units


def _are_units(row: Row) -> bool:
    """Return whether most cells are units: some instruments have units of their own, such as g.cm."""
    cells = [cell for cell in (row.cells[1:] if plain(row.cells[0]) in {"units", "unit"} else row.cells) if cell]
    return sum(map(is_unit, cells)) >= _MOST * len(cells)


def _aligned(
    names: Row, units: Row | None, first: Row, sheet: Sheet, default: Sequence[tuple[str, str]]
) -> list[Heading]:
    """Return headings over the columns; a label before the names, such as `Interval data:`, is not one."""
    texts, given = list(names.cells), list(units.cells) if units else []
    if texts[0] == "#":
        texts = texts[1:]
    labelled = texts[0].endswith(":") or plain(texts[0]) == "variables"
    if labelled and sheet.number(first.cells[0]) is not None:
        texts, given = texts[1:], given[1:] if given and not given[0] else given
    elif labelled:
        texts[0] = ""
    if len(given) == len(texts) - 1 and plain(texts[0]) in {"index", "no", "nr", "point", "#"}:
        given = ["1", *given]  # a count of the rows has no unit, not even an empty cell where blanks separate
    given = [unit or "1" for unit in given] + ["1" if units else ""] * (len(texts) - len(given))
    columns = [heading(text, unit) for text, unit in zip(texts, given, strict=False)]
    fallback = dict(default)
    return [column if column.unit else column._replace(unit=fallback.get(column.quantity, "")) for column in columns]


def _divided(block: RawBlock) -> list[RawBlock]:
    """Split a table by the column that names its parts, such as Malvern's `Action Name` or NETZSCH's `Segment`."""
    names = [plain(title.text) for title in block.headings]
    column = next((names.index(name) for name in known()["divided_by"] if name in names), None)
    if column is None:
        return [block]
    parts: list[RawBlock] = []
    last = None
    for row in block.rows:
        word = row.cells[column] if column < len(row.cells) else ""
        if word != last or not parts:
            parts.append(RawBlock(f"{block.title} {word}".strip(), block.headings, [], block.settings))
            last = word
        parts[-1].rows.append(row)
    return parts
