"""Every way in which IPOPT can end has words, and most a next step."""

from __future__ import annotations

import re
from pathlib import Path

import casadi

from tvimdesign.solve.optimizer.statuses import MEANINGS, meaning


def _statuses() -> set[str]:
    """Return the statuses in CasADi's interface to IPOPT, read off the library itself."""
    found = sorted(Path(casadi.__file__).parent.glob("*casadi_nlpsol_ipopt*"))
    assert found, "CasADi keeps its interface to IPOPT elsewhere: look there"
    words = re.findall(rb"\0([A-Z][A-Za-z]+(?:_[A-Za-z]+)+)(?=\0)", found[0].read_bytes())
    return {word.decode() for word in words if not word.decode().isupper()}


def test_every_status_casadi_can_give_has_a_meaning() -> None:
    statuses = _statuses()
    assert {"Solve_Succeeded", "Infeasible_Problem_Detected", "Restoration_Failed"} <= statuses
    assert statuses <= set(MEANINGS)


def test_every_failure_has_a_next_step_and_no_words_of_ipopt() -> None:
    for status, found in MEANINGS.items():
        assert found.words
        assert "_" not in found.words
        assert found.step or status == "Solve_Succeeded"


def test_a_status_of_a_later_ipopt_is_shown_as_it_is() -> None:
    assert "phase of the moon" in meaning("Phase_Of_The_Moon").words
