"""Readers of the study file's sections, one file a section or kind of value."""

from typing import Any

from tvimdesign.device import MODES
from tvimdesign.study.sections.goals import ACCEPT, FRONT, MINIMIZE, REQUIRE
from tvimdesign.study.sections.section import Schema, Section
from tvimdesign.study.sections.settings import AS_DRAWN, CONTROL, CURRENTS, DUTY, MODULE, POINTS, PROFILE, SOLVER, WRITE
from tvimdesign.study.sections.sweeps import SWEEP
from tvimdesign.study.sections.task import TASK
from tvimdesign.study.sections.tolerances import ROBUST, TOLERANCES
from tvimdesign.study.sections.vary import VARY
from tvimdesign.study.study import FORMAT, Study
from tvimdesign.study.text.values import Reading, misfit, whole
from tvimdesign.study.text.yaml_text import Node, Text

_LONGEST = {"name": 200, "description": 10_000}
_TEXT: Schema = {"type": ["string", "number", "null"]}


def _read_format(reading: Reading, node: Node | None) -> None:
    if node is not None and (version := whole(reading.problems, node, "tvimdesign")) != FORMAT:
        message = f"this version of tvimdesign does not read format {version}"
        reading.problems.add(node, "tvimdesign", message, str(FORMAT))


def _words(name: str, meaning: str) -> Section:
    def read(reading: Reading, node: Node | None) -> str:
        if node is None or (isinstance(node, Text) and node.empty):
            return ""
        if not isinstance(node, Text):
            misfit(reading.problems, node, name, "a text")
        if len(node.value) > _LONGEST[name]:
            message = f"{len(node.value)} characters, the limit is {_LONGEST[name]}"
            reading.problems.add(node, name, message, "a shorter text")
        return node.value.strip()

    return Section(name, meaning, read, _TEXT, lambda study: getattr(study, name), needs_mode=False)


def _read_before(reading: Reading, node: Node | None) -> None:
    """Read nothing: the reader of studies takes mode and catalogue first, as the other sections depend on them."""


SECTIONS = (
    Section("tvimdesign", "format of the file", _read_format, {"const": FORMAT}, needs_mode=False),
    _words("name", "name of the study"),
    _words("description", "purpose of the study"),
    Section("mode", "how the polymer is loaded", _read_before, {"enum": list(MODES)}, lambda study: study.mode),
    Section(
        "catalog", "folder of your own records, relative to this file",
        _read_before, _TEXT, lambda study: study.catalog_folder,
    ),
    MODULE, AS_DRAWN, TASK, DUTY, CONTROL, VARY, REQUIRE, ACCEPT, MINIMIZE, FRONT, POINTS, PROFILE, CURRENTS,
    TOLERANCES, ROBUST, SOLVER, SWEEP, WRITE,
)  # fmt: skip
NAMES = tuple(section.name for section in SECTIONS)


def written(study: Study) -> dict[str, Any]:
    """Return a study's sections as Python values; every quantity has the digits it takes to read the same number."""
    values = {section.name: section.write(study) for section in SECTIONS if section.write}
    return {name: value for name, value in values.items() if value not in (None, "", {}, [])}
