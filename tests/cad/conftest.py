"""The designs as fixtures, and their parts as the child process makes them."""

import os
from collections.abc import Callable
from pathlib import Path

import pytest
import quick_parts
from cad_designs import BLOCKS, CASES, Made, design_of, whole
from shared_solids import _shared_solids

from tvimdesign.cad import CadReport, make_cad
from tvimdesign.cad.make import JOB
from tvimdesign.study.design import Design, write_design

__all__ = ["_shared_solids"]

QUICK = {"paper", "blocks"}
"""Cases that the fast tests take; every case is one of the slow tests."""


@pytest.fixture(
    scope="session", params=[pytest.param(case, marks=[] if case in QUICK else pytest.mark.slow) for case in CASES]
)
def design(request: pytest.FixtureRequest) -> Design:
    mode, overrides = CASES[request.param]
    return design_of(request.param, overrides, mode)


@pytest.fixture(scope="session")
def paper() -> Design:
    return design_of("paper", {})


@pytest.fixture(scope="session")
def blocks() -> Design:
    return design_of("blocks", BLOCKS, "compression")


@pytest.fixture(
    scope="session",
    params=["quick paper", *(pytest.param(name, marks=pytest.mark.slow) for name in ("paper", "blocks"))],
)
def made(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Made:
    """Return the parts of the paper's size in either mode; the quick ones without most of the checks on the solids."""
    folder, name = tmp_path_factory.mktemp("cad"), request.param.removeprefix("quick ")
    design = whole(request.getfixturevalue(name))
    write_design(design, folder / "design.json")
    steps: list[str] = []
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("PYTHONPATH", str(Path(quick_parts.__file__).parent), prepend=os.pathsep)
        job = quick_parts.__name__ if name != request.param else JOB
        report = make_cad(folder / "design.json", folder / "cad", steps.append, job=job)
    return Made(design, report, steps, whole=name == request.param)


@pytest.fixture
def job(tmp_path: Path) -> Callable[..., CadReport]:
    """Make the parts of the paper's module with some values changed behind the model's back."""

    def run(**values: float) -> CadReport:
        good = whole(design_of("changed", {}))
        design = good.model_copy(update={"values": good.values | values})
        write_design(design, tmp_path / "design.json")
        return make_cad(tmp_path / "design.json", tmp_path / "cad")

    return run
