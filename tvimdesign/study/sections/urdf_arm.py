"""Arm of a task from a URDF: all that a joint carries, every other joint at zero."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, NamedTuple
from xml.etree import ElementTree

import numpy as np
from numpy.typing import NDArray

from tvimdesign.base.errors import InputError

Array = NDArray[np.float64]
_TURNS = ("revolute", "continuous")


class Frame(NamedTuple):
    """Place of a frame in that of the joint."""

    origin: Array
    """[m]."""
    rotation: Array
    """Matrix from it to that of the joint."""

    def then(self, element: ElementTree.Element | None) -> Frame:
        """Return the frame that an `origin` of a URDF places in this one."""
        xyz, rpy = (_vector(element, name, (0.0, 0.0, 0.0)) for name in ("xyz", "rpy"))
        turned = np.eye(3)
        for angle, axis in zip(rpy, np.eye(3), strict=True):  # roll, pitch and yaw, about fixed axes
            turned = _turn(angle, axis) @ turned
        return Frame(self.origin + self.rotation @ xyz, self.rotation @ turned)


class Arm(NamedTuple):
    """Bodies that a joint carries, about its axis."""

    length: float
    """Largest distance of a link's frame from the axis [m]."""
    mass: float
    """[kg]."""
    centre: float
    """Distance of the centre of mass from the axis [m]."""
    inertia: float
    """[kg*m^2]."""


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


def _turn(angle: float, axis: Array) -> Array:
    """Return the matrix of a rotation about a unit vector (Rodrigues)."""
    cross: Array = np.cross(np.eye(3), axis)
    turned: Array = np.eye(3) + np.sin(angle) * cross + (1.0 - np.cos(angle)) * cross @ cross
    return turned


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
