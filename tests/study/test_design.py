"""Designs that are read again: of this version, and of another."""

import json
from pathlib import Path

import pytest
from support import ROOT

from tvimdesign.base.errors import InputError
from tvimdesign.study.design import read_design


def test_a_design_that_lacks_an_input_is_told_to_be_of_another_version(tmp_path: Path) -> None:
    kept = ROOT / "cad/paper_shear/design.json"
    assert read_design(kept).mode == "shear"
    plain = json.loads(kept.read_text())
    del plain["values"]["wire_diameter"]
    other = tmp_path / "design.json"
    other.write_text(json.dumps(plain))
    with pytest.raises(InputError, match=r"has no wire_diameter: another version wrote it; write it anew"):
        read_design(other)
