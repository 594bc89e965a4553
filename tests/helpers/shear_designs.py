"""The shear module compiled as the solver compiles it, in designs of different proportions."""

from collections.abc import Callable
from functools import cache
from typing import Any

import pytest
from support import fine, tight

from tvimdesign.device import table_for
from tvimdesign.simulation.working_cycle.cycle import Cycle
from tvimdesign.simulation.working_cycle.device_functions import DeviceFunctions
from tvimdesign.study import given, read_study_text

Build = Callable[..., DeviceFunctions]
# Designs of other proportions: thin and fast, thick and slow, under an aluminium rotor with a fan on the cold side.
DESIGNS: dict[str, dict[str, float | str]] = {
    "as it is": {},
    "thin": {"pcl_thickness": 0.6e-3, "current": 2.2},
    "thick": {"pcl_thickness": 2e-3, "current": 1.8, "rotor_thickness": 3e-3},
    "aluminium": {"structure_material": "aluminum_6061_t6", "current": 3.0, "cold_side_coefficient": 60.0},
    "sink": {"cold_side": "sink", "cooling_current": 0.8},
    "equilibrium": {"phase_model": "equilibrium"},
}


@pytest.fixture(scope="session")
def build() -> Build:
    """Return a model of one of the designs, built once."""

    @cache
    def make(
        design: str = "as it is", cells: int = 12, rotor_cells: int | None = None, **module: float
    ) -> DeviceFunctions:
        table = table_for("shear")
        study = read_study_text("mode: shear\n", "a test").model_copy(update={"module": DESIGNS[design]})
        inputs: dict[str, Any] = given(study)
        if rotor_cells is not None:
            inputs["rotor_cells"] = rotor_cells
        return DeviceFunctions(table, {**inputs, **module}, ("cold", "hot"), cells)

    return make


@pytest.fixture(scope="session")
def switch_of(build: Build) -> Callable[[str], Cycle]:
    """Return the switch of one of the designs as the product simulates it."""

    @cache
    def run(design: str) -> Cycle:
        model = build(design)
        return tight(model).run(model.start)

    return run


@pytest.fixture(scope="session")
def judged(build: Build) -> Callable[[str], Cycle]:
    """Return the switch of one of the designs as CVODES has it."""

    @cache
    def run(design: str) -> Cycle:
        model = build(design)
        return fine(model).run(model.start)

    return run
