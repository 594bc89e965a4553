"""Trial points of searches: at modules, never where a body of the heat equation has a conductance below zero."""

from __future__ import annotations

from support import ROOT

from tvimdesign.solve.optimizer.optimizer import Optimizer
from tvimdesign.study import read_study, read_study_text

STUDY = """
mode: shear
vary:
  core_radius: [6 mm, 30 mm]
  pcl_inner_radius: [15 mm, 30 mm]
  placement_radius: [30 mm, 60 mm]
minimize: response_time
solver: {starts: 8}
"""


def test_no_search_begins_with_a_core_wider_than_the_layer_s_inner_edge() -> None:
    """Nor with a wall inside the rotor's rim: heat would flow from cold to hot there."""
    optimizer = Optimizer(read_study_text(STUDY, "test"))
    place = optimizer.model.index
    begins = list(optimizer.multistart.points())
    assert len(begins) == 8
    for begin in begins:
        values = optimizer.model.values(begin, optimizer.multistart.cycle)
        assert begin[place["core_radius"]] < begin[place["pcl_inner_radius"]]
        assert values["rotor_radius"] < values["housing_inner_radius"]
    assert optimizer.multistart.passed_over["no such module"] > 0


def test_starts_of_a_module_with_links_that_correct_others_differ() -> None:
    # A link that corrects another is below zero at the study's start, too: no reason to pass over a point.
    study = read_study(ROOT / "studies/wrist_compression.yaml")
    study = study.model_copy(update={"solver": study.solver.model_copy(update={"starts": 3})})
    multistart = Optimizer(study).multistart
    begins = list(multistart.points())
    assert not multistart.heats(begins[0])
    assert len({begin.tobytes() for begin in begins}) == 3
    assert all(multistart.trial(begin) is not None for begin in begins)
