"""The documents say what is so."""

from __future__ import annotations

import re
import shlex
from pathlib import Path

import pytest
import yaml
from support import ROOT, Command

from tvimdesign.catalog import Catalog, check_records
from tvimdesign.device import table_for
from tvimdesign.solve.result import answer
from tvimdesign.study import read_study, read_study_text

README = (ROOT / "README.md").read_text()


def _blocks(language: str) -> list[str]:
    return re.findall(rf"^```{language}\n(.*?)^```", README, re.M | re.S)


def test_the_first_two_commands_are_the_study_and_the_tests() -> None:
    start = README.index("## Quick start")
    assert re.findall(r"^```sh\n(.*?)^```", README[start:], re.M | re.S)[:2] == ["make study\n", "make test\n"]


@pytest.mark.parametrize(("study", "column"), [("paper_as_published", 1), ("paper_shear", 2)])
def test_the_table_in_the_readme_is_what_the_studies_come_to(study: str, column: int) -> None:
    read = read_study(ROOT / f"studies/{study}.yaml")
    values = answer(read, Catalog(), table_for(read.mode)).design.values
    cold, hot = values["joint_stiffness@cold"], values["joint_stiffness@hot"]
    expected = {
        "envelope": f"{1e3 * values['envelope_diameter']:.0f} mm x {1e3 * values['envelope_height']:.1f} mm",
        "mass": f"{1e3 * values['module_mass']:.0f} g",
        "spring stiffness": f"{values['spring_stiffness']:.2f} N·m/rad",
        "stiffness cold / hot at 1 Hz": f"{cold:.0f} / {hot:.1f} N·m/rad",
        "torque held when frozen": f"{values['holding_torque']:.0f} N·m",
        "far face at 100 °C": f"{values['far_face_time']:.0f} s",
        "joint soft": f"{values['softening_time']:.0f} s",
        "joint stiff again, cold side in free air": f"{values['stiffening_time']:.0f} s",
        "every slice of the layer half frozen": f"{values['frozen_time']:.0f} s",
        "stiff again, as the melting curve would claim": f"{values['equilibrium_stiffening_time']:.0f} s",
    }
    rows = [[cell.strip() for cell in line.split("|")[1:-1]] for line in README.splitlines() if line.startswith("|")]
    reported = {row[0]: row[column] for row in rows if row[0] in expected}
    assert reported == expected


@pytest.mark.parametrize("block", [0, 1])
def test_the_studies_in_the_readme_have_an_optimum(block: int) -> None:
    study = read_study_text(_blocks("yaml")[block], "README.md")
    assert answer(study, Catalog(), table_for(study.mode)).design.status == "optimal"


def test_the_commands_in_the_readme_work(tvimdesign: Command, tmp_path: Path) -> None:
    lines = [line.split("#")[0] for line in _blocks("sh")[2].splitlines()]
    commands = [shlex.split(line)[1:] for line in lines if line.strip()]
    assert [words[0] for words in commands] == ["new", "check", "run", "cad", "rows", "simulate", "ledger"]
    for words in commands:
        if words[0] == "cad":  # the parts have their own tests; here its input is looked at
            assert (tmp_path / words[1]).exists()
            continue
        more = ["--no-cad", "--no-plots"] if words[0] == "run" else []
        done = tvimdesign(*words, *more, cwd=tmp_path)
        assert done.returncode == 0, done.stderr


def test_the_record_in_the_docs_is_one_that_can_be_used(tmp_path: Path) -> None:
    page = (ROOT / "docs/catalogue.md").read_text()
    record = re.findall(r"^```yaml\n(.*?)^```", page, re.M | re.S)[0]
    (tmp_path / "peltiers").mkdir()
    (tmp_path / "peltiers/my_pad.yaml").write_text(record)
    catalog = Catalog(tmp_path)
    assert check_records(catalog) == []
    text = f"mode: shear\ncatalog: {tmp_path}\nmodule: {{peltier_module: my_pad}}\n"
    study = read_study_text(text, "docs/catalogue.md")
    assert answer(study, catalog, table_for("shear")).design.choices["peltier_module"] == "my_pad"


def test_links_lead_somewhere() -> None:
    for page in (ROOT / "README.md", ROOT / "cad/README.md", *sorted((ROOT / "docs").glob("*.md"))):
        for target in re.findall(r"\]\(([^)#:]+)\)", page.read_text()):
            assert (page.parent / target).exists(), f"{page.name}: {target}"


def test_the_citation_has_the_package_s_version() -> None:
    import tvimdesign as package

    assert yaml.safe_load((ROOT / "CITATION.cff").read_text())["version"] == package.__version__


@pytest.mark.parametrize("floor", ["catalog", "physics", "device", "study", "solve", "cad", "report"])
def test_the_architecture_names_every_floor(floor: str) -> None:
    assert f"`{floor}/`" in (ROOT / "docs/architecture.md").read_text()
    assert (ROOT / "tvimdesign" / floor).is_dir()
