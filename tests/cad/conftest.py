"""The designs as fixtures, and their parts as the child process makes them."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest
from cad_designs import CASES, design_of

from tvimdesign.cad import CadReport, make_cad
from tvimdesign.study.design import Design, write_design


@pytest.fixture(scope="session", params=CASES)
def design(request: pytest.FixtureRequest) -> Design:
    return design_of(request.param, CASES[request.param])


@pytest.fixture(scope="session")
def paper() -> Design:
    return design_of("paper", {})


@pytest.fixture(scope="session")
def made(tmp_path_factory: pytest.TempPathFactory) -> tuple[CadReport, list[str]]:
    """The paper's parts, made by the child process, and what it said on the way."""
    folder = tmp_path_factory.mktemp("cad")
    write_design(design_of("paper", {}), folder / "design.json")
    steps: list[str] = []
    return make_cad(folder / "design.json", folder / "cad", 120.0, steps.append), steps


@pytest.fixture
def job(tmp_path: Path) -> Callable[..., CadReport]:
    """Make the parts of the paper's module with some values changed behind the model's back."""

    def run(timeout_s: float = 60.0, **values: float) -> CadReport:
        good = design_of("changed", {})
        design = good.model_copy(update={"values": good.values | values})
        write_design(design, tmp_path / "design.json")
        return make_cad(tmp_path / "design.json", tmp_path / "cad", timeout_s)

    return run
