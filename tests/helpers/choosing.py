"""A study with short lists, and its combinations solved one by one without the search that is tested."""

import itertools
import math

from support import sample_text

from tvimdesign.device import Input
from tvimdesign.solve.nlp.mixture import discrete_records, with_records
from tvimdesign.solve.optimizer.optimizer import Optimizer
from tvimdesign.study import Options, Study, read_study_text

LISTED = sample_text("listed_choices")


def listed(text: str = LISTED) -> Study:
    """Return the study of a text."""
    return read_study_text(text, "a test")


def by_brute_force(study: Study, reference: dict[str, float], starts: int) -> dict[tuple[float, ...], float]:
    """Objective of every combination of sizes that has a design, each solved alone and cold.

    The best of some starts, the study's own and random ones. Sizes come in the study's order; objectives are over
    `reference`.
    """
    lists = {
        name: vary.values
        for name, vary in study.vary.items()
        if isinstance(vary, Options) and isinstance(study.table.quantity(name), Input)
    }
    single_start = study.model_copy(update={"solver": study.solver.model_copy(update={"starts": starts})})
    optimizer = Optimizer(single_start, reference)
    begins = list(optimizer.multistart.points())
    objectives: dict[tuple[float, ...], float] = {}
    for combination in itertools.product(*lists.values()):
        sizes = [float(value) for value in combination]
        within = {name: (size, size) for name, size in zip(lists, sizes, strict=True)}
        for begin in begins:
            place = begin.copy()
            for name, size in zip(lists, sizes, strict=True):
                place[optimizer.model.index[name]] = size
            run = optimizer.solve(within, begin=place)
            if run.start.converged:
                objectives[tuple(sizes)] = min(run.start.objective, objectives.get(tuple(sizes), math.inf))
    return objectives


def with_each_record(study: Study, reference: dict[str, float], starts: int) -> dict[tuple[str | float, ...], float]:
    """Return the same for every combination of records and sizes; records come first, in the study's order."""
    objectives: dict[tuple[str | float, ...], float] = {}
    for records in discrete_records(study, study.table):
        alone = by_brute_force(with_records(study, records), reference, starts)
        objectives |= {(*records.values(), *sizes): objective for sizes, objective in alone.items()}
    return objectives
