"""The simulator people get is looser than the one other tests difference: it must still find the same cycle."""

from collections.abc import Callable

import pytest

from tvimdesign.solve.model import Model
from tvimdesign.solve.simulate import Simulator, Switch


@pytest.mark.parametrize("design", ["as it is", "thin", "thick", "aluminium"])
def test_the_shipped_tolerance_finds_the_values_of_the_tight_one(
    design: str, build: Callable[..., Model], switch_of: Callable[[str], Switch]
) -> None:
    model, tight = build(design), switch_of(design)
    shipped = Simulator(model).run(model.start)
    for name, value in tight.values.items():
        assert shipped.values[name] == pytest.approx(value, rel=2e-4), name
