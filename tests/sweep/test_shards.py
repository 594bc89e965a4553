"""Plans of sweeps and their shards."""

import json
import math
import re
import resource
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from scipy.stats import qmc
from small_studies import ALGEBRAIC
from small_sweeps import plan
from support import ROOT, cases_of, sample_text, study_path

import tvimdesign as tvim
from tvimdesign.base.errors import InputError, OutputError
from tvimdesign.study import StudyError
from tvimdesign.sweep.answers import CellAnswers
from tvimdesign.sweep.plan import Cell, CellAnswer, SweepPlan
from tvimdesign.sweep.pool import CellQueue
from tvimdesign.sweep.run_sweep import CellKeys
from tvimdesign.sweep.shards import Shards, ShardWriter

COLUMNS = ("module_mass", "response_time", "spring_material")
KEYS = [f"{number:032x}" for number in range(5)]


def answer(number: float) -> CellAnswer:
    return CellAnswer("optimal", "", 0, 0.1, (0.1 * number, math.inf, "music_wire"), warm=True)


def written(folder: Path, keys: list[str], columns: tuple[str, ...] = COLUMNS) -> None:
    with ShardWriter(folder, columns) as shard:
        shard.append([(key, answer(number), 0.25) for number, key in enumerate(keys)])


def test_what_is_kept_comes_back_to_the_last_digit(tmp_path):
    written(tmp_path, KEYS[:3])
    written(tmp_path, KEYS[3:])
    shards = Shards(tmp_path, COLUMNS)
    assert len(shards) == 5
    stored = list(shards.cells(iter([KEYS[2], KEYS[3]])))
    assert stored == [answer(2), answer(0)]
    first, _ = sorted((tmp_path / "shards").iterdir())
    assert [json.loads(line)[-1] for line in first.read_text().splitlines()[1:]] == [0.25] * 3  # what each took


def test_an_unfinished_line_is_no_cell_and_the_next_shard_is_new(tmp_path):
    written(tmp_path, KEYS)
    (path,) = (tmp_path / "shards").iterdir()
    whole = path.read_bytes()
    for cut in (1, 2, 40, 200):
        path.write_bytes(whole[:-cut])
        assert len(Shards(tmp_path, COLUMNS)) == (4 if cut < 150 else 3)
    written(tmp_path, KEYS[3:])
    assert len(Shards(tmp_path, COLUMNS)) == 5
    path.write_bytes(whole[:20])
    assert len(Shards(tmp_path, COLUMNS)) == 2


def test_a_shard_with_fewer_columns_is_left_alone_and_one_with_more_serves(tmp_path):
    written(tmp_path, KEYS)
    shards = Shards(tmp_path, ("spring_material", "module_mass"))
    (stored,) = shards.cells(iter(KEYS[1:2]))
    assert stored.values == ("music_wire", 0.1)
    assert len(Shards(tmp_path, (*COLUMNS, "peak_power"))) == 0


FILLS_ITS_DISK = f"""
import sys
sys.path[:0] = {[str(ROOT / "tests/sweep"), str(ROOT / "tests/helpers")]!r}
from pathlib import Path
from test_shards import KEYS, answer
from tvimdesign.base.errors import OutputError
from tvimdesign.sweep.shards import ShardWriter
with ShardWriter(Path(sys.argv[1]), ("a", "b", "c")) as shard:
    try:
        for key in KEYS:
            shard.append([(key, answer(1.0), 0.1)])
    except OutputError as error:
        print(error)
"""


@pytest.mark.gate
def test_full_disks_and_folders_in_the_way_keep_the_cells_before(tmp_path):
    done = subprocess.run(
        [sys.executable, "-c", FILLS_ITS_DISK, str(tmp_path)], capture_output=True, text=True, check=True,
        preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (300, 300)),
    )  # fmt: skip
    assert "File too large; the cells before are kept: make room, then the same command with --resume" in done.stdout
    (path,) = (tmp_path / "shards").iterdir()
    assert path.read_bytes().endswith(b"]\n")
    assert len(Shards(tmp_path, ("a", "b", "c"))) == 2
    (tmp_path / "other").mkdir()
    (tmp_path / "other/shards").write_text("a file")
    with pytest.raises(OutputError, match=r"shards: cannot be written"):
        written(tmp_path / "other", KEYS)


OPTIMISED = sample_text("optimised_cells")


def plan_over(tmp_path: Path, sweep: str, study: str = "mode: shear\n") -> SweepPlan:
    path = tmp_path / "study.yaml"
    path.write_text(f"{study}sweep: {sweep}\n")
    return plan(path)


def test_grids_and_samples_lie_where_they_are_asked_for(tmp_path):
    sweep_plan = plan_over(tmp_path, "{over: {current: [1 A, 2 A], arc_count: {from: 3, to: 5}}}")
    cells = [sweep_plan.texts(number) for number in range(sweep_plan.count)]
    assert cells == [(current, count) for current in ("1 A", "2 A") for count in ("3", "4", "5")]
    sweep_plan = plan_over(tmp_path, "{over: {current: {from: 0.5 A, to: 8 A, count: 5, spacing: logarithmic}}}")
    assert [sweep_plan.axis_values(number)[0] for number in range(5)] == pytest.approx([0.5, 1.0, 2.0, 4.0, 8.0])
    over = "{current: {from: 1 A, to: 2 A}, pcl_thickness: {from: 0.6 mm, to: 2 mm}}"
    sweep_plan = plan_over(tmp_path, f"{{method: sobol, count: 5, seed: 9, over: {over}}}")
    shares = qmc.Sobol(2, rng=9).random_base2(3)[:5]
    expected = qmc.scale(shares, [1.0, 0.6], [2.0, 2.0])
    assert np.array([sweep_plan.axis_values(number) for number in range(5)]) == pytest.approx(expected, rel=1e-9)
    over = "{rate_model: [smi, bending], arc_count: {from: 3, to: 6}}"
    sweep_plan = plan_over(tmp_path, f"{{method: latin_hypercube, count: 8, over: {over}}}")
    words, counts = zip(*(sweep_plan.texts(number) for number in range(8)), strict=True)
    assert sorted(words) == ["bending"] * 4 + ["smi"] * 4
    assert sorted(counts) == ["3", "3", "4", "4", "5", "5", "6", "6"]


def test_bad_or_too_many_cells_are_refused_with_advice(tmp_path):
    with pytest.raises(StudyError, match=r"study.yaml:2:\d+: module.current: '99 A' is above the upper limit"):
        plan_over(tmp_path, "{over: {pcl_thickness: [1 mm], current: [1 A, 99 A]}}")
    with pytest.raises(StudyError, match="no unit"):
        plan_over(tmp_path, "{over: {pcl_thickness: [1 mm, 1 furlong]}}")
    over = "over: {current: {from: 1 A, to: 2 A, count: 1000}, pcl_thickness: {from: 1 mm, to: 2 mm, count: 1000}}"
    with pytest.raises(InputError, match=r"1000000 cells; the limit is 100000; .*say `most: 1000000`"):
        plan_over(tmp_path, f"{{{over}}}")
    assert plan_over(tmp_path, f"{{most: 1000000, {over}}}").count == 1_000_000
    path = tmp_path / "study.yaml"
    path.write_text("mode: shear\n")
    with pytest.raises(InputError, match=r"there is no `sweep:`; add, for one, sweep: {over: "):
        plan(path)


@cases_of("shards", "keys")
def test_every_cell_has_a_key_of_its_own(tmp_path, sweep):
    sweep_plan = plan_over(tmp_path, sweep, OPTIMISED)
    keys = CellKeys(sweep_plan)
    assert len({keys.key(sweep_plan.texts(number)) for number in range(sweep_plan.count)}) == sweep_plan.count


def test_a_key_changes_with_study_and_record_not_with_other_cells(tmp_path):
    def key(sweep: str = "{over: {current: [1 A, 2 A]}}", study: str = "mode: shear\n") -> str:
        sweep_plan = plan_over(tmp_path, sweep, study)
        return CellKeys(sweep_plan).key(sweep_plan.texts(0))

    assert key() == key() == key("{over: {current: [1 A, 3 A, 4 A]}}")
    assert key() == key("{over: {current: {from: 1000 mA, to: 2 A, count: 4}}}")
    assert key() != key(study="mode: shear\nmodule: {wire_diameter: 2.3 mm}\n")
    assert key() != key(study="mode: shear\nsolver: {cells: 20}\n")
    assert key() == key(study="mode: shear\nname: other\nwrite: {cad: false}\n")


def test_a_key_changes_with_what_the_table_reads_of_a_record(tmp_path):
    records = tmp_path / "records/structure_materials"
    records.mkdir(parents=True)

    def key(value: str, text: str = "") -> str:
        (records / "own.yaml").write_text(
            f"title: own {text}\nbased_on: polycarbonate_bambu\nvalues:\n"
            f"  {value}, status: datasheet, source: s {text}}}\n"
        )
        study = "mode: shear\ncatalog: records\nmodule: {structure_material: own}\n"
        swept = plan_over(tmp_path, "{over: {current: [1 A, 2 A]}}", study)
        return CellKeys(swept).key(swept.texts(0))

    printed = key("nozzle_temperature: {value: 250, unit: degC")
    assert printed == key("nozzle_temperature: {value: 260, unit: degC", "again")
    assert printed != key("density: {value: 1210, unit: kg/m^3")
    assert key("density: {value: 1210, unit: kg/m^3") != key("density: {value: 1220, unit: kg/m^3")


def answers(path: Path, order: list[int], *settings: str) -> dict[int, CellAnswer]:
    sweep_plan = plan(path, *settings)
    cells = CellAnswers(sweep_plan)
    return {number: cells.answer(Cell("", sweep_plan.texts(number))) for number in order}


def test_the_order_of_cells_changes_no_digit(study_file):
    over = "sweep.over={pcl_thickness: [0.6 mm, 1 mm], arc_count: [3, 4]}"
    forward, backward = answers(study_file, [0, 1, 2, 3], over), answers(study_file, [3, 0], over)
    assert backward == {number: forward[number] for number in backward}
    assert len({cell.values for cell in forward.values()}) == 4


@pytest.mark.gate
def test_a_cell_below_its_yield_says_by_how_much(tmp_path):
    path = tmp_path / "study.yaml"
    band = ALGEBRAIC.replace('">= 5 N.m/rad"', '[">= 5 N.m/rad", "<= 5.1 N.m/rad"]')
    path.write_text(f"{band}robust: {{yield: 95 %}}\nsweep: {{over: {{link_thickness: [5 mm]}}}}\n")
    (cell,) = answers(path, [0]).values()
    assert cell.status == "below_yield"
    assert re.match(r"yield [\d.]+% of 95% asked, most lost to \w*spring_stiffness [<>]= 5", cell.reason)


@pytest.mark.slow
def test_optimised_cells_are_the_same_in_any_order(tmp_path):
    path = tmp_path / "study.yaml"
    path.write_text(tvim.load(study_path("paper_shear")).text)
    over = "sweep={over: {pcl_thickness: [0.6 mm, 0.9 mm], require.holding_torque: ['>= 12 N.m', '>= 120 N.m']}}"
    single_start = "solver.starts=1"
    forward, backward = answers(path, [0, 1, 2, 3], over, single_start), answers(path, [2, 0], over, single_start)
    assert backward == {number: forward[number] for number in backward}
    assert [forward[number].warm for number in (0, 2)] == [True, True]
    assert forward[1].status == "infeasible"
    assert "violates" in forward[1].reason


def test_workers_stay_with_a_kind_and_a_dead_one_s_cells_run_alone(study_file):
    sweep_plan = plan(study_file, "sweep.over={pcl_thickness: [1 mm, 2 mm], rate_model: [smi, bending]}")
    cells = [Cell(str(number), sweep_plan.texts(number)) for number in range(4)]
    left = CellQueue(cells, sweep_plan, workers=2)
    first, other, second = left.next(1), left.next(2), left.next(1)
    assert [cell.texts[1] for cell in (*first, *other, *second)] == ["smi", "bending", "smi"]
    left.done(1000, 1.0)
    left.put_back([*first, *second])
    assert [len(left.next(1)) for _ in range(3)] == [1, 1, 1]
    assert left.next(1) == []
    assert len(left) == 0


def test_own_records_are_found_by_a_worker_that_began_in_another_folder(tmp_path, monkeypatch):
    study = "mode: shear\ncatalog: records\nsolver: {cells: 6}\nsweep: {over: {spring_material: [own]}}\n"
    own = "title: Own\nbased_on: music_wire\nvalues: {stress_relief_temperature: {value: 250, unit: degC, "
    (tmp_path / "records/spring_materials").mkdir(parents=True)
    (tmp_path / "records/spring_materials/own.yaml").write_text(f"{own}status: datasheet, source: a sheet}}}}\n")
    (tmp_path / "study.yaml").write_text(study)
    monkeypatch.chdir(tmp_path)
    sweep_plan = plan(Path("study.yaml"))
    monkeypatch.chdir("/")
    assert CellAnswers(sweep_plan).answer(Cell("key", sweep_plan.texts(0))).status == "evaluated"
