"""Files of measured data, from instruments and by hand; maps of their columns; and fits of what could be read."""

from __future__ import annotations

import json
import random
import zipfile
from functools import cache
from io import BytesIO
from pathlib import Path

import yaml

from fuzzing.kind import Drawn, Kind
from fuzzing.mutations import ODD, encoded, mutated_bytes, mutated_data, mutated_table, mutated_text, paths
from tvimdesign.simulation.measurement.measure_files import kind_sheets, measure_files
from tvimdesign.simulation.measurement.reading.data_file import read_data_file
from tvimdesign.simulation.measurement.reading.headings import column_map, read_column_map

SAMPLES = Path(__file__).with_name("samples")
_ENCODINGS = ("utf-8", "utf-8", "utf-8-sig", "utf-16", "latin-1", "cp1252")
_ENDINGS = (".csv", ".txt", ".tts", ".osc", ".gt", ".json", ".xlsx", ".ods", ".xls", "")
_MAPS = [
    "angle: {column: 2, unit: deg}\ntorque: {heading: M, unit: N.m}\ndecimal: comma\n",
    "angular_frequency: w\nstorage_modulus: 2\nloss_modulus: {column: 3, unit: kPa}\nseparator: tab\nunits: SI\n",
    "time: {column: 1, unit: min}\ntemperature: {heading: 'Temp.', unit: degC}\nheat_flow: {column: 3, unit: mW}\n",
]


@cache
def _samples() -> list[tuple[str, bytes]]:
    return [(path.name, path.read_bytes()) for path in sorted(SAMPLES.iterdir()) if path.name != "settings.json"]


def _workbook(data: bytes, draw: random.Random) -> bytes:
    """Return a workbook with one of its parts changed, or some of its bytes."""
    if draw.random() < 0.3:
        return mutated_bytes(data, draw)
    made = BytesIO()
    with zipfile.ZipFile(BytesIO(data)) as book, zipfile.ZipFile(made, "w") as changed:
        names = book.namelist()
        which = names[-1] if draw.random() < 0.7 else draw.choice(names)
        for name in names:
            text = book.read(name).decode()
            changed.writestr(name, mutated_text(text.replace("><", ">\n<"), draw) if name == which else text)
    return made.getvalue()


def _text_of(data: bytes) -> str:
    return data.decode("utf-16") if data[:2] in (b"\xff\xfe", b"\xfe\xff") else data.decode()


def _data_file(draw: random.Random) -> Drawn:
    name, data = draw.choice(_samples())
    ending = Path(name).suffix if draw.random() < 0.9 else draw.choice(_ENDINGS)
    if name.endswith(".xlsx"):
        return Drawn(f"input{ending}", _workbook(data, draw))
    text = _text_of(data)
    if name.endswith(".json") and draw.random() < 0.6:
        text = json.dumps(mutated_data(text, list(paths(json.loads(text))), draw))
    elif draw.random() < 0.8:
        text = mutated_table(text, draw)
    changed = text.encode(draw.choice(_ENCODINGS), "replace") if draw.random() < 0.7 else mutated_text(text, draw)
    return Drawn(f"input{ending}", mutated_bytes(changed, draw) if changed and draw.random() < 0.1 else changed)


def _use_data(path: Path) -> None:
    """Do what `fit` does before it fits: read, show what was read, and look which kind it is and what it lacks."""
    file = read_data_file(path)
    file.shown()
    for block in file.blocks:
        for sheet in kind_sheets().values():
            if not sheet.fits(block):
                sheet.lacking(block)


def _map(draw: random.Random) -> Drawn:
    text = draw.choice(_MAPS)
    if draw.random() < 0.4:
        plain = yaml.safe_load(text)
        text = json.dumps(mutated_data(json.dumps(plain), list(paths(plain)), draw))
    return Drawn("input.yaml", mutated_text(text, draw))


def _use_map(path: Path) -> None:
    """Read a map, and read a file and a workbook by it."""
    columns = read_column_map(path)
    for name in ("torque_angle.csv", "rheocompass.txt"):
        read_data_file(SAMPLES / name, columns).shown()


@cache
def _kinds() -> dict[str, dict[str, str]]:
    """Settings that each kind of the samples needs."""
    settings: dict[str, dict[str, str]] = json.loads((SAMPLES / "settings.json").read_text())
    return settings


def _fit(draw: random.Random) -> Drawn:
    """Return a table whose numbers or headings are changed, the kind it is fitted as, and settings.

    Most spectra may have two modes at most, which is a tenth of the work.
    """
    kind, given = draw.choice(list(_kinds().items()))
    few = {"largest_modes": "2"} if "largest_modes" in kind_sheets()[kind].settings and draw.random() < 0.95 else {}
    settings = {**given, **few}
    text = (SAMPLES / f"{kind}.csv").read_text()
    request = {"kind": kind if draw.random() < 0.8 else draw.choice(list(kind_sheets())), "settings": dict(settings)}
    if draw.random() < 0.4:
        name = draw.choice([*kind_sheets()[kind].settings, "x"])
        request["settings"][name] = str(draw.choice([*ODD, "0", "-1 mm", "1e9 K"]))
    data = text if draw.random() < 0.2 else mutated_table(text, draw)
    return Drawn("input.json", encoded(json.dumps({**request, "data": data, "columns": {}})))


def _use_fit(path: Path) -> None:
    """Do what `fit` does: read the file beside the one that says how."""
    request = json.loads(path.read_bytes())
    data = path.with_name("data.csv")
    data.write_bytes(encoded(request["data"]))
    measure_files([data], request["kind"], request["settings"], column_map(request["columns"], "columns")).read()


DATA_FILES = Kind(_data_file, _use_data)
COLUMN_MAPS = Kind(_map, _use_map)
FITS = Kind(_fit, _use_fit, writes=True, most_seconds=15.0)
"""A spectrum with the fewest modes that its data bear is some fifty least squares: seconds of work, not a hang."""
