"""The joint as MJCF and URDF files, and how their XML is written."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any
from xml.etree import ElementTree as Xml

from tvimdesign.report.robot.joint_model import JointModel, RigidBody, header
from tvimdesign.report.robot.joint_state import JointState
from tvimdesign.report.robot.maxwell_hinges import JOINT, Hinge, MaxwellHinges, Spring, held_angles, maxwell_hinges


def numbers(*values: float) -> str:
    """Format numbers for an attribute, to ten digits."""
    return " ".join(f"{value:.10g}" for value in values)


def comment(lines: Sequence[str]) -> Xml.Element[Any]:
    """Format lines as a comment; two hyphens, which XML does not allow in one, become one."""
    text = "\n".join(lines)
    while "--" in text:
        text = text.replace("--", "-")
    return Xml.Comment(f"\n{text}\n")


def document(root: Xml.Element) -> str:
    """Return the whole file."""
    Xml.indent(root)
    return '<?xml version="1.0" encoding="utf-8"?>\n' + Xml.tostring(root, encoding="unicode") + "\n"


_NEARLY_NOTHING = 1e-14
"""Inertia of a body that only carries a hinge [kg*m^2], a little above MuJoCo's least."""
_ACROSS = 0.6
"""Inertia of the bench's load across the axis over that about it: nobody gave it, and a body has more than a half."""
_FAR = 1e3
"""Angle [rad] that no joint reaches: so far a spring that only pushes is slack."""
_STIFF_FRICTION = "0.9999 0.9999 0.001 0.5 2"


def mjcf(model: JointModel, state: JointState) -> str:
    """Return one state of the joint as an MJCF file."""
    made = maxwell_hinges(state, model.count, model.step)
    root = Xml.Element("mujoco", model=f"{model.slug}_{state.point}")
    root.append(comment([*header(model, state), *_merged(model, state, made)]))
    Xml.SubElement(root, "compiler", angle="radian", autolimits="true")
    Xml.SubElement(root, "option", timestep=numbers(model.step), integrator="implicitfast")
    assets = Xml.SubElement(root, "asset")
    for body in (model.base, model.moving):
        Xml.SubElement(assets, "mesh", name=body.name, file=body.mesh, inertia="shell")
    base = _body(Xml.SubElement(root, "worldbody"), model.base)
    moving = _body(base, model.moving)
    Xml.SubElement(
        moving, "joint", name=JOINT, type="hinge", axis="0 0 1", range=numbers(-model.stop_angle, model.stop_angle),
        stiffness=numbers(state.springs), damping=numbers(made.damping), frictionloss=numbers(state.friction),
        solreffriction=numbers(2.0 * model.step, 1.0), solimpfriction=_STIFF_FRICTION,
    )  # fmt: skip
    _load(moving, model.load)
    tendons = Xml.SubElement(root, "tendon")
    for hinge in made.hinges:
        _hinge(base, hinge)
    for spring in made.springs:
        _spring(tendons, spring)
    angles = held_angles(state, made, model.released_from)
    order = (JOINT, *(hinge.name for hinge in made.hinges))
    keys = Xml.SubElement(root, "keyframe")
    Xml.SubElement(keys, "key", name="held", qpos=numbers(*(angles[name] for name in order)))
    return document(root)


def _merged(model: JointModel, state: JointState, made: MaxwellHinges) -> list[str]:
    """Return what of the PCL the time step leaves, and what the keyframe is."""
    return [
        f"With this time step {made.merged} of {len(state.modes)} elements are plain damping: they relax within two "
        "steps. Write the files again with --timestep for another one.",
        f"Keyframe held: turned to {model.released_from:.4g} rad at once and held there for {state.hold:g} s.",
    ]


def _body(parent: Xml.Element, body: RigidBody) -> Xml.Element:
    """Return a body with its mass properties; its mesh is only to be seen."""
    element = Xml.SubElement(parent, "body", name=body.name)
    tensor = body.inertia
    order = ((0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2))
    Xml.SubElement(
        element, "inertial", pos=numbers(*body.centre), mass=numbers(body.mass),
        fullinertia=numbers(*(tensor[row][column] for row, column in order)),
    )  # fmt: skip
    Xml.SubElement(
        element, "geom", name=body.name, type="mesh", mesh=body.name, mass="0", contype="0", conaffinity="0", group="1"
    )
    return element


def _hinge(parent: Xml.Element, hinge: Hinge) -> None:
    carrier = Xml.SubElement(parent, "body", name=hinge.name)
    Xml.SubElement(
        carrier, "inertial", pos="0 0 0", mass=numbers(_NEARLY_NOTHING), diaginertia=numbers(*[_NEARLY_NOTHING] * 3)
    )
    Xml.SubElement(
        carrier, "joint", name=hinge.name, type="hinge", axis="0 0 1", damping=numbers(hinge.damping),
        armature=numbers(hinge.armature),
    )  # fmt: skip


def _spring(parent: Xml.Element, spring: Spring) -> None:
    slack = numbers(-_FAR, 0.0) if spring.pushes else "0"
    tendon = Xml.SubElement(
        parent, "fixed", name=spring.name, stiffness=numbers(spring.stiffness), springlength=slack
    )  # fmt: skip
    for name, coefficient in spring.coefficients.items():
        Xml.SubElement(tendon, "joint", joint=name, coef=numbers(coefficient))


def _load(parent: Xml.Element, inertia: float) -> None:
    """Write the load that the study puts on the bench: a body to replace by a user's own link."""
    if inertia <= 0.0:
        return
    parent.append(comment(["The load of the bench: take this body out where a link of your own is attached."]))
    load = Xml.SubElement(parent, "body", name="load")
    Xml.SubElement(
        load, "inertial", pos="0 0 0", mass=numbers(_NEARLY_NOTHING),
        diaginertia=numbers(_ACROSS * inertia, _ACROSS * inertia, inertia),
    )  # fmt: skip


_NO_STIFFNESS = (
    "URDF has no stiffness of a joint: the file has the damping and friction of the state; the stiffness is in "
    "states.csv."
)


def urdf(model: JointModel, state: JointState) -> str:
    """Return one state of the joint as a URDF file."""
    root = Xml.Element("robot", name=f"{model.slug}_{state.point}")
    root.append(comment([*header(model, state), _NO_STIFFNESS]))
    for body in (model.base, model.moving):
        _link(root, body)
    joint = Xml.SubElement(root, "joint", name=JOINT, type="revolute")
    Xml.SubElement(joint, "origin", xyz="0 0 0", rpy="0 0 0")
    Xml.SubElement(joint, "parent", link=model.base.name)
    Xml.SubElement(joint, "child", link=model.moving.name)
    Xml.SubElement(joint, "axis", xyz="0 0 1")
    Xml.SubElement(
        joint, "limit", lower=numbers(-model.stop_angle), upper=numbers(model.stop_angle),
        effort=numbers(model.holding_torque), velocity=numbers(model.quickest),
    )  # fmt: skip
    Xml.SubElement(joint, "dynamics", damping=numbers(state.damping), friction=numbers(state.friction))
    return document(root)


def _link(root: Xml.Element, body: RigidBody) -> None:
    link = Xml.SubElement(root, "link", name=body.name)
    inertial = Xml.SubElement(link, "inertial")
    Xml.SubElement(inertial, "origin", xyz=numbers(*body.centre), rpy="0 0 0")
    Xml.SubElement(inertial, "mass", value=numbers(body.mass))
    (xx, xy, xz), (_, yy, yz), (_, _, zz) = body.inertia
    Xml.SubElement(
        inertial, "inertia", ixx=numbers(xx), ixy=numbers(xy), ixz=numbers(xz), iyy=numbers(yy), iyz=numbers(yz),
        izz=numbers(zz),
    )  # fmt: skip
    visual = Xml.SubElement(link, "visual")
    Xml.SubElement(visual, "origin", xyz="0 0 0", rpy="0 0 0")
    Xml.SubElement(Xml.SubElement(visual, "geometry"), "mesh", filename=body.mesh)
