"""Evaluate frozen designs: every input, choice and output of a study's module, with all else that is simulated."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterator, Mapping
from contextlib import suppress
from dataclasses import fields, is_dataclass
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np

import tvimdesign
from oracle.compare import Renames, Value
from oracle.frozen_files import FOLDER, read_frozen
from tvimdesign.base.units import si_unit
from tvimdesign.device import table_for
from tvimdesign.simulation.working_cycle.device_functions import resolve_design

CODE = Path(tvimdesign.__file__).parents[1]
"""The tree under test: its studies are read, whichever tree this script is in."""


def study_files() -> dict[str, Path]:
    """Return the files of all studies by name: the shipped ones, and those of the tests."""
    files = (path for folder in ("studies", "tests/studies") for path in (CODE / folder).glob("*.yaml"))
    return {path.stem: path for path in sorted(files, key=lambda path: path.stem)}


def load_study(name: str) -> tvimdesign.Study:
    """Read a study by name."""
    return tvimdesign.load(study_files()[name])


def frozen_file(name: str) -> Path:
    """Return the path of a study's frozen design and outputs."""
    return FOLDER / "studies" / f"{name}.json"


def chosen_by_search(study: tvimdesign.Study, design: tvimdesign.Design) -> dict[str, Any]:
    """Return what is needed to evaluate the optimum of a study again, and how good it is.

    The study gives all other inputs itself; they are compared among the outputs.
    """
    varied, table = sorted(study.resolved.vary), study.resolved.table
    chosen = {name: design.choices[name] if name in design.choices else design.values[name] for name in varied}
    return {
        "mode": design.mode,
        "chosen": chosen,
        "units": {name: si_unit(table.unit(name)) for name in varied if name not in design.choices},
        "current_profiles": design.current_profiles,
        "optimum": {
            "status": design.status,
            "objective": design.solution.get("objective"),
            "reference": design.solution.get("reference", {}),
        },
    }


@cache
def evaluate_frozen(name: str, renames: Renames) -> tvimdesign.Result:
    """Evaluate a study at its frozen design, by the names of today; nothing is optimised.

    Raises
    ------
    FileNotFoundError
        If the study has no frozen design.
    TvimError
        If the study cannot be evaluated there.
    """
    return evaluated_study(load_study(name), read_frozen(frozen_file(name)), renames).evaluate(progress=False)


def evaluated_study(study: tvimdesign.Study, design: Mapping[str, Any], renames: Renames) -> tvimdesign.Study:
    """Return a study with the values of a frozen design in place of what it varies, and its current profiles."""
    chosen = {
        renames.name_now(name): f"{value!r} {design['units'][name]}" if name in design["units"] else value
        for name, value in design["chosen"].items()
    }
    profiles = {f"currents.{phase}": _current(profile) for phase, profile in design["current_profiles"].items()}
    without = dict.fromkeys(("minimize", "front", "robust", *(["profile"] if profiles else [])), None)
    return study.set({**chosen, **without, **profiles})


def _current(profile: Mapping[str, Any]) -> dict[str, list[str]]:
    units = {"moments": "s", "currents": "A"}
    return {series: [f"{value!r} {unit}" for value in profile[series]] for series, unit in units.items()}


def outputs(result: tvimdesign.Result) -> dict[str, Value]:
    """Return every value of an evaluated design by name: numbers in SI, and words.

    Groups are `choice:` for words, none for inputs and outputs, `hidden:` for quantities that no report shows,
    `limit:` and `advice:` for margins, `low:` and `high:` for ends of intervals, and others for values of the same
    module under other conditions.
    """
    design, data = result.design, result.data
    values: dict[str, Value] = {f"choice:{name}": word for name, word in design.choices.items()}
    values |= {"choice:above_rating": " ".join(design.above_rating), "choice:accepting": " ".join(design.accepting)}
    values |= design.values
    for name, ends in design.intervals.items():
        values |= {f"low:{name}": ends[0], f"high:{name}": ends[1]}
    values |= dict(_margins("limit", data["checks"])) | dict(_margins("advice", data["warnings"]))
    values |= {f"unpowered:{name}": entry["si"]["value"] for name, entry in data["cooling"]["unpowered"].items()}
    values |= {f"default current:{name}": entry["si"]["value"] for name, entry in data["at_default_currents"].items()}
    for idealization in data["idealizations"]:
        for name, entry in idealization["as_drawn"].items():
            values[f"without {idealization['choice']}:{name}"] = entry["si"]["value"]
    return values | hidden_values(design)


def _margins(group: str, checks: Any) -> Iterator[tuple[str, Value]]:
    """Yield the margin of each limit by output and sense; of several with one name, the later ones are numbered."""
    seen: Counter[str] = Counter()
    for check in checks:
        name = f"{check['output']} {check['limit'].split()[1]}"
        seen[name] += 1
        yield f"{group}:{name}" + (f" {seen[name]}" if seen[name] > 1 else ""), check["margin"]


def hidden_values(design: tvimdesign.Design) -> dict[str, Value]:
    """Return the quantities of the table that no report shows, at each operating point.

    What is no plain number, such as the links of the heat network, is three numbers: see `digest`.
    """
    table, known = table_for(design.mode), {**resolve_design(design).values, **design.values}
    points = tuple(design.study["operating_points"])
    values: dict[str, Value] = {}
    for row in table.outputs:
        if row.hidden and not row.instant:
            for name in [f"{row.name}@{point}" for point in points] if row.per_point else [row.name]:
                with suppress(tvimdesign.InputError):  # it needs the state of a phase
                    values |= digest(f"hidden:{name}", table.resolve(known, [name])[name])
    return values


def digest(name: str, value: Any) -> dict[str, Value]:
    """Return a number as it is, and a structure of numbers as their count, sum, and sum of logarithms.

    The logarithms show a relative change of the smallest number too. The order of the numbers does not matter, so that
    a list of tuples may become a list of records.
    """
    numbers = list(_numbers(value))
    if isinstance(value, bool | int | float | np.number):
        return {name: numbers[0]}
    logarithms = [math.log(abs(number)) for number in numbers if number and math.isfinite(number)]
    return {
        f"{name}[count]": float(len(numbers)), f"{name}[sum]": sum(sorted(numbers)),
        f"{name}[log]": math.fsum(logarithms),
    }  # fmt: skip


def _numbers(value: Any) -> Iterator[float]:
    if isinstance(value, bool | int | float | np.number):
        yield float(value)
    elif is_dataclass(value):
        for part in fields(value):
            yield from _numbers(getattr(value, part.name))
    elif isinstance(value, Mapping):
        for part in value.values():
            yield from _numbers(part)
    elif isinstance(value, list | tuple | np.ndarray):
        for part in value:
            yield from _numbers(part)
