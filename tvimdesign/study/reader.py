"""From a study file to a `Study`: reads every section, collects every problem, and raises them all at once."""

from __future__ import annotations

import os
from collections.abc import Callable
from dataclasses import dataclass, field
from difflib import get_close_matches
from pathlib import Path
from typing import Any, TypeVar

from pydantic import BaseModel, ValidationError

from tvimdesign.base.errors import CatalogError, InputError
from tvimdesign.catalog import Catalog
from tvimdesign.device import MODES, Table, table_for
from tvimdesign.study.sections.accept import read_accept
from tvimdesign.study.sections.currents import read_currents
from tvimdesign.study.sections.goals import read_front, read_minimize, read_require
from tvimdesign.study.sections.settings import read_module, read_points
from tvimdesign.study.sections.sweep_block import SweepBlock
from tvimdesign.study.sections.sweeps import read_sweep
from tvimdesign.study.sections.tolerances import read_robust, read_tolerances
from tvimdesign.study.sections.vary import check_against_module, read_vary, with_start
from tvimdesign.study.study import FORMAT, ProfileOptions, Range, SolverOptions, Study, Vary, WriteOptions, unit_of
from tvimdesign.study.text.mistakes import Mistakes, one_of, quoted, step
from tvimdesign.study.text.named_file import is_folder
from tvimdesign.study.text.values import Reading, entries, flag, in_unit, misfit, number, text, unknown_keys, whole
from tvimdesign.study.text.yaml_text import Mapping, Node, Text
from tvimdesign.study.tree import SECTIONS, StudyTree, tree_of_file, tree_of_text

LONGEST_TEXT = 10_000
TableOf = Callable[[str], Table]
CatalogOf = Callable[[Path | None], Catalog]
_Options = TypeVar("_Options", bound=BaseModel)


def read_study(path: str | os.PathLike[str], table: TableOf = table_for, catalog: CatalogOf = Catalog) -> Study:
    """Read a study file.

    `table` gives the table of a mode and `catalog` the catalogue with a folder of the user's records. Raises StudyError
    with every problem found, and InputError where there is no such file or it cannot be opened.
    """
    return read_tree(tree_of_file(path), table, catalog)


def read_tree(tree: StudyTree, table: TableOf = table_for, catalog: CatalogOf = Catalog) -> Study:
    """Read a study from its tree; raises StudyError with every problem found."""
    return _Reader(Mistakes(tree.file, list(tree.problems)), tree.name, tree.folder, table, catalog, tree.root).read()


def read_swept(tree: StudyTree) -> tuple[Study, SweepBlock | None]:
    """Read a study and what it asks to be swept, None where nothing is; raises StudyError with every problem found."""
    reader = _Reader(Mistakes(tree.file, list(tree.problems)), tree.name, tree.folder, table_for, Catalog, tree.root)
    return reader.read(), reader.sweep


def read_study_text(
    source: str, name: str = "study", folder: Path = Path(), table: TableOf = table_for, catalog: CatalogOf = Catalog
) -> Study:
    """Read a study from its text; `name` stands for the file in messages, `folder` is where its catalogue is."""
    return read_tree(tree_of_text(source, name, name, folder), table, catalog)


@dataclass
class _Reader:
    """Reads one study; each method takes one section."""

    problems: Mistakes
    name: str
    folder: Path
    table: TableOf
    catalog: CatalogOf
    root: Mapping
    sections: dict[str, Node] = field(default_factory=dict)
    sweep: SweepBlock | None = None
    """What is swept, which is no part of the study that each cell is."""

    def read(self) -> Study:
        """Read all sections and return the study; raises StudyError with every problem."""
        found = entries(self.problems, self.root, "", "")
        self.sections = unknown_keys(self.problems, found, "", "section", list(SECTIONS))
        plain = self._plain()
        folder, mode = self._catalog_folder(), self._mode()
        reading = Reading(self.problems, mode, self.table(mode), self._records(folder)) if mode else None
        parts = self._parts(reading) if reading else {}
        self.problems.stop()
        assert reading is not None
        study = Study(**plain, **parts, catalog_folder=folder.as_posix() if folder else None)
        return study.based_on(reading.catalog, reading.table)

    def _plain(self) -> dict[str, Any]:
        """The sections that need no table."""
        self._format()
        return {
            "name": self._words("name", 200) or self.name,
            "description": self._words("description", LONGEST_TEXT),
            "profile": self._options("profile", ProfileOptions),
            "solver": self._options("solver", SolverOptions),
            "write": self._options("write", WriteOptions),
        }

    def _records(self, folder: Path | None) -> Catalog:
        """The catalogue; without the user's folder where that cannot be used, so that the rest is still checked."""
        try:
            return self.catalog(folder)
        except CatalogError as error:
            self.problems.add(self.sections.get("catalog", self.root), "catalog", str(error))
            return self.catalog(None)

    def _parts(self, reading: Reading) -> dict[str, Any]:
        get = self.sections.get
        points = read_points(reading, get("operating_points"))
        module = read_module(reading, get("module"))
        vary = read_vary(reading, get("vary"))
        check_against_module(reading, vary, module, get("module"))
        require = read_require(reading, get("require"), points)
        minimize = read_minimize(reading, get("minimize"), points)
        front = read_front(reading, get("front"), points)
        self._both_or_neither()
        self._profile_has_a_range(reading.table, vary)
        currents = read_currents(reading, get("currents"), searched=_says_something(get("vary")))
        tolerances = read_tolerances(reading, get("tolerances"), points)
        self.sweep = read_sweep(reading, get("sweep"), points)
        return {
            "mode": reading.mode,
            "module": module,
            "vary": with_start(vary, module),
            "require": require,
            "accept": read_accept(reading, get("accept")),
            "minimize": minimize,
            "front": front,
            "operating_points": points,
            "currents": currents,
            "tolerances": tolerances,
            "robust": read_robust(reading, get("robust"), tolerances, searched=_says_something(get("vary"))),
        }

    def _both_or_neither(self) -> None:
        vary, minimize = (self.sections.get(key) for key in ("vary", "minimize"))
        front = self.sections.get("front")
        if _says_something(front) and not _says_something(vary):
            assert front is not None
            self.problems.add(front, "front", "nothing may change: `vary` is missing", "`vary` and `minimize` with it")
        if _says_something(minimize) and not _says_something(vary):
            assert minimize is not None
            self.problems.add(minimize, "minimize", "nothing may change: `vary` is missing", "both or neither")
        elif _says_something(vary) and not _says_something(minimize):
            assert vary is not None
            self.problems.add(vary, "vary", "there is nothing to improve: `minimize` is missing", "both or neither")

    def _profile_has_a_range(self, table: Table, vary: dict[str, Vary]) -> None:
        """A current may only follow a profile between the ends of a range."""
        section = self.sections.get("profile")
        for phase, (_, node) in entries(Mistakes(self.name), section, "profile", "").items():
            if phase not in ProfileOptions.model_fields:
                continue  # told already
            row = table.phase(phase).current_input
            asked = self.sections.get("vary")
            if row not in vary and isinstance(asked, Mapping) and row in asked.entries:
                continue  # what is wrong with that range has been told
            if not isinstance(vary.get(row), Range) and not (isinstance(node, Text) and node.value.strip() == "0"):
                found = f"the current of this phase has no range: `vary.{row}` is missing"
                self.problems.add(node, step("profile", phase), found, f"{row}: [0.1 A, 3 A] under `vary`, for one")

    def _format(self) -> None:
        node = self.sections.get("tvimdesign")
        version = None if node is None else whole(self.problems, node, "tvimdesign")
        if node is not None and version is not None and version != FORMAT:
            found = f"this version of tvimdesign does not read format {version}"
            self.problems.add(node, "tvimdesign", found, str(FORMAT))

    def _mode(self) -> str | None:
        """The mode; where it is misspelt the one that must be meant, so that other mistakes are told now too."""
        node = self.sections.get("mode")
        expected = one_of(list(MODES))
        if node is None:
            self.problems.add(self.root, "mode", "missing", expected, f"write 'mode: {MODES[0]}'")
            return None
        word = text(self.problems, node, "mode", expected)
        if word is None:
            return None
        try:
            self.table(word)
        except InputError:
            self.problems.unknown(node, "mode", f"mode: {quoted(word)}", word, MODES)
            meant = get_close_matches(word.lower(), MODES, n=1)
            return meant[0] if meant else None
        return word

    def _catalog_folder(self) -> Path | None:
        node = self.sections.get("catalog")
        if node is None or (isinstance(node, Text) and node.empty):
            return None
        word = text(self.problems, node, "catalog", "a folder of records, relative to the study")
        if word is None:
            return None
        folder = self.folder / word
        if not is_folder(folder):
            found = f"there is no folder {quoted(word)} beside the study"
            self.problems.add(node, "catalog", found, "a folder of records")
            return None
        return folder

    def _words(self, key: str, most: int) -> str:
        node = self.sections.get(key)
        if node is None or (isinstance(node, Text) and node.empty):
            return ""
        if not isinstance(node, Text):
            misfit(self.problems, node, key, "a text")
        elif len(node.value) > most:
            self.problems.add(node, key, f"{len(node.value)} characters, the limit is {most}", "a shorter text")
        return node.value.strip() if isinstance(node, Text) else ""

    def _options(self, key: str, model: type[_Options]) -> _Options:
        fields = model.model_fields
        found = entries(self.problems, self.sections.get(key), key, f"settings: {', '.join(fields)}")
        known = unknown_keys(self.problems, found, key, "setting", list(fields))
        readers: dict[Any, Callable[[Mistakes, Node, str], Any]] = {int: whole, float: number, bool: flag}
        read = {}
        for name, node in known.items():
            unit = unit_of(fields[name])
            expected = f"a quantity in {unit}"
            read[name] = (
                in_unit(self.problems, node, step(key, name), unit, expected)
                if unit
                else readers[fields[name].annotation](self.problems, node, step(key, name))
            )
        try:
            return model(**{name: value for name, value in read.items() if value is not None})
        except ValidationError as error:
            for fault in error.errors():
                name = str(fault["loc"][0])
                message = fault["msg"].replace("Input should be", f"{fault['input']:g} should be")
                hint = f"{name} means: {fields[name].description}"
                self.problems.add(known[name], step(key, name), message, hint=hint)
            return model()


def _says_something(node: Node | None) -> bool:
    return (
        node is not None
        and not (isinstance(node, Text) and node.empty)
        and not (isinstance(node, Mapping) and not node.entries)
    )
