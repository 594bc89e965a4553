"""Ends commands at random moments by SIGINT, SIGTERM and SIGKILL, and looks at what is left.

    python campaigns/kills.py [--tries 20] [--seed 1] [--jobs 2] [--commands run front ...]
                              [--signals SIGINT ...] [--out FILE] [--fe-python PATH]

After each: the command did not go on, no process left two seconds later, no temporary folder, every file whole, the
manifest says what happened, a front or a sweep that is resumed ends in the same bytes as one that ran through, and an
explorer has kept what it said that it kept. A moment is so many seconds of processor time of the command and its
children, so that it means the same beside other work. Tries are appended to FILE, a line each; those in it are not done
again.
"""

from __future__ import annotations

import argparse
import asyncio
import json
import os
import random
import resource
import shutil
import signal
import subprocess
import sys
import tempfile
import threading
import time
import zipfile
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from contextlib import suppress
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

import explorer_talk
import psutil
from ended_commands import COMMANDS, FIRST, GOES_ON, NEEDS_FE, ROOT, SERVED, SERVES, SMALL, coarse_python
from shell_signals import follow_signals

SIGNALS = (signal.SIGINT, signal.SIGTERM, signal.SIGKILL)
MARK = "TVIMDESIGN_CAMPAIGN"
_UNFINISHED = ("running", "interrupted", "failed")
"""What a manifest says of a command that did not come to its end."""
GONE = 2.0
"""Seconds after which nothing is at work, on a machine without other work."""


@dataclass(frozen=True)
class Try:
    """One command that is ended."""

    command: str
    number: signal.Signals
    after: float
    """Seconds of the processor."""


def environment(own: Path) -> dict[str, str]:
    """Return the environment: a temporary folder, no kept parts, and a mark of its processes."""
    (own / "tmp").mkdir(parents=True, exist_ok=True)
    return {
        **os.environ, "PYTHONPATH": str(ROOT), "TMPDIR": str(own / "tmp"),
        "TVIMDESIGN_CACHE": "",
        "TVIMDESIGN_SPREAD": "on", "OMP_NUM_THREADS": "1", MARK: str(own),
    }  # fmt: skip


def start(words: list[str], own: Path) -> subprocess.Popen[bytes]:
    """Start a command in `own`, its results into the folder out.

    The folder is named as it stands from there: a page that names it is the same of each try.
    """
    with (own / "said.txt").open("ab") as errors, (own / "told.txt").open("ab") as output:
        return subprocess.Popen(
            [sys.executable, "-m", "tvimdesign", *words, "--out", "out"],
            cwd=own, stdout=output, stderr=errors, env=environment(own), start_new_session=True,
        )  # fmt: skip


def processor_time(process: subprocess.Popen[bytes]) -> float:
    """Seconds of the processor that a command and its children have taken."""
    seconds = 0.0
    with suppress(psutil.Error):  # it ended meanwhile
        mine = psutil.Process(process.pid)
        for member in [mine, *mine.children(recursive=True)]:
            with suppress(psutil.Error):
                seconds += sum(member.cpu_times()[:4])
    return seconds


def load() -> float:
    """Processes that wait for each core: as many times as long everything takes."""
    return max(os.getloadavg()[0] / (os.cpu_count() or 1), 1.0)


def until(process: subprocess.Popen[bytes], seconds: float) -> None:
    """Wait until a command has taken so many seconds of the processor, or is through."""
    last, still, cores = 0.0, time.monotonic(), os.cpu_count() or 1
    while process.poll() is None and last < seconds:
        time.sleep(min(max((seconds - last) / cores, 0.03), 0.5))  # a look takes milliseconds of the processor
        now = processor_time(process)
        still = time.monotonic() if now > last else still
        last = max(now, last)
        if time.monotonic() > still + 3.0 * load():  # it waits for something, as an explorer does
            return


def ended_within(process: subprocess.Popen[bytes], seconds: float) -> tuple[int | None, float]:
    """Exit code of a command, none where it is at work then, and what it took of the processor meanwhile [s]."""
    began, before, now = time.monotonic(), processor_time(process), 0.0
    while process.poll() is None and time.monotonic() < began + seconds:
        now = max(now, processor_time(process))
        time.sleep(0.05)
    return process.returncode, max(now - before, 0.0)


def address_of(own: Path) -> str:
    """Return where an explorer serves; empty where it does not yet."""
    words = (own / "told.txt").read_text(errors="replace").split()
    return next((word for word in words if word.startswith("http://")), "")


class Talking:
    """A conversation with an explorer, in a thread, from when it serves until it is gone."""

    def __init__(self, process: subprocess.Popen[bytes], own: Path, seed: int) -> None:
        """Begin."""
        self._process, self._own = process, own
        self._conversation = explorer_talk.Conversation(seed)
        self._thread = threading.Thread(target=self._talk, daemon=True)
        self._thread.start()

    def _talk(self) -> None:
        while self._process.poll() is None and not address_of(self._own):
            time.sleep(0.05)
        if address := address_of(self._own):
            asyncio.run(self._conversation.lead(address))

    def not_kept(self) -> list[str]:
        """Return what an explorer that is opened again has lost of what it reported as kept."""
        self._thread.join(10.0)
        if not (self._own / "out/explore.json").exists():
            return ["nothing is kept"] if self._conversation.history else []
        return explorer_talk.not_kept(self._conversation, SMALL, self._own / "out")


def at_work(own: Path) -> list[psutil.Process]:
    """Processes with the mark that have not ended."""
    processes = []
    for process in psutil.process_iter():
        with suppress(psutil.Error):  # it ended meanwhile, or is another user's
            if process.environ().get(MARK) == str(own) and process.status() != psutil.STATUS_ZOMBIE:
                processes.append(process)
    return processes


def faults_after(attempt: Try, own: Path, seed: int = 1) -> list[str]:
    """Run a command, end it, and say what is not as it should be."""
    process = start(COMMANDS[attempt.command], own)
    talk = Talking(process, own, seed) if attempt.command == SERVES else None
    until(process, attempt.after)
    ended = process.poll() is not None  # it was through before
    process.send_signal(attempt.number)
    began = time.monotonic()
    code, more = ended_within(process, 30.0 * load())
    if code is None:
        process.kill()
        process.wait()
        return [f"still at work 30 s after {attempt.number.name}"]
    faults = [f"went on for {more:.1f} s of the processor, to its end"] if code == 0 and more > GONE else []
    while at_work(own) and time.monotonic() < began + GONE * load():
        time.sleep(0.05)
    if left := at_work(own):
        faults.append(f"{len(left)} processes left after {GONE:g} s")
        for one_left in left:
            one_left.kill()
    if list((own / "tmp").iterdir()):
        faults.append(f"left in the temporary folder: {', '.join(path.name for path in (own / 'tmp').iterdir())}")
    expected = {signal.SIGKILL: -signal.SIGKILL}.get(attempt.number, 128 + attempt.number)
    if talk:
        faults += talk.not_kept()
    early = {-attempt.number} if _status(own / "out") is None else set()  # Python was not up yet
    through = ended or code == 0  # each ends with 0 where nobody ends it; its work may be done when the signal comes
    if code not in ({0} if ended else {expected, 0, *early}):
        faults.append(f"exit code {code}")
    if "Traceback" in (own / "said.txt").read_text(errors="replace"):
        faults.append("a traceback")
    return faults + broken_files(own / "out", attempt, through=through)


def broken_files(out: Path, attempt: Try, *, through: bool) -> list[str]:
    """Return what is not whole in a folder of results."""
    faults = []
    for path in sorted(path for path in out.rglob("*") if path.is_file()):
        name, data = path.relative_to(out).as_posix(), path.read_bytes()
        if any(part.startswith(".") for part in path.relative_to(out).parts):
            if attempt.number != signal.SIGKILL:
                faults.append(f"{name} is left half written")
        elif not whole(path, data):
            faults.append(f"{name} is broken")
    if status := _status(out):
        wanted = "running" if attempt.number == signal.SIGKILL else "interrupted"
        if through and status in _UNFINISHED:
            faults.append(f"the folder says {status} of what was through")
        elif not through and status != wanted:
            faults.append(f"the folder says {status}, not {wanted}")
    return faults


def _status(out: Path) -> str | None:
    """Return what a folder says became of its command; empty where it is broken, which is a fault of its own.

    An unfinished run has said who writes, and no manifest yet.
    """
    for name in ("manifest.json", "unfinished/.run.json"):
        if (out / name).exists():
            try:
                return str(json.loads((out / name).read_bytes())["status"])
            except (ValueError, KeyError):
                return ""
    return None


def whole(path: Path, data: bytes) -> bool:
    """Return whether a file of its kind has its end."""
    if path.suffix == ".json":
        try:
            json.loads(data)
        except ValueError:
            return False
    if path.suffix == ".fmu":
        return zipfile.is_zipfile(path)
    ends = {".png": b"IEND\xaeB`\x82", ".pdf": b"%%EOF\n", ".svg": b"</svg>\n", ".csv": b"\n", ".txt": b"\n",
            ".step": b"END-ISO-10303-21;\n", ".yaml": b"\n"}  # fmt: skip
    return data.endswith(ends.get(path.suffix, b"")) and len(data) > 0


def resumed_differs(command: str, own: Path, reference: Path) -> list[str]:
    """Go on with a command that was ended, and compare what it made with one that ran through."""
    process = start([*COMMANDS[command], "--resume"], own)
    if process.wait(timeout=600.0 * load()) != 0:
        return [f"resumed, it ends with {process.returncode}"]
    files, other = (_compared(folder) for folder in (reference, own / "out"))
    differences = [f"resumed, {name} is not there" for name in sorted(files - other)]
    return differences + [
        f"resumed, {name} differs"
        for name in sorted(files & other)
        if (reference / name).read_bytes() != (own / "out" / name).read_bytes()
    ]


def _compared(folder: Path) -> set[Path]:
    """Files that must be the same: neither the manifest, which has times, nor who wrote which cell of a sweep."""
    files = {path.relative_to(folder) for path in folder.rglob("*") if path.is_file()}
    return {path for path in files if path.name != "manifest.json" and path.parts[0] != "shards"}


def tried(
    command: str, number: int, *, signals: Sequence[signal.Signals], seed: int, through: Through, folder: Path
) -> dict[str, Any]:
    """Return when and how the command was ended, whether it was resumed, and its faults."""
    draw = random.Random(f"{command} {seed} {number}")
    attempt = Try(command, draw.choice(signals), draw.uniform(0.3, 0.95 * through.seconds))
    own = folder / f"{command}-{number}"
    own.mkdir()
    faults = faults_after(attempt, own, number)
    resumable = [own / "out" / part / GOES_ON[command] for part in ("", "unfinished") if command in GOES_ON]
    resumed = any(folder.is_dir() for folder in resumable)
    if resumed:
        faults += resumed_differs(command, own, through.out)
    report = {"signal": attempt.number.name, "after": round(attempt.after, 2), "resumed": resumed, "faults": faults}
    if faults:
        report["said"] = (own / "said.txt").read_text(errors="replace")[-2000:]
    shutil.rmtree(own)
    return {"command": command, "seed": seed, "number": number, **report}


@dataclass(frozen=True)
class Through:
    """Return the result of a command that is not ended."""

    out: Path
    seconds: float
    """Of the processor."""


def prepare(command: str, folder: Path) -> None:
    """Make the results that a command works on, beside the folders of its tries."""
    place, words = FIRST.get(command, ("", []))
    if place and not (folder / place).exists():
        (folder / place).mkdir()
        if start(words, folder / place).wait():
            sys.exit(f"what {command} needs ends badly: {(folder / place / 'said.txt').read_text()}")


def run_through(command: str, folder: Path) -> Through:
    """Run a command to its end, which must be a good one; an explorer has none."""
    own = folder / f"{command}-through"
    own.mkdir()
    if command == SERVES:
        return Through(own / "out", SERVED)
    prepare(command, folder)
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    if code := start(COMMANDS[command], own).wait():
        sys.exit(f"{command} ends with {code} where nobody ends it: {(own / 'said.txt').read_text()}")
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return Through(own / "out", after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime)


def campaign(options: argparse.Namespace, folder: Path) -> list[dict[str, Any]]:
    """End each command so many times; every try, the earlier ones too. Failures are printed."""
    signals = [signal.Signals[name] for name in options.signals]
    lines = options.out.read_text().splitlines() if options.out and options.out.exists() else []
    every = [json.loads(line) for line in lines]
    there = {(past["command"], past["seed"], past["number"]) for past in every}
    for command in options.commands:
        left = [number for number in range(options.tries) if (command, options.seed, number) not in there]
        if not left:
            continue
        through = run_through(command, folder)
        print(f"{command}: {through.seconds:.1f} s of the processor where it runs through", flush=True)
        with ThreadPoolExecutor(options.jobs) as pool:
            one_try = partial(tried, command, signals=signals, seed=options.seed, through=through, folder=folder)
            for attempt in pool.map(one_try, left):
                every.append(attempt)
                for fault in attempt["faults"]:
                    when = f"{attempt['signal']} after {attempt['after']:.1f} s"
                    print(f"{command} {attempt['number']}: {when}: {fault}", flush=True)
                if options.out:
                    with options.out.open("a") as out:
                        out.write(json.dumps(attempt) + "\n")
    return every


def main() -> int:
    """Run the campaign; 1 where something was left."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--tries", type=int, default=20, help="of each command")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--jobs", type=int, default=2, help="tries at once")
    names = [sent.name for sent in SIGNALS]
    parser.add_argument("--signals", nargs="+", choices=names, default=names, help="that end commands")
    parser.add_argument("--commands", nargs="+", choices=list(COMMANDS), help="all that the machine has the tools for")
    parser.add_argument("--out", type=Path, help="file that tries are appended to")
    parser.add_argument("--fe-python", type=Path, help=f"a Python that has netgen and ngsolve, for {NEEDS_FE}")
    options = parser.parse_args()
    follow_signals()
    options.commands = options.commands or [name for name in COMMANDS if name != NEEDS_FE or options.fe_python]
    with tempfile.TemporaryDirectory(prefix="kills-") as folder:
        if options.fe_python:
            COMMANDS[NEEDS_FE] += ["--fe-python", str(coarse_python(options.fe_python, Path(folder)))]
        every = campaign(options, Path(folder))
    every = [attempt for attempt in every if attempt["command"] in options.commands]
    for command in dict.fromkeys(attempt["command"] for attempt in every):
        some = [attempt for attempt in every if attempt["command"] == command]
        failed, resumed = (sum(bool(attempt[what]) for attempt in some) for what in ("faults", "resumed"))
        print(f"{command}: {len(some)} tries, {failed} failures, {resumed} resumed")
    return int(any(attempt["faults"] for attempt in every))


if __name__ == "__main__":
    sys.exit(main())
