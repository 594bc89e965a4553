"""The current of a phase as the optimiser frees it: its range, its pieces, its slew."""

from __future__ import annotations

from tvimdesign.simulation.working_cycle.device_functions import DeviceFunctions
from tvimdesign.solve.nlp.problem_parts import FreeCurrent
from tvimdesign.solve.optimizer.optimizer import Optimizer
from tvimdesign.study import given, read_study_text

STUDY = """
mode: shear
module: {current_slew: %s A/s}
vary: {current: [0.5 A, 2 A], cooling_current: [0.1 A, 0.9 A]}
minimize: module_mass
profile: {softening: 3, stiffening: 2}
"""


def freed(slew: str, phase: str, pieces: int) -> FreeCurrent:
    """Return the current of a phase, without a problem around it."""
    optimizer = object.__new__(Optimizer)
    optimizer.study = read_study_text(STUDY % slew, "a test")
    optimizer.table = optimizer.study.table
    points = tuple(optimizer.study.operating_points)
    optimizer.model = DeviceFunctions(optimizer.table, given(optimizer.study), points, 4)
    return optimizer._current(phase, pieces)


def test_each_phase_frees_its_own_current_between_the_study_s_bounds() -> None:
    assert freed("2", "softening", 3) == FreeCurrent("softening", "current", 3, 0.5, 2.0, 2.0)
    assert freed("2", "stiffening", 2) == FreeCurrent("stiffening", "cooling_current", 2, 0.1, 0.9, 2.0)
