"""A URDF parser takes the file, and reads the bodies and the joint as they were written."""

from __future__ import annotations

import pytest
from robot_models import model_of, module_of
from urdf_parser_py import xml_reflection
from urdf_parser_py.urdf import URDF

from tvimdesign.report.robot.model_files import urdf


def _refuse(message: str) -> None:
    raise AssertionError(message)


def test_a_parser_reads_the_bodies_and_the_joint(mode: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(xml_reflection.core, "on_error", _refuse)
    model = model_of(mode)
    state = model.states[-1]
    read = URDF.from_xml_string(urdf(model, state).encode())
    read.check_valid()
    assert read.get_root() == "base"
    moving, joint = read.link_map["moving"], read.joint_map["joint"]
    assert moving.inertial.mass == pytest.approx(model.moving.mass)
    assert moving.inertial.origin.xyz == pytest.approx(list(model.moving.centre))
    tensor = moving.inertial.inertia.to_matrix()
    assert tensor == [pytest.approx(list(row)) for row in model.moving.inertia]
    assert moving.visual.geometry.filename == "moving.stl"
    assert (joint.type, joint.parent, joint.child, list(joint.axis)) == ("revolute", "base", "moving", [0.0, 0.0, 1.0])
    assert (joint.limit.lower, joint.limit.upper) == pytest.approx((-model.stop_angle, model.stop_angle))
    assert joint.limit.effort == pytest.approx(float(module_of(mode).quantity("holding_torque")))
    assert joint.dynamics.damping == pytest.approx(float(module_of(mode).quantity(f"joint_damping@{state.point}")))
