"""Labels of quantities for people: `joint_damping@hot` is "joint damping, hot"; and what stands at an axis."""

from __future__ import annotations

import re
from functools import cache
from importlib import resources

from tvimdesign.base.units import pretty
from tvimdesign.base.yaml_data import plain_data

_CAPITALS = {"pcl": "PCL", "peltier": "Peltier", "peltiers": "Peltiers"}
_NAME = re.compile(r"\b[a-z][a-z0-9]*(?:_[a-z0-9]+)+(?:@\w+)?|\b[a-z_0-9]+@\w+|^[a-z]+(?= [<>]=)")


@cache
def _labels() -> dict[str, str]:
    """Return labels of quantities whose names do not read as words."""
    return dict(plain_data(resources.files(__package__).joinpath("labels.yaml").read_text(encoding="utf-8")))


def name_in_words(name: str) -> str:
    """Return a quantity's full name in words."""
    quantity, _, point = name.partition("@")
    words = " ".join(_CAPITALS.get(word, word) for word in quantity.split("_"))
    return f"{words}, {point.replace('_', ' ')}" if point else words


def label(name: str) -> str:
    """Return the label of a quantity: a few words for people; its name in words if it has none of its own."""
    quantity, _, point = name.partition("@")
    words = _labels().get(quantity)
    if words is None:
        return name_in_words(name)
    return f"{words}, {point.replace('_', ' ')}" if point else words


def in_labels(text: str) -> str:
    """Return a text with each name of a quantity replaced by its label."""
    return _NAME.sub(lambda match: label(match[0]), text)


def axis_label(name: str, unit: str) -> str:
    """Return what stands at an axis: the quantity in words, and its unit; a dash for a number without one."""
    words = name_in_words(name)
    shown = pretty(unit)
    return f"{words[0].upper()}{words[1:]} ({shown if shown and shown != '1' else '–'})"
