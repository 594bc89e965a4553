"""The section `task`: an arm with its payload and its motions; inputs of the group "Task", limits, a trajectory.

The arm may be that beyond a joint of a URDF; what the section gives besides comes in place of the URDF's.
"""

from __future__ import annotations

import csv
import io
from collections.abc import Iterator
from contextlib import suppress
from itertools import pairwise
from pathlib import Path
from typing import Any, NamedTuple
from xml.etree import ElementTree

import numpy as np
from numpy.typing import NDArray

from tvimdesign.base.errors import InputError
from tvimdesign.device import Choice, Input, Table
from tvimdesign.device.core.task import ARM, GROUP
from tvimdesign.study.sections import section
from tvimdesign.study.study import GivenTrajectory, Requirement, Study
from tvimdesign.study.text import values
from tvimdesign.study.text.mistakes import RefusedError, step
from tvimdesign.study.text.yaml_text import Mapping, Node, Sequence

Array = NDArray[np.float64]
_TURNS = ("revolute", "continuous")


class Frame(NamedTuple):
    """Place of a frame in that of the joint."""

    origin: Array  # [m]
    rotation: Array  # Matrix from it to that of the joint

    def then(self, element: ElementTree.Element | None) -> Frame:
        """Return the frame that an `origin` of a URDF places in this one."""
        from scipy.spatial.transform import Rotation  # takes a tenth of a second, which other studies do not pay

        xyz, rpy = (_vector(element, name, (0.0, 0.0, 0.0)) for name in ("xyz", "rpy"))
        turned = Rotation.from_euler("xyz", rpy).as_matrix()  # roll, pitch and yaw, about fixed axes
        return Frame(self.origin + self.rotation @ xyz, self.rotation @ turned)


class Arm(NamedTuple):
    """Bodies that a joint carries, about its axis."""

    length: float  # Largest distance of a link's frame from the axis [m]
    mass: float  # [kg]
    centre: float  # Distance of the centre of mass from the axis [m]
    inertia: float  # [kg*m^2]


def arm_of(text: str, joint: str) -> Arm:
    """Return the arm beyond a joint of a URDF; raises InputError where there is none."""
    if "<!ENTITY" in text:
        raise InputError("the URDF defines entities: expand its macros first")
    try:
        robot = ElementTree.fromstring(text)
    except ElementTree.ParseError as error:
        raise InputError(f"the URDF is no XML: {error}") from error
    turning = {item.get("name", ""): item for item in robot.findall("joint") if item.get("type") in _TURNS}
    if joint not in turning:
        raise InputError(f"the URDF has no revolute joint {joint!r}: it has {', '.join(sorted(turning)) or 'none'}")
    axis = _vector(turning[joint].find("axis"), "xyz", (1.0, 0.0, 0.0))
    axis = axis / np.linalg.norm(axis)
    links = {link.get("name", ""): link for link in robot.findall("link")}
    length = mass = 0.0
    inertia: Any = 0.0
    moment: Array = np.zeros(3)
    for name, frame in _carried(robot, turning[joint]):
        length = max(length, _from_axis(frame.origin, axis))
        inertial = links[name].find("inertial") if name in links else None
        if inertial is None:
            continue
        body = frame.then(inertial.find("origin"))
        kilograms = _number(inertial.find("mass"), "value")
        along = body.rotation.T @ axis
        mass += kilograms
        moment += kilograms * body.origin
        inertia += along @ _tensor(inertial.find("inertia")) @ along + kilograms * _from_axis(body.origin, axis) ** 2
    if not mass or not length:
        raise InputError(f"the URDF gives no mass, or no link away from the axis, beyond the joint {joint!r}")
    return Arm(length, mass, _from_axis(moment / mass, axis), float(inertia))


def _carried(robot: ElementTree.Element, joint: ElementTree.Element) -> Iterator[tuple[str, Frame]]:
    """Yield the links beyond a joint with their frames."""
    beyond = [(_link(joint, "child"), Frame(np.zeros(3), np.eye(3)))]
    reached = set()
    while beyond:
        name, frame = beyond.pop()
        if name in reached:
            raise InputError(f"the URDF's link {name!r} is its own parent")
        reached.add(name)
        yield name, frame
        beyond += [
            (_link(item, "child"), frame.then(item.find("origin")))
            for item in robot.findall("joint")
            if _link(item, "parent") == name
        ]


def _link(joint: ElementTree.Element, end: str) -> str:
    element = joint.find(end)
    return "" if element is None else element.get("link", "")


def _from_axis(point: Array, axis: Array) -> float:
    return float(np.linalg.norm(np.cross(axis, point)))


def _tensor(element: ElementTree.Element | None) -> Array:
    xx, xy, xz, yy, yz, zz = (_number(element, name) for name in ("ixx", "ixy", "ixz", "iyy", "iyz", "izz"))
    return np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])


def _vector(element: ElementTree.Element | None, name: str, default: tuple[float, float, float]) -> Array:
    words = None if element is None else element.get(name)
    try:
        vector = np.array(default if words is None else [float(word) for word in words.split()])
    except ValueError as error:
        raise InputError(f'the URDF\'s {name}="{words}" is not three numbers') from error
    if vector.shape != (3,) or not np.isfinite(vector).all():
        raise InputError(f'the URDF\'s {name}="{words}" is not three numbers')
    return vector


def _number(element: ElementTree.Element | None, name: str) -> float:
    word = "0" if element is None else element.get(name, "0")
    try:
        return float(word)
    except ValueError as error:
        raise InputError(f'the URDF\'s {name}="{word}" is no number') from error


_ALLOWED = {
    "allowed_sag": ("sag@cold", "largest sag of the frozen joint: the requirement `sag@cold`"),
    "allowed_force": ("impact_force@cold", "largest force of the impact, which the frozen joint has most of"),
    "allowed_hic": (
        "head_injury@cold",
        "largest Head Injury Criterion (HIC15) of a head that strikes the frozen joint",
    ),
}
_URDF = {"urdf": "file of a robot, beside the study", "joint": "its joint that the module is"}
_MOST_MOMENTS = 1000
_LARGEST_FILE = 1_000_000
_EXPECTED = "moments: [0 s, 0.5 s] and angles: [0 deg, 40 deg], for one, or the name of a CSV file beside the study"


def task_quantities(table: Table) -> dict[str, Input | Choice]:
    """Return what `task` sets, by name."""
    given: tuple[Input | Choice, ...] = (*table.choices, *table.inputs)
    return {row.name: row for row in given if row.group == GROUP and row.name != "trajectory"}


def _read(reading: values.Reading, node: Node | None) -> dict[str, Any]:
    """Return what `module`, `require` and `trajectory` take from the section; every problem is noted."""
    problems, rows = reading.problems, task_quantities(reading.table)
    given = values.entries(problems, node, "task", "an arm_length, a payload and what the arm does")
    known = values.unknown_keys(problems, given, "task", "part of a task", [*rows, *_ALLOWED, "trajectory", *_URDF])
    module: dict[str, float | str] = {"task": ARM} if known else {}
    limits: list[Requirement] = []
    trajectory = None
    for name, value in known.items():
        path = step("task", name)
        with suppress(RefusedError):
            if name == "trajectory":
                trajectory = _trajectory(reading, value, path)
                module["trajectory"] = "given"
            elif name in _ALLOWED:
                output, unit = _ALLOWED[name][0], reading.table.unit(_ALLOWED[name][0])
                limit = values.in_unit(problems, value, path, unit, f"a quantity in {unit}")
                limits.append(
                    Requirement(output=output, sense="<=", limit=limit, text=f"<= {values.exactly(limit, unit)}")
                )
            elif name in rows:
                module[name] = values.read_input(reading, value, path, rows[name])
    module = {**_from_urdf(reading, known, module.get("arm_length")), **module}
    return {"module": module, "require": tuple(limits), "trajectory": trajectory}


def _from_urdf(reading: values.Reading, known: dict[str, Node], length: Any) -> dict[str, float]:
    """Return what a URDF gives of the arm, on a `length` [m] unless None; empty without one or with a problem noted."""
    if not known.keys() & _URDF:
        return {}
    first = next(name for name in _URDF if name in known)
    with suppress(RefusedError):
        urdf, joint = values.all_readable(
            lambda name, meaning: values.text(reading.problems, known.get(name, known[first]), step("task", name),
                                       f"the {meaning}"), _URDF
        ).values()  # fmt: skip
        try:
            if len(known.keys() & _URDF) < len(_URDF):
                raise InputError(f"`{first}` stands alone")
            arm = arm_of(_content(reading.folder / urdf), joint)
            length = length or arm.length
            shares = {"arm_length": length, "arm_mass": arm.mass, "arm_centre_share": arm.centre / length,
                      "arm_inertia_share": arm.inertia / (arm.mass * length**2)}  # fmt: skip
            for name, value in shares.items():
                row = reading.table.quantity(name)
                assert isinstance(row, Input)
                if not row.lower <= value <= row.upper:
                    raise InputError(f"its {name} is {values.exactly(value, row.unit)}")
        except InputError as error:
            expected = "`urdf: arm.urdf` and `joint: elbow`"
            reading.problems.refuse(known[first], step("task", first), str(error), expected)
        return shares
    return {}


def _trajectory(reading: values.Reading, node: Node, path: str) -> GivenTrajectory:
    """Return the trajectory of a mapping or of a CSV file. Raises RefusedError, with a problem noted."""
    problems = reading.problems
    try:
        if not isinstance(node, Mapping):
            return _checked(*_of_csv(reading.folder / values.text(problems, node, path, _EXPECTED)), at_rest=False)
        known = values.unknown_keys(problems, node.entries, path, "series", list(GivenTrajectory.model_fields))
        series = []
        for name, unit in (("moments", "s"), ("angles", "rad")):
            items, at = known.get(name), step(path, name)
            if not isinstance(items, Sequence):
                values.misfit(problems, items or node, at, _EXPECTED)
            series.append(list(values.quantities(problems, items, at, unit)))
        flags = {key: known[key] for key in ("at_rest",) if key in known}
        at_rest = values.readable(lambda key, item: values.flag(problems, item, step(path, key)), flags)
        return _checked(*series, at_rest=at_rest.get("at_rest", True))
    except InputError as error:
        problems.refuse(node, path, str(error), _EXPECTED)


def _checked(moments: list[float], angles: list[float], *, at_rest: bool) -> GivenTrajectory:
    if len(moments) != len(angles) or not 2 <= len(moments) <= _MOST_MOMENTS:
        counts = f"{len(moments)} moments and {len(angles)} angles"
        raise InputError(f"{counts}: must be as many, and 2 to {_MOST_MOMENTS}")
    if any(later <= earlier for earlier, later in pairwise(moments)):
        raise InputError("the moments do not rise")
    return GivenTrajectory(moments=tuple(moments), angles=tuple(angles), at_rest=at_rest)


def _of_csv(path: Path) -> tuple[list[float], list[float]]:
    """Return times [s] and angles [rad] of a file's first two columns, below a heading; raises InputError."""
    try:
        rows = [row for row in csv.reader(io.StringIO(_content(path))) if row]
        times, angles = zip(*((float(row[0]), float(row[1])) for row in rows[1:]), strict=True)
    except (ValueError, IndexError, csv.Error) as error:
        raise InputError(f"{path.name} needs a heading, then a time in s and an angle in rad a line") from error
    return list(times), list(angles)


def _content(path: Path) -> str:
    """Return the text of a small file; raises InputError."""
    try:
        with path.open("rb") as file:
            content = file.read(_LARGEST_FILE + 1)
        if len(content) > _LARGEST_FILE:
            raise InputError(f"{path.name} is larger than {_LARGEST_FILE // 1_000_000} MB")
        return content.decode("utf-8-sig")
    except OSError as error:
        raise InputError(f"{path.name} cannot be read: {error.strerror}") from error
    except UnicodeDecodeError as error:
        raise InputError(f"{path.name} is no text in UTF-8") from error


def _write(study: Study) -> dict[str, Any]:
    rows = task_quantities(study.table)
    written: dict[str, Any] = {
        name: value if isinstance(value, str) else values.exactly(value, study.table.unit(name))
        for name, value in study.module.items()
        if name in rows
    }
    if study.trajectory:
        written["trajectory"] = section.changed(study.trajectory)
    return written


def _schema(table: Table) -> section.Schema:
    allowed = {name: {"description": meaning, "allOf": [section.QUANTITY]} for name, (_, meaning) in _ALLOWED.items()}
    given = section.shape(section.field_schemas(GivenTrajectory), ["moments", "angles"])
    trajectory = {"description": f"angles of the housing over time: {_EXPECTED}", "anyOf": [given, {"type": "string"}]}
    return section.mapping(
        {
            **{name: section.set_schema(row) for name, row in task_quantities(table).items()},
            **allowed,
            "trajectory": trajectory,
            **{name: {"description": meaning, "type": "string"} for name, meaning in _URDF.items()},
        }
    )


TASK = section.Section(
    "task", "arm and payload that the joint moves, and how: hold, sine, trajectory, impact", _read, _schema, _write
)
