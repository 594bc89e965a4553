"""The problems that a search over listed choices goes through: one for each family of records, built once.

The problems of a search as plain data, from which another process builds the same ones and goes on with them.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from tvimdesign.base.deadline import Deadline
from tvimdesign.base.errors import InfeasibleError, InputError, SimulationError, TimeOverError
from tvimdesign.solve.discrete.combinations import ExactCombinations
from tvimdesign.solve.discrete.discrete_choices import Sizes
from tvimdesign.solve.discrete.record_families import Family, possible
from tvimdesign.solve.discrete.relaxation import Relaxation
from tvimdesign.solve.nlp.mixture import Mixture, with_records
from tvimdesign.solve.nlp.solution import SolverEffort
from tvimdesign.solve.nlp.solver_run import Progress
from tvimdesign.solve.optimizer.optimizer import Optimizer
from tvimdesign.study import Study

MAX_COMBINATIONS = 1_000_000
MAX_FAMILIES = 60
"""Families of records: each is searched on its own, from every start."""
MAX_MIXED = 100
"""Records that are mixed in one problem: each is one of its free numbers."""


@dataclass
class Trees:
    """Builds the problems of one search, all of whose objectives are over the same reference."""

    study: Study
    reference: dict[str, float] | None
    progress: Progress
    objectives: Sequence[str]
    deadline: Deadline
    sizes: Sizes

    def of(self, families: Sequence[Family]) -> list[Relaxation]:
        """Return the problem of each family, built once for all families that differ in numbers alone.

        Raises InfeasibleError where every family violates a limit that nothing free can cure, TimeOverError where the
        time is over before the first problem is built.
        """
        trees: list[Relaxation] = []
        refused: list[InfeasibleError] = []
        for whole in families:
            if trees and self.deadline.passed:
                break
            if refused:
                self.deadline.check("a family of records was found that no fixed limit excludes")
            try:
                family = possible(self.study, whole)
                optimizer = self._built(family, trees)
            except InfeasibleError as error:  # a limit that nothing free can mend, with these records
                refused.append(error)
                continue
            except TimeOverError:
                if trees:
                    break
                raise
            self.reference = optimizer.reference
            sizes = self.sizes.mixed(family.mixtures)
            trees.append(Relaxation(len(trees), optimizer, family.fixed, sizes, SolverEffort()))
        if not trees:
            raise refused[0]
        return trees

    def exact(self) -> ExactCombinations:
        """Return the problems of single combinations of records, over the reference of the families."""
        return ExactCombinations(self._optimizer, self.sizes)

    def _built(self, family: Family, trees: Sequence[Relaxation]) -> Optimizer:
        if not family.mixtures:
            study = with_records(self.study, family.records)
            alike = (relaxation.optimizer.with_records(study) for relaxation in trees if not relaxation.sizes.mixtures)
            built = next(filter(None, alike), None)
            return built or self._optimizer(family.records)
        error: SimulationError | None = None
        for first in _beginnings(family.mixtures):
            records = dict(family.records)
            for mixture in first:
                records |= mixture.records[0]
            try:
                return self._optimizer(records, first)
            except SimulationError as failed:  # the start has another module with other records
                error = error or failed
        assert error is not None
        raise error

    def _optimizer(self, records: Mapping[str, str], mixtures: Sequence[Mixture] = ()) -> Optimizer:
        study = with_records(self.study, records)
        return Optimizer(
            study, self.reference, self.progress, objectives=self.objectives, deadline=self.deadline, mixtures=mixtures
        )


def refuse_too_many(families: Sequence[Family], sizes: Sizes) -> None:
    """Raise InputError where there are more choices than a search can go through."""
    combinations = sizes.count * sum(family.count for family in families)
    if combinations > MAX_COMBINATIONS:
        raise InputError(
            f"vary: {combinations} combinations of listed choices; the limit is {MAX_COMBINATIONS}; "
            "narrow a list with from and to, take a longer step, or give a range in place of a list"
        )
    if len(families) > MAX_FAMILIES:
        raise InputError(
            f"vary: {len(families)} combinations of records and options that make modules of different structure; the "
            f"limit is {MAX_FAMILIES}, as each is searched on its own; choose among fewer"
        )
    mixed = max(sum(len(mixture.records) for mixture in family.mixtures) for family in families)
    if mixed > MAX_MIXED:
        raise InputError(
            f"vary: {mixed} records to choose from; the limit is {MAX_MIXED}; choose among fewer, or in two studies"
        )


def _beginnings(mixtures: Sequence[Mixture]) -> list[tuple[Mixture, ...]]:
    """Return the mixtures as they are, then with another record of one of them first."""
    beginnings = [tuple(mixtures)]
    for place, mixture in enumerate(mixtures):
        for first in range(1, len(mixture.records)):
            others = [i for i in range(len(mixture.records)) if i != first]
            beginnings.append((*mixtures[:place], mixture.in_order([first, *others]), *mixtures[place + 1 :]))
    return beginnings
