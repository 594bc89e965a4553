"""The joint by temperatures of its parts: what is alike warm is one column, and a molten film is in series."""

import numpy as np
import pytest
from support import ROOT

from tvimdesign.cad.fe.warm_joint import WarmJoint, softening_time
from tvimdesign.simulation.working_cycle.resolved_module import resolve_study
from tvimdesign.study import read_study

NAMES = ("paper_reconstructed", "paper_compression")


def joint_of(name: str) -> WarmJoint:
    module = resolve_study(read_study(ROOT / f"studies/{name}.yaml"))
    return WarmJoint(module.table, module.values)


@pytest.mark.parametrize("name", NAMES)
def test_alike_columns_are_one_and_molten_ones_are_soft(name: str) -> None:
    joint = joint_of(name)
    parts = joint.parts(23.0, 23.0, np.full(8, 23.0), 100.0, 23.0)
    one = joint.stiffness(np.full((1, 4), 100.0), np.ones(1), np.full(4, 0.25), parts)
    many = joint.stiffness(np.full((3, 8), 100.0), np.array([0.2, 0.3, 0.5]), np.full(8, 0.125), parts)
    assert many == pytest.approx(one, rel=1e-12)
    parts = joint.parts(23.0, 23.0, np.full(8, 23.0), 23.0, 23.0)
    alone = float(joint.quantity["spring_stiffness"])
    frozen, molten = (joint.stiffness(np.full((1, 4), at), np.ones(1), np.full(4, 0.25), parts) for at in (23.0, 120.0))
    held = 1.0 / sum(joint.quantity["structure_compliances"]) if name == NAMES[0] else frozen
    assert frozen == pytest.approx(alone + held, rel=0.05)
    assert alone < molten < 0.2 * frozen


def test_a_molten_film_is_in_series_and_uneven_blocks_are_refused() -> None:
    joint = joint_of(NAMES[0])
    parts = joint.parts(23.0, 23.0, np.full(8, 23.0), 23.0, 23.0)
    shares, slices = np.ones(1), np.array([0.1, 0.9])
    alone = float(joint.quantity["spring_stiffness"])
    whole, film = (joint.stiffness(np.array([[120.0, other]]), shares, slices, parts) for other in (120.0, 23.0))
    # Ten times as stiff as the whole layer molten, but for what structure and frozen rest give.
    assert film - alone == pytest.approx(10.0 * (whole - alone), rel=0.15)
    # `block.soft_share` counts slices: thin ones in the melt would make more of it than there is.
    joint = joint_of(NAMES[1])
    parts = joint.parts(23.0, 23.0, np.full(8, 23.0), 23.0, 23.0)
    with pytest.raises(ValueError, match="alike"):
        joint.stiffness(np.full((1, 2), 100.0), np.ones(1), np.array([0.1, 0.9]), parts)


def test_the_time_is_where_the_stiffness_passes_its_limit() -> None:
    joint = joint_of(NAMES[0])
    times, celsius = np.linspace(0.0, 100.0, 201), np.linspace(22.0, 122.0, 201)
    course = {
        "times": times, "columns": celsius[:, None, None] * np.ones((1, 2, 4)), "shares": np.full(2, 0.5),
        "slices": np.full(4, 0.25), "core": np.full(201, 23.0), "edge": np.full(201, 23.0),
        "plate": np.full((201, 8), 23.0), "hot": celsius, "cold": np.full(201, 23.0),
    }  # fmt: skip
    found = softening_time(joint, course)
    at = np.full((2, 4), np.interp(found, times, celsius))
    parts = joint.parts(23.0, 23.0, np.full(8, 23.0), float(at[0, 0]), 23.0)
    assert joint.stiffness(at, course["shares"], course["slices"], parts) == pytest.approx(joint.soft, rel=2e-3)
    cold = {**course, "columns": np.full((201, 2, 4), 22.0)}
    assert softening_time(joint, cold) == np.inf
