"""Files of measured data written for a test, and what fits of them come to."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

from tvimdesign.simulation.measurement.measure_files import Measured, kind_sheet, kind_sheets, measure_files, measure_of
from tvimdesign.simulation.measurement.measurement import Measurement
from tvimdesign.simulation.measurement.reading.data_file import read_data_file


def csv(path: Path, **columns: Any) -> Path:
    """A file of columns; `name__unit` is the heading `name [unit]`."""
    heads = [name.replace("__", " [") + "]" for name in columns]
    heads = [head.replace("_per_", "/").replace("_", " ") for head in heads]
    rows = [";".join(f"{x:.12g}" for x in row) for row in zip(*columns.values(), strict=True)]
    path.write_text("\n".join([";".join(heads), *rows]) + "\n")
    return path


def measured(paths: Path | Sequence[Path], kind: str = "", **settings: str) -> Measured:
    return measure_files([paths] if isinstance(paths, Path) else paths, kind, settings)


def found(paths: Path | Sequence[Path], kind: str = "", **settings: str) -> Measurement:
    """Return the same, with intervals of the covariance: profiles take most of the time."""
    files = [read_data_file(path) for path in ([paths] if isinstance(paths, Path) else paths)]
    blocks = [block for file in files for block in file.blocks]
    sheet = kind_sheet(kind) if kind else next(one for one in kind_sheets().values() if one.fits(blocks[0]))
    result: Measurement = measure_of(sheet)(blocks, sheet.values(settings), profiles=False)
    return result
