"""The page of a run shows the verification of its design: put in when it is verified, found when it is run again."""

import json
from pathlib import Path

from tvimdesign.base.atomic_files import digest_of
from tvimdesign.base.manifest import MANIFEST
from tvimdesign.base.results_folder import ResultsFolder
from tvimdesign.cad.fe.model_comparison import Compared
from tvimdesign.cad.fe.run_solvers import Solved
from tvimdesign.page.blocks import Page, Picture, Points, Section, Words
from tvimdesign.report.output.page_sections import write_page
from tvimdesign.report.run.verification_section import (
    folder_of_verification,
    put_on_page,
    verification_section,
    verification_sections,
    verified,
)

ROWS = [Compared("hub", "N*m/rad", "frozen joint", model=400.0, fe=505.0, coarse=500.0)]


def run_folder(place: Path) -> Path:
    with ResultsFolder(place, False) as folder:
        folder.write("design.json", '{"name": "wrist"}')
        page = Page("Wrist", "shear module", "OPTIMAL", "good", [Points(["x"])], None,
                    [Section("study", "Study", [Words(["mode: shear"])])], "", {})  # fmt: skip
        write_page(folder, page)
        folder.finish("optimal", {}, {})
    return place


def verification(of: Path) -> Path:
    with ResultsFolder(folder_of_verification(of), False) as folder:
        folder.write_json("verify.json", verified(ROWS, {"joint": Solved({}, {}, of)}))
        folder.finish("verified", {"design": of / "design.json"}, {})
    return folder.path


def test_a_verification_goes_onto_the_page_of_its_own_design_alone(tmp_path: Path) -> None:
    run = run_folder(tmp_path / "wrist")
    assert not verification_sections(run)
    assert put_on_page(verification(run), run)
    text = (run / "report.html").read_text()
    assert text.index('id="verification"') < text.index('id="study"')
    assert "0.792" in text
    assert "beyond: hub" in text
    assert json.loads((run / MANIFEST).read_text())["files"]["report.html"] == digest_of(run / "report.html")
    (section,) = verification_sections(run)
    assert section.name == "verification"
    run = run_folder(tmp_path / "other")
    folder = verification(run)
    (run / "design.json").write_text('{"name": "another"}')
    before = (run / "report.html").read_bytes()
    assert not put_on_page(folder, run)
    assert not verification_sections(run)
    assert (run / "report.html").read_bytes() == before


def test_the_page_takes_the_fields_it_has_room_for(tmp_path: Path) -> None:
    run = run_folder(tmp_path / "wrist")
    folder = verification(run)
    for name, size in (("joint", 1000), ("spring", 1_500_000), ("link", 2000)):
        (folder / f"{name}.png").write_bytes(b"x" * size)
    words = [block.says for block in verification_section(folder, run, 1e5).blocks if isinstance(block, Picture)]
    assert words == ["Stress in the frozen joint, bent by the torque on its core",
                     "Stress in the link under a force in its tool hole"]  # fmt: skip
    assert put_on_page(folder, run)
    assert (run / "report.html").read_text().count("data:image/png") == 3
