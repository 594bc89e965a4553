"""A run of the solver as plain data, to the last bit, so that it can be kept in a file."""

from __future__ import annotations

import base64
from collections.abc import Mapping
from dataclasses import asdict
from typing import Any

import numpy as np

from tvimdesign.simulation.working_cycle.current_profile import CurrentProfile
from tvimdesign.solve.nlp.solution import Start
from tvimdesign.solve.nlp.solver_run import Array, Run

_ARRAYS = ("inputs", "unknowns", "multipliers", "bound_multipliers", "parameter_multipliers")


def plain_run(run: Run) -> dict[str, Any]:
    """What JSON can hold of a run: all of it. Arrays are 64-bit numbers in base 64."""
    return {
        "start": asdict(run.start),
        "current_profiles": {phase: profile.plain() for phase, profile in run.current_profiles.items()},
        "ends": run.ends,
        "within": {name: list(ends) for name, ends in run.within.items()},
        **{name: _text(getattr(run, name)) for name in _ARRAYS},
    }


def run_of(plain: Mapping[str, Any]) -> Run:
    """The run that `plain_run` describes."""
    return Run(
        start=Start(**plain["start"]),
        current_profiles={
            phase: CurrentProfile.from_plain(profile) for phase, profile in plain["current_profiles"].items()
        },
        ends=plain["ends"],
        within={name: (low, high) for name, (low, high) in plain["within"].items()},
        **{name: _array(plain[name]) for name in _ARRAYS},
    )


def _text(numbers: Array) -> str:
    return base64.b64encode(np.ascontiguousarray(numbers, dtype="<f8").tobytes()).decode()


def _array(text: str) -> Array:
    return np.frombuffer(base64.b64decode(text), dtype="<f8").copy()
