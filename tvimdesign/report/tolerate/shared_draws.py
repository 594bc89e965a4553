"""Modules drawn by the jobs of an array, on a cluster, or where an analysis was stopped: thousands of them a cell."""

from __future__ import annotations

import base64
from collections import OrderedDict
from collections.abc import Sequence
from contextlib import ExitStack
from dataclasses import astuple, dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tvimdesign.base.errors import TvimError
from tvimdesign.report.output.progress import Progress
from tvimdesign.report.output.results_folder import ResultsFolder
from tvimdesign.report.output.shared_folder import CellsAsked, answered_cells
from tvimdesign.simulation.working_cycle.resolved_module import ResolvedModule
from tvimdesign.solve.batch.batch_model import BatchModel
from tvimdesign.solve.nlp.spread import drawn_values
from tvimdesign.solve.uncertainty.tolerance import Draw, Drawn, Tolerancing, columns_of
from tvimdesign.sweep.keys import key_of, said_of
from tvimdesign.sweep.run_sweep import SweepDone, Where
from tvimdesign.sweep.work import Cell, CellAnswer

Array = NDArray[np.float64]
BLOCK = 1 << 13
"""Modules of a cell: tenths of a second with a whole cycle, and some 100 kB."""
_DRAWN = "drawn"
_MOST_KEPT = 3
"""Draws whose compiled functions are kept."""


@dataclass(frozen=True)
class Module:
    """A module whose tolerances are analysed, and what spreads in it."""

    resolved: ResolvedModule
    names: tuple[str, ...]


@dataclass(frozen=True)
class DrawWork:
    """Draws of modules; a cell is set to the number of one, and to the first module of a block."""

    draws: tuple[tuple[Module, Draw], ...]
    samples: int
    seed: int
    columns: tuple[str, ...] = ("values",)
    """The outputs of a block, a row an output, as 64-bit numbers in base 64."""
    numbers: tuple[bool, ...] = (False, True)

    def answers(self) -> DrawAnswers:
        """Compiles each draw's functions once."""
        return DrawAnswers(self)


class DrawAnswers:
    """Computes blocks of modules."""

    def __init__(self, work: DrawWork) -> None:
        """Nothing is compiled yet."""
        self._work = work
        self._compiled: OrderedDict[int, BatchModel] = OrderedDict()

    def answer(self, cell: Cell) -> CellAnswer:
        """The outputs of one block."""
        number, first = (int(text) for text in cell.texts)
        module, draw = self._work.draws[number]
        columns = columns_of(module.resolved, module.names, self._model(number), draw, 1)
        count = min(BLOCK, self._work.samples - first)
        values = drawn_values(columns, draw.contributors, count, self._work.seed, first)
        text = base64.b64encode(np.ascontiguousarray(values, dtype="<f8").tobytes()).decode()
        return CellAnswer(_DRAWN, "", None, None, (text,))

    def _model(self, number: int) -> BatchModel:
        if number not in self._compiled:
            module, draw = self._work.draws[number]
            self._compiled[number] = BatchModel(module.resolved, module.names, list(draw.outputs))
            if len(self._compiled) > _MOST_KEPT:
                self._compiled.popitem(last=False)
        return self._compiled[number]


def blocks_asked(analyses: Sequence[Tolerancing], samples: int, seed: int) -> CellsAsked:
    """A cell for each block of everything that the analyses draw."""
    draws = [(Module(one.resolved, tuple(one.names)), draw) for one in analyses for draw in _draws_of(one)]
    work = DrawWork(tuple(draws), samples, seed)
    blocks = [(number, first) for number in range(len(draws)) for first in range(0, samples, BLOCK)]
    said = [_said(module, draw) for module, draw in draws]
    keys = [key_of([said[number], samples, seed, first]) for number, first in blocks]
    return CellsAsked(work, keys, lambda cell: tuple(map(str, blocks[cell])), "block")


def drawn_elsewhere(
    stack: ExitStack, out: Path, analyses: Sequence[Tolerancing], samples: int, where: Where, progress: Progress, *,
    overwrite: bool, resume: bool,
) -> tuple[ResultsFolder | None, SweepDone, list[Drawn]]:  # fmt: skip
    """Draw all modules of the analyses; returns the folder, none where another job gathers, and what each has drawn.

    Raises TvimError where a block cannot be computed.
    """
    asked = blocks_asked(analyses, samples, analyses[0].resolved.study.solver.seed)
    folder, done = answered_cells(stack, out, asked, where, progress, overwrite=overwrite, resume=resume)
    if folder is None:
        return None, done, []
    found, blocks = [], asked.there(folder.path)
    for analysis in analyses:
        drawn = {}
        for draw in _draws_of(analysis):
            parts = [_values(next(blocks).answer, len(draw.outputs)) for _ in range(0, samples, BLOCK)]
            drawn[draw] = np.concatenate(parts, axis=1)
        found.append(drawn.__getitem__)
    return folder, done, found


def _draws_of(analysis: Tolerancing) -> list[Draw]:
    """What an analysis draws, each once."""
    return list(dict.fromkeys([analysis.whole, *(analysis.on_preload or ())]))


def _values(answer: CellAnswer, outputs: int) -> Array:
    if answer.status != _DRAWN:
        raise TvimError(f"a block of modules could not be computed: {answer.reason}; --overwrite begins again")
    return np.frombuffer(base64.b64decode(str(answer.values[0])), dtype="<f8").reshape(outputs, -1)


def _said(module: Module, draw: Draw) -> dict[str, Any]:
    """What makes one draw another."""
    values = {name: getattr(value, "name", value) for name, value in module.resolved.values.items()}
    profiles = {phase: repr(profile) for phase, profile in module.resolved.current_profiles.items()}
    return {
        "study": said_of(module.resolved.study), "values": values, "profiles": profiles, "names": module.names,
        "contributors": [astuple(one) for one in draw.contributors], "outputs": draw.outputs,
    }  # fmt: skip
