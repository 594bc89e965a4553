"""The limits a design must keep: the study's requirements and the machine's own rules, in one list."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any, Literal

from tvimdesign.device import Event, Path, Table
from tvimdesign.study import Study
from tvimdesign.units import from_si, pretty, to_si


@dataclass(frozen=True)
class Limit:
    """One named limit on one output, SI."""

    output: str
    sense: Literal["<=", ">="]
    limit: float
    scale: float
    """What a residual of one means: the limit itself, or the row's unit where the limit is zero."""
    origin: str
    """`require` for the study's own, otherwise the reason the machine has it."""

    step: str = "1 %"
    """What a hundredth of the scale is, in words."""

    @property
    def name(self) -> str:
        """Output and sense, unique in a study."""
        return f"{self.output} {self.sense}"

    def residual(self, value: Any) -> Any:
        """How far a value is beyond the limit, as a share of the scale; kept where <= 0. Floats and symbols."""
        beyond = value - self.limit if self.sense == "<=" else self.limit - value
        return beyond / self.scale


def limits_of(study: Study, table: Table) -> list[Limit]:
    """Return the study's requirements, then the table's rules the study has not replaced by its own in that sense."""
    own = [
        make_limit(table, output, r.sense, r.limit, "require")
        for r in study.require
        for output in _behind(table, r.output, r.sense)
    ]
    taken = {(limit.output, limit.sense) for limit in own}
    for row in table.outputs:
        for rule in row.rules:
            if (row.name, rule.sense) not in taken:
                own.append(make_limit(table, row.name, rule.sense, rule.value, rule.reason))
    return own


def _behind(table: Table, name: str, sense: str) -> tuple[str, ...]:
    """The rows a limit is put on: the named one, or each of those it is the least of."""
    row = table.output(name)
    return row.least_of if row.least_of and sense == ">=" else (name,)


def on_switch(table: Table, output: str) -> bool:
    """Whether an output depends on how a switch runs."""
    above = (output.partition("@")[0], *table.ancestors(output))
    return any(isinstance(table.row(base), Event | Path) for base in above)


def is_constant(limit: Limit, table: Table, free: Iterable[str]) -> bool:
    """Whether nothing free can change the output a limit stands on."""
    return not on_switch(table, limit.output) and not set(free) & table.ancestors(limit.output)


def advice_of(table: Table) -> list[Limit]:
    """Return the limits that are reported where they are broken."""
    return [
        make_limit(table, row.name, rule.sense, rule.value, rule.reason) for row in table.outputs for rule in row.advice
    ]


def make_limit(table: Table, name: str, sense: Literal["<=", ">="], limit: float, origin: str) -> Limit:
    """Return a limit with its scale: its own size; for a zero its unit; for a temperature 100 K."""
    unit = table.unit(name)
    if unit == "degC":
        return Limit(name, sense, limit, 100.0, origin, "1 K")
    if limit != 0.0:
        return Limit(name, sense, limit, abs(limit), origin)
    return Limit(name, sense, limit, abs(to_si(1.0, unit)), origin, f"0.01 {pretty(unit)}".rstrip())


def in_words(limit: Limit, table: Table) -> str:
    """Write the limit as a reader would: `joint_stiffness@hot >= 5 N·m/rad`."""
    unit = table.unit(limit.output)
    return f"{limit.output} {limit.sense} {from_si(limit.limit, unit):.6g} {pretty(unit)}".rstrip()
