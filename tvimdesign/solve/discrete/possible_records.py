"""Records that break a limit whatever else is chosen, left out before anything is solved: arithmetic alone says so."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from tvimdesign.base.errors import InfeasibleError
from tvimdesign.device import Input
from tvimdesign.solve.discrete.record_families import Family
from tvimdesign.solve.nlp.constraints import ALGEBRAIC_TOLERANCE, Constraint, constraints_of, on_cycle, unchangeable
from tvimdesign.solve.nlp.mixture import MixedDevice, Mixture
from tvimdesign.solve.optimizer.record_choices import with_records
from tvimdesign.study import Study, given


def possible(study: Study, family: Family) -> Family:
    """Return the family without the records that violate a limit which nothing else can change.

    Raises InfeasibleError, with what such a limit wants, where a mixture has no record left.
    """
    if not family.mixtures:
        return family
    chosen = with_records(study, family.records)
    known = (study.table, given(chosen), tuple(study.operating_points), study.solver.cells)
    model = MixedDevice(*known, family.mixtures)
    limits = constraints_of(chosen, study.table, model.words)
    records, mixtures = dict(family.records), []
    for mixture in family.mixtures:
        left = _left(chosen, model, mixture, _of_it_alone(study, model, limits, mixture))
        records |= left.records[0]
        mixtures += [left] if len(left.records) > 1 else []
    return Family(records, tuple(mixtures))


def _of_it_alone(
    study: Study, model: MixedDevice, limits: Sequence[Constraint], mixture: Mixture
) -> list[Constraint]:  # fmt: skip
    """Return the limits that depend on a mixture's records and on nothing else that is free."""
    without_cycle = [limit for limit in limits if not on_cycle(study.table, limit.output)]
    outputs = list(dict.fromkeys(limit.output for limit in without_cycle))
    free = {name for name in study.vary if isinstance(study.table.quantity(name), Input)}
    free |= {name for other in model.mixtures if other is not mixture for name in other.shares}
    rows, columns = model.outputs(outputs).jac_sparsity(0, 0).get_triplet()
    names = [model.names[column] for column in columns]
    moved = {outputs[row] for row, name in zip(rows, names, strict=True) if name in free}
    own = {outputs[row] for row, name in zip(rows, names, strict=True) if name in mixture.shares}
    return [limit for limit in without_cycle if limit.output in own - moved]


def _left(study: Study, model: MixedDevice, mixture: Mixture, limits: Sequence[Constraint]) -> Mixture:
    """Return the records that satisfy the limits."""
    outputs = list(dict.fromkeys(limit.output for limit in limits))
    cycle = dict.fromkeys(model.switch_names, np.inf)
    places, messages = [], []
    for place in range(len(mixture.records)):
        inputs = model.start.copy()
        for other, name in enumerate(mixture.shares):
            inputs[model.index[name]] = float(other == place)
        values = model.some_values(outputs, inputs, cycle)
        broken = [limit for limit in limits if not limit.residual(values[limit.output]) <= ALGEBRAIC_TOLERANCE]
        messages += [unchangeable(limit, model.table, values[limit.output], study) for limit in broken]
        places += [] if broken else [place]
    if not places:
        raise InfeasibleError("\n  ".join(dict.fromkeys(messages)))
    return mixture.in_order(places)
