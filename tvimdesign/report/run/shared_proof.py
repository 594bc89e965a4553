"""Every combination of listed choices solved as cells: by jobs of an array, on a cluster, or where it was stopped."""

from __future__ import annotations

import json
from collections.abc import Iterator
from contextlib import ExitStack
from dataclasses import asdict, dataclass, replace
from functools import partial
from pathlib import Path

from tvimdesign.base.deadline import Deadline
from tvimdesign.base.errors import InputError, TvimError
from tvimdesign.report.output.progress import Progress, progress_output, wide_console
from tvimdesign.report.output.results_folder import PROGRESS, ResultsFolder
from tvimdesign.report.output.shared_folder import CellsAsked, gatherer, joined, say_part
from tvimdesign.solve.discrete.enumeration import BLOCK, Begin, Block, SolvedBlock, blocks_of, solved
from tvimdesign.solve.discrete.relaxation import Relaxation
from tvimdesign.solve.discrete.sent_trees import Asked, Begun
from tvimdesign.solve.nlp.plain_run import plain_run, run_of
from tvimdesign.solve.nlp.solution import SolverEffort
from tvimdesign.solve.search import Search, optimize
from tvimdesign.study import SolverOptions, Study
from tvimdesign.sweep.keys import key_of, said_of
from tvimdesign.sweep.run_sweep import SweepDone, Where, run_cells
from tvimdesign.sweep.shards import SHARDS
from tvimdesign.sweep.work import Cell, CellAnswer

_SOLVED = "solved"
_NOTHING = "the study lists no sizes whose combinations could be shared out"


@dataclass(frozen=True)
class ProofWork:
    """A search whose starts are done; a cell is set to the place of a tree and to the first combination of a block."""

    asked: Asked
    begun: tuple[Begun, ...]
    columns: tuple[str, ...] = ("solved",)
    """The designs of a block and what they took, as JSON."""
    numbers: tuple[bool, ...] = (True, True)

    def answers(self) -> ProofAnswers:
        """Builds the problems once."""
        trees = self.asked.built()
        for tree, begun in zip(trees, self.begun, strict=True):
            begun.take(tree)
        return ProofAnswers(trees)


@dataclass(frozen=True)
class ProofAnswers:
    """Solves blocks of combinations."""

    trees: list[Relaxation]

    def answer(self, cell: Cell) -> CellAnswer:
        """The designs of one block."""
        block = Block(*map(int, cell.texts))
        found = solved(self.trees[block.place], block)
        told = {
            "runs": [{"box": box, **plain_run(run)} for box, run in found.runs.items()],
            "work": asdict(found.work),
        }
        return CellAnswer(_SOLVED, "", None, None, (json.dumps(told),))


class OtherParts(Exception):  # noqa: N818 - how a job ends whose part is solved, no error
    """Ends the search of one job of an array once its part of the combinations is solved."""

    def __init__(self, done: SweepDone) -> None:
        """With what is done."""
        super().__init__("other jobs have parts of it")
        self.done = done


def proof_asked(begin: Begin) -> CellsAsked:
    """A cell for each block of combinations. What its starts came to follows from the study, which the key has."""
    study = _found_anywhere(begin.study)
    asked = Asked(study.model_dump_json(), begin.reference, list(begin.objectives), float("inf"))
    blocks = blocks_of(begin.trees)
    whole = [said_of(_without_limit(study)), begin.reference, list(begin.objectives), BLOCK]
    keys = [key_of([*whole, *block]) for block in blocks]
    texts = [tuple(map(str, block)) for block in blocks]
    return CellsAsked(ProofWork(asked, tuple(Begun.of(begin.trees))), keys, texts.__getitem__, "block")


def proved_in(folder: Path, where: Where, progress: Progress, deadline: Deadline | None = None) -> Search:
    """A search whose combinations are solved as cells that a folder keeps: all of them, whatever part others have.

    Its `deadline` is the study's time limit unless given. It raises TvimError where a block cannot be solved.
    """
    everything = replace(where, part=(1, 1))

    def enumerated(begin: Begin) -> Iterator[tuple[Block, SolvedBlock]]:
        asked = proof_asked(begin)
        with begin.trees[0].optimizer.deadline.paused():
            run_cells(asked.work, asked.keys, asked.texts, folder, everything, progress, asked.called)
        for block, kept in zip(blocks_of(begin.trees), asked.there(folder), strict=True):
            yield block, _solved(kept.answer, folder)

    return partial(optimize, enumerate_all=enumerated, deadline=deadline)


def prove_part(study: Study, folder: Path, where: Where, progress: Progress) -> SweepDone:
    """Search a study and solve this job's part of its combinations. Raises InputError, InfeasibleError, TvimError."""

    def enumerated(begin: Begin) -> Iterator[tuple[Block, SolvedBlock]]:
        asked = proof_asked(begin)
        raise OtherParts(run_cells(asked.work, asked.keys, asked.texts, folder, where, progress, asked.called))

    objectives = study.front.of if study.front else ()
    try:
        found = optimize(study, progress, objectives=objectives, enumerate_all=enumerated)
    except OtherParts as ended:
        return ended.done
    if found.out_of_time is not None:
        raise TvimError("the search ended at its `time_limit` before its combinations were solved one by one")
    raise InputError(f"--shard: {_NOTHING}")


def _solved(answer: CellAnswer, folder: Path) -> SolvedBlock:
    if answer.status != _SOLVED:
        raise TvimError(f"some combinations could not be solved: {answer.reason}; --overwrite begins again")
    try:
        told = json.loads(str(answer.values[0]))
        runs = {tuple((low, high) for low, high in run.pop("box")): run_of(run) for run in told["runs"]}
        return SolvedBlock(runs, SolverEffort(**told["work"]))
    except (ValueError, KeyError, TypeError) as error:
        raise TvimError(f"{folder}: what a shard holds is no block of combinations: {error}") from error


def _found_anywhere(study: Study) -> Study:
    """The study with the whole path of its catalogue: a worker may have begun in another folder."""
    folder = study.catalog_folder
    return study.model_copy(update={"catalog_folder": str(Path(folder).resolve())}) if folder else study


def _without_limit(study: Study) -> Study:
    """The study as if it had as much time as any: how long a search may take changes nothing of a combination."""
    usual = SolverOptions.model_fields["time_limit"].default
    return study.model_copy(update={"solver": study.solver.model_copy(update={"time_limit": usual})})


def claimed(
    stack: ExitStack, out: Path, study: Study, where: Where, *, overwrite: bool, resume: bool, as_json: bool
) -> ResultsFolder | None:
    """The folder of a run whose combinations are cells; none where another job of the array writes its answer.

    A job solves its part first, and says what it has done where it does not gather. Raises InputError, OutputError,
    InfeasibleError, TvimError.
    """
    if where.alone:
        return stack.enter_context(ResultsFolder(out, overwrite, resume, SHARDS, (PROGRESS,)))
    if study.task != "optimize":
        raise InputError(f"--shard: {_NOTHING}")
    with progress_output() as progress, joined(out, (PROGRESS,), overwrite=overwrite) as shared:
        done = prove_part(study, shared, where, progress)
    folder = gatherer(stack, out, (PROGRESS,)) if done.whole else None
    if folder is None:
        say_part(done, where, out, wide_console(), as_json=as_json)
    return folder
