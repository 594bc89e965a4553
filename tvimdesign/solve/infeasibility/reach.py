"""Reach of a study's variables: whether its target impedances lie within it, asked before the search starts."""

from __future__ import annotations

from tvimdesign.base.deadline import Deadline
from tvimdesign.base.errors import InfeasibleError, InputError, TimeOverError
from tvimdesign.base.units import format_quantity
from tvimdesign.device import Table
from tvimdesign.solve.optimizer.optimizer import Optimizer
from tvimdesign.study import ProfileOptions, Study

_ENDS = {
    "soft": ("joint_impedance@hot", 1.0, "softening_band"),
    "stiff": ("joint_impedance@cold", -1.0, "stiffening_band"),
}
"""For each target: the impedance it is compared with, whether its least or largest value counts, and its band."""


def refuse_unreachable(study: Study, deadline: Deadline | None = None) -> None:
    """Raise InputError, with what would be reachable, for a stated target that no design within the ranges has."""
    if study.module.get("impedance_targets") != "stated":
        return
    for word, (row, sign, band) in _ENDS.items():
        reached = _extreme(study, row, sign, deadline)
        target, factor = (_given(study, study.table, name) for name in (f"{word}_impedance", band))
        limit = target * factor if sign > 0.0 else target / factor
        if reached is not None and sign * (reached - limit) > 0.0:
            end, most = ("softest", "least") if sign > 0.0 else ("stiffest", "largest")
            unit = study.table.unit(row)
            wanted, has, possible = (
                format_quantity(value, unit) for value in (target, reached, reached / factor**sign)
            )
            raise InputError(
                f"{word}_impedance {wanted} cannot be reached: the {end} joint within the ranges under `vary` and the "
                f"machine's rules has {has}; the {most} target is {possible}"
            )


def _extreme(study: Study, row: str, sign: float, deadline: Deadline | None) -> float | None:
    """Least or largest value of a row within the ranges and the machine's rules; None where none is found in time."""
    extreme = study.model_copy(
        update={
            "module": {**study.module, "impedance_targets": "operating_points"},
            "require": (),
            "minimize": {row: sign},
            "profile": ProfileOptions(),
        }
    )
    try:
        optimizer = Optimizer(extreme, deadline=deadline)
    except (InfeasibleError, TimeOverError):
        return None
    run = optimizer.solve()
    if not run.start.converged:
        return None
    return optimizer.model.values(run.inputs, optimizer.multistart.cycle)[row]


def _given(study: Study, table: Table, name: str) -> float:
    value = study.module.get(name, getattr(table.quantity(name), "default", None))
    assert isinstance(value, float | int)
    return float(value)
