"""The joint as a URDF file: two links, a revolute joint with limits, damping and friction.

URDF has no stiffness: a client that reads it puts springs and PCL on the joint by states.csv or temperatures.csv.
"""

from __future__ import annotations

from xml.etree import ElementTree as Xml

from tvimdesign.robot.joint_model import JointModel, header
from tvimdesign.robot.joint_state import JointState
from tvimdesign.robot.maxwell_hinges import JOINT
from tvimdesign.robot.rigid_bodies import RigidBody
from tvimdesign.robot.xml_text import comment, document, numbers

_NO_STIFFNESS = (
    "URDF has no stiffness of a joint: the file has the damping and friction of the state; the stiffness is in "
    "states.csv."
)


def urdf(model: JointModel, state: JointState) -> str:
    """One state of the joint as a URDF file."""
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
        joint, "limit", lower=numbers(-model.stroke), upper=numbers(model.stroke),
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
