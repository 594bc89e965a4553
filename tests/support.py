"""Names that tests share: where the project is, its studies, and the type of the command fixture."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from subprocess import CompletedProcess

from tvimdesign.solve.model import Model
from tvimdesign.solve.simulate import Simulator

ROOT = Path(__file__).resolve().parents[1]
STUDIES = sorted((ROOT / "studies").glob("*.yaml"))
Command = Callable[..., CompletedProcess[str]]


def fine(model: Model) -> Simulator:
    """A simulator ten thousand times as exact as the product's, for what is differenced or held to many digits."""
    return Simulator(model, tolerance=1e-9, steps=200)
