"""The parts that studies become."""

import json
from pathlib import Path

import pytest
from support import Command, study_path

MADE = ("elbow_printed", "elbow_machined", "wrist_joint", "wrist_compression", "paper_shear", "machined_compression",
        "driven_joint")  # fmt: skip
"""Studies whose parts are made: the others differ from these in dimensions alone."""


@pytest.mark.slow
@pytest.mark.parametrize("study", [study_path(name) for name in MADE], ids=MADE)
def test_a_study_becomes_parts_that_pass_every_check(tvimdesign: Command, tmp_path: Path, study: Path) -> None:
    done = tvimdesign("run", study, "--no-plots", "--out", tmp_path / "out")
    assert done.returncode == 0, done.stderr
    cad = tmp_path / "out/cad"
    assert all(check["ok"] for check in json.loads((cad / "checks.json").read_text())["checks"])
    mode = json.loads((tmp_path / "out/design.json").read_text())["mode"]
    pcl = {"shear": "pcl_arc", "compression": "pcl_block"}[mode]
    parts = ("housing", "rotor", "link", "retainer", pcl, "heater", "spring_left", "spring_right")
    for part in parts:
        assert (cad / f"step/{part}.step").stat().st_size > 500
    for part in parts[:5]:
        assert (cad / f"print/{part}.3mf").stat().st_size > 500
    for part in parts[:4]:
        assert (cad / f"drawings/{part}.pdf").stat().st_size > 10_000
    for name in ("assembly.step", "assembly.glb", "preview.png", "views/exploded.png", "views/section.png"):
        assert (cad / name).stat().st_size > 10_000
    for name in ("bom.csv", "assembly.md", "springs/spring.csv", "springs/spring.pdf"):
        assert (cad / name).stat().st_size > 500
