"""The modules as the tests evaluate them: two operating points, default inputs and records."""

from typing import Any

import numpy as np
import pytest
from device_values import inputs_of
from support import tight

from tvimdesign.device import Supplied, Table, table_for
from tvimdesign.simulation.working_cycle.cycle import Cycle, Simulator
from tvimdesign.simulation.working_cycle.device_functions import DeviceFunctions

POINTS = ("cold", "hot")


@pytest.fixture(scope="session")
def table() -> Table:
    return table_for("shear")


@pytest.fixture(scope="session")
def inputs() -> dict[str, Any]:
    return inputs_of()


@pytest.fixture(scope="session", params=["unity", "geometry"])
def model(request: pytest.FixtureRequest, table: Table) -> DeviceFunctions:
    return DeviceFunctions(table, inputs_of(transmission=request.param), POINTS, 12)


@pytest.fixture(scope="session")
def unity(table: Table) -> DeviceFunctions:
    return DeviceFunctions(table, inputs_of(), POINTS, 12)


@pytest.fixture(scope="session")
def simulator(unity: DeviceFunctions) -> Simulator:
    return tight(unity)


@pytest.fixture(scope="session")
def cycle(simulator: Simulator, unity: DeviceFunctions) -> Cycle:
    return simulator.run(unity.start)


@pytest.fixture(scope="session")
def squeezed() -> dict[str, Any]:
    """Inputs of the compression module by default, at a current that gets its slender blocks to 100 degC."""
    return inputs_of("compression", current=3.0)


@pytest.fixture(scope="session")
def squeezed_model(squeezed: dict[str, Any]) -> DeviceFunctions:
    return DeviceFunctions(table_for("compression"), squeezed, POINTS, 12)


@pytest.fixture(scope="session")
def squeezed_switch(squeezed_model: DeviceFunctions) -> Cycle:
    return tight(squeezed_model).run(squeezed_model.start)


@pytest.fixture(scope="session")
def algebraic(table: Table) -> list[str]:
    """Full names of the outputs a study can ask for that no simulation supplies."""
    return [name for name in table.names(POINTS) if not isinstance(table.quantity(name), Supplied)]


@pytest.fixture(scope="session")
def numbers(cycle: Cycle) -> dict[str, float]:
    """Values of what a simulation supplies."""
    assert all(np.isfinite(value) for value in cycle.values.values())
    return dict(cycle.values)
