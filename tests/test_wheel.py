"""Fit, verify and validation from a wheel, in an interpreter of its own and outside the repository.

The cases of the validation come from the source distribution, which has them; what they compare is the wheel's package.

With `FE_PYTHON`, a Python that has netgen and ngsolve, a design is verified; without it the command has to say what it
lacks. `make check-wheel FE_PYTHON=...` runs this file.
"""

import os
import re
import shutil
import site
import subprocess
import sys
import tarfile
import venv
import zipfile
from pathlib import Path

import pytest
from answers import shipped_answer
from support import ROOT, STUDIES, run_process

from tvimdesign.study.design import write_design

pytestmark = pytest.mark.slow

ANGLES = (0.02, 0.041, 0.059, 0.081, 0.1, 0.079, 0.061, 0.04)


class Installed:
    """The wheel in an environment of its own, with this interpreter's libraries but for the package."""

    def __init__(self, folder: Path) -> None:
        """Build the wheel from a copy of the sources and install it."""
        self.folder = folder
        source = folder / "source"
        shutil.copytree(ROOT / "tvimdesign", source / "tvimdesign", ignore=shutil.ignore_patterns("__pycache__"))
        files = ["pyproject.toml", "README.md", "setup.py", "LICENSE", "MANIFEST.in"]
        for name in [*files, "studies", "tests/studies", "docs", "validation"]:
            path = ROOT / name
            if path.exists():
                (shutil.copytree if path.is_dir() else shutil.copy)(path, source / name)
        pip = [sys.executable, "-m", "pip", "--quiet", "--disable-pip-version-check"]
        run([*pip, "wheel", "--no-deps", "--no-build-isolation", "--wheel-dir", folder, source], folder)
        self.wheel = next(folder.glob("tvimdesign-*.whl"))
        build = "import sys, setuptools.build_meta as build; build.build_sdist(sys.argv[1])"
        run([sys.executable, "-c", build, folder], source)
        self.sources = next(folder.glob("tvimdesign-*.tar.gz"))
        home = folder / "environment"
        venv.create(home, symlinks=True)
        self.python = home / "bin/python"
        own = next(home.glob("lib/python*/site-packages"))
        run([*pip, "--python", self.python, "install", "--no-deps", self.wheel], folder)
        # Libraries come from where the tests run; a folder named so runs no .pth of its own, so no editable install.
        (own / "libraries.pth").write_text("".join(f"{path}\n" for path in site.getsitepackages()))
        shutil.rmtree(source)

    def says(self, *words: object) -> subprocess.CompletedProcess[str]:
        """Run the command line in a folder outside the repository."""
        return run([self.python, "-m", "tvimdesign", *words], self.folder, check=False)


def run(words: list[object], folder: Path, *, check: bool = True) -> subprocess.CompletedProcess[str]:
    known = {name: value for name, value in os.environ.items() if name not in ("PYTHONPATH", "VIRTUAL_ENV")}
    done = run_process(words, 3600.0, cwd=folder, env=known, text=True)
    if check:
        done.check_returncode()
    return done


@pytest.fixture(scope="module")
def installed(tmp_path_factory: pytest.TempPathFactory) -> Installed:
    return Installed(tmp_path_factory.mktemp("wheel"))


def test_the_package_is_the_wheel_s_and_has_solvers_and_studies(installed):
    where = run([installed.python, "-c", "import tvimdesign; print(tvimdesign.__file__)"], installed.folder).stdout
    assert Path(where.strip()).is_relative_to(installed.folder)
    names = zipfile.ZipFile(installed.wheel).namelist()
    solvers = {path.name for path in (ROOT / "tvimdesign/cad/fe/solvers").glob("*.py")}
    assert solvers == {Path(name).name for name in names if name.startswith("tvimdesign/cad/fe/solvers/")}
    assert "tvimdesign/__init__.pyi" in names
    assert installed.says("new", "--list").stdout.splitlines()[::2] == [study.stem for study in STUDIES]


def test_a_fit_and_its_record(installed):
    loads = [0.1, 0.2, 0.3, 0.4, 0.5, 0.4, 0.3, 0.2]
    rows = "".join(f"{torque},{angle}\n" for torque, angle in zip(loads, ANGLES, strict=True))
    (installed.folder / "weights.csv").write_text("torque [N.m],angle [rad]\n" + rows)
    sizes = ["--set", "wire_diameter=2 mm", "--set", "coil_diameter=20 mm", "--set", "coil_count=5"]
    done = installed.says("fit", "weights.csv", *sizes, "--out", "fitted")
    assert done.returncode == 0, done.stderr
    assert "stiffness" in (installed.folder / "fitted/fit.json").read_text()


def test_a_verification_of_a_shipped_design(installed):
    write_design(shipped_answer("paper_reconstructed").design, installed.folder / "design.json")
    solver = os.environ.get("FE_PYTHON")
    done = installed.says("verify", "design.json", "--out", "verified", "--fe-python", solver or sys.executable)
    if not solver:
        assert done.returncode != 0
        assert "tvimdesign[fe]" in done.stderr + done.stdout
        return
    assert done.returncode == 0, done.stderr
    assert (installed.folder / "verified/report.html").stat().st_size > 1e5


def test_the_cases_of_the_validation(installed):
    # All of them, and each comes to what the page says of it.
    with tarfile.open(installed.sources) as archive:
        for member in archive:
            member.name = member.name.partition("/")[2]
            if member.name.startswith(("validation/", "studies/", "tests/studies/")):
                archive.extract(member, installed.folder, filter="data")
    command = [installed.python, "validation/run.py", "--docs", "compared"]
    done = run(command, installed.folder, check=False)
    outcomes = verdicts(installed.folder / "compared/validation.md")
    assert "cannot be compared" not in done.stdout, done.stdout
    assert outcomes == verdicts(ROOT / "docs/validation.md"), done.stdout
    assert len(outcomes) == len(list((ROOT / "validation/cases").glob("*/case.yaml")))


def verdicts(page: Path) -> dict[str, str]:
    """Return the verdict of each case on the validation's page, by its name."""
    rows = re.findall(r"^\| \[.*\]\(#(\w+)\) \|.*\| ([A-Za-z ]+) \|$", page.read_text(), re.MULTILINE)
    return dict(rows)
