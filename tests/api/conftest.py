"""One study that is optimised within seconds, and its result, which the tests of the door share."""

import pytest
from support import study_path

import tvimdesign as tvim


@pytest.fixture(scope="session")
def study() -> tvim.Study:
    return tvim.load(study_path("paper_shear"))


@pytest.fixture(scope="session")
def result(study: tvim.Study) -> tvim.Result[tvim.Study]:
    """Run the study from one start."""
    return study.set({"solver.starts": 1}).run(progress=False)
