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


@pytest.mark.parametrize(
    ("name", "written", "said"),
    [
        (
            "module_mass",
            "5 g",
            "3:16: require.module_mass: the value '5 g' does not fit here; expected a limit such as '<= ",
        ),
        ("module_mass", "'< 5 g'", "does not fit here; expected a limit"),
        ("module_mass", "'== 5 g'", "does not fit here; expected a limit"),
        ("module_mass", "'<= 5 g <= 6 g'", "is no unit"),
        ("module_mass", "'<=> 5 g'", "does not fit here"),
        ("module_mass", "'<= '", "does not fit here"),
        ("module_mass", "'<= 5'", "say the unit"),
        ("module_mass", "'<= 5 mm'", "mm is not of that kind"),
        ("module_mass", "'<= 1,5 g'", "decimal comma"),
        ("module_mass", "'<= nan g'", "does not start with a number"),
        ("module_mass", "'<= 1e999 g'", "out of range"),
        ("module_mass", "[]", "a list of 0 limits; expected 1 to 10 limits"),
        ("module_mass", "['<= 5 g', 3]", "require.module_mass[1]: the value '3' does not fit here"),
        ("module_mass", "{max: 5 g}", "a mapping (name: value) does not fit here"),
        ("module_mass", "['>= 5 g', '<= 4 g']", "cannot be both at least 5 g and at most 4 g"),
        ("joint_stiffness@hot", "['>= 5 N.m/rad', '>= 1 N.m/rad', '<= 4 N.m/rad']", "at least 5 N·m/rad and at most 4"),
        (
            "joint_stiffness",
            "'>= 5 N.m/rad'",
            "has a value at each operating point; expected one of joint_stiffness@cold, ",
        ),
        ("joint_stiffness@ht", "'>= 5 N.m/rad'", "no such operating point: 'ht'; expected one of cold, hot"),
        ("joint_stiffness@", "'>= 5 N.m/rad'", "no such operating point: ''"),
        (
            "module_mass@hot",
            "'>= 5 g'",
            "is the same at every operating point; expected 'module_mass'; leave out '@hot'",
        ),
        ("wire_diameter", "'>= 5 mm'", "is something the study sets, no output"),
        ("face_temperature", "'>= 5 degC'", "changes during the switch and has no single value"),
        ("moduli", "'>= 5'", "3:3: require.moduli: no such output; expected one of joint_stiffness, module_mass, "),
        ("modul_mass", "'>= 5 g'", "3:3: require.modul_mass: no such output"),
    ],
)
def test_refused_limits(problems: Refuse, name: str, written: str, said: str) -> None:
    lines = problems(f"mode: shear\nrequire:\n  {name}: {written}\n")
    assert len(lines) == 1
    assert said in lines[0]


def test_minimize_by_one_name(read: Read) -> None:
    study = read("mode: shear\nvary: {coil_count: [2, 3]}\nminimize: joint_stiffness@hot")
    assert study.minimize == {"joint_stiffness@hot": 1.0}


def test_events_and_paths_are_outputs_too(read: Read) -> None:
    study = read(
        "mode: shear\nvary: {coil_count: [2, 3]}\nminimize: {response_time: 1}\nrequire: {switch_energy: '<= 400 J'}"
    )
    assert study.minimize == {"response_time": 1.0}
    assert study.require[0].limit == 400.0


@pytest.mark.parametrize(
    ("written", "said"),
    [
        ("modul_mass", "minimize: no such output"),
        ("joint_stiffness", "has a value at each operating point"),
        ("[module_mass]", "a list does not fit here; expected the name of an output, or outputs with their weights"),
        ("{module_mass: 0}", "the weight 0 is not above 0"),
        ("{module_mass: -1}", "the weight -1 is not above 0"),
        ("{module_mass: 1e999}", "out of range"),
        ("{module_mass: .inf}", "does not start with a number"),
        ("{module_mass: }", "no value does not fit here; expected a weight, a number above 0"),
        ("{module_mass: 1 g}", "g is not of that kind"),
        ("{wire_diameter: 1}", "is something the study sets, no output"),
    ],
)
def test_refused_weights(problems: Refuse, written: str, said: str) -> None:
    lines = problems(f"mode: shear\nvary: {{coil_count: [2, 3]}}\nminimize: {written}\n")
    assert len(lines) == 1
    assert said in lines[0]


FREE = "mode: shear\nvary: {current: [1 A, 2 A]}\nminimize: module_mass\n"


def test_a_front_is_two_or_three_outputs_and_a_count(read: Read) -> None:
    front = read(FREE + "front: {of: [response_time, joint_stiffness@hot, module_mass], points: 30}\n").front
    assert front is not None
    assert front.of == ("response_time", "joint_stiffness@hot", "module_mass")
    assert front.points == 30
    assert read(FREE + "front: {of: [response_time, module_mass]}\n").front is not None
    assert read(FREE).front is None


@pytest.mark.parametrize(
    ("written", "said"),
    [
        ("{of: [response_time]}", "front.of: are not two or three outputs"),
        ("{points: 5}", "front.of: are not two or three outputs"),
        ("{of: [response_time, module_mas]}", "module_mass"),
        ("{of: [response_time, current]}", "is something the study sets"),
        ("{of: [response_time, response_time]}", "names an output twice"),
        ("{of: [response_time, module_mass], points: 2}", "2 points"),
        ("{of: [response_time, module_mass], pionts: 9}", "pionts"),
        ("30", "front"),
    ],
)
def test_a_front_that_cannot_be_is_refused_with_its_place(problems: Refuse, written: str, said: str) -> None:
    found = problems(FREE + f"front: {written}\n")
    assert any(said in problem for problem in found), found


def test_a_front_of_a_module_that_is_only_evaluated_is_refused(problems: Refuse) -> None:
    found = problems("mode: shear\nfront: {of: [response_time, module_mass]}\n")
    assert any("nothing may change" in problem for problem in found)
