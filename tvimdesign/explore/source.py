"""Sources of an explorer: a study file, a result with its design and front, a sweep with its cells, or an atlas."""

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from tvimdesign.base.errors import InputError
from tvimdesign.explore.messages import Way
from tvimdesign.explore.state import State, beginning, refuse_other_folders, sized_state
from tvimdesign.report.run.front_report import points_shown
from tvimdesign.report.sweep.atlas_page import STUDIES, SUMMARY, module_points
from tvimdesign.report.sweep.sweep_figures import shown_cells
from tvimdesign.solve.nlp.solver_run import OPTIMAL
from tvimdesign.study import Design, Study, StudyTree, read_design, read_tree, tree_of_file, tree_of_values, tree_yaml
from tvimdesign.study.sections import written
from tvimdesign.sweep.swept_cells import SweptCells, is_sweep, open_cells


@dataclass(frozen=True)
class Source:
    """A study, where to begin in it, and the front of the result or the cells of the sweep it is from."""

    tree: StudyTree
    study: Study
    chosen: Mapping[str, Any] = field(default_factory=dict)  # Choices of a design found for it, by name
    folder: Path | None = None  # Of the result
    front: Mapping[str, Any] | None = None  # As in its results.json
    cells: SweptCells | None = None  # Of the sweep
    modules: Sequence[Mapping[str, Any]] = ()  # Rows of the atlas that have one

    @property
    def text(self) -> bytes:
        """Text that identifies the study."""
        return tree_yaml(self.tree).encode()

    @property
    def first(self) -> State:
        """First state of an explorer."""
        if self.cells and self.cells.best:
            return _state_of(self.cells, self.cells.best[0])
        way = "optimize" if self.study.vary else "evaluate"
        return State(way=way, at=beginning(self.study, self.chosen))

    def points_shown(self) -> dict[str, Any] | None:
        """Return the points of the front or the cells of the sweep in the table's units; None for a study."""
        if self.cells:
            return shown_cells(self.cells)
        if self.modules:
            return module_points(self.modules)
        if self.front is None or not self.front["points"]:
            return None
        return points_shown(self.front, self.study.table)

    def at_point(self, number: int, state: State) -> State:
        """Return the state that shows a point of the front or a cell. Raises InputError if there is none."""
        if self.cells:
            return _state_of(self.cells, number)
        if self.modules and self.folder:
            return _of_atlas(self.tree, self.folder, self.modules, number)
        point = next((point for point in (self.front or {"points": []})["points"] if point["number"] == number), None)
        if point is None or self.folder is None:
            raise InputError(f"point {number}: the front has none of this number")
        path = (self.folder / point["design"]).resolve()
        if not path.is_relative_to(self.folder.resolve()):
            raise InputError(f"point {number}: its design lies outside {self.folder}")
        at = beginning(self.study, _of_design(read_design(path)))
        return state.model_copy(update={"way": "evaluate", "at": at})


def open_source(path: Path, settings: Sequence[str] = ()) -> Source:
    """Open a study file, the folder or design.json of a result, or the folder of a sweep or an atlas.

    Raises InputError.
    """
    if is_sweep(path):
        return _sweep(path, settings)
    if (path / SUMMARY).is_file():
        return _atlas(path, settings)
    design = path / "design.json" if path.is_dir() else path
    if design.suffix == ".json":
        return _result(read_design(design), design)
    tree = tree_of_file(path, settings)
    study = read_tree(tree)
    refuse_other_folders(tree, study)
    return Source(tree, study)


def _result(design: Design, path: Path) -> Source:
    request = Study.model_validate(design.study)
    tree = tree_of_values(written(request), f"The study of {path}", Path())
    study = read_tree(tree)
    refuse_other_folders(tree, study)
    return Source(tree, study, _of_design(design), path.parent, _front_of(path.parent))


def _sweep(folder: Path, settings: Sequence[str]) -> Source:
    if settings:
        raise InputError(f"--set: the cells of {folder} are of its study as it was swept; open the study file instead")
    cells = open_cells(folder)
    refuse_other_folders(cells.plan.tree, cells.plan.study)
    return Source(cells.plan.tree, cells.plan.study, cells=cells)


def _state_of(cells: SweptCells, number: int) -> State:
    """Return the state that shows a cell, evaluated; a cell without an answer is computed again."""
    cell = cells.cell(number)
    way: Way = "evaluate" if cell.answered or not cell.study.vary else "optimize"
    return State(way=way, changes=cell.changes, at={**beginning(cell.study), **cell.at})


def _atlas(folder: Path, settings: Sequence[str]) -> Source:
    """Open an atlas at its first module."""
    try:
        rows = json.loads((folder / SUMMARY).read_bytes())["rows"]
        modules = [row for row in rows if row["status"] == OPTIMAL]
        tree = tree_of_file(_study_of(folder, modules[0]), settings)
    except (OSError, ValueError, LookupError, TypeError) as error:
        raise InputError(f"{folder / SUMMARY}: no modules of `tvimdesign atlas` can be read: {error!r}") from error
    return Source(tree, read_tree(tree), folder=folder, modules=modules)


def _study_of(folder: Path, row: Mapping[str, Any]) -> Path:
    return folder / STUDIES / f"{row['kind']}-{row['torque [N*m]']:g}Nm-{row['cycle [s]']:g}s.yaml"


def _of_atlas(base: StudyTree, folder: Path, modules: Sequence[Mapping[str, Any]], number: int) -> State:
    """Return the state that shows a module of an atlas, evaluated. Raises InputError if it cannot be shown."""
    if not 1 <= number <= len(modules):
        raise InputError(f"module {number}: the atlas has the modules 1 to {len(modules)}")
    path = _study_of(folder, modules[number - 1])
    tree = tree_of_file(path)
    if read_tree(tree).mode != read_tree(base).mode:
        raise InputError(f"module {number}: it is of another mode; explore {path}")
    return sized_state(base, tree_yaml(tree)).model_copy(update={"way": "evaluate"})


def _of_design(design: Design) -> dict[str, Any]:
    return {**design.values, **design.choices}


def _front_of(folder: Path) -> dict[str, Any] | None:
    """Return the front of a result; None if it has none, or its results.json is another program's."""
    try:
        front = json.loads((folder / "results.json").read_bytes()).get("front")
    except (OSError, ValueError, AttributeError):
        return None
    return front if isinstance(front, dict) and isinstance(front.get("points"), list) else None
