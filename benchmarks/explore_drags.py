"""Drag to answer in the explorer: a page's messages over the real socket, one after the other, as a hand sends them.

`python benchmarks/explore_drags.py [STUDY] [--drags 100] [--leak 1000]` prints the median and the ninth of ten of the
time from sending a drag to its answer, for evaluating and for optimising. With `--leak` as many random drags follow,
the server's and the worker's memory is read before and after, and the last state is compared with a fresh evaluation.
"""

from __future__ import annotations

import argparse
import asyncio
import contextlib
import os
import random
import statistics
import tempfile
import time
from collections import Counter
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import psutil
from aiohttp import ClientSession, ClientWebSocketResponse
from aiohttp.test_utils import TestServer

from tvimdesign.base.units import from_si
from tvimdesign.explore.engine import value_names
from tvimdesign.explore.server import Server
from tvimdesign.explore.state import State, tree_of
from tvimdesign.solve.result import answer
from tvimdesign.study import Range, Study, given, read_tree

TOKEN = "benchmark-of-drags"
COMPILED = 45.0
"""Seconds that kernels are given to compile, before drags are timed; a machine that is busy takes longer."""
_STEP = 0.02
"""What a drag moves by, as a share: a slider's few pixels."""
_LONGEST = 2.0
"""Seconds that a draft is waited for."""


class Hand:
    """One page, without a browser."""

    def __init__(self, socket: ClientWebSocketResponse, study: Study, seed: int = 1) -> None:
        """Talk to a socket of a study's explorer."""
        self.socket, self.study, self.random = socket, study, random.Random(seed)
        self.number = self.last_draft = 0
        self.is_refused = False
        table, known = study.table, given(study)
        self.values = {name: from_si(float(known[name]), table.unit(name))
                       for name, variable in study.vary.items() if isinstance(variable, Range)}  # fmt: skip
        """Where the last module has the variables, in their units."""
        self.undrawn = ""
        """Why the last draft is none."""
        self.seconds_of: dict[str, int] = {}
        """Processes whose processor time is reported, by name."""

    async def until(self, *, stage: str = "", number: int = 0) -> dict[str, Any]:
        """Return the next answer of that number or a later one, and of that stage."""
        while True:
            reply = await self.socket.receive_json()
            if reply["kind"] == "refused":
                raise RuntimeError(reply["words"])
            if reply["kind"] == "draft":  # the drafter may be quicker than the solver
                self._keep_draft(reply)
            if reply["kind"] != "answer":
                continue
            self.number = max(self.number, reply["number"])
            for name, variable in reply["shown"].get("variables", {}).items():
                self.values[name] = variable["value"]
            if reply["number"] >= number and (not stage or reply["shown"]["stage"] == stage):
                return dict(reply)

    async def drafted(self, number: int) -> str:
        """Return why there is no draft of an answer, or none within `_LONGEST`; nothing where it is drawn."""
        with contextlib.suppress(TimeoutError):
            async with asyncio.timeout(_LONGEST):
                while self.last_draft < number:
                    reply = await self.socket.receive_json()
                    if reply["kind"] == "draft":
                        self._keep_draft(reply)
        return self.undrawn if self.last_draft >= number else f"no draft within {_LONGEST:g} s"

    def _keep_draft(self, draft: dict[str, Any]) -> None:
        """Note a drawing, or why this infeasible design has none."""
        self.last_draft, self.undrawn = max(self.last_draft, draft["number"]), draft.get("words", "")

    async def wait(self, seconds: float) -> None:
        """Do nothing, as a page does that is only looked at."""
        with contextlib.suppress(TimeoutError):
            async with asyncio.timeout(seconds):
                while True:
                    await self.socket.receive()

    async def drag(self, message: dict[str, Any]) -> tuple[float, dict[str, Any]]:
        """Seconds to the answer of a drag, and the answer."""
        number = self.number + 1
        began = time.perf_counter()
        await self.socket.send_json({**message, "final": False})
        reply = await self.until(stage="quick", number=number)
        self.is_refused = "values" not in reply["shown"]
        return time.perf_counter() - began, reply

    def variables(self) -> Iterator[dict[str, Any]]:
        """Drags of variables from where the module has them, and back again from where there is no module."""
        ranges = {name: variable for name, variable in self.study.vary.items() if isinstance(variable, Range)}
        while True:
            name = self.random.choice(list(ranges))
            unit, before = self.study.table.unit(name), self.values[name]
            low, high = (from_si(end, unit) for end in (ranges[name].lower, ranges[name].upper))
            after = before + self.random.uniform(-3.0, 3.0) * _STEP * (high - low)
            if not low <= after <= high:
                continue
            yield {"kind": "set", "name": name, "text": f"{after:.9g} {unit}".removesuffix(" 1")}
            if self.is_refused:
                yield {"kind": "set", "name": name, "text": f"{before:.9g} {unit}".removesuffix(" 1")}

    def requirements(self) -> Iterator[dict[str, Any]]:
        """Drags of requirements: each goes to and fro by some percent about what the study asks."""
        names = list(dict.fromkeys(limit.output for limit in self.study.require))
        moved = dict.fromkeys(names, 0.0)
        while True:
            name = self.random.choice(names)
            before, at = moved[name], moved[name] + self.random.uniform(-1.0, 1.0) * _STEP
            moved[name] = min(max(at, -0.1), 0.1)
            unit = self.study.table.unit(name)
            own = [limit for limit in self.study.require if limit.output == name]
            if moved[name] == before or not any(limit.limit for limit in own):
                continue
            texts = [f"{limit.sense} {from_si(limit.limit, unit) * (1.0 + moved[name]):.9g} {unit}" for limit in own]
            yield {"kind": "require", "name": name, "texts": [text.removesuffix(" 1") for text in texts]}


async def measured(study: Path, drags: int, leak: int, compiled: float) -> None:
    """Time drags, then drag on at random."""
    print(f"load of the machine: {os.getloadavg()[0]:.1f} on {os.cpu_count()} cores", flush=True)
    with tempfile.TemporaryDirectory() as folder:
        server = Server(study, Path(folder) / "out", token=TOKEN)
        async with (
            TestServer(server.app(), host="127.0.0.1") as started,
            ClientSession() as client,
            client.ws_connect(started.make_url(f"/{TOKEN}/socket"), max_msg_size=0) as socket,
        ):
            assert server.session is not None
            hand = Hand(socket, server.session.source.study)
            await hand.until(stage="exact")
            await _way(hand, "evaluate")
            await hand.wait(compiled)
            session = server.session
            hand.seconds_of = {"solver": session.solver.process, "drafter": session.drafter.process}
            walks = {"evaluate": hand.variables(), "optimize": hand.requirements()}
            await _timed(hand, "evaluate", walks["evaluate"], drags)
            await _timed(hand, "draft in 3-D", walks["evaluate"], drags, drafts=True)
            await _way(hand, "optimize")
            await _timed(hand, "optimise", walks["optimize"], drags)
            if leak:
                await _leak(hand, server, walks, leak)


async def _way(hand: Hand, way: str) -> None:
    number = hand.number + 1
    await hand.socket.send_json({"kind": "way", "way": way})
    await hand.until(stage="exact", number=number)


async def _timed(hand: Hand, what: str, drags: Iterator[dict[str, Any]], count: int, *, drafts: bool = False) -> None:
    times, without, before = [], Counter[str](), _processor(hand)
    for _ in range(count):
        began = time.perf_counter()
        _, reply = await hand.drag(next(drags))
        words = reply["shown"]["status"] if hand.is_refused else await hand.drafted(reply["number"]) if drafts else ""
        if words:
            without[words] += 1
        else:
            times.append(1e3 * (time.perf_counter() - began))
    for words, number in without.most_common(5):
        print(f"{what}: {number} answered in words: {words}")
    ninth = statistics.quantiles(times, n=10)[8] if len(times) > 1 else float("nan")
    print(f"{what}: median {statistics.median(times or [float('nan')]):.0f} ms, nine of ten under {ninth:.0f} ms, "
          f"worst {max(times, default=float('nan')):.0f} ms, of {len(times)} drags; processor a drag: "
          + ", ".join(f"{name} {1e3 * (now - before[name]) / count:.0f} ms" for name, now in _processor(hand).items()),
          flush=True)  # fmt: skip


def _processor(hand: Hand) -> dict[str, float]:
    """Seconds of the processor that each process has taken, the one of server and client among them."""
    seconds = {"server and client": time.process_time()}
    for name, number in hand.seconds_of.items():
        times = psutil.Process(number).cpu_times()
        seconds[name] = times.user + times.system
    return seconds


def _memory(server: Server) -> dict[str, float]:
    """Megabytes of the server and of its workers, as Linux counts them."""
    assert server.session is not None
    session = server.session
    processes = {"server": os.getpid(), "solver": session.solver.process, "drafter": session.drafter.process}
    pages = {name: int(Path(f"/proc/{process}/statm").read_text().split()[1]) for name, process in processes.items()}
    return {name: count * os.sysconf("SC_PAGE_SIZE") / 1e6 for name, count in pages.items()}


async def _leak(hand: Hand, server: Server, walks: dict[str, Iterator[dict[str, Any]]], count: int) -> None:
    assert server.session is not None
    process, refused = (server.session.solver.process, server.session.drafter.process), 0
    before, began = _memory(server), time.perf_counter()
    for way in ("optimize", "evaluate") * 2:
        await _way(hand, way)
        for _ in range(count // 4):
            await hand.drag(next(walks[way]))
            refused += hand.is_refused
    hand.is_refused = True
    while hand.is_refused:  # the last is a module, which compares with another answer
        await hand.drag(last := next(walks["evaluate"]))
    await hand.socket.send_json({**last, "final": True})
    reply = await hand.until(stage="exact", number=hand.number)
    after = _memory(server)
    state: State = server.session.history.state
    fresh = read_tree(tree_of(server.session.source.tree, state))
    values = answer(fresh).design.values
    exact = [from_si(values[name], fresh.table.unit(name)) for name in value_names(fresh)]
    pairs = [(a, b) for a, b in zip(reply["shown"]["values"], exact, strict=True) if a is not None]
    worst = max(abs(a - b) / max(abs(b), 1e-9) for a, b in pairs)
    grown = ", ".join(f"{name} {before[name]:.0f} to {after[name]:.0f} MB" for name in before)
    now = server.session.solver.process, server.session.drafter.process
    alive = "the same workers to the end" if now == process else "a worker died"
    print(f"{count} random drags in {time.perf_counter() - began:.0f} s, {refused} of them answered in words: "
          f"{grown}; {alive}; the last state is a fresh evaluation of {len(pairs)} values to {worst:.1e}",
          flush=True)  # fmt: skip


def main() -> None:
    """Read the arguments, measure."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("study", nargs="?", type=Path, default=Path("tests/studies/paper_shear.yaml"))
    parser.add_argument("--drags", type=int, default=100)
    parser.add_argument("--leak", type=int, default=0)
    parser.add_argument("--compiled", type=float, default=COMPILED, help="seconds that kernels are given to compile")
    options = parser.parse_args()
    asyncio.run(measured(options.study, options.drags, options.leak, options.compiled))


if __name__ == "__main__":
    main()
