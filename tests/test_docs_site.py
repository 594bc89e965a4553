"""The docs site: built strictly, nothing from another host; theory names every equation, drawings every radius."""

import ast
import os
import re
import subprocess
import sys
from pathlib import Path

import pytest
from section_drawing import SECTIONS, missing
from support import ROOT, STUDIES

from tvimdesign.device import MODES, Output, table_for

THEORY = "\n".join(path.read_text() for path in sorted((ROOT / "docs/theory").glob("*.md")))
REFERENCES = (ROOT / "docs/theory/references.md").read_text()


def _public(module: Path) -> list[str]:
    """Public functions and classes of a file, as the pages name them: `spring.rate`."""
    body = ast.parse(module.read_text()).body
    named = [node.name for node in body if isinstance(node, (ast.FunctionDef, ast.ClassDef))]
    return [f"{module.stem}.{name}" for name in named if not name.startswith("_")]


def test_theory_names_every_equation_and_none_that_is_gone() -> None:
    names = [name for module in sorted((ROOT / "tvimdesign/physics").rglob("*.py")) for name in _public(module)]
    assert len(names) > 100
    without = [name for name in names if f"`{name}`" not in THEORY]
    assert not without, f"docs/theory does not name: {', '.join(without)}"
    modules = {module.stem: _public(module) for module in (ROOT / "tvimdesign/physics").rglob("*.py")}
    named = re.findall(r"`(\w+)\.(\w+)`", THEORY)
    gone = [f"{stem}.{name}" for stem, name in named if stem in modules and f"{stem}.{name}" not in modules[stem]]
    assert not gone


@pytest.mark.parametrize("mode", MODES)
def test_every_group_and_headline_of_the_table_has_a_page(mode: str) -> None:
    outputs = table_for(mode).outputs
    groups = {output.group for output in outputs if not output.hidden}
    headlines = {output.name for output in outputs if isinstance(output, Output) and output.headline}
    assert headlines
    without = sorted(name for name in groups | headlines if f"`{name}`" not in THEORY)
    assert not without, f"docs/theory does not name: {', '.join(without)}"


def test_every_source_that_a_page_cites_is_in_the_references() -> None:
    pages = [path for path in (ROOT / "docs/theory").glob("*.md") if path.name != "references.md"]
    marks = {mark for path in pages for mark in re.findall(r"\[([A-Z][A-Za-z, ]*)\](?!\()", path.read_text())}
    cited = {key for mark in marks for key in mark.split(", ")} - {"N", "K", "V", "W", "J", "Pa", "Hz", "A", "N/m"}
    assert {"Sh", "Fe", "GL"} <= cited
    assert not [key for key in cited if f"| [{key}] |" not in REFERENCES]


@pytest.mark.parametrize("study", SECTIONS)
def test_a_section_labels_every_radius_level_and_height(study: str) -> None:
    assert not missing(study)
    drawing = (ROOT / f"docs/pictures/section_{study}.svg").read_text()
    assert "housing_outer_radius" in drawing


def test_every_study_has_a_small_picture() -> None:
    pictures = ROOT / "docs/pictures/studies"
    assert {path.stem for path in pictures.glob("*.png")} == {path.stem for path in STUDIES}
    assert all(path.stat().st_size < 40_000 for path in pictures.glob("*.png"))


@pytest.mark.gate
def test_the_site_builds_strictly_and_loads_nothing_from_another_host(tmp_path: Path) -> None:
    done = subprocess.run(
        [sys.executable, "-m", "mkdocs", "build", "--quiet", "--strict", "--site-dir", str(tmp_path / "site")],
        cwd=ROOT, capture_output=True, text=True, check=False,
        env={**os.environ, "NO_MKDOCS_2_WARNING": "1", "PYTHONPATH": str(ROOT)},
    )  # fmt: skip
    assert done.returncode == 0, done.stderr[-2000:]
    site = tmp_path / "site"
    pages = {path.relative_to(site).as_posix(): path.read_text() for path in site.rglob("*.html")}
    assert {"index.html", "tutorial.html", "theory/springs.html", "reference/layout.html", "gallery.html"} <= set(pages)
    for name, text in pages.items():
        loaded = re.findall(r"<(?:script|img|iframe|link)\b[^>]*?(?:src|href)=\"?(https?:[^\"\s>]+)", text)
        assert not loaded, f"{name} loads {loaded}"
    assert "<math" in pages["theory/springs.html"]
    assert 'id="wire_diameter"' in pages["reference/layout.html"]
