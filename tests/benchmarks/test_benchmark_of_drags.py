"""The hand of the explorer's benchmark: every drag is a change, and it turns back where there is no module."""

from __future__ import annotations

from itertools import islice
from typing import Any, cast

import pytest
from aiohttp import ClientWebSocketResponse
from explore_drags import Hand
from support import ROOT

from tvimdesign.study import read_study


@pytest.fixture
def hand() -> Hand:
    """A hand that nobody answers."""
    return Hand(cast(ClientWebSocketResponse, None), read_study(ROOT / "studies/paper_shear.yaml"))


def test_no_drag_says_what_was_said_before_for_it_would_not_be_answered(hand: Hand) -> None:
    for drags in (hand.variables(), hand.requirements()):
        told: dict[str, Any] = {}
        for drag in islice(drags, 3000):
            said = drag.get("text", drag.get("texts"))
            assert told.get(drag["name"]) != said
            told[drag["name"]] = said


def test_a_drag_to_where_there_is_no_module_is_taken_back_to_where_one_was(hand: Hand) -> None:
    drags = hand.variables()
    for _ in range(50):
        hand.is_refused = False
        there = next(drags)
        hand.is_refused = True
        back = next(drags)
        assert back["name"] == there["name"]
        assert float(back["text"].split()[0]) == pytest.approx(hand.values[back["name"]], rel=1e-8)
        assert back["text"] != there["text"]
