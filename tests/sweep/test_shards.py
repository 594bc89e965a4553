"""What a shard keeps is whole lines, whatever ends its writer."""

import math
import resource
import subprocess
import sys
from pathlib import Path

import pytest
from support import ROOT

from tvimdesign.base.errors import OutputError
from tvimdesign.sweep.plan import CellAnswer
from tvimdesign.sweep.shards import Shards, ShardWriter

COLUMNS = ("module_mass", "response_time", "spring_material")
KEYS = [f"{number:032x}" for number in range(5)]


def answer(number: float) -> CellAnswer:
    return CellAnswer("optimal", "", 0, 0.1, (0.1 * number, math.inf, "music_wire"), warm=True)


def written(folder: Path, keys: list[str], columns: tuple[str, ...] = COLUMNS) -> None:
    with ShardWriter(folder, columns) as shard:
        shard.append([(key, answer(number), 0.25) for number, key in enumerate(keys)])


def test_what_is_kept_comes_back_to_the_last_digit(tmp_path: Path) -> None:
    written(tmp_path, KEYS[:3])
    written(tmp_path, KEYS[3:])
    shards = Shards(tmp_path, COLUMNS)
    assert len(shards) == 5
    found = list(shards.kept(iter([KEYS[2], KEYS[3]])))
    assert [one.answer for one in found] == [answer(2), answer(0)]
    assert found[0].seconds == 0.25
    assert len(list((tmp_path / "shards").iterdir())) == 2


def test_an_unfinished_line_is_no_cell_and_the_next_shard_is_new(tmp_path: Path) -> None:
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


def test_a_shard_with_fewer_columns_is_left_alone_and_one_with_more_serves(tmp_path: Path) -> None:
    written(tmp_path, KEYS)
    shards = Shards(tmp_path, ("spring_material", "module_mass"))
    (found,) = shards.kept(iter(KEYS[1:2]))
    assert found.answer.values == ("music_wire", 0.1)
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


def test_full_disks_and_folders_in_the_way_keep_the_cells_before(tmp_path: Path) -> None:
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
