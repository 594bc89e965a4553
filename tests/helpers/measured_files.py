"""Files of measured data written for a test, and what fits of them come to."""

import zipfile
from collections.abc import Sequence
from io import BytesIO
from pathlib import Path
from typing import Any

import numpy as np

from tvimdesign.simulation.measurement.measure_files import Measured, kind_sheet, kind_sheets, measure_files, measure_of
from tvimdesign.simulation.measurement.measurement import Measurement
from tvimdesign.simulation.measurement.reading.data_file import read_data_file


def csv(path: Path, **columns: Any) -> Path:
    """Write a file of columns; `name__unit` is the heading `name [unit]`."""
    heads = [name.replace("__", " [") + "]" for name in columns]
    heads = [head.replace("_per_", "/").replace("_", " ") for head in heads]
    rows = [";".join(f"{x:.12g}" for x in row) for row in zip(*columns.values(), strict=True)]
    path.write_text("\n".join([";".join(heads), *rows]) + "\n")
    return path


def measured(paths: Path | Sequence[Path], kind: str = "", **settings: str) -> Measured:
    return measure_files([paths] if isinstance(paths, Path) else paths, kind, settings)


def fit_files(paths: Path | Sequence[Path], kind: str = "", **settings: str) -> Measurement:
    """Return the same, with intervals of the covariance: profiles take most of the time."""
    files = [read_data_file(path) for path in ([paths] if isinstance(paths, Path) else paths)]
    blocks = [block for file in files for block in file.blocks]
    sheet = kind_sheet(kind) if kind else next(known for known in kind_sheets().values() if known.fits(blocks[0]))
    result: Measurement = measure_of(sheet)(blocks, sheet.values(settings), profiles=False)
    return result


def holds(estimate: Any, truth: float) -> bool:
    """Return whether an interval has both ends, and the truth between them."""
    return estimate.low is not None and estimate.high is not None and estimate.low < truth < estimate.high


def moduli(omega: Any, modes: Sequence[tuple[float, float]]) -> tuple[Any, Any]:
    """Storage and loss modulus of Maxwell elements side by side (Ferry, eqs. 3-24 and 3-25)."""
    reduced = [(modulus, omega * tau) for tau, modulus in modes]
    return sum(g * x**2 / (1 + x**2) for g, x in reduced), sum(g * x / (1 + x**2) for g, x in reduced)


def oscillated(path: Path, omega: Any, storage: Any, loss: Any, celsius: Any = 100.0) -> Path:
    """Write a file of moduli over frequency, or over temperature."""
    return csv(path, angular_frequency__rad_per_s=omega, **{"G'__Pa": storage, "G''__Pa": loss},
               temperature__degC=np.broadcast_to(celsius, len(omega)))  # fmt: skip


def turned(
    path: Path, hertz: float, seed: int, joint: tuple[float, float, float, float], size: float,
    errors: tuple[float, float],
) -> Path:  # fmt: skip
    """Write four periods of I theta'' + b theta' + K theta + T_f sgn theta' = T, of a joint's I, K, b and T_f.

    The angle has the first of the errors, the torque the second as a share of its range.
    """
    (inertia, stiffness, damping, friction), noise = joint, np.random.default_rng(seed)
    omega, time = 2.0 * np.pi * hertz, np.linspace(0.0, 4.0 / hertz, 200)
    angle, quarter = size * np.cos(omega * time + 0.3), -np.sin(omega * time + 0.3)
    torque = (stiffness - inertia * omega**2) * angle + damping * omega * size * quarter + friction * np.sign(quarter)
    return csv(path, time__s=time, angle__rad=angle + noise.normal(0.0, errors[0], 200),
               torque__Nm=torque + noise.normal(0.0, errors[1] * np.ptp(torque), 200))  # fmt: skip


def arrhenius(celsius: Any, energy: float, reference: float) -> Any:
    """Return how much slower a melt is than at a reference, both in degrees Celsius."""
    return np.exp(energy / 8.314462618 * (1.0 / (celsius + 273.15) - 1.0 / (reference + 273.15)))


def workbook(rows: list[list[object]]) -> bytes:
    """Write the least that is a workbook (ECMA-376): one sheet with text in its cells, and numbers."""
    lines = []
    for i, row in enumerate(rows, start=1):
        cells = "".join(
            f'<c r="{chr(65 + j)}{i}"><v>{cell}</v></c>'
            if isinstance(cell, float)
            else f'<c r="{chr(65 + j)}{i}" t="inlineStr"><is><t>{cell}</t></is></c>'
            for j, cell in enumerate(row)
        )
        lines.append(f'<row r="{i}">{cells}</row>')
    main = "http://schemas.openxmlformats.org/spreadsheetml/2006/main"
    office = "http://schemas.openxmlformats.org/officeDocument/2006/relationships"
    package = "http://schemas.openxmlformats.org/package/2006"
    kind = "application/vnd.openxmlformats-officedocument.spreadsheetml"
    files = {
        "[Content_Types].xml": f'<Types xmlns="{package}/content-types"><Default Extension="rels" '
        'ContentType="application/vnd.openxmlformats-package.relationships+xml"/>'
        '<Override PartName="/xl/workbook.xml" '
        f'ContentType="{kind}.sheet.main+xml"/><Override PartName="/xl/worksheets/sheet1.xml" '
        f'ContentType="{kind}.worksheet+xml"/></Types>',
        "_rels/.rels": f'<Relationships xmlns="{package}/relationships"><Relationship Id="r1" '
        f'Type="{office}/officeDocument" Target="xl/workbook.xml"/></Relationships>',
        "xl/workbook.xml": f'<workbook xmlns="{main}" xmlns:r="{office}"><sheets><sheet name="data" sheetId="1" '
        'r:id="r1"/></sheets></workbook>',
        "xl/_rels/workbook.xml.rels": f'<Relationships xmlns="{package}/relationships"><Relationship Id="r1" '
        f'Type="{office}/worksheet" Target="worksheets/sheet1.xml"/></Relationships>',
        "xl/worksheets/sheet1.xml": f'<worksheet xmlns="{main}"><sheetData>{"".join(lines)}</sheetData></worksheet>',
    }
    stream = BytesIO()
    with zipfile.ZipFile(stream, "w") as book:
        for name, text in files.items():
            book.writestr(name, text)
    return stream.getvalue()
