"""A stated target that no design reaches is refused, with what would be; the extremes are given, not solved for."""

from __future__ import annotations

import pytest

from tvimdesign.base.errors import InputError
from tvimdesign.solve.infeasibility import reach
from tvimdesign.study import read_study_text

STUDY = """
mode: shear
module: {impedance_targets: stated, soft_impedance: 5 N.m/rad, stiff_impedance: 100 N.m/rad,
         softening_band: 2, stiffening_band: 2}
"""


def refuse(monkeypatch: pytest.MonkeyPatch, hot: float | None, cold: float | None) -> None:
    extremes = {"joint_impedance@hot": hot, "joint_impedance@cold": cold}
    monkeypatch.setattr(reach, "_extreme", lambda _study, row, _sign, _deadline: extremes[row])
    reach.refuse_unreachable(read_study_text(STUDY, "a test"))


@pytest.mark.parametrize(
    ("hot", "cold", "said"),
    [
        # Soft is twice 5 N*m/rad, stiff half of 100.
        (10.5, 80.0, r"soft_impedance 5 .* the softest joint .* has 10.5 .*; the least target is 5.25"),
        (4.0, 40.0, r"stiff_impedance 100 .* the stiffest joint .* has 40 .*; the largest target is 80"),
    ],
)
def test_a_target_beyond_reach_is_refused_with_the_nearest_one(
    monkeypatch: pytest.MonkeyPatch, hot: float, cold: float, said: str
) -> None:
    with pytest.raises(InputError, match=said):
        refuse(monkeypatch, hot, cold)


@pytest.mark.parametrize(("hot", "cold"), [(9.5, 51.0), (10.0, 50.0), (None, None), (None, 51.0)])
def test_a_target_within_reach_or_of_unknown_reach_is_not(
    monkeypatch: pytest.MonkeyPatch, hot: float | None, cold: float | None
) -> None:
    refuse(monkeypatch, hot, cold)
