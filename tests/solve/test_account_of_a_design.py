"""Account of a search with a design: everything but what differs from run to run."""

from types import SimpleNamespace
from typing import Any

from tvimdesign.solve.nlp.solution import Start
from tvimdesign.solve.result import _plain


def account(seconds: float) -> dict[str, Any]:
    """Return the account of a search of two starts that took as long each."""
    starts = [
        Start(number, "Solve_Succeeded", True, 20 + number, 0.5, seconds, {"wire_diameter": 1e-3}, {"wire_diameter": w})
        for number, w in ((1, 1.1e-3), (2, 1.3e-3))
    ]
    found: Any = SimpleNamespace(
        objective=0.5, reference={"module_mass": 0.1}, starts=starts, held=[], distinct_optima=lambda: starts[:1]
    )
    return _plain(found)


def test_an_account_lists_every_start_whatever_time_it_took() -> None:
    assert account(0.7) == account(31.0)
    first, second = account(0.7)["starts"]
    assert (first["number"], first["iterations"], first["end"]) == (1, 21, {"wire_diameter": 1.1e-3})
    assert (second["number"], second["converged"], second["begin"]) == (2, True, {"wire_diameter": 1e-3})
    assert account(0.7)["distinct_optima"] == [1]


def test_a_design_that_no_search_found_has_none() -> None:
    assert _plain(None) == {}
