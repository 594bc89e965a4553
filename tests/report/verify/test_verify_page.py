"""`run --verify` and the page of a verification: rows worst first, pictures, and what solved them."""

import sys
from pathlib import Path
from typing import Any

import pytest
from support import Command

from tvimdesign.cad.fe.model_comparison import Compared
from tvimdesign.cad.fe.run_solvers import Solved
from tvimdesign.cli import commands
from tvimdesign.page.page_file import page_html
from tvimdesign.report.output.command import Command as OutputCommand
from tvimdesign.report.verification_tables import far, verified
from tvimdesign.report.verify_design import verify_page

PIXEL = bytes.fromhex(
    "89504e470d0a1a0a0000000d4948445200000001000000010806000000"
    "1f15c4890000000d49444154789c6360000002000001e221bc330000000049454e44ae426082"
)


def test_rows_pictures_and_solvers_are_on_the_page_worst_first(tmp_path: Path) -> None:
    rows = [
        Compared("core", "N*m/rad", "core of the rotor", model=87.0, fe=100.0, coarse=102.0),
        Compared("hub", "N*m/rad", "frozen joint", model=500.0, fe=505.0, coarse=505.0),
    ]
    solved = {
        name: Solved({"unknowns": 2e4, "seconds": 33.0, "gigabytes": 0.7}, {}, tmp_path) for name in ("joint", "link")
    }
    with OutputCommand(tmp_path / "out") as command:
        command.folder.write("joint.png", PIXEL)
        page = verify_page(command, "Wrist", verified(rows, solved), rows)
        text = page_html(page).decode()
    assert page.status == "1 OF 2 BEYOND 10 %"
    assert page.tone == "warn"
    assert text.index("core</") < text.index("hub</")
    assert "0.870" in text
    assert "-2.0" in text
    assert text.count("data:image/png") == 1
    assert "Stress in the frozen joint" in text
    assert "20000" in text
    rows = [
        Compared(f"of_{model:g}", "s", "", model=model, fe=100.0, coarse=100.0) for model in (89.0, 91.0, 109.0, 110.5)
    ]
    assert far(rows) == ["of_89", "of_110.5"]


STUDY = "mode: shear\n"


def test_what_finite_elements_lack_is_told_before_the_run(tmp_path: Path, tvimdesign: Command) -> None:
    (tmp_path / "mine.yaml").write_text(STUDY)
    refused = tvimdesign("run", "mine.yaml", "--verify", "--fe-python", str(tmp_path / "none"), cwd=tmp_path)
    assert refused.returncode == 2
    assert "--fe-python" in refused.stderr
    assert not (tmp_path / "results").exists()


def test_the_run_comes_first_and_its_folder_is_verified(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    done: list[Any] = []
    monkeypatch.setattr("tvimdesign.report.run.run_study.run_study", lambda *_, **__: done.append("run"))
    monkeypatch.setattr("tvimdesign.cad.fe.run_solvers.require_fe", done.append)
    monkeypatch.setattr(
        "tvimdesign.report.verify_design.verify_design",
        lambda path, out, _, **given: done.append((path, out, given["told"])),
    )
    out = tmp_path / "wrist"
    commands.run(tmp_path / "mine.yaml", out=out, verified=True, json=True)
    assert done == [sys.executable, "run", (out, tmp_path / "wrist-verified", False)]
