"""An explorer that is talked to and ended at some moment, and what it has kept of what was said."""

from __future__ import annotations

import contextlib
import json
import random
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any

import aiohttp

from tvimdesign.base.errors import TvimError
from tvimdesign.explore.source import open_source
from tvimdesign.explore.state import open_history

Changes = dict[str, str]
"""Values of the module under the hand, by name."""


class Conversation:
    """Values set one after the other, each once the one before is kept."""

    def __init__(self, seed: int) -> None:
        """Start without messages."""
        self._draw = random.Random(seed)
        self.history: Changes = {}
        """What the explorer said that it kept."""
        self.requested: Changes = {}
        """The same, and what it has not answered yet."""

    async def lead(self, address: str) -> None:
        """Talk to the explorer at an address until it is gone."""
        with contextlib.suppress(aiohttp.ClientError, OSError, json.JSONDecodeError, TypeError):
            async with aiohttp.ClientSession() as client, client.ws_connect(f"{address}socket") as socket:
                await _wait_for_state(socket, lambda _: True)
                await socket.send_json({"kind": "way", "way": "evaluate"})
                await _wait_for_state(socket, lambda state: state["way"] == "evaluate")
                while True:
                    name, text = self._draw.choice([
                        ("pcl_thickness", f"{self._draw.uniform(0.6, 2.0):.4f} mm"),
                        ("current", f"{self._draw.uniform(0.8, 2.5):.4f} A"),
                    ])  # fmt: skip
                    self.requested = {**self.history, name: text}
                    await socket.send_json({"kind": "set", "name": name, "text": text})
                    await _wait_for_state(socket, partial(_has, name=name, text=text))
                    self.history = self.requested


async def _wait_for_state(socket: aiohttp.ClientWebSocketResponse, wanted: Callable[[dict[str, Any]], bool]) -> None:
    """Wait for a state that is wanted."""
    while True:
        message = await socket.receive_json()
        if message["kind"] == "state" and wanted(message):
            return


def _has(state: dict[str, Any], *, name: str, text: str) -> bool:
    return any(variable["name"] == name and variable["text"] == text for variable in state["controls"]["variables"])


def not_kept(conversation: Conversation, study: Path, folder: Path) -> list[str]:
    """Return what an explorer that is opened again has lost."""
    source = open_source(study)
    try:
        there = open_history(folder, source.text, source.first).state.at
    except TvimError as error:
        return [f"cannot be opened again: {error}"]
    wanted = [{**source.first.at, **changes} for changes in (conversation.history, conversation.requested)]
    return [] if there in wanted else [f"kept {there}, said {wanted[0]}"]
