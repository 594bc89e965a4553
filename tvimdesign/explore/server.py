"""The local server: a page, its files, and a socket; on the loopback address alone, to who has the token."""

import asyncio
import contextlib
import hmac
import json
import logging
import re
import secrets
import signal
import webbrowser
from collections.abc import AsyncIterator, Awaitable, Callable, Sequence
from importlib import resources
from pathlib import Path
from typing import Any

from aiohttp import WSCloseCode, WSMsgType, web
from aiohttp.http_exceptions import HttpProcessingError

from tvimdesign.base.errors import InputError
from tvimdesign.base.record import own_template
from tvimdesign.explore.messages import MOST_BYTES
from tvimdesign.explore.session import Session
from tvimdesign.explore.source import open_source
from tvimdesign.explore.state import PARTS, open_history
from tvimdesign.report.output.terminal import wide_console

STATIC = {
    "page": Path(str(resources.files("tvimdesign.report.page"))) / "static",
    "explore": Path(__file__).parent / "static",
}
"""Folders of code and styles by the names they are imported by."""
_STYLES = ("page/theme.css", "page/page.css", "page/figures.css", "explore/explore.css")
HOST = "127.0.0.1"
SHORTEST_TOKEN = 16
_TOKEN = re.compile(r"[A-Za-z0-9_-]*")
_LOCAL = {"127.0.0.1", "localhost", "[::1]"}
_SLOWEST = 256
"""Messages that may wait for a page that does not read; one that is further behind is let go, and comes again."""
FAREWELL = 1.0  # Seconds that a page has to answer that the server ends
_LONGEST_NAME = 255  # Letters of a request's path behind the token, and bytes that a file's name may have
Handler = Callable[[web.Request], Awaitable[web.StreamResponse]]


class Server:
    """The pages that are open, and the session they share."""

    def __init__(
        self, source: Path, folder: Path, settings: Sequence[str] = (), token: str = "", *, overwrite: bool = False
    ) -> None:
        """Prepare a server; `token` is drawn unless given. With `overwrite` a history begins again."""
        self.token = token or secrets.token_urlsafe(24)
        self._source, self._folder, self._settings = source, folder, settings
        self._overwrite = overwrite
        self._pages: set[asyncio.Queue[str]] = set()
        self._sockets: set[web.WebSocketResponse] = set()
        self.session: Session | None = None

    def app(self) -> web.Application:
        """Return the application, with its session from its start to its end."""
        # A log of this program's faults only, not of malformed requests and of pages that vanish.
        log = logging.getLogger(__name__)
        log.addFilter(_is_fault)
        app = web.Application(middlewares=[self._guard], client_max_size=MOST_BYTES, handler_args={"logger": log})
        base = f"/{self.token}"
        app.router.add_get(f"{base}/", self._page)
        app.router.add_get(f"{base}/socket", self._socket)
        app.router.add_get(f"{base}/static/{{room}}/{{path:.+}}", self._static)
        app.router.add_get(f"{base}/{PARTS}/{{path:.+}}", self._part)
        app.cleanup_ctx.append(self._with_session)
        app.on_shutdown.append(self._end_pages)
        return app

    async def _with_session(self, _: web.Application) -> AsyncIterator[None]:
        self.session = Session(self._source, self._folder, self._send, self._settings, overwrite=self._overwrite)
        yield
        self.session.close()

    async def _end_pages(self, _: web.Application) -> None:
        """Tell the pages; a server that ends would wait a minute for those that stay open."""
        ended = (socket.close(code=WSCloseCode.GOING_AWAY) for socket in self._sockets)
        await asyncio.gather(*ended, return_exceptions=True)

    def _send(self, message: dict[str, Any]) -> None:
        """To every page; one that does not read is not waited for."""
        text = json.dumps(message, allow_nan=False)
        for queue in list(self._pages):
            if queue.qsize() < _SLOWEST:
                queue.put_nowait(text)
            else:
                self._pages.discard(queue)

    # --- who may ask ---

    @web.middleware
    async def _guard(self, request: web.Request, handler: Handler) -> web.StreamResponse:
        """Refuse a malformed request, one without the token, and one by another host's name or page."""
        if not self._is_well_formed(request):
            raise web.HTTPBadRequest
        given, host = request.path.split("/", 2)[1], request.headers.get("Host", "")
        is_local = host.rpartition(":")[0] in _LOCAL or host in _LOCAL
        if not hmac.compare_digest(given.encode(), self.token.encode()) or not is_local:
            raise web.HTTPNotFound
        origin = request.headers.get("Origin")
        if origin is not None and origin.removeprefix("http://") != host:
            raise web.HTTPForbidden
        response = await handler(request)
        response.headers.setdefault("Referrer-Policy", "no-referrer")
        response.headers.setdefault("X-Content-Type-Options", "nosniff")
        return response

    def _is_well_formed(self, request: web.Request) -> bool:
        """Return whether a request names a path that can be a file's, in headers that a browser can send."""
        path, raw = request.path, request.rel_url.raw_path
        named = path.startswith("/") and path.isprintable() and len(raw) <= len(self.token) + _LONGEST_NAME
        # Another server on this machine may have set a cookie in any script.
        return named and all(value.isascii() for name, value in request.raw_headers if name.lower() != b"cookie")

    # --- what there is ---

    async def _page(self, _: web.Request) -> web.Response:
        nonce = secrets.token_urlsafe(16)
        headers = {"Content-Security-Policy": content_policy(nonce), "Cache-Control": "no-store"}
        return web.Response(text=explore_page(nonce), content_type="text/html", headers=headers)

    async def _static(self, request: web.Request) -> web.StreamResponse:
        folder = STATIC.get(request.match_info["room"])
        return _file(folder, request.match_info["path"]) if folder else web.Response(status=404)

    async def _part(self, request: web.Request) -> web.StreamResponse:
        return _file(self._folder / PARTS, request.match_info["path"])

    async def _socket(self, request: web.Request) -> web.WebSocketResponse:
        """Messages in, answers out, until the page is closed; what was done stays."""
        socket = web.WebSocketResponse(max_msg_size=MOST_BYTES, heartbeat=20.0, timeout=FAREWELL)
        await socket.prepare(request)
        session = self.session
        assert session is not None
        queue: asyncio.Queue[str] = asyncio.Queue()
        answers = sorted(session.answers.values(), key=lambda reply: int(reply["number"]))
        drafts = [session.draft] if session.draft else []
        points = {"kind": "points", "points": session.source.points_shown()}  # drawn once; null if there are none
        for reply in (session.state_shown(), points, *answers, *drafts):
            queue.put_nowait(json.dumps(reply, allow_nan=False))
        self._pages.add(queue)
        self._sockets.add(socket)
        sender = asyncio.create_task(_forward(queue, socket))
        try:
            async for message in socket:
                if message.type == WSMsgType.TEXT:
                    for reply in session.receive(message.data):
                        queue.put_nowait(json.dumps(reply, allow_nan=False))
        finally:
            self._pages.discard(queue)
            self._sockets.discard(socket)
            sender.cancel()
        return socket


def _is_fault(record: logging.LogRecord) -> bool:
    error = record.exc_info[1] if record.exc_info else None
    return not isinstance(error, HttpProcessingError | web.RequestPayloadError | ConnectionError)


async def _forward(queue: asyncio.Queue[str], socket: web.WebSocketResponse) -> None:
    while not socket.closed:
        await socket.send_str(await queue.get())


def _file(folder: Path, name: str) -> web.StreamResponse:
    """Serve a file of a folder; one outside, by dots or by a link, is not found."""
    path = (folder / name).resolve()
    if not path.is_relative_to(folder.resolve()) or not path.is_file():
        raise web.HTTPNotFound
    return web.FileResponse(path, headers={"Cache-Control": "no-cache"})


def explore_page(nonce: str) -> str:
    """Return the empty page; its content comes over the socket."""
    imports = json.dumps({"imports": {f"{room}/": f"./static/{room}/" for room in STATIC}})
    text: str = own_template(__file__, "explore.html.jinja").render(styles=_STYLES, imports=imports, nonce=nonce)
    return text


def content_policy(nonce: str) -> str:
    """Return a policy that allows no other host, and inline code only with the nonce."""
    return (
        f"default-src 'none'; script-src 'self' 'nonce-{nonce}'; style-src 'self' 'unsafe-inline'; "
        "img-src 'self' data: blob:; connect-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'"
    )


def serve(
    source: Path, folder: Path, port: int, token: str, *, overwrite: bool, browse: bool, settings: Sequence[str]
) -> None:
    """Serve until interrupted. Raises InputError for what cannot be opened, a short token, and a port that is taken."""
    if token and (len(token) < SHORTEST_TOKEN or not _TOKEN.fullmatch(token)):
        raise InputError(
            f"--token: needs {SHORTEST_TOKEN} or more letters, digits, - and _; leave it out to have one drawn"
        )
    opened = open_source(source, settings)
    open_history(folder, opened.text, opened.first, overwrite=overwrite)
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
