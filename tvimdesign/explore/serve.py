"""The command `explore`: opens a study or a result, serves its page, and says where."""

from __future__ import annotations

import asyncio
import contextlib
import re
import signal
import webbrowser
from collections.abc import Sequence
from pathlib import Path

from aiohttp import web

from tvimdesign.base.errors import InputError
from tvimdesign.explore.server import FAREWELL, HOST, Server
from tvimdesign.explore.states.history import open_kept
from tvimdesign.explore.states.source import open_source
from tvimdesign.report.output.progress import wide_console

SHORTEST_TOKEN = 16
_TOKEN = re.compile(r"[A-Za-z0-9_-]*")


def serve(
    source: Path, folder: Path, port: int, token: str, *, overwrite: bool, browse: bool, settings: Sequence[str]
) -> None:
    """Serve until interrupted. Raises InputError for what cannot be opened, a short token, and a port that is taken."""
    if token and (len(token) < SHORTEST_TOKEN or not _TOKEN.fullmatch(token)):
        raise InputError(
            f"--token: needs {SHORTEST_TOKEN} or more letters, digits, - and _; leave it out to have one drawn"
        )
    opened = open_source(source, settings)
    open_kept(folder, opened.text, opened.first, overwrite=overwrite)
    with contextlib.suppress(KeyboardInterrupt):
        asyncio.run(_serve(Server(source, folder, settings, token, overwrite=overwrite), port, browse))


async def _serve(server: Server, port: int, browse: bool) -> None:
    runner = web.AppRunner(server.app(), access_log=None, shutdown_timeout=FAREWELL)
    await runner.setup()
    try:
        site = web.TCPSite(runner, HOST, port)
        try:
            await site.start()
        except OSError as error:
            raise InputError(f"--port {port}: cannot be used on {HOST}: {error.strerror}; 0 takes a free one") from None
        address = f"http://{HOST}:{runner.addresses[0][1]}/{server.token}/"
        wide_console().print(f"Explorer at {address}", soft_wrap=True)
        wide_console().print("Open it in a browser on this machine; Ctrl-C ends it, and nothing is lost.")
        if browse:
            webbrowser.open(address)
        await _until_ended()
    finally:
        await runner.cleanup()


async def _until_ended() -> None:
    ended = asyncio.Event()
    for number in (signal.SIGINT, signal.SIGTERM):
        with contextlib.suppress(NotImplementedError):  # Windows has KeyboardInterrupt alone
            asyncio.get_running_loop().add_signal_handler(number, ended.set)
    await ended.wait()
