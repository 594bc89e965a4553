"""List what the oracle knows of each kind: the frozen values of every subject, and how to compute those of now."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from functools import partial

from oracle import fits, messages, part_volumes, study_outputs
from oracle.compare import Renames, Values
from oracle.frozen_files import FOLDER, read_frozen

KINDS = ("outputs", "parts", "fit", "messages")
OF_STUDIES = {"outputs", "parts"}
"""Kinds whose subjects are studies."""
FILES = {"parts": FOLDER / "parts.json", "fit": FOLDER / "fits.json", "messages": FOLDER / "messages.json"}
"""Where the values of all subjects of a kind are frozen; each study has a file of its own for its outputs."""
Subject = tuple[str, Callable[[], Values]]
"""A name, such as that of a study, and what computes its values."""


def subjects(kind: str, studies: Sequence[str], renames: Renames) -> Iterator[Subject]:
    """Yield the subjects of a kind; of outputs and parts those of the named studies, or of all if none is named."""
    if kind in OF_STUDIES:
        for name in studies or study_outputs.study_files():
            yield name, partial(_outputs if kind == "outputs" else _parts, name, renames)
    elif kind == "fit":
        for case in fits.fit_cases():
            yield case.name, partial(fits.fit, case)
    else:
        for name, text in messages.bad_studies().items():
            yield name, partial(messages.message_places, text)


def _outputs(name: str, renames: Renames) -> Values:
    return study_outputs.outputs(study_outputs.evaluate_frozen(name, renames))


def _parts(name: str, renames: Renames) -> Values:
    return part_volumes.part_volumes(study_outputs.evaluate_frozen(name, renames).design)


def frozen_values(kind: str, studies: Sequence[str]) -> dict[str, Values]:
    """Return the frozen values of every subject of a kind, as `subjects` lists them."""
    by_subject: dict[str, Values]
    if kind == "outputs":
        files = {path.stem: read_frozen(path) for path in sorted((FOLDER / "studies").glob("*.json"))}
        by_subject = {name: data["outputs"] for name, data in files.items() if "outputs" in data}
    else:
        by_subject = read_frozen(FILES[kind])["values"]
    every = not studies or kind not in OF_STUDIES
    return {name: values for name, values in by_subject.items() if every or name in studies}
