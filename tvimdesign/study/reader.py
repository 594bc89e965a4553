"""From a study file to a `Study`: reads every section, collects every problem, and raises them all at once."""

import os
from collections.abc import Callable
from contextlib import suppress
from difflib import get_close_matches
from pathlib import Path

from tvimdesign.base.errors import CatalogError, InputError
from tvimdesign.catalog import Catalog
from tvimdesign.device import MODES, Table, table_for
from tvimdesign.study.resolve import with_fitting_defaults
from tvimdesign.study.sections import NAMES, SECTIONS
from tvimdesign.study.sections.goals import is_simulated
from tvimdesign.study.sections.sweeps import SweepBlock
from tvimdesign.study.study import Study
from tvimdesign.study.text.mistakes import Mistakes, RefusedError, is_folder, one_of, quoted
from tvimdesign.study.text.values import Reading, text, unknown_keys
from tvimdesign.study.text.yaml_text import Node, Text
from tvimdesign.study.tree import StudyTree, tree_of_file, tree_of_text

TableOf = Callable[[str], Table]
CatalogOf = Callable[[Path | None], Catalog]


def read_study(path: str | os.PathLike[str]) -> Study:
    """Read a study file; raises as `read_tree`, and InputError where there is no such file or it cannot be opened."""
    return read_tree(tree_of_file(path))


def read_tree(tree: StudyTree, table: TableOf = table_for, catalog: CatalogOf = Catalog) -> Study:
    """Read a study from its tree; raises StudyError with every problem found.

    `table` gives the table of a mode and `catalog` the catalogue with a folder of the user's records.
    """
    return _read(tree, table, catalog)[0]


def read_swept(tree: StudyTree) -> tuple[Study, SweepBlock | None]:
    """Read a study and what it asks to be swept, None where nothing is; raises StudyError with every problem found."""
    return _read(tree, table_for, Catalog)


def read_study_text(source: str, name: str = "study", folder: Path = Path()) -> Study:
    """Read a study from its text; `name` stands for the file in messages, `folder` is where its catalogue is."""
    return read_tree(tree_of_text(source, name, name, folder))


def _read(tree: StudyTree, table: TableOf, catalog: CatalogOf) -> tuple[Study, SweepBlock | None]:
    """Read every section; what is swept is no part of the study that each cell is."""
    problems = Mistakes(tree.file, list(tree.problems))
    nodes = unknown_keys(problems, tree.root.entries, "", "section", list(NAMES))
    folder = _catalog_folder(problems, nodes.get("catalog"), tree.folder)
    mode = _mode(problems, nodes.get("mode"), tree, table)
    records = _records(problems, nodes.get("catalog", tree.root), folder if mode else None, catalog)
    readers = {section.name: section.read for section in SECTIONS}
    reading = Reading(problems, mode, table(mode or MODES[0]), records, nodes, readers, tree.folder)
    read = {section.name: reading.section(section.name) for section in SECTIONS if mode or not section.needs_mode}
    problems.stop()
    fields = {name: read[name] for name in Study.model_fields if name in read}
    fields["trajectory"] = read["task"]["trajectory"] if mode else None
    limits = fields.get("require", ())
    fields["simulated"] = tuple(limit for limit in limits if is_simulated(limit.output, reading.points))
    fields["require"] = tuple(limit for limit in limits if limit not in fields["simulated"])
    named = {"name": read["name"] or tree.name, "mode": mode, "catalog_folder": folder.as_posix() if folder else None}
    study = Study(**{**fields, **named}).based_on(reading.catalog, reading.table)
    return with_fitting_defaults(study), read["sweep"]


def _mode(problems: Mistakes, node: Node | None, tree: StudyTree, table: TableOf) -> str:
    """Return the mode, of a misspelt one that which must be meant, so that other mistakes are reported too; or none."""
    expected = one_of(list(MODES))
    if node is None:
        problems.add(tree.root, "mode", "missing", expected, f"write 'mode: {MODES[0]}'")
        return ""
    with suppress(RefusedError):
        word = text(problems, node, "mode", expected)
        try:
            table(word)
        except InputError:
            problems.unknown(node, "mode", f"mode: {quoted(word)}", word, MODES)
            return next(iter(get_close_matches(word.lower(), MODES, n=1)), "")
        return word
    return ""


def _catalog_folder(problems: Mistakes, node: Node | None, beside: Path) -> Path | None:
    if node is None or (isinstance(node, Text) and node.empty):
        return None
    with suppress(RefusedError):
        word = text(problems, node, "catalog", "a folder of records, relative to the study")
        if is_folder(beside / word):
            return beside / word
        problems.add(node, "catalog", f"there is no folder {quoted(word)} beside the study", "a folder of records")
    return None


def _records(problems: Mistakes, node: Node, folder: Path | None, catalog: CatalogOf) -> Catalog:
    """Return the catalogue; without the user's folder if that cannot be used, so that the rest is still checked."""
    try:
        return catalog(folder)
    except CatalogError as error:
        problems.add(node, "catalog", str(error))
        return catalog(None)
