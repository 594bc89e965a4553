"""Read bad studies and note where each message points: line, column and key of the text."""

from __future__ import annotations

import tempfile
import warnings
from collections import Counter
from pathlib import Path

import tvimdesign
from oracle.compare import Value
from oracle.frozen_files import FOLDER, read_frozen

BAD_STUDIES = FOLDER / "bad_studies.json"
"""Texts by name: the bad studies of the tests, one of each set of places."""


def bad_studies() -> dict[str, str]:
    """Return the texts of the corpus by name."""
    texts: dict[str, str] = read_frozen(BAD_STUDIES)
    return texts


def message_places(text: str) -> dict[str, Value]:
    """Return how many messages a study gets at each place, `line:column key`; wording is left out."""
    with tempfile.TemporaryDirectory(prefix="bad-study-") as folder, warnings.catch_warnings():
        warnings.simplefilter("ignore")
        path = Path(folder) / "x.yaml"
        path.write_bytes(text.encode("utf-8", "surrogatepass"))
        return _places(path)


def _places(path: Path) -> dict[str, Value]:
    try:
        tvimdesign.load(path)
    except tvimdesign.StudyError as error:
        counts = Counter(f"{problem.line}:{problem.column} {problem.path}" for problem in error.problems)
        return {place: float(count) for place, count in counts.items()}
    except tvimdesign.TvimError as error:
        return {type(error).__name__: 1.0}
    return {"accepted": 1.0}
