"""One small sweep, and its table as one process makes it."""

from pathlib import Path

import pytest
from small_sweeps import SMALL, swept


@pytest.fixture(scope="session")
def study_file(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("sweep") / "small.yaml"
    path.write_text(SMALL)
    return path


@pytest.fixture(scope="session")
def one_process(study_file: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return the folder of the sweep that one worker process made."""
    out = tmp_path_factory.mktemp("one") / "out"
    swept(study_file, out, workers=1)
    return out
