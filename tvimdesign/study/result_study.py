"""A result turned into a study that evaluates its module: what the search chose is written down."""

from __future__ import annotations

import os
from collections.abc import Mapping
from pathlib import Path

from tvimdesign.device import Choice, Input, table_for
from tvimdesign.device.table.quantity import Feature
from tvimdesign.study.design import Design
from tvimdesign.study.sections.all_sections import written
from tvimdesign.study.study import GivenCurrent, ProfileOptions, Range, Study
from tvimdesign.study.tree import tree_of_values, tree_yaml


def result_text(design: Design, source: str, folder: Path) -> str:
    """Return the text of a study whose `run` gives the design; `folder` will hold its file."""
    return study_text(evaluating(design), f"The module of {source}", folder)


def study_text(study: Study, title: str, folder: Path) -> str:
    """Return the text of a study below a line with its title; `folder` will hold its file."""
    if study.catalog_folder:
        records = os.path.relpath(Path(study.catalog_folder).resolve(), folder.resolve())
        study = study.model_copy(update={"catalog_folder": records})
    return tree_yaml(tree_of_values(written(study), title, folder))


def started_at(study: Study, values: Mapping[str, float], choices: Mapping[str, str | float]) -> Study:
    """Return the study with its search started at a design, or as near as its ranges allow."""
    module, vary = dict(study.module), dict(study.vary)
    for name, allowed in study.vary.items():
        if isinstance(allowed, Range):
            start = min(max(values[name], allowed.lower), allowed.upper)
            vary[name] = allowed.model_copy(update={"start": start})
        else:
            module[name] = choices[name] if name in choices else values[name]
    return study.model_copy(update={"module": module, "vary": vary})


def evaluating(design: Design) -> Study:
    """Return the design's study with the chosen values in place of ranges and lists, without what a search needs.

    Inputs and choices that have no effect in this module, such as those of a part it does not have, are left out.
    """
    study, table = Study.model_validate(design.study), table_for(design.mode)
    chosen = {name: design.choices.get(name, design.values.get(name)) for name in study.vary}
    module = {**study.module, **{name: value for name, value in chosen.items() if value is not None}}
    lacking = {Feature(choice.name, design.choices[choice.name]) for choice in table.choices}
    rows: list[Choice | Input] = [*table.choices, *table.inputs]
    idle = {row.name for row in rows if lacking & set(row.requires)}
    effective = {name: value for name, value in module.items() if name not in idle}
    currents = {phase: GivenCurrent.model_validate(plain) for phase, plain in design.current_profiles.items()}
    update = {
        "module": effective, "vary": {}, "minimize": {}, "front": None, "robust": None, "profile": ProfileOptions(),
        "currents": currents,
    }  # fmt: skip
    return study.model_copy(update=update)
