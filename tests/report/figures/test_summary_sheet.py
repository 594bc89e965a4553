"""The one page for a mail or a lab book: A4, one page, whatever the run has to show."""

import re
from pathlib import Path
from typing import Any

import pytest
from PIL import Image

from tvimdesign.report.figures.summary_sheet import summary
from tvimdesign.report.figures.theme import as_file

ROW = ["torque held when frozen", ">= 20 N·m", "20", "19 to 23.2", "at the limit"]


def sheet_of(picture: str = "", rows: int = 10, warnings: int = 3) -> dict[str, Any]:
    return {
        "title": "Elbow, printed " * 9, "kind": "shear module", "status": "Nominal optimum: add margins " * 4,
        "tone": "warn", "heads": ["requirement", "asked", "got", "range", "margin"], "rows": [ROW] * rows,
        "facts": [("Size and mass", "89.4 mm diameter x 31.4 mm high · 117 g (115 to 120) " * 3)] * 6,
        "warnings": [("heating stops 29.6 K below the point `hot`", "require: {x: 1}")] * warnings,
        "picture": picture, "made_by": "Written by a test.",
    }  # fmt: skip


@pytest.mark.parametrize("rows", [0, 10, 60])
def test_it_is_one_sheet_of_a4(tmp_path: Path, rows: int) -> None:
    Image.new("RGB", (1800, 800), "grey").save(tmp_path / "preview.png")
    figure = summary(sheet_of(str(tmp_path / "preview.png"), rows))
    pdf = as_file(figure, "pdf")
    assert len(re.findall(rb"/Type /Page\b", pdf)) == 1
    (box,) = re.findall(rb"/MediaBox\s*\[([^\]]+)\]", pdf)
    assert tuple(map(float, box.split()[2:])) == pytest.approx((595.3, 841.9), abs=1.0)  # points, ISO 216
    places = [text.get_position() for text in figure.texts]
    assert min(y for _, y in places) > 0.04
    assert all(0.0 < x < 1.0 and y < 1.0 for x, y in places)
