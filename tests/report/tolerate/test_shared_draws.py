"""Modules drawn by the jobs of an array, by processes or on a cluster: the same bytes as in one process."""

from __future__ import annotations

from contextlib import ExitStack
from pathlib import Path

import pytest
from local_cluster import LocalCluster, answered_on
from support import Command

from tvimdesign.report.output.shared_folder import CellsAsked
from tvimdesign.report.tolerate import shared_draws
from tvimdesign.report.tolerate.shared_draws import BLOCK, blocks_asked, drawn_elsewhere
from tvimdesign.simulation.working_cycle.resolved_module import resolve_study
from tvimdesign.solve.nlp.spread import drawn_values
from tvimdesign.solve.uncertainty.tolerance import Tolerancing
from tvimdesign.study import read_study
from tvimdesign.sweep.run_sweep import Where

STUDY = """
mode: shear
module: {transmission: unity, leg_model: ignored, spring_material: paper_wire}
require: {spring_stiffness: [">= 5.3 N.m/rad", "<= 6 N.m/rad"], preload_margin: ">= 0 rad"}
tolerances:
  wire_diameter: 0.025 mm
  spring_youngs_modulus: 1 %
  preload_angle: {row: free_angle_tolerance, adjusted_to: 1 deg}
write: {plots: false}
solver: {cells: 6}
"""
"""Arithmetic alone; the modules of the slow test below go through a cycle."""
WITH_A_CYCLE = STUDY.replace("require: {", 'require: {response_time: "<= 200 s", ')
SAMPLES = 2 * BLOCK
TABLES = ("outputs.csv", "limits.csv", "contributors.csv", "not_known.csv", "tolerances.json")


@pytest.fixture(scope="module")
def study_file(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("shared") / "arm.yaml"
    path.write_text(STUDY)
    return path


@pytest.fixture(scope="module")
def expected(tvimdesign: Command, study_file: Path) -> dict[str, bytes]:
    return _by_one_process(tvimdesign, study_file)


def _by_one_process(tvimdesign: Command, study: Path) -> dict[str, bytes]:
    """The tables of one process that draws all modules."""
    out = study.parent / "expected"
    done = tvimdesign("tolerate", study, "--samples", SAMPLES, "--workers", 1, "--out", out)
    assert done.returncode == 0, done.stderr
    return _tables(out)


def _tables(out: Path) -> dict[str, bytes]:
    return {name: (out / name).read_bytes() for name in TABLES}


def _asked(study_file: Path) -> CellsAsked:
    module = resolve_study(read_study(study_file))
    return blocks_asked([Tolerancing(module, lambda _: None)], SAMPLES, module.study.solver.seed)


def test_blocks_are_parts_of_one_draw(study_file: Path) -> None:
    analysis = Tolerancing(resolve_study(read_study(study_file)), lambda _: None)
    contributors = analysis.whole.contributors
    whole = drawn_values(lambda columns: columns, contributors, 64, 1)
    parts = [drawn_values(lambda columns: columns, contributors, 16, 1, first) for first in (0, 16, 32, 48)]
    assert [part.tobytes() for part in parts] == [whole[:, at : at + 16].tobytes() for at in (0, 16, 32, 48)]


@pytest.mark.gate
def test_the_jobs_of_an_array_draw_the_same_bytes(
    tvimdesign: Command, study_file: Path, expected: dict[str, bytes], tmp_path: Path
) -> None:
    for part in (2, 1):
        done = tvimdesign(
            "tolerate", study_file, "--samples", SAMPLES, "--workers", 1, "--shard", f"{part}/2", "--out", tmp_path
        )
        assert done.returncode == 0, done.stderr
        assert ("Part 2 of 2" in done.stdout) == (part == 2)
    assert _tables(tmp_path) == expected
    again = tvimdesign("tolerate", study_file, "--samples", SAMPLES, "--resume", "--out", tmp_path)
    assert again.returncode == 0, again.stderr
    assert "block 1 of" not in again.stderr  # all are there
    assert _tables(tmp_path) == expected


@pytest.mark.gate
def test_another_draw_is_computed_anew(study_file: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(shared_draws, "BLOCK", 64)
    drawn = []
    for wire in (2.4e-3, 2.5e-3):
        study = read_study(study_file)
        changed = {**study.module, "wire_diameter": wire}
        module = resolve_study(study.model_copy(update={"module": changed}))
        analysis = Tolerancing(module, lambda _: None)
        with ExitStack() as stack:
            _, done, found = drawn_elsewhere(
                stack, tmp_path, [analysis], 64, Where(workers=1), lambda _: None, overwrite=False, resume=bool(drawn)
            )
        assert (done.reused, done.computed) == (0, len(shared_draws._draws_of(analysis)))
        drawn.append(found[0](analysis.whole))
        assert (drawn[-1] == analysis.drawn_here(64, study.solver.seed)(analysis.whole)).all()
    assert (drawn[0] != drawn[1]).any()


@pytest.mark.slow
def test_a_cluster_that_loses_a_worker_draws_the_same_bytes(tvimdesign: Command, tmp_path: Path) -> None:
    study, out = tmp_path / "cycle.yaml", tmp_path / "out"
    study.write_text(WITH_A_CYCLE)
    expected = _by_one_process(tvimdesign, study)
    with LocalCluster(tmp_path) as cluster:
        done = answered_on(cluster, _asked(study), out, {1: lambda: cluster.kill_worker(1)})
    assert (done.whole, done.reused) == (True, 0)
    gathered = tvimdesign("tolerate", study, "--samples", SAMPLES, "--resume", "--out", out)
    assert gathered.returncode == 0, gathered.stderr
    assert "block 1 of" not in gathered.stderr
    assert _tables(out) == expected
