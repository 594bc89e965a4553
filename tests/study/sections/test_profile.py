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
def test_nothing_and_zero_keep_the_currents_constant(read: Read, section: str) -> None:
    assert read(VARY + section).profile.pieces() == {}
    assert read("mode: shear\n" + section).profile.pieces() == {}


@pytest.mark.parametrize(
    ("section", "said"),
    [
        (
            "{stiffening: 4}",
            "4:23: profile.stiffening: the current of this phase has no range: `vary.cooling_current` is missing; "
            "expected cooling_current: [0.1 A, 3 A] under `vary`",
        ),
        ("{softning: 4}", "profile.softning: no such setting; expected one of softening, stiffening; did you mean"),
        ("{softening: -1}", "profile.softening: -1 should be greater than or equal to 0"),
        ("{softening: 65}", "profile.softening: 65 should be less than or equal to 64"),
        ("{softening: 2.5}", "profile.softening: the value '2.5' does not fit here; expected a whole number"),
        ("{softening: many}", "profile.softening: "),
        ("{softening: [4]}", "profile.softening: a list does not fit here"),
        ("{softening: 4 s}", "profile.softening: "),
        ("4", "profile: "),
        ("[softening]", "profile: a list does not fit here"),
    ],
)
def test_refused_profiles(problems: Refuse, section: str, said: str) -> None:
    lines = problems(VARY + f"profile: {section}")
    assert len(lines) == 1, lines
    assert said in lines[0]


def test_only_stages_that_a_user_drives_have_a_profile(problems: Refuse) -> None:
    lines = problems(VARY + "profile: {equilibrium_stiffening: 4}")
    assert "profile.equilibrium_stiffening: no such setting; expected one of softening, stiffening" in lines[0]


@pytest.mark.parametrize("vary", ["{choose: [1 A, 2 A]}", "{from: 1 A, to: 2 A}"])
def test_a_list_of_currents_is_no_range(read: Read, problems: Refuse, vary: str) -> None:
    text = f"mode: shear\nvary:\n  current: {vary}\nminimize: response_time\nprofile: {{softening: 4}}"
    if "from" in vary:
        assert read(text).profile.pieces() == {"softening": 4}
    else:
        (line,) = problems(text)
        assert "profile.softening: the current of this phase has no range" in line


def test_a_profile_in_a_study_that_varies_nothing_is_refused(problems: Refuse) -> None:
    (line,) = problems("mode: shear\nprofile: {softening: 4}")
    assert "`vary.current` is missing" in line


def test_every_mistake_of_the_section_is_told(problems: Refuse) -> None:
    lines = problems("mode: shear\nprofile: {softening: -2, stiffening: 3, stifening: 1}")
    assert len(lines) >= 3
    assert any("stifening" in line and "did you mean 'stiffening'" in line for line in lines)
