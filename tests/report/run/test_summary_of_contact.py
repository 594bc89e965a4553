"""What a run says of points at which its blocks lose the link, and from when on a released link is drawn."""

from __future__ import annotations

import numpy as np
import pytest
from comparable import COMPRESSION, SHEAR
from stiff_when_warm import LOSSLESS

from tvimdesign.report.compare.comparison_page import _from_where_it_moves
from tvimdesign.report.run.blocks.warnings import warnings_of
from tvimdesign.solve.result import answer
from tvimdesign.study import drawn, read_study_text


def _said(text: str, **module: float) -> str:
    study = read_study_text(text, "test")
    study = study.model_copy(update={"module": {**study.module, **module}})
    return " ".join(warning.text for warning in warnings_of(answer(drawn(study)), []))


@pytest.mark.gate
def test_a_run_says_where_small_motions_say_little_of_the_joint() -> None:
    # In a hold of 10 s a printed structure creeps as its loss says: frozen blocks are left as well.
    said = _said(COMPRESSION)
    assert "at hot no PCL touches the link for" in said
    assert "at cold no PCL touches the link for" in said
    said = _said(COMPRESSION, **LOSSLESS)
    assert "at hot no PCL touches the link for" in said
    assert "at cold no PCL" not in said


def test_nothing_is_said_of_contact_where_the_layer_is_bonded() -> None:
    assert "no PCL touches the link" not in _said(SHEAR)


def test_a_release_is_drawn_from_where_a_link_begins_to_move() -> None:
    times = np.geomspace(1e-8, 1.0, 400)
    quick, slow = ({"label": "", "x": times.tolist(), "y": (0.1 * np.cos(w * times)).tolist()} for w in (100.0, 10.0))
    one, other = _from_where_it_moves([quick, slow])
    # cos(w t) = 0.999 at w t = sqrt(0.002); samples are 4.7 % apart.
    assert one["x"][0] == other["x"][0] == pytest.approx(np.sqrt(0.002) / 100.0, rel=0.05)
    assert one["x"][-1] == 1.0
    assert len(one["x"]) == len(one["y"]) < 400
