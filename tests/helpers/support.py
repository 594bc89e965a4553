"""Names that tests share: where the project is, its studies, and the type of the command fixture."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from subprocess import CompletedProcess

from tvimdesign.simulation.working_cycle.cycle import Simulator
from tvimdesign.simulation.working_cycle.device_functions import DeviceFunctions

ROOT = Path(__file__).resolve().parents[2]
STUDIES = sorted((ROOT / "studies").glob("*.yaml"))
RELEASED = ("paper_shear", "paper_compression", "machined_shear", "machined_compression")
"""Studies whose parts are in cad/."""
Command = Callable[..., CompletedProcess[str]]
TRANSFORMED = {"hold_angle", "set_angle", "backlash", "relaxation_loss"}
"""Rows read off a Laplace transform, whose weights cancel: other rounding shows in the tenth digit."""

USED_BY_PARTS = {
    "hole_compensation", "making_method", "thinnest_wall", "overhang_angle", "bridge_span", "hole_depth_ratio",
    "bed_length", "bed_width", "bed_height", "flange_azimuth",
}  # fmt: skip
"""Rows that print files and checks on the solids read alone."""


def digits(name: str, usual: float) -> float:
    """Relative tolerance between two ways to compute a row, by full name, from the one that is usual."""
    return 1e-9 if name.partition("@")[0] in TRANSFORMED else usual


def fine(model: DeviceFunctions) -> Simulator:
    """A simulator ten thousand times as exact as the product's, for what is differenced or held to many digits."""
    return Simulator(model, tolerance=1e-9, steps=200)
