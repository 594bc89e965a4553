"""A limit on what is the least of several is one on each: IPOPT goes to and fro over a kink of the least."""

from __future__ import annotations

import pytest

from tvimdesign.device.core.impedance.structure_stiffness import CORE_PARTS
from tvimdesign.solve.nlp.constraints import constraints_of
from tvimdesign.solve.optimizer.optimizer import Optimizer
from tvimdesign.study import given, read_study_text

STUDY = """
mode: {mode}
vary: {{current: [0.5 A, 2.5 A], core_radius: [7 mm, 16 mm], coil_count: [3, 8], link_thickness: [3 mm, 8 mm]}}
minimize: {{switch_energy: 1, peak_power: 1}}
require: {{holding_torque: ">= 10.8 N.m"}}
solver: {{cells: 6, starts: 1}}
"""


@pytest.mark.parametrize("mode", ["shear", "compression"])
def test_a_torque_limit_applies_at_the_core_s_foot_and_at_all_holes(mode: str) -> None:
    study = read_study_text(STUDY.format(mode=mode), "test")
    limited = {limit.output for limit in constraints_of(study, study.table)}
    assert set(CORE_PARTS) < limited
    assert not {"core_holding_torque", "holding_torque"} & limited
    parts = study.table.evaluate(given(study), [*CORE_PARTS, "core_holding_torque"])
    assert parts["core_holding_torque"] == min(parts[name] for name in CORE_PARTS)


def test_a_search_over_the_kink_between_foot_and_holes_ends() -> None:
    """As one limit on the core it runs out of 300 iterations; its foot and its holes apart take some thirty."""
    run = Optimizer(read_study_text(STUDY.format(mode="shear").replace("[7 mm", "[6 mm"), "test")).solve()
    assert run.start.converged
    assert run.start.iterations < 100
