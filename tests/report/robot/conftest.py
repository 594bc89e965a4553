"""Both modes, which every model for simulators is written of."""

import pytest


@pytest.fixture(params=["shear", "compression"])
def mode(request: pytest.FixtureRequest) -> str:
    return str(request.param)
