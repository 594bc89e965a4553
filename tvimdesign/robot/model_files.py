"""The joint as MJCF, URDF and SDF files and as a `ros2_control` description, and how their XML is written.

The PCL of a state as hinges, dampers and springs, which is all that a simulator of rigid bodies has.

A Maxwell element (relaxation time tau, stiffness k) is a hinge that nothing but a damper k tau holds, and a spring k
between it and the link: k (phi - q) = k tau dq/dt. Elements that relax within two time steps are plain damping.

Blocks that only push have a face each: a hinge that a spring joins to the link only where it is pressed, with the
elements between the face and the housing. That spring is taken out of the elements (`without_spring`), so that a block
that touches is as stiff, and relaxes, as it does in `physics/motions/one_sided.py`.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any
from xml.etree import ElementTree as Xml

import numpy as np
from numpy.typing import NDArray

from tvimdesign.physics.motions.motion import Modes
from tvimdesign.robot.joint_model import JointModel, JointState, RigidBody, header


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


_NEARLY_NOTHING = 1e-14  # Inertia of a body that only carries a hinge [kg*m^2], a little above MuJoCo's least
_ACROSS = 0.6
"""Inertia of the bench's load across the axis over that about it: nobody gave it, and a body has more than a half."""
_FAR = 1e3  # Angle [rad] that no joint reaches: so far a spring that only pushes is slack
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
    tendon = Xml.SubElement(parent, "fixed", name=spring.name, stiffness=numbers(spring.stiffness), springlength=slack)
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


def sdf(model: JointModel, state: JointState) -> str:
    """Return one state of the joint as an SDF file; the joint has the state's stiffness and damping (Kelvin-Voigt)."""
    root = Xml.Element("sdf", version="1.7")
    root.append(comment([*header(model, state), _ONE_FREQUENCY]))
    whole = Xml.SubElement(root, "model", name=f"{model.slug}_{state.point}")
    for body in (model.base, model.moving):
        link = Xml.SubElement(whole, "link", name=body.name)
        (xx, xy, xz), (_, yy, yz), (_, _, zz) = body.inertia
        inertial = _with_texts(link, "inertial", pose=numbers(*body.centre, 0.0, 0.0, 0.0), mass=numbers(body.mass))
        tensor = {"ixx": xx, "ixy": xy, "ixz": xz, "iyy": yy, "iyz": yz, "izz": zz}
        _with_texts(inertial, "inertia", **{name: numbers(value) for name, value in tensor.items()})
        visual = Xml.SubElement(link, "visual", name=body.name)
        _with_texts(Xml.SubElement(visual, "geometry"), "mesh", uri=body.mesh)
    joint = _with_texts(whole, "joint", parent=model.base.name, child=model.moving.name)
    joint.attrib.update(name=JOINT, type="revolute")
    axis = _with_texts(joint, "axis", xyz="0 0 1")
    limits = {"lower": -model.stop_angle, "upper": model.stop_angle, "effort": model.holding_torque}
    _with_texts(axis, "limit", **{name: numbers(value) for name, value in limits.items()})
    _with_texts(
        axis, "dynamics", damping=numbers(state.damping), friction=numbers(state.friction),
        spring_reference="0", spring_stiffness=numbers(state.stiffness),
    )  # fmt: skip
    return document(root)


def _with_texts(owner: Xml.Element, kind: str, **texts: str) -> Xml.Element:
    element = Xml.SubElement(owner, kind)
    for own, text in texts.items():
        Xml.SubElement(element, own).text = text
    return element


_ONE_FREQUENCY = "Stiffness and damping are those of the whole joint at the state's frequency; nothing relaxes."


def ros2_control(model: JointModel) -> str:
    """Return the `ros2_control` description: the joint commanded by its stiffness, which heaters change.

    A robot's URDF includes it; in place of its mock stands the plugin of the heaters' driver.
    """
    root = Xml.Element("robot", name=model.slug)
    system = Xml.SubElement(root, "ros2_control", name=model.slug, type="system")
    _with_texts(system, "hardware", plugin="mock_components/GenericSystem")
    joint = Xml.SubElement(system, "joint", name=JOINT)
    command = Xml.SubElement(joint, "command_interface", name="impedance")
    stiffnesses = [state.stiffness for state in model.states]
    for name, value in (("min", min(stiffnesses)), ("max", max(stiffnesses))):
        Xml.SubElement(command, "param", name=name).text = numbers(value)
    for name in ("position", "velocity", "effort", "temperature", "stiffness"):
        Xml.SubElement(joint, "state_interface", name=name)
    return document(root)


JOINT = "joint"  # Name of the joint in every model
MERGED_STEPS = 2.0
"""Elements that relax within so many steps are plain damping: explicit steps of them would not be stable."""
LONGEST = 1e6  # Relaxation time [s] of what does not relax: eleven days
IDLE_DAMPING = 1e-3  # Damping of a hinge that bears nothing [N*m*s/rad]: it must be held by something
ARMATURE_SHARE = 1e-4  # Inertia of an element's hinge over that of what moves
CONTACT_RATIO = 4.0  # Stiffness of the spring between link and face over that of the block before anything relaxes
SIDES = (("ahead", 1.0), ("behind", -1.0))  # The blocks against positive and against negative angles


@dataclass(frozen=True)
class Hinge:
    """A hinge about the joint's axis that carries nothing."""

    name: str
    damping: float  # [N*m*s/rad]
    armature: float  # Its own inertia [kg*m^2]


@dataclass(frozen=True)
class Spring:
    """A spring between two angles, or one that acts only where its angle is above zero."""

    name: str
    stiffness: float  # [N*m/rad]
    coefficients: Mapping[str, float]  # Its angle is the sum of these times the angles of the named hinges
    pushes: bool = False  # True if it acts only where its angle is above zero


@dataclass(frozen=True)
class MaxwellHinges:
    """All that the PCL of a state is made of, for one time step."""

    hinges: tuple[Hinge, ...]
    springs: tuple[Spring, ...]
    damping: float  # Of the joint itself, from elements that are merged [N*m*s/rad]
    merged: int  # How many of each side's elements those are


def maxwell_hinges(state: JointState, count: int, step: float) -> MaxwellHinges:
    """Return the PCL of a state for a time step [s]; `count` elements, so that every state has the same hinges."""
    armature = ARMATURE_SHARE * state.inertia
    if not state.one_sided:
        hinges, springs, damping, merged = _elements(state.modes, count, step, armature, (JOINT, "pcl", 1.0))
        return MaxwellHinges(tuple(hinges), tuple(springs), damping, merged)
    contact = CONTACT_RATIO * sum(stiffness for _, stiffness in state.modes)
    modes = without_spring(state.modes, contact)
    whole = contact + sum(stiffness for _, stiffness in modes)
    faces: list[Hinge] = []
    hinges, springs, merged = [], [], 0
    for name, sense in SIDES:
        face = f"face_{name}"
        carried, between, damping, merged = _elements(modes, count, step, armature, (face, f"pcl_{name}", sense))
        # Explicit steps of a face on its springs are stable while w dt < 2: it has the inertia for w dt = 1.
        faces.append(Hinge(face, damping, whole * step**2))
        springs.append(Spring(f"contact_{name}", contact, {JOINT: sense, face: -sense}, pushes=True))
        hinges += carried
        springs += between
    return MaxwellHinges((*faces, *hinges), tuple(springs), 0.0, merged)


def _elements(
    modes: Modes, count: int, step: float, armature: float, to: tuple[str, str, float]
) -> tuple[list[Hinge], list[Spring], float, int]:
    """Return hinges and springs of elements behind a hinge, what is merged as its damping, and how many that are."""
    carrier, name, sense = to
    hinges, springs, damping, merged = [], [], 0.0, 0
    for index in range(count):
        time, stiffness = modes[index] if index < len(modes) else (0.0, 0.0)
        if time < MERGED_STEPS * step:
            damping += stiffness * time
            merged += index < len(modes)
            time, stiffness = 0.0, 0.0
        own = f"{name}_{index + 1}"
        hinges.append(Hinge(own, stiffness * min(time, LONGEST) or IDLE_DAMPING, armature))
        springs.append(Spring(own, stiffness, {carrier: sense, own: -sense}))
    return hinges, springs, damping, merged


def without_spring(modes: Modes, spring: float) -> Modes:
    """Return Maxwell elements that in series with a stiffer spring [N*m/rad] are the given ones.

    With b = 1/(1 - sum k/S) and u = sqrt(k/tau) the rates are the eigenvalues x of diag(1/tau) + b/S u u^T, and an
    element has the stiffness b^2 (u.v)^2/x with its eigenvector v.
    """
    times, stiffnesses = np.array(modes, dtype=float).T
    ratio = 1.0 / (1.0 - float(np.sum(stiffnesses)) / spring)
    weights = np.sqrt(stiffnesses / times)
    rates, vectors = np.linalg.eigh(np.diag(1.0 / times) + ratio / spring * np.outer(weights, weights))
    # The slowest rate of PCL that does not relax is lost in rounding: no rate is below the slowest given one.
    rates = np.maximum(rates, 1.0 / np.max(times))
    strengths = ratio**2 * (weights @ vectors) ** 2 / rates
    return [(float(1.0 / rate), float(stiffness)) for rate, stiffness in zip(rates, strengths, strict=True)]


def held_angles(state: JointState, made: MaxwellHinges, angle: float) -> dict[str, float]:
    """Return all hinges' angles [rad] after the link was turned to a positive angle at once and held for `hold`."""
    if not state.one_sided:
        return _relaxed(made, JOINT, "pcl", angle, state.hold)
    return {**{hinge.name: 0.0 for hinge in made.hinges}, **_pressed(made, angle, state.hold), JOINT: angle}


def _relaxed(made: MaxwellHinges, carrier: str, name: str, angle: float, hold: float) -> dict[str, float]:
    """Return hinge angles of elements whose carrier is held: q = phi (1 - exp(-t/tau))."""
    damping = {hinge.name: hinge.damping for hinge in made.hinges}
    own = [spring for spring in made.springs if spring.name.startswith(f"{name}_")]
    return {
        carrier: angle,
        **{
            element.name: angle * -float(np.expm1(-hold * element.stiffness / damping[element.name])) for element in own
        },
    }


def _pressed(made: MaxwellHinges, angle: float, hold: float) -> dict[str, float]:
    """Return face and hinges of the block ahead, behind its contact spring."""
    from scipy.linalg import expm

    damping = {hinge.name: hinge.damping for hinge in made.hinges}
    contact = next(spring for spring in made.springs if spring.name == "contact_ahead")
    own = [spring for spring in made.springs if spring.name.startswith("pcl_ahead_")]
    stiffness, held_by = np.array([(element.stiffness, damping[element.name]) for element in own]).T
    # Without inertia the face stands where its springs agree: (S phi + sum k q)/(S + sum k).
    whole = contact.stiffness + float(np.sum(stiffness))
    matrix = np.zeros((len(own) + 1, len(own) + 1))
    matrix[:-1, :-1] = (np.outer(stiffness, stiffness) / whole - np.diag(stiffness)) / held_by[:, None]
    matrix[:-1, -1] = stiffness * contact.stiffness / whole / held_by
    angles: NDArray[np.float64] = (expm(matrix * hold) @ np.append(np.zeros(len(own)), angle))[:-1]
    face = (contact.stiffness * angle + float(stiffness @ angles)) / whole
    return {"face_ahead": face, **{element.name: float(q) for element, q in zip(own, angles, strict=True)}}
