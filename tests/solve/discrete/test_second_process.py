"""Two processes find what one finds, to the last bit; one that dies leaves its tasks to the other."""

from types import SimpleNamespace
from typing import Any

import psutil
import pytest

from tvimdesign.base.child_process import PARENT
from tvimdesign.base.deadline import Deadline
from tvimdesign.solve.discrete import second_process
from tvimdesign.solve.discrete.box_tasks import Answer, Task
from tvimdesign.solve.discrete.second_process import ParallelSolver
from tvimdesign.solve.discrete.trees import ProblemSpec
from tvimdesign.solve.nlp.solution import Choosing
from tvimdesign.solve.search import optimize
from tvimdesign.study import Study, read_study_text

STUDY = """
mode: shear
module: {transmission: unity}
vary:
  spring_material: {choose: [music_wire, stainless_302]}
  wire_diameter: {catalog: metric, from: 2.2 mm, to: 2.8 mm}
  coil_count: {from: 3, to: 5, step: 0.5}
  coil_diameter: [12 mm, 30 mm]
  pcl_outer_radius: [32 mm, 40 mm]
  current: [0.3 A, 2 A]
require:
  spring_stiffness: ">= 5 N.m/rad"
  holding_torque: ">= 12 N.m"
accept: [peltier_temperature_margin, structure_temperature_margin, stiffening_structure_margin, current_margin]
minimize: {envelope_volume: 1, module_mass: 1, response_time: 1}
solver: {starts: 1, cells: 6, fineness: 0.67, alternatives: 3}
"""


@pytest.fixture(scope="module")
def study() -> Study:
    """Forty combinations or so."""
    return read_study_text(STUDY, "a test")


@pytest.fixture(scope="module")
def alone(study: Study) -> Choosing:
    """Return the result of one process."""
    found = optimize(study).choosing
    assert found is not None
    return found


def _by_two(study: Study, monkeypatch: pytest.MonkeyPatch) -> Choosing:
    monkeypatch.setattr(second_process, "WORTH", 1)
    monkeypatch.delenv(PARENT, raising=False)
    monkeypatch.setattr("os.cpu_count", lambda: 2)
    found = optimize(study).choosing
    assert found is not None
    return found


@pytest.mark.gate
def test_two_processes_find_what_one_finds(study: Study, alone: Choosing, monkeypatch: pytest.MonkeyPatch) -> None:
    used: list[Task] = []
    use = ParallelSolver._used

    def counted(self: ParallelSolver, task: Task) -> Answer:
        used.append(task)
        return use(self, task)

    monkeypatch.setattr(ParallelSolver, "_used", counted)
    together = _by_two(study, monkeypatch)
    assert used  # the other process had a share; how large a one depends on the machine
    assert [one.objective for one in together.best] == [one.objective for one in alone.best]
    assert [one.choices for one in together.best] == [one.choices for one in alone.best]
    assert together.work == alone.work
    assert (together.solved, together.pruned) == (alone.solved, alone.pruned)


@pytest.mark.gate
def test_a_process_that_dies_leaves_its_tasks(
    study: Study, alone: Choosing, monkeypatch: pytest.MonkeyPatch
) -> None:  # fmt: skip
    rounds: list[int] = []
    solve, children = ParallelSolver.solve, []

    def dying(self: ParallelSolver, tasks: list[Task], ahead: list[Task]) -> list[Answer]:
        rounds.append(len(tasks))
        children.append(self._child)
        if len(rounds) == 2:
            self._child.kill()
        return solve(self, tasks, ahead)

    monkeypatch.setattr(ParallelSolver, "solve", dying)
    together = _by_two(study, monkeypatch)
    assert len(rounds) > 2
    assert [one.objective for one in together.best] == [one.objective for one in alone.best]
    assert not psutil.pid_exists(children[0].pid)


def test_none_is_started_in_a_child_of_ours_nor_for_a_few_combinations(
    study: Study, monkeypatch: pytest.MonkeyPatch
) -> None:
    started: list[Any] = []
    monkeypatch.setattr(second_process, "ParallelSolver", started.append)
    monkeypatch.setattr("os.cpu_count", lambda: 2)
    deadline = Deadline(10.0)
    monkeypatch.setenv(PARENT, "1")
    second_process.second_process(study, None, (), deadline, second_process.WORTH)
    monkeypatch.delenv(PARENT)
    second_process.second_process(study, None, (), deadline, second_process.WORTH - 1)
    assert not started
    second_process.second_process(study, None, (), deadline, second_process.WORTH)
    assert len(started) == 1


def test_no_wait_for_the_other_process_s_task_once_time_is_up(monkeypatch: pytest.MonkeyPatch) -> None:
    class Tree:
        optimizer = SimpleNamespace(deadline=Deadline(0.0, lambda: 0.0))

        def best_within(self, _box: Any, _near: Any) -> tuple[None, bool]:
            return None, False

    monkeypatch.setattr(second_process, "start_child", lambda *_, **__: None)
    monkeypatch.setattr(ParallelSolver, "_write", lambda *_: None)
    both: Any = ParallelSolver(ProblemSpec("", None, (), 0.0))
    both._trees, task = [Tree()], Task(0, ((0, 0),), None, "within")
    both._under_way = task  # and never answered
    assert both.solve([task]) == [Answer(None, certain=False)]
