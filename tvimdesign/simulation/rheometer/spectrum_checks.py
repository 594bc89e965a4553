"""What a virtual rheometer refuses: a spectrum that is none, times or temperatures that do not rise."""

from __future__ import annotations

import math
from collections.abc import Iterable
from itertools import pairwise

from tvimdesign.base.errors import InputError
from tvimdesign.physics.polymers.polymer import Modes


def check_spectrum(modes: Modes, place: str) -> None:
    """Raise InputError, naming the value and its place, where a spectrum is none."""
    if not modes:
        raise InputError(f"{place}: the spectrum has no modes; expected at least one (relaxation time, modulus)")
    for number, mode in enumerate(modes, start=1):
        for name, unit, value in zip(("relaxation time", "modulus"), ("s", "Pa"), mode, strict=True):
            if not (math.isfinite(value) and value > 0.0):
                raise InputError(
                    f"{place}: mode {number} has the {name} {value:g} {unit}; expected a number greater than zero"
                )


def check_rising(values: Iterable[float], place: str, unit: str) -> None:
    """Raise InputError, naming the value and its place, where numbers do not rise one after the other."""
    for number, (before, after) in enumerate(pairwise(values), start=2):
        if not after > before:
            raise InputError(
                f"{place}: value {number} is {after:g} {unit} and follows {before:g} {unit}; expected rising values"
            )
