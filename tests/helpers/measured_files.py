"""Files of measured data written for a test, and what fits of them come to."""

import zipfile
from collections.abc import Sequence
from io import BytesIO
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
