"""The joint as MJCF, URDF and SDF files and as a `ros2_control` description, from templates.

The PCL of a state as hinges, dampers and springs, which is all that a simulator of rigid bodies has.

A Maxwell element (relaxation time tau, stiffness k) is a hinge that nothing but a damper k tau holds, and a spring k
between it and the link: k (phi - q) = k tau dq/dt. Elements that relax within two time steps are plain damping.

Blocks that only push have a face each: a hinge that a spring joins to the link only where it is pressed, with the
elements between the face and the housing. That spring is taken out of the elements (`without_spring`), so that a block
that touches is as stiff, and relaxes, as it does in `physics/motions/one_sided.py`.
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tvimdesign.base.record import own_template
from tvimdesign.physics.motions.motion import Modes
from tvimdesign.robot.joint_model import JointModel, JointState, header

JOINT = "joint"  # Name of the joint in every model


def numbers(values: float | Sequence[float]) -> str:
    """Format a number or several for an attribute, to ten digits."""
    return " ".join(f"{value:.10g}" for value in np.ravel(values).tolist())


def comment(lines: Sequence[str]) -> str:
    """Format lines as a comment; two hyphens, which XML does not allow in one, become one."""
    from markupsafe import Markup

    return Markup(f"<!--\n{re.sub('-+', '-', chr(10).join(lines))}\n-->")


def document(template: str, **parts: Any) -> str:
    """Return a whole file from its template; an apostrophe may stand as it is between quotes."""
    made = own_template(__file__, f"{template}.xml.jinja", numbers=numbers, comment=comment)
    return str(made.render(joint=JOINT, **parts)).replace("&#39;", "'") + "\n"


_NEARLY_NOTHING = 1e-14  # Inertia of a body that only carries a hinge [kg*m^2], a little above MuJoCo's least
_ACROSS = 0.6
"""Inertia of the bench's load across the axis over that about it: nobody gave it, and a body has more than a half."""
_FAR = 1e3  # Angle [rad] that no joint reaches: so far a spring that only pushes is slack


def mjcf(model: JointModel, state: JointState) -> str:
    """Return one state of the joint as an MJCF file."""
    made = maxwell_hinges(state, model.count, model.step)
    angles = held_angles(state, made, model.released_from)
    lines = [
        *header(model, state),
        f"With this time step {made.merged} of {len(state.modes)} elements are plain damping: they relax within two "
        "steps. Write the files again with --timestep for another one.",
        f"Keyframe held: turned to {model.released_from:.4g} rad at once and held there for {state.hold:g} s.",
    ]
    return document(
        "mjcf", model=model, state=state, made=made, lines=lines, nearly_nothing=_NEARLY_NOTHING, across=_ACROSS,
        far=_FAR, held=[angles[name] for name in (JOINT, *(hinge.name for hinge in made.hinges))],
    )  # fmt: skip


def urdf(model: JointModel, state: JointState) -> str:
    """Return one state of the joint as a URDF file."""
    lacking = (
        "URDF has no stiffness of a joint: the file has the damping and friction of the state; the stiffness is in "
        "states.csv."
    )
    return document("urdf", model=model, state=state, lines=[*header(model, state), lacking])


def sdf(model: JointModel, state: JointState) -> str:
    """Return one state of the joint as an SDF file; the joint has the state's stiffness and damping (Kelvin-Voigt)."""
    what = "Stiffness and damping are those of the whole joint at the state's frequency; nothing relaxes."
    return document("sdf", model=model, state=state, lines=[*header(model, state), what])


def ros2_control(model: JointModel) -> str:
    """Return the `ros2_control` description: the joint commanded by its stiffness, which heaters change.

    A robot's URDF includes it; in place of its mock stands the plugin of the heaters' driver.
    """
    return document("ros2_control", model=model)


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
