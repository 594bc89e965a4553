"""A small study to explore, and a server with a client that talks to its socket."""

import asyncio
from collections.abc import AsyncIterator, Callable, Coroutine
from concurrent.futures import ThreadPoolExecutor
from contextlib import asynccontextmanager
from pathlib import Path
from typing import Any, TypeVar

from aiohttp import ClientWebSocketResponse
from aiohttp.test_utils import TestClient, TestServer
from support import sample_text

from tvimdesign.explore.server import Server

Result = TypeVar("Result")
SMALL = sample_text("explored")
TOKEN = "a-token-for-tests"
LONGEST = 180.0
"""Seconds that a test waits for a message on a busy machine."""


def small_study(folder: Path, text: str = SMALL) -> Path:
    """Write the study."""
    path = folder / "small.yaml"
    path.write_text(text, encoding="utf-8")
    return path


def awaited(work: Coroutine[Any, Any, Result]) -> Result:
    """Return what a coroutine comes to, in a thread of its own: this one may have Playwright's event loop running."""
    with ThreadPoolExecutor(1) as thread:
        return thread.submit(asyncio.run, work).result()


class Talk:
    """One page's socket: sends messages, and waits for those that are looked for."""

    def __init__(self, socket: ClientWebSocketResponse) -> None:
        self.socket = socket
        self.heard: list[dict[str, Any]] = []

    async def until(self, wanted: Callable[[dict[str, Any]], bool]) -> dict[str, Any]:
        """Return the first message from now on that is wanted."""
        async with asyncio.timeout(LONGEST):
            while True:
                message = await self.socket.receive_json()
                self.heard.append(message)
                if wanted(message):
                    return message

    async def kind(self, kind: str) -> dict[str, Any]:
        """Return the next message of a kind."""
        return await self.until(lambda message: message["kind"] == kind)

    async def answer(self, stage: str) -> dict[str, Any]:
        """Return the next answer of a stage."""
        return await self.until(lambda sent: sent["kind"] == "answer" and sent["shown"]["stage"] == stage)

    async def change(self, **message: Any) -> dict[str, Any]:
        """Send a message and return the state that follows."""
        await self.send(**message)
        return await self.kind("state")

    async def save(self, file: str) -> None:
        """Save the study."""
        await self.send(kind="save", file=file)
        await self.kind("saved")

    async def send(self, **message: Any) -> None:
        """Send a message."""
        await self.socket.send_json(message)


@asynccontextmanager
async def served(study: Path, folder: Path) -> AsyncIterator[tuple[Server, TestClient]]:
    """Serve a study, with a client for it."""
    server = Server(study, folder, token=TOKEN)
    async with TestServer(server.app(), host="127.0.0.1") as started, TestClient(started) as client:
        yield server, client


@asynccontextmanager
async def talking(study: Path, folder: Path) -> AsyncIterator[Talk]:
    """Open a page of the study's server, and read its state."""
    async with served(study, folder) as (_, client), client.ws_connect(f"/{TOKEN}/socket") as socket:
        talk = Talk(socket)
        await talk.kind("state")
        yield talk
