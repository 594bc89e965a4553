"""Fit the measurement files of the repository, as `tvimdesign fit --json` does."""

from __future__ import annotations

import json
import tempfile
import warnings
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import tvimdesign
from oracle.compare import Value
from oracle.frozen_files import FOLDER, read_frozen
from oracle.study_outputs import CODE, digest
from tvimdesign.simulation.measurement.reading.data_file import read_data_file

SAMPLES = CODE / "campaigns/fuzzing/samples"
CORPUS = CODE / "campaigns/corpus/fits"
MEASUREMENTS = FOLDER / "measurements.json"
"""Content by name, decoded as Latin-1, of files that the tests write, and of a log, which has no sample."""
_LOGGED = {
    "study": str(CODE / "studies/paper_reconstructed.yaml"),
    "fitted": "rotor_contact rotor_coefficient cold_side_coefficient",
}
_WORDING = {"notes", "words", "misfit", "read", "files", "meaning", "format", "tvimdesign", "units"}
"""Keys of the JSON that are for readers."""


@dataclass(frozen=True)
class FitCase:
    """Describe one fit: a file's data, the kind of measurement, and the settings."""

    name: str
    file_name: str
    data: bytes
    kind: str = ""
    settings: Mapping[str, str] = field(default_factory=dict)


def fit_cases() -> Iterator[FitCase]:
    """Yield the files of instruments, the data of each kind, and the files that once failed in a campaign."""
    settings: dict[str, dict[str, str]] = json.loads((SAMPLES / "settings.json").read_text(encoding="utf-8"))
    for path in sorted(SAMPLES.iterdir()):
        if path.name != "settings.json":
            kind = path.stem if path.stem in settings and path.suffix == ".csv" else ""
            yield FitCase(f"samples/{path.name}", path.name, path.read_bytes(), kind, settings.get(kind, {}))
    for path in sorted(CORPUS.glob("*/input.json")):
        request = json.loads(path.read_text(encoding="utf-8"))
        data = request["data"].encode("utf-8", "surrogatepass")
        yield FitCase(f"corpus/{path.parent.name}", "data.csv", data, request["kind"], request["settings"])
    for name, text in read_frozen(MEASUREMENTS).items():
        yield FitCase(f"measurements/{name}", name, text.encode("latin-1"), "", _LOGGED if "log" in name else {})


def fit(case: FitCase) -> dict[str, Value]:
    """Return the numbers and names of a fit's JSON, without its wording, and what was read of the file.

    Of data that are refused, the kind of the error is returned.
    """
    with tempfile.TemporaryDirectory(prefix="fit-") as folder, warnings.catch_warnings():
        warnings.simplefilter("ignore")
        path = Path(folder) / case.file_name
        path.write_bytes(case.data)
        return _columns(path) | _fitted(path, case)


def _columns(path: Path) -> dict[str, Value]:
    """Return a digest of the columns of every table in a file, in SI."""
    try:
        blocks = read_data_file(path).blocks
    except tvimdesign.TvimError as error:
        return {"read:refused": type(error).__name__}
    values: dict[str, Value] = {}
    for index, block in enumerate(blocks):
        for name, column in block.columns.items():
            values |= digest(f"read:{index}.{name}", column.values)
        values |= {f"read:{index}.{name}[problem]": 1.0 for name in block.problems}
    return values


def _fitted(path: Path, case: FitCase) -> dict[str, Value]:
    try:
        data = tvimdesign.fit(path, case.kind, **case.settings).data
    except tvimdesign.TvimError as error:
        return {"fit:refused": type(error).__name__}
    counts: dict[str, Value] = {f"fit:{words}[count]": float(len(data[words])) for words in ("notes", "words")}
    values = {f"fit:{name}": value for name, value in _plain("", data)}
    # Channels are named after the file, which is in another folder each time.
    return counts | {name: value.replace(f"{path.parent}/", "") if isinstance(value, str) else value
                     for name, value in values.items()}  # fmt: skip


def _plain(name: str, value: Any) -> Iterator[tuple[str, Value]]:
    """Yield the values of JSON by path; entries of a list that have a name go by it."""
    if isinstance(value, Mapping):
        for key, part in value.items():
            if key not in _WORDING:
                yield from _plain(f"{name}.{key}" if name else key, part)
    elif isinstance(value, list):
        for index, part in enumerate(value):
            key = part.get("name", index) if isinstance(part, Mapping) else index
            yield from _plain(f"{name}[{key}]", part)
    elif isinstance(value, bool | int | float):
        yield name, float(value)
    else:
        yield name, value
