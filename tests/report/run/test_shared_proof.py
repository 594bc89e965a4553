"""Every combination solved by the jobs of an array, by processes or on a cluster: the same files as by one process."""

from __future__ import annotations

import json
import shutil
import subprocess
import sys
import time
from contextlib import suppress
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from choosing import LISTED, listed
from local_cluster import LocalCluster, answered_on
from support import ROOT, Command, environment

from tvimdesign.base.process_tree import end_process_tree
from tvimdesign.report.output.shared_folder import CellsAsked, joined
from tvimdesign.report.run.shared_proof import ProofAnswers, ProofWork, proof_asked, prove_part
from tvimdesign.solve.discrete.enumeration import BLOCK, Begin, blocks_of, solved
from tvimdesign.solve.nlp.plain_run import plain_run, run_of
from tvimdesign.solve.search import optimize
from tvimdesign.study import Study
from tvimdesign.sweep.run_sweep import Where
from tvimdesign.sweep.shards import Shards

STUDY = (
    LISTED.replace("solver: {", "solver: {prove: true, alternatives: 3, ").replace(
        "{catalog: metric, from: 1.9 mm, to: 2.4 mm}", "{choose: [2.2 mm, 2.4 mm, 2.5 mm, 2.6 mm]}"
    )
    + "accept: [peltier_temperature_margin, structure_temperature_margin]\n"
)
"""Twenty-four combinations, in two blocks with designs in both."""
WORDS = ("--no-cad", "--no-plots")
FILES = ("design.json", "results.csv", "summary.txt", "choices.csv", "limits.csv", "why.csv")


@pytest.fixture(scope="module")
def study_file(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("proof") / "listed.yaml"
    path.write_text(STUDY)
    return path


@pytest.fixture(scope="module")
def expected(tvimdesign: Command, study_file: Path) -> dict[str, bytes]:
    out = study_file.parent / "expected"
    done = tvimdesign("run", study_file, *WORDS, "--out", out)
    assert done.returncode == 0, done.stderr
    assert not (out / "shards").exists()
    return _files(out)


def _files(out: Path) -> dict[str, bytes]:
    """All but what tells times."""
    return {path.name: path.read_bytes() for path in sorted(out.iterdir()) if path.name in FILES} | {
        "choosing": json.dumps(json.loads((out / "results.json").read_text())["choosing"]).encode()
    }


class _Stopped(Exception):  # noqa: N818 - a way out of a search that is as it should be, no error
    """Ends a search where its combinations would be solved."""


@pytest.fixture(scope="module")
def begin() -> Begin:
    return _begun(listed(STUDY))


def _begun(study: Study) -> Begin:
    """A search whose starts are done."""
    caught: list[Begin] = []

    def enumerated(begin: Begin) -> Any:
        caught.append(begin)
        raise _Stopped

    with suppress(_Stopped):
        optimize(study, enumerate_all=enumerated)
    return caught[0]


@pytest.mark.gate
def test_the_jobs_of_an_array_prove_the_same(
    tvimdesign: Command, study_file: Path, expected: dict[str, bytes], tmp_path: Path
) -> None:
    for part in (2, 1):
        done = tvimdesign("run", study_file, *WORDS, "--workers", 1, "--shard", f"{part}/2", "--out", tmp_path)
        assert done.returncode == 0, done.stderr
        assert ("1 of 2 cells are still with other parts" in done.stdout) == (part == 2)
        assert (tmp_path / "results.csv").exists() == (part == 1)
    assert _files(tmp_path) == expected
    again = tvimdesign("run", study_file, *WORDS, "--resume", "--out", tmp_path)
    assert again.returncode == 0, again.stderr
    assert "block 1 of" not in again.stderr  # all are there
    assert _files(tmp_path) == expected


@pytest.mark.gate
def test_a_run_that_was_killed_goes_on_with_what_is_kept(
    tvimdesign: Command, study_file: Path, expected: dict[str, bytes], tmp_path: Path, begin: Begin
) -> None:
    asked = proof_asked(begin)
    with joined(tmp_path) as folder:
        one = prove_part(begin.study, folder, Where(1, part=(2, 2)), lambda _: None)
    assert (one.cells, one.computed, one.missing) == (2, 1, 1)
    shard = next((folder / "shards").iterdir())
    with shard.open("ab") as stream:
        stream.write(shard.read_bytes().splitlines()[1][:-40])  # a line that was being written
    done = tvimdesign("run", study_file, *WORDS, "--resume", "--out", tmp_path)
    assert done.returncode == 0, done.stderr
    assert len(Shards(tmp_path, asked.work.columns)) == 1  # the other is used, but its shard is not as it was written
    assert f"{tmp_path}/unfinished-1: holds what else" in done.stderr
    shutil.rmtree(tmp_path / "unfinished-1")
    assert _files(tmp_path) == expected


@pytest.mark.gate
def test_a_block_is_solved_alike_whoever_solves_it_and_whatever_before(begin: Begin) -> None:
    work = proof_asked(begin).work
    assert isinstance(work, ProofWork)
    elsewhere = work.answers()
    assert isinstance(elsewhere, ProofAnswers)
    first, last = blocks_of(begin.trees)
    assert (first.first, last.first, last.first + BLOCK > begin.trees[0].sizes.count) == (0, BLOCK, True)
    here = [solved(begin.trees[0], block) for block in (last, first)]
    there = [solved(elsewhere.trees[0], block) for block in (first, last)]
    for one, other in zip(here, reversed(there), strict=True):
        assert one.runs.keys() == other.runs.keys()
        assert one.runs
        for box, run in one.runs.items():
            assert run.unknowns.tobytes() == other.runs[box].unknowns.tobytes()
        assert one.work == other.work


@pytest.mark.gate
def test_a_run_comes_back_from_its_text_to_the_last_bit(begin: Begin) -> None:
    run = begin.trees[0].optima[0]
    back = run_of(json.loads(json.dumps(plain_run(run))))
    assert back.start == run.start
    for name in ("inputs", "unknowns", "multipliers", "bound_multipliers", "parameter_multipliers"):
        assert getattr(back, name).tobytes() == np.asarray(getattr(run, name)).tobytes()
    assert (back.current_profiles, back.ends, dict(back.within)) == (run.current_profiles, run.ends, dict(run.within))


def test_a_key_changes_with_the_study_and_not_with_its_time(begin: Begin) -> None:
    base = proof_asked(begin)
    assert len(set(base.keys)) == len(base.keys)
    assert _keys(begin, time_limit=5.0) == list(base.keys)
    assert not set(_keys(begin, elements=3)) & set(base.keys)
    assert not set(proof_asked(begin._replace(objectives=["module_mass"])).keys) & set(base.keys)


def _keys(begin: Begin, **changed: Any) -> list[str]:
    solver = begin.study.solver.model_copy(update=changed)
    asked: CellsAsked = proof_asked(begin._replace(study=begin.study.model_copy(update={"solver": solver})))
    return list(asked.keys)


def test_what_has_nothing_to_share_says_so(tvimdesign: Command, tmp_path: Path) -> None:
    plain = tmp_path / "plain.yaml"
    plain.write_text(STUDY.replace("prove: true, ", ""))
    said = tvimdesign("run", plain, *WORDS, "--shard", "1/2", "--out", tmp_path / "out")
    assert (said.returncode, "say --prove" in said.stderr) == (2, True)
    plain.write_text("mode: shear\n")
    said = tvimdesign("run", plain, *WORDS, "--prove", "--shard", "1/2", "--out", tmp_path / "out")
    assert (said.returncode, "lists no sizes" in said.stderr) == (2, True)


@pytest.mark.slow
def test_a_run_killed_between_two_blocks_goes_on_with_the_first(
    tvimdesign: Command, study_file: Path, expected: dict[str, bytes], tmp_path: Path, begin: Begin
) -> None:
    out, columns = tmp_path / "out", proof_asked(begin).work.columns
    words = ["run", str(study_file), *WORDS, "--workers", "1", "--out", str(out)]
    process = subprocess.Popen([sys.executable, "-m", "tvimdesign", *words], env=environment(), cwd=ROOT)
    try:
        while process.poll() is None and not len(Shards(out, columns)):
            time.sleep(0.02)
    finally:
        end_process_tree(process.pid)
        process.wait()
    assert len(Shards(out, columns)) == 1
    done = tvimdesign(*words, "--resume")
    assert done.returncode == 0, done.stderr
    assert "block 1 of 1" in done.stderr
    assert _files(out) == expected


@pytest.mark.slow
def test_a_cluster_that_loses_a_worker_proves_the_same(
    tvimdesign: Command, study_file: Path, expected: dict[str, bytes], tmp_path: Path, begin: Begin
) -> None:
    out = tmp_path / "out"
    with LocalCluster(tmp_path) as cluster:
        asked = proof_asked(begin)
        done = answered_on(cluster, asked, out, {0: lambda: cluster.kill_worker(1)})
        assert (done.whole, done.computed) == (True, 2)
        again = tvimdesign("run", study_file, *WORDS, "--scheduler", cluster.address, "--resume", "--out", out)
    assert again.returncode == 0, again.stderr
    assert "block 1 of" not in again.stderr
    assert _files(out) == expected
