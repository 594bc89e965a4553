"""The section `profile`: in how many pieces a current may change, and where it may not."""

from collections.abc import Callable

import pytest

from tvimdesign.study import Study

Read = Callable[..., Study]
Refuse = Callable[..., list[str]]
VARY = "mode: shear\nvary: {current: [0.5 A, 3 A], coil_count: [2, 3]}\nminimize: response_time\n"


def test_pieces_by_stage(read: Read) -> None:
    study = read(VARY + "profile: {softening: 8}")
    assert study.profile.pieces() == {"softening": 8}
    both = VARY.replace("coil_count: [2, 3]", "cooling_current: [0 A, 2 A]")
    assert read(both + "profile: {softening: 8, stiffening: 4}").profile.pieces() == {"softening": 8, "stiffening": 4}


@pytest.mark.parametrize(
    "section", ["", "profile:", "profile: {}", "profile: {softening: 0}", "profile: {stiffening: 0}"]
)
def test_zero_pieces_are_a_constant_current(read: Read, section: str) -> None:
    assert read(VARY + section).profile.pieces() == {}
    assert read("mode: shear\n" + section).profile.pieces() == {}


def test_a_range_with_named_ends_may_have_a_profile(read: Read) -> None:
    text = "mode: shear\nvary: {current: {from: 1 A, to: 2 A}}\nminimize: response_time\nprofile: {softening: 4}"
    assert read(text).profile.pieces() == {"softening": 4}
