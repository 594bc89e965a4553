"""What the summary says of the best constant current beside a profile."""

from types import SimpleNamespace
from typing import Any

import pytest

from tvimdesign.report.run.full_summary import constant_against


@pytest.mark.parametrize(
    ("margins", "objective", "said"),
    [
        (None, 1.1, "its objective is 10.0% higher"),
        (None, 0.9, "its objective is 10.0% lower"),
        ("some", 0.9, "it has no margins for the yield, the profile's module has"),
    ],
)
def test_a_constant_current_is_told_higher_lower_or_unlike(margins: Any, objective: float, said: str) -> None:
    found: Any = SimpleNamespace(objective=1.0, yield_reached=margins)
    assert constant_against(objective, found) == said
