"""Sizes one can buy, of the shipped records that list them: wires by diameter, screws and pins by length."""

from __future__ import annotations

import pytest

from tvimdesign.study import Options, read_study_text

STUDY = "tvimdesign: 1\nname: x\nmode: shear\nvary: {{{}}}\nminimize: module_mass\n"


@pytest.mark.parametrize(
    ("row", "record", "lengths"),
    [
        # ISO 7380-1 M4 and ISO 4762 M2 as commonly sold; ISO 8734 pins of 2.5 mm between 8 and 12 mm.
        ("retainer_screw_length", "{catalog: iso_7380_m4, to: 16 mm}", (8, 10, 12, 16)),
        ("link_screw_length", "{catalog: iso_7380_m3, from: 10 mm, to: 12 mm}", (10, 12)),
        ("link_dowel_length", "{catalog: iso_8734_2_5, from: 8 mm, to: 12 mm}", (8, 10, 12)),
    ],
)
def test_the_lengths_a_screw_or_pin_is_sold_in_are_those_that_are_tried(
    row: str, record: str, lengths: tuple[int, ...]
) -> None:
    study = read_study_text(STUDY.format(f"{row}: {record}"), "x.yaml")
    result = study.vary[row]
    assert isinstance(result, Options)
    assert result.values == pytest.approx([1e-3 * length for length in lengths])
