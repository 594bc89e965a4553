"""Whether the ratings of a Peltier module's data sheet agree with one another."""

from __future__ import annotations

from tvimdesign.base.record import Record
from tvimdesign.physics.heat_flow import peltier

ALIKE = 0.1
"""Share by which ratings of a Peltier module may differ from what the others make of them: makers round that far."""
_RATED = ("seebeck", "resistance", "conductance", "hot_side_temperature", "max_cooling_power")


def contradiction(record: Record) -> str:
    """What is wrong with a Peltier module's cooling power; nothing where it agrees or where the record has none."""
    if not set(_RATED) <= record.entries.keys():
        return ""
    *parameters, hot, stated = (record.value(name) for name in _RATED)
    computed = float(peltier.max_cooling_power(peltier.PeltierModule(*parameters), hot))
    if abs(computed / stated - 1.0) <= ALIKE:
        return ""
    return (
        f"{record.title}: Seebeck coefficient and resistance make a largest cooling power of {computed:.3g} W, the "
        f"sheet says {stated:.3g} W; its cooling may be off by as much. Measure one, or take the lower."
    )
