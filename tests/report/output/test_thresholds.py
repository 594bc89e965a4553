"""What soft and stiff are said to mean."""

from __future__ import annotations

import pytest

from tvimdesign.device import table_for
from tvimdesign.report.output.thresholds import meaning, soft_in_words, stiff_in_words
from tvimdesign.solve.result import answer
from tvimdesign.study import read_study_text

TABLE = table_for("shear")
STATED = "impedance_targets: stated, soft_impedance: 40 N.m/rad, stiff_impedance: 300 N.m/rad"


@pytest.mark.parametrize(
    ("module", "soft", "stiff"),
    [
        (STATED,
         "|Z| <= 80 N·m/rad at 1 Hz, twice soft_impedance", "|Z| >= 150 N·m/rad at 1 Hz, half of stiff_impedance"),
        (f"{STATED}, softening_band: 1.5, stiffening_band: 4",
         "|Z| <= 60 N·m/rad at 1 Hz, 1.5 times soft_impedance", "|Z| >= 75 N·m/rad at 1 Hz, 1/4 of stiff_impedance"),
    ],
)  # fmt: skip
def test_soft_and_stiff_are_said_as_impedances(module: str, soft: str, stiff: str) -> None:
    """By hand: band times 40, and 300 over the band."""
    study = read_study_text(f"mode: shear\nmodule: {{{module}}}\n", "a test")
    found = answer(study)
    assert soft_in_words(found.design, TABLE) == soft
    assert stiff_in_words(found.design, TABLE) == stiff
    assert meaning("softening_time", found.design, TABLE).endswith(f"(soft: {soft})")
    assert meaning("stiffening_time", found.design, TABLE).endswith(f"(stiff: {stiff})")
