"""Pieces of work: each in a process of its own with a time-out, done again only where something it read has changed."""

import gc
import os
import pickle
import shutil
import signal
import subprocess
import sys
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import psutil
import pytest
from cad_designs import design_of, whole
from support import ROOT, are_gone, is_at_work

from tvimdesign.base.errors import GeometryError
from tvimdesign.cad import make_cad
from tvimdesign.cad.cad_report import SolidCheck
from tvimdesign.cad.geometry.dimensions import dimensions
from tvimdesign.cad.jobs.build_plan import build_plan
from tvimdesign.cad.jobs.cache import Cache, Result, TrackedDesign
from tvimdesign.cad.jobs.worker import Done, Job, Turn, Work, WorkerPool
from tvimdesign.study.design import Design, write_design

Run = Callable[..., Done]
TITLES = {"structure_material": "PETG"}


def plate(job: Job) -> list[SolidCheck]:
    (job.folder / "out/plate.txt").write_text(f"{job.dims.link_thickness:.3f}")
    (job.folder / "kept/thickness").write_text(f"{round(job.dims.link_thickness)}")
    return [SolidCheck("plate", 0.0, 1.0, True, "plate")]


def thickness(job: Job) -> list[SolidCheck]:
    (job.folder / "out/layer.txt").write_text(f"{job.dims.pcl_thickness:.3f}")
    return []


def stack(job: Job) -> list[SolidCheck]:
    (job.folder / "out/stack.txt").write_text((job.needs["plate"] / "thickness").read_text() + job.design.name)
    return []


def never_ends(_: Job) -> list[SolidCheck]:
    while True:
        pass


def crashes(_: Job) -> list[SolidCheck]:
    os.kill(os.getpid(), signal.SIGKILL)
    return []


def refuses(_: Job) -> list[SolidCheck]:
    raise GeometryError("bore is -1 mm; it must be above zero")


def by_whom(job: Job) -> list[SolidCheck]:
    (job.folder / f"out/{job.folder.parent.name}.txt").write_text(str(os.getpid()))
    return []


def collects(job: Job) -> list[SolidCheck]:
    (job.folder / "out/collects.txt").write_text(str(gc.isenabled()))
    return []


PLATE, STACK = Work(name="plate", do=plate), Work(name="stack", do=stack, needs=("plate",), named=True)


@pytest.fixture
def run(tmp_path: Path) -> Run:
    def do(*wanted: Work, design: Design | None = None, limit: float = 600.0, **changed: float) -> Done:
        base = design or design_of("toy", {})
        subject = TrackedDesign(base.model_copy(update={"values": base.values | changed}), TITLES)
        return WorkerPool(subject, Cache(tmp_path / "kept"), lambda _: None, limit, workers=2).do(wanted)

    return do


def text(done: Done, name: str) -> str:
    folder = done.results[name].folder / "out"
    return (folder / f"{name}.txt").read_text()


def test_work_is_done_in_order_and_only_what_changed_again(run):
    first = run(STACK, PLATE)
    assert first.reused == []
    assert text(first, "stack") == "4toy"
    assert first.results["plate"].checks[0].name == "plate"
    again = run(STACK, PLATE)
    assert set(again.reused) == {"plate", "stack"}
    assert again.results["plate"].checks == first.results["plate"].checks
    run(PLATE, STACK)
    assert set(run(PLATE, STACK, core_radius=0.011).reused) == {"plate", "stack"}
    run(PLATE, STACK)
    # 4.2 mm is written otherwise, but what the stack needs of it, rounded, is the same.
    thicker = run(PLATE, STACK, link_thickness=4.2e-3)
    assert (thicker.reused, text(thicker, "plate")) == (["stack"], "4.200")
    thickest = run(PLATE, STACK, link_thickness=5.0e-3)
    assert (thickest.reused, text(thickest, "stack")) == ([], "5toy")
    run(PLATE, STACK)
    renamed = run(PLATE, STACK, design=design_of("other", {}))
    assert (renamed.reused, text(renamed, "stack")) == (["plate"], "4other")


def test_work_that_nothing_needs_is_started_last(tmp_path):
    order: list[str] = []
    late = replace(STACK, turn=Turn.LATE)
    subject = TrackedDesign(design_of("toy", {}), TITLES)
    workshop = WorkerPool(subject, Cache(tmp_path / "kept"), order.append, workers=1)
    done = workshop.do([PLATE, late, Work(name="layer", do=thickness)])
    assert order == ["1 of 3, plate", "2 of 3, layer", "3 of 3, stack"]
    assert list(done.results) == ["plate", "stack", "layer"]


def test_results_of_other_files_work_or_code_are_not_used(run, tmp_path, monkeypatch):
    first = run(PLATE)
    (first.results["plate"].folder / "out/plate.txt").write_text("5.000")
    again = run(PLATE)
    assert (again.reused, text(again, "plate")) == ([], "4.000")
    run(PLATE, Work(name="layer", do=thickness))
    shutil.rmtree(tmp_path / "kept/plate")
    (tmp_path / "kept/layer").rename(tmp_path / "kept/plate")
    again = run(PLATE)
    assert (again.reused, text(again, "plate")) == ([], "4.000")
    monkeypatch.setattr("tvimdesign.cad.jobs.cache.code_digest", lambda: "other")
    assert run(PLATE).reused == []


DAMAGE: dict[str, Callable[[Path], object]] = {
    "nothing": lambda folder: (folder / "trace.json").write_text(""),
    "a list": lambda folder: (folder / "trace.json").write_text("[]"),
    "other types": lambda folder: (folder / "trace.json").write_text(
        '{"code": 1, "reads": 2, "needs": {}, "files": [], "checks": 5}'
    ),
    "another name": lambda folder: (folder / "trace.json").write_text(
        (folder / "trace.json").read_text().replace("plate.txt", "../plate.txt")
    ),
    "a check less": lambda folder: (folder / "trace.json").write_text(
        (folder / "trace.json").read_text().replace('"checks": [{', '"checks": [{"odd": 1, ')
    ),
    "no file": lambda folder: shutil.rmtree(folder / "out"),
    "a file for the folder": lambda folder: (shutil.rmtree(folder.parent), folder.parent.write_text("")),
    "a link for the folder": lambda folder: (shutil.rmtree(folder.parent), folder.parent.symlink_to("/nowhere")),
    "a file beside": lambda folder: (folder.parent / "0123").write_text(""),
}

DAMAGE |= {
    "a file that others may write": lambda folder: (folder / "kept/thickness").chmod(0o646),
    "a trace that others may write": lambda folder: (folder / "trace.json").chmod(0o646),
    "a folder that others may write": lambda folder: (folder / "out").chmod(0o757),
    "a file with a second name": lambda folder: (folder / "second").hardlink_to(folder / "out/plate.txt"),
    "a link for a file": lambda folder: (
        (folder / "out/plate.txt").rename(folder / "out/other"), (folder / "out/plate.txt").symlink_to("other"),
    ),
}  # fmt: skip
if hasattr(os, "getuid") and os.getuid() == 0:  # only root gives files away
    DAMAGE |= {
        f"another user's {name}": lambda folder, name=name: os.chown(folder / name, 12345, 12345)
        for name in ("trace.json", "out/plate.txt", "kept/thickness", "out", ".", "..")
    }


@pytest.mark.parametrize("name", DAMAGE)
def test_a_damaged_file_in_the_cache_is_made_again(run, name):
    first = run(PLATE, STACK)
    DAMAGE[name](first.results["plate"].folder)
    again = run(PLATE, STACK)
    assert not again.failed
    assert ("plate" in again.reused) == (name == "a file beside")
    assert text(again, "plate") == "4.000"
    assert set(run(PLATE, STACK).reused) == {"plate", "stack"}


def test_a_damaged_result_is_reported(tmp_path):
    subject, store = TrackedDesign(design_of("toy", {}), {}), Cache(tmp_path)
    done = WorkerPool(subject, store, lambda _: None).do([PLATE])
    (done.results["plate"].folder / "trace.json").write_text("{}")
    assert WorkerPool(subject, store, lambda _: None).do([PLATE]).reused == []
    assert store.damaged == ["plate"]


@pytest.mark.gate
def test_stuck_crashed_and_refused_work_is_named(run, tmp_path):
    stuck = Work(name="bore", do=never_ends)
    needing = Work(name="assembly", do=stack, needs=("bore", "plate"))
    done = run(stuck, needing, PLATE, limit=0.5)
    assert done.failed["bore"].startswith("bore: it was stopped after 0.5 s of processor time")
    assert done.lost == ["assembly"]
    assert list(done.results) == ["plate"]
    done = run(Work(name="rotor", do=crashes), Work(name="hub", do=refuses), PLATE)
    assert done.failed["rotor"] == "rotor: its process ended with code -9"
    assert done.failed["hub"] == "hub: bore is -1 mm; it must be above zero"
    assert list(done.results) == ["plate"]
    assert [path for path in (tmp_path / "kept").rglob("*") if path.is_file()] == [
        path for path in (tmp_path / "kept/plate").rglob("*") if path.is_file()
    ]


def test_a_child_does_several_pieces_and_a_dead_one_is_replaced(tmp_path):
    subject = TrackedDesign(design_of("toy", {}), TITLES)
    plan = [Work(name=name, do=crashes if name == "crash" else by_whom) for name in ("a", "b", "crash", "c", "d")]
    done = WorkerPool(subject, Cache(tmp_path), lambda _: None, workers=1).do(plan)
    assert list(done.failed) == ["crash"]
    by = {name: text(done, name) for name in "abcd"}
    assert by["a"] == by["b"] != by["c"] == by["d"]
    assert str(os.getpid()) not in by.values()
    assert not any(psutil.pid_exists(int(number)) for number in by.values())


@pytest.mark.gate
def test_children_that_are_spawned_do_the_same_work(tmp_path, monkeypatch):
    """As on a system where a fork is not safe: they import all anew, and all that they are given is sent to them."""
    pool = of_elsewhere(tmp_path, monkeypatch)
    done = pool.do([PLATE, STACK, Work(name="who", do=by_whom)])
    assert done.failed == {}
    assert text(done, "stack") == "4toy"
    assert done.results["plate"].checks == (SolidCheck("plate", 0.0, 1.0, True, "plate"),)
    assert not psutil.pid_exists(int(text(done, "who")))


def test_a_plan_of_parts_can_be_sent_to_a_child_that_is_spawned():
    plan = build_plan(dimensions(design_of("toy", {})))
    again, subject = pickle.loads(pickle.dumps((plan, TrackedDesign(design_of("toy", {}), TITLES))))
    assert [work.name for work in again] == [work.name for work in plan]
    assert subject.watched(True)[0].name == "toy"


SPAWNING = """
import os, sys, time
from pathlib import Path
from types import SimpleNamespace

from cad_designs import design_of
from tvimdesign.base import child_process
from tvimdesign.cad.jobs import worker
from tvimdesign.cad.jobs.cache import Cache, Result
from tvimdesign.cad.jobs.cache import TrackedDesign

child_process.sys = worker.sys = SimpleNamespace(platform="darwin")

def never_ends(job):
    print(os.getpid(), flush=True)
    while True:
        time.sleep(0.01)

if __name__ == "__main__":
    subject = TrackedDesign(design_of("toy", {}), {})
    pool = worker.WorkerPool(subject, Cache(Path("kept").absolute()), lambda _: None, workers=1)
    pool.do([worker.Work(name="plate", do=never_ends)])
"""


@pytest.mark.gate
def test_a_spawned_child_is_gone_with_its_parent_though_it_is_at_work(tmp_path):
    """Linux alone signals a parent's end; here a child watches its parent, as elsewhere."""
    (tmp_path / "spawning.py").write_text(SPAWNING)
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join([str(ROOT), str(ROOT / "tests/helpers")])}
    command = [sys.executable, "spawning.py"]
    with subprocess.Popen(command, cwd=tmp_path, stdout=subprocess.PIPE, text=True, env=environment) as parent:
        assert parent.stdout is not None
        child = int(parent.stdout.readline())
        assert is_at_work(child)
        parent.kill()
        parent.wait()
        left = not are_gone([child])
        if left:
            os.kill(child, signal.SIGKILL)
    assert not left


def of_elsewhere(folder: Path, monkeypatch: pytest.MonkeyPatch) -> WorkerPool:
    """Return the pool of a system that is no Linux, with one child."""
    subject = TrackedDesign(design_of("toy", {}), TITLES)
    with monkeypatch.context() as patched:
        patched.setattr("tvimdesign.cad.jobs.worker.sys.platform", "darwin")
        pool = WorkerPool(subject, Cache(folder / "kept"), lambda _: None, workers=1)
    assert pool._context.get_start_method() == "spawn"
    return pool


def test_the_oldest_results_go_when_there_are_many(run, tmp_path, monkeypatch):
    monkeypatch.setattr("tvimdesign.cad.jobs.cache._MOST", 2)
    for thickness in (4.0e-3, 4.1e-3, 4.2e-3):
        run(PLATE, link_thickness=thickness)
    assert len(list((tmp_path / "kept/plate").iterdir())) == 2
    assert run(PLATE, link_thickness=4.1e-3).reused == ["plate"]
    assert run(PLATE, link_thickness=4.0e-3).reused == []


def test_a_thicker_layer_leaves_the_pins_as_they_were(run):
    # A part without a drawing: the kernel's threads, which other tests may have started, do not survive a fork.
    pins = next(work for work in build_plan(dimensions(design_of("toy", {}))) if work.name == "link_dowel")
    layer = Work(name="layer", do=thickness)
    assert run(pins, layer).failed == {}
    again = run(pins, layer, pcl_thickness=1.1e-3)
    assert again.reused == ["link_dowel"]
    assert again.failed == {}


STUCK = """
import sys
from functools import partial
from tvimdesign.cad.jobs import main as job
from tvimdesign.cad.jobs import worker
from tvimdesign.cad.parts import shear_parts

def stuck(dims):
    while True:
        pass

shear_parts.DRAWN["{kind}"] = stuck
worker.WorkerPool = partial(worker.WorkerPool, limit=20.0)
sys.exit(job.main(sys.argv[1:]))
"""


@pytest.mark.slow
def test_a_stuck_part_is_named_and_the_others_are_made(tmp_path, monkeypatch):
    (tmp_path / "stuck_job.py").write_text(STUCK.format(kind="retainer"))
    monkeypatch.setenv("PYTHONPATH", str(tmp_path))
    write_design(whole(design_of("paper", {})), tmp_path / "design.json")
    with pytest.raises(GeometryError, match=r"^retainer: it was stopped after 20 s.*; the other \d+ files are written"):
        make_cad(tmp_path / "design.json", tmp_path / "cad", job="stuck_job")
    assert (tmp_path / "cad/step/housing.step").exists()
    assert (tmp_path / "cad/drawings/rotor.pdf").exists()
    assert not (tmp_path / "cad/step/retainer.step").exists()
    assert not (tmp_path / "cad/assembly.step").exists()


@pytest.mark.slow
def test_a_second_making_takes_over_everything_and_gives_the_same_files(tmp_path, monkeypatch):
    monkeypatch.setenv("TVIMDESIGN_CACHE", str(tmp_path / "kept"))
    write_design(whole(design_of("paper", {})), tmp_path / "design.json")
    first = make_cad(tmp_path / "design.json", tmp_path / "cad")
    made = {name: (tmp_path / "cad" / name).read_bytes() for name in first.files}
    shutil.rmtree(tmp_path / "cad")
    second = make_cad(tmp_path / "design.json", tmp_path / "cad")
    assert len(second.reused) == len(build_plan(dimensions(design_of("paper", {}))))
    assert second.checks == first.checks
    assert {name: (tmp_path / "cad" / name).read_bytes() for name in second.files} == made


def test_files_are_handed_out_while_the_next_piece_of_work_is_done(tmp_path):
    messages: list[str] = []

    def made(result: Result) -> None:
        messages.append(f"made {result.folder.parent.name}")

    subject = TrackedDesign(design_of("toy", {}), TITLES)
    workshop = WorkerPool(subject, Cache(tmp_path / "kept"), messages.append, workers=1, made=made)
    workshop.do([PLATE, Work(name="layer", do=thickness)])
    assert messages == ["1 of 2, plate", "2 of 2, layer", "made plate", "made layer"]
    messages.clear()
    workshop.do([PLATE, Work(name="layer", do=thickness)])
    assert messages == ["made plate", "made layer"]


def test_children_collect_garbage_though_who_forks_them_does_not(run):
    gc.disable()
    try:
        assert text(run(Work(name="collects", do=collects)), "collects") == "True"
    finally:
        gc.enable()
