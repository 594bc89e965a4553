"""Names and units of the table as words on figures: `joint_damping@hot` is "joint damping, hot"."""

from __future__ import annotations

from tvimdesign.base.units import pretty

_CAPITALS = {"pcl": "PCL", "peltier": "Peltier", "peltiers": "Peltiers"}


def name_in_words(name: str) -> str:
    """A quantity's full name in words."""
    quantity, _, point = name.partition("@")
    words = " ".join(_CAPITALS.get(word, word) for word in quantity.split("_"))
    return f"{words}, {point.replace('_', ' ')}" if point else words


def axis_label(name: str, unit: str) -> str:
    """What stands at an axis: the quantity in words, and its unit; a dash for a number without one."""
    words = name_in_words(name)
    shown = pretty(unit)
    return f"{words[0].upper()}{words[1:]} ({shown if shown and shown != '1' else '–'})"
