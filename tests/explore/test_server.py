"""The server: who may ask, what it gives, what it refuses in the study's own words, and what it keeps."""

import asyncio
import gc
import json
import logging
import socket
import struct
import time
from pathlib import Path
from typing import Any

import pytest
from aiohttp import ClientSession, WSMsgType
from aiohttp.test_utils import TestServer
from explored import SMALL, TOKEN, awaited, served, small_study, talking

from tvimdesign.base.errors import InputError
from tvimdesign.explore.messages import read_message
from tvimdesign.explore.server import HOST, Server, serve
from tvimdesign.explore.source import open_source
from tvimdesign.explore.state import FILE, open_history, write_history
from tvimdesign.study import Range, read_study
from tvimdesign.study.text.mistakes import StudyError


async def _statuses(study: Path, folder: Path, requests: list[tuple[str, dict[str, str]]]) -> list[int]:
    async with served(study, folder) as (_, client):
        (folder / "parts").mkdir()
        (folder / "parts" / "bom.csv").write_text("a part")
        (folder / "parts" / "link").symlink_to(study)
        result = []
        for path, headers in requests:
            async with client.get(path, headers=headers, allow_redirects=False) as response:
                result.append(response.status)
        return result


def test_only_the_token_opens_the_folder_and_nothing_outside(tmp_path):
    outside = [
        f"/{TOKEN}/parts/..%2fexplore.json", f"/{TOKEN}/parts/%2e%2e/explore.json", f"/{TOKEN}/parts/link",
        f"/{TOKEN}/parts//etc/passwd", f"/{TOKEN}/static/page/..%2fpage_file.py", f"/{TOKEN}/static/other/x",
        f"/{TOKEN}/explore.json", "/", "/wrong/", f"/{TOKEN}x/", "/wrong/socket",
    ]  # fmt: skip
    files = ("", "static/page/theme.css", "static/explore/main.js", "parts/bom.csv")
    given = [f"/{TOKEN}/{file}" for file in files]
    requests: list[tuple[str, dict[str, str]]] = [(path, {}) for path in given + outside]
    requests += [(given[0], {"Host": "example.com"}), (given[0], {"Origin": "http://example.com"})]
    result = awaited(_statuses(small_study(tmp_path), tmp_path / "out", requests))
    assert result == [200] * len(given) + [404] * len(outside) + [404, 403]
    assert HOST == "127.0.0.1"


REFUSED = [
    *(("pcl_thickness", text) for text in ("1,5 mm", "5 kg", "-1 mm")), ("core_radius", "ten"), ("cover", "plat"),
]  # fmt: skip


def test_what_is_typed_is_refused_in_the_words_of_a_study(tmp_path):
    study = small_study(tmp_path)

    async def talk() -> list[dict[str, Any]]:
        async with talking(study, tmp_path / "out") as page:
            result = []
            for name, text in REFUSED:
                await page.send(kind="set", name=name, text=text)
                result.append(await page.kind("refused"))
            return result

    for (name, text), refused in zip(REFUSED, awaited(talk()), strict=True):
        written = SMALL.replace("{cover: none}", "{" + f'{name}: "{text}"' + "}")
        written = "\n".join(line for line in written.splitlines() if not line.startswith("  pcl_thickness: ["))
        (tmp_path / "other.yaml").write_text(written)
        with pytest.raises(StudyError) as error:
            read_study(tmp_path / "other.yaml")
        (problem,) = error.value.problems
        assert refused["words"].removeprefix("explore: ") == str(problem).partition(": ")[2]
        assert refused["name"] == name


_LONG = '{"kind": "pin", "name": "' + "x" * 200_000 + '"}'


@pytest.mark.parametrize(
    "text",
    ["no JSON", "{}", '{"kind": "delete"}', '{"kind": "set", "name": "x"}', '{"kind": "pin", "name": 3}',
     '{"kind": "undo", "more": 1}', '{"kind": "unpin", "number": -1}', _LONG],
)  # fmt: skip
def test_a_message_of_no_known_form_is_refused(text):
    with pytest.raises(InputError, match="message"):
        read_message(text)


def test_sections_and_folders_are_out_of_reach(tmp_path):
    async def talk() -> list[str]:
        async with talking(small_study(tmp_path), tmp_path / "out") as page:
            words = []
            for message in (
                {"kind": "set", "name": "catalog", "text": ".."}, {"kind": "set", "name": "write.cad", "text": "true"},
                {"kind": "range", "name": "catalog", "low": "1", "high": "2"}, {"kind": "save", "file": "../x.yaml"},
                {"kind": "save", "file": "explore.json"}, {"kind": "point", "number": 1}, {"kind": "cad"},
                {"kind": "undo"}, {"kind": "recall", "number": 0},
            ):  # fmt: skip
                await page.send(**message)
                words.append((await page.kind("refused"))["words"])
            return words

    assert all(awaited(talk()))
    assert not (tmp_path / "x.yaml").exists()


def test_a_catalogue_outside_the_studys_folder_is_refused(tmp_path):
    (tmp_path / "records").mkdir()
    (tmp_path / "inner").mkdir()
    study = small_study(tmp_path / "inner", f"catalog: ../records\n{SMALL}")
    with pytest.raises(InputError, match="lies outside the study's folder"):
        open_source(study)


def test_changes_are_undone_kept_and_saved_as_a_study_that_reads_the_same(tmp_path):
    study, folder = small_study(tmp_path), tmp_path / "out"

    async def change() -> list[dict[str, Any]]:
        async with talking(study, folder) as page:
            first = await page.change(kind="require", name="peak_power", texts=["<= 10 W"])
            await page.send(kind="set", name="core_radius", text="9 mm", final=False)
            second = await page.change(kind="set", name="core_radius", text="9.5 mm")
            third = await page.change(kind="undo")
            await page.change(kind="redo")
            await page.change(kind="range", name="current", low="1 A", high="2 A")
            await page.change(kind="weight", name="module_mass", text="3")
            await page.save("kept.yaml")
            await page.change(kind="way", way="evaluate")
            await page.change(kind="set", name="pcl_thickness", text="0.9 mm")
            await page.save("fixed.yaml")
            return [first, second, third]

    async def again() -> dict[str, Any]:
        async with served(study, folder) as (server, _):
            return server.session.state_shown()

    first, second, third = awaited(change())
    assert first["controls"]["requirements"][0]["text"] == "10 W"
    assert _input(second, "core_radius") == "9.5 mm"
    assert _input(third, "core_radius") == _input(first, "core_radius")
    assert (second["redo"], third["redo"]) == (False, True)
    stored = read_study(folder / "kept.yaml")
    assert (stored.require[0].limit, stored.module["core_radius"]) == (10.0, pytest.approx(9.5e-3))
    current = stored.vary["current"]
    assert isinstance(current, Range)
    assert (current.lower, current.upper, current.start) == (1.0, 2.0, 1.5)
    assert stored.minimize == {"response_time": 1.0, "module_mass": 3.0}
    fixed = read_study(folder / "fixed.yaml")
    assert (fixed.vary, fixed.minimize, fixed.module["pcl_thickness"]) == ({}, {}, pytest.approx(0.9e-3))
    reopened = awaited(again())
    assert (reopened["way"], reopened["controls"]["variables"][0]["text"]) == ("evaluate", "0.9 mm")
    assert json.loads((folder / FILE).read_text())["state"]["changes"]["core_radius"] == "9.5 mm"


def test_a_folder_of_something_else_and_a_study_that_changed_are_refused(tmp_path):
    study, folder = small_study(tmp_path), tmp_path / "out"

    async def opened() -> None:
        async with served(study, folder):
            pass

    awaited(opened())
    small_study(tmp_path, SMALL.replace("12 W", "13 W"))
    with pytest.raises(InputError, match="before its file changed"):
        awaited(opened())
    (tmp_path / "other").mkdir()
    (tmp_path / "other" / "thesis.txt").write_text("years of work")
    folder = tmp_path / "other"
    with pytest.raises(InputError, match="no explorer's"):
        awaited(opened())


def test_overwriting_loses_no_history_where_the_explorer_is_refused(tmp_path):
    study, folder = small_study(tmp_path), tmp_path / "out"

    async def change() -> None:
        async with talking(study, folder) as page:
            await page.change(kind="require", name="peak_power", texts=["<= 10 W"])

    awaited(change())
    before = (folder / FILE).read_bytes()
    with socket.create_server((HOST, 0)) as taken, pytest.raises(InputError, match="cannot be used"):
        serve(study, folder, taken.getsockname()[1], "", overwrite=True, browse=False, settings=())
    assert (folder / FILE).read_bytes() == before
    (folder / FILE).write_text('{"name": "an application"}')
    with pytest.raises(InputError, match="not written by `tvimdesign explore`"):
        serve(study, folder, 0, "", overwrite=True, browse=False, settings=())
    assert (folder / FILE).read_text() == '{"name": "an application"}'


def test_a_history_that_somebody_changed_meanwhile_is_kept_beside(tmp_path):
    opened = open_source(small_study(tmp_path))
    out = tmp_path / "out"
    out.mkdir()
    stored = open_history(out, opened.text, opened.first)
    before = write_history(out, stored, "")
    assert write_history(out, stored, before) == before
    (out / FILE).write_text("changed by hand")
    write_history(out, stored, before)
    assert (out / "explore-1.json").read_text() == "changed by hand"
    assert json.loads((out / FILE).read_text())["study"] == stored.study


def test_a_study_that_is_saved_replaces_only_what_was_saved_before(tmp_path):
    study, folder = small_study(tmp_path), tmp_path / "out"

    async def save() -> list[str]:
        async with talking(study, folder) as page:
            message = []
            for text in (None, None, "mine", "changed by hand"):
                if text:
                    (folder / f"{text[:4]}.yaml").write_text(text)
                await page.send(kind="save", file=f"{(text or 'chan')[:4]}.yaml")
                answer = await page.until(lambda reported: reported["kind"] in {"saved", "refused"})
                message.append(answer["kind"])
            return message

    saved = awaited(save())
    assert saved[:2] == ["saved", "saved"]
    assert "saved" not in saved[2:]
    assert (folder / "mine.yaml").read_text() == "mine"
    assert (folder / "chan.yaml").read_text() == "changed by hand"


def _input(state: dict[str, Any], name: str) -> str:
    return str(next(item["text"] for item in state["controls"]["inputs"] if item["name"] == name))


def test_a_server_that_ends_does_not_wait_for_the_pages_that_are_open(tmp_path):
    async def ended() -> tuple[float, WSMsgType]:
        server = TestServer(Server(small_study(tmp_path), tmp_path / "out", token=TOKEN).app(), host="127.0.0.1")
        await server.start_server()
        async with ClientSession() as client, client.ws_connect(server.make_url(f"/{TOKEN}/socket")) as socket:
            await socket.receive_json()
            begin = time.monotonic()
            closing = asyncio.create_task(server.close())
            heard = await socket.receive()
            while heard.type == WSMsgType.TEXT:
                heard = await socket.receive()
            await closing
            return time.monotonic() - begin, heard.type

    seconds, last = awaited(ended())
    assert last == WSMsgType.CLOSE
    assert seconds < 50.0  # aiohttp would wait for a minute


def _request(target: str = f"/{TOKEN}/", *headers: bytes, method: str = "GET", host: bytes = b"127.0.0.1") -> bytes:
    lines = (f"{method} {target} HTTP/1.1".encode(), b"Host: " + host, *headers)
    return b"\r\n".join(lines) + b"\r\n\r\n"


UPGRADE = (b"Upgrade: websocket", b"Connection: Upgrade", b"Sec-WebSocket-Version: 13")
CHUNKED = b"Transfer-Encoding: chunked"
MALFORMED = {
    "no path": _request("*", method="OPTIONS"),
    "a null byte with the token": _request(f"/{TOKEN}/parts/%00"),
    "a long name with the token": _request(f"/{TOKEN}/parts/{5000 * 'x'}"),
    "a name that no file can have": _request(f"/{TOKEN}/parts/{'%c3%a4' * 50}"),
    "bytes that are no text": _request(f"/{TOKEN}/parts/").replace(b"parts/", b"parts/\xff\xfe"),
    "a bad address": _request("http://[::1/"),
    "a bad version": _request().replace(b"1.1", b"9.9"),
    "HTTP/2": b"PRI * HTTP/2.0\r\n\r\nSM\r\n\r\n",
    "all bytes": bytes(range(256)) * 4,
    "a null byte in a header": _request(f"/{TOKEN}/", b"X: \0"),
    "a huge header": _request(f"/{TOKEN}/", b"X: " + b"y" * 100_000),
    "no host": _request().replace(b"Host: 127.0.0.1\r\n", b""),
    "two hosts": _request(f"/{TOKEN}/", b"Host: example.com"),
    "half a host": _request(host=b"[::1"),
    "a bad length": _request(f"/{TOKEN}/", b"Content-Length: -5", method="POST"),
    "chunks and a length": _request(f"/{TOKEN}/", CHUNKED, b"Content-Length: 5", method="POST") + b"0\r\n\r\n",
    "a bad range": _request(f"/{TOKEN}/static/page/theme.css", b"Range: bytes=9999999-1"),
    "a socket without a key": _request(f"/{TOKEN}/socket", *UPGRADE),
    "a socket with a bad key": _request(f"/{TOKEN}/socket", *UPGRADE, b"Sec-WebSocket-Key: \xff\xfe"),
    "a socket without the token": _request("/socket", *UPGRADE) + b"\xff\xff\xff",
}


async def _first_line(port: int, request: bytes) -> bytes:
    reader, writer = await asyncio.open_connection("127.0.0.1", port)
    writer.write(request)
    line = await asyncio.wait_for(reader.readline(), 20.0)
    writer.close()
    return line


def test_malformed_requests_are_refused_in_silence(tmp_path, caplog):
    async def ask() -> dict[str, bytes]:
        async with served(small_study(tmp_path), tmp_path / "out") as (_, client):
            result = {name: await _first_line(client.port or 0, request) for name, request in MALFORMED.items()}
            result["well formed"] = await _first_line(client.port or 0, _request(f"/{TOKEN}/", b"Cookie: a=\xc3\xa4"))
            return result

    answers = awaited(ask())
    gc.collect()  # a task that failed unseen is logged once it is collected
    assert answers.pop("well formed").split()[1] == b"200"
    assert {name: line for name, line in answers.items() if not line.split()[1].startswith(b"4")} == {}
    assert [record.getMessage() for record in caplog.records] == []


def test_pages_that_vanish_leave_no_word(tmp_path, caplog):
    key = b"Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ=="
    opened = _request(f"/{TOKEN}/socket", *UPGRADE, key)
    frames = (b"", 40 * b"\xff", b"\x81\xfe", b"\x88\x00")
    started = (_request(), _request()[:20], b"", *(opened + frame for frame in frames))

    async def vanish() -> None:
        async with served(small_study(tmp_path), tmp_path / "out") as (_, client):
            for request in started:
                for pause in (0.0, 0.05):
                    with socket.create_connection(("127.0.0.1", client.port or 0)) as item:
                        item.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, struct.pack("ii", 1, 0))  # end by a reset
                        item.sendall(request)
                        await asyncio.sleep(pause)
                    await asyncio.sleep(0.05)

    awaited(vanish())
    gc.collect()
    assert [record.getMessage() for record in caplog.records] == []


def test_a_fault_of_the_program_is_logged(tmp_path, monkeypatch, caplog):
    def fault(_: str) -> str:
        raise ValueError("a fault")

    monkeypatch.setattr("tvimdesign.explore.server.explore_page", fault)
    (status,) = awaited(_statuses(small_study(tmp_path), tmp_path / "out", [(f"/{TOKEN}/", {})]))
    assert status == 500
    assert [(record.levelno, bool(record.exc_info)) for record in caplog.records] == [(logging.ERROR, True)]
