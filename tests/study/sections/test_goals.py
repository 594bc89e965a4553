"""The sections `require` and `minimize`: limits and weights, good and bad."""

from collections.abc import Callable

import pytest

from tvimdesign.study import Study

Read = Callable[..., Study]
Refuse = Callable[..., list[str]]


@pytest.mark.parametrize(
    ("written", "sense", "limit"),
    [
        ("'>= 5 g'", ">=", 5e-3),
        ("'>=5 g'", ">=", 5e-3),
        ("<= 5 kg", "<=", 5.0),
        ("'<=   5e-1 kg'", "<=", 0.5),
        ("' <= 5 g '", "<=", 5e-3),
    ],
)
def test_limits(read: Read, written: str, sense: str, limit: float) -> None:
    (requirement,) = read(f"mode: shear\nrequire: {{module_mass: {written}}}").require
    assert (requirement.output, requirement.sense) == ("module_mass", sense)
    assert requirement.limit == pytest.approx(limit)
    assert requirement.text == written.strip("' ")


def test_equal_limits_are_no_contradiction(read: Read) -> None:
    assert len(read("mode: shear\nrequire: {module_mass: ['>= 5 g', '<= 0.005 kg']}").require) == 2


def test_minimize_by_one_name(read: Read) -> None:
    study = read("mode: shear\nvary: {coil_count: [2, 3]}\nminimize: joint_stiffness@hot")
    assert study.minimize == {"joint_stiffness@hot": 1.0}


def test_events_and_paths_are_outputs_too(read: Read) -> None:
    study = read(
        "mode: shear\nvary: {coil_count: [2, 3]}\nminimize: {response_time: 1}\nrequire: {switch_energy: '<= 400 J'}"
    )
    assert study.minimize == {"response_time": 1.0}
    assert study.require[0].limit == 400.0


FREE = "mode: shear\nvary: {current: [1 A, 2 A]}\nminimize: module_mass\n"


def test_a_front_is_two_or_three_outputs_and_a_count(read: Read) -> None:
    front = read(FREE + "front: {of: [response_time, joint_stiffness@hot, module_mass], points: 30}\n").front
    assert front is not None
    assert front.of == ("response_time", "joint_stiffness@hot", "module_mass")
    assert front.points == 30
    assert read(FREE + "front: {of: [response_time, module_mass]}\n").front is not None
    assert read(FREE).front is None
