"""Ends commands at random moments by SIGINT, SIGTERM and SIGKILL, and looks at what is left.

    python campaigns/kills.py [--tries 20] [--seed 1] [--commands run front parts] [--json FILE]

After each: no process left two seconds later, no temporary folder, every file whole, the manifest says what happened,
and a front or a sweep that is resumed ends in the same bytes as one that ran through.
"""

from __future__ import annotations

import argparse
import json
import os
import random
import signal
import subprocess
import sys
import tempfile
import time
from collections import Counter
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path

import psutil

ROOT = Path(__file__).resolve().parents[1]
SIGNALS = (signal.SIGINT, signal.SIGTERM, signal.SIGKILL)
MARK = "TVIMDESIGN_CAMPAIGN"
_STUDY = str(ROOT / "studies/paper_as_published.yaml")
_FRONT = [str(ROOT / "studies/front_shear.yaml"), "--set", "front.points=3", "--set", "solver.starts=1",
          "--no-cad", "--no-plots"]  # fmt: skip
_OVER = "sweep={over: {pcl_thickness: {from: 0.6 mm, to: 2 mm, count: 12}, wire_diameter: [2 mm, 2.4 mm]}}"
_GOES_ON = {"front": "front/progress", "sweep": "shards"}
"""Commands that can be resumed, and the folder of what they go on from."""
COMMANDS = {
    "run": ["run", _STUDY, "--no-cad"],
    "front": ["run", *_FRONT],
    "parts": ["cad", str(ROOT / "cad/paper_shear/design.json")],
    "sweep": ["sweep", _STUDY, "--set", _OVER, "--workers", "2", "--no-plots"],
    "compare": ["compare", _STUDY, str(ROOT / "studies/compare_shear.yaml"), "--points", "0"],
}
"""What is ended; each gets `--out`."""


@dataclass(frozen=True)
class Try:
    """One command that is ended."""

    command: str
    number: signal.Signals
    after: float
    """Seconds from its start."""


def environment(own: Path) -> dict[str, str]:
    """A temporary folder of its own, no kept parts, and a mark by which its processes are known."""
    (own / "tmp").mkdir(parents=True, exist_ok=True)
    return {
        **os.environ, "PYTHONPATH": str(ROOT), "TMPDIR": str(own / "tmp"), "TVIMDESIGN_CACHE": "",
        "TVIMDESIGN_SPREAD": "on", "OMP_NUM_THREADS": "1", MARK: str(own),
    }  # fmt: skip


def start(words: list[str], own: Path) -> subprocess.Popen[bytes]:
    """Start a command whose results go into `own`/out."""
    with (own / "said.txt").open("ab") as said:
        return subprocess.Popen(
            [sys.executable, "-m", "tvimdesign", *words, "--out", str(own / "out")],
            cwd=own, stdout=subprocess.DEVNULL, stderr=said, env=environment(own), start_new_session=True,
        )  # fmt: skip


def at_work(own: Path) -> list[psutil.Process]:
    """Processes with the mark that have not ended."""
    found = []
    for process in psutil.process_iter():
        with suppress(psutil.Error):  # it ended meanwhile, or is another user's
            if process.environ().get(MARK) == str(own) and process.status() != psutil.STATUS_ZOMBIE:
                found.append(process)
    return found


def faults_after(one: Try, own: Path) -> list[str]:
    """Run a command, end it, and say what is not as it should be."""
    process = start(COMMANDS[one.command], own)
    time.sleep(one.after)
    ended = process.poll() is not None  # it was through before
    process.send_signal(one.number)
    began = time.monotonic()
    try:
        code = process.wait(timeout=30.0)
    except subprocess.TimeoutExpired:
        process.kill()
        process.wait()
        return [f"still at work 30 s after {one.number.name}"]
    found = []
    while at_work(own) and time.monotonic() < began + 2.0:
        time.sleep(0.05)
    if left := at_work(own):
        found.append(f"{len(left)} processes left after 2 s")
        for one_left in left:
            one_left.kill()
    if list((own / "tmp").iterdir()):
        found.append(f"left in the temporary folder: {', '.join(path.name for path in (own / 'tmp').iterdir())}")
    expected = {signal.SIGKILL: -signal.SIGKILL}.get(one.number, 128 + one.number)
    early = {-one.number} if not (own / "out/manifest.json").exists() else set()  # Python was not up yet
    if not ended and code not in {expected, 0, 3, 4, *early}:
        found.append(f"exit code {code}")
    if "Traceback" in (own / "said.txt").read_text(errors="replace"):
        found.append("a traceback")
    return found + broken_files(own / "out", one, ended=ended or code != expected)


def broken_files(out: Path, one: Try, *, ended: bool) -> list[str]:
    """What is not whole in a folder of results."""
    found = []
    for path in sorted(path for path in out.rglob("*") if path.is_file()):
        name, data = path.relative_to(out).as_posix(), path.read_bytes()
        if path.name.startswith("."):
            if one.number != signal.SIGKILL:
                found.append(f"{name} is left half written")
        elif not whole(path, data):
            found.append(f"{name} is broken")
    manifest = out / "manifest.json"
    if manifest.exists() and not ended:
        wanted = "running" if one.number == signal.SIGKILL else "interrupted"
        status = json.loads(manifest.read_bytes())["status"]
        if status != wanted:
            found.append(f"the manifest says {status}, not {wanted}")
    return found


def whole(path: Path, data: bytes) -> bool:
    """Whether a file of its kind has its end."""
    if path.suffix == ".json":
        try:
            json.loads(data)
        except ValueError:
            return False
    ends = {".png": b"IEND\xaeB`\x82", ".pdf": b"%%EOF\n", ".svg": b"</svg>\n", ".csv": b"\n", ".txt": b"\n",
            ".step": b"END-ISO-10303-21;\n", ".yaml": b"\n"}  # fmt: skip
    return data.endswith(ends.get(path.suffix, b"")) and len(data) > 0


def resumed_differs(command: str, own: Path, reference: Path) -> list[str]:
    """Go on with a command that was ended, and compare what it made with one that ran through."""
    process = start([*COMMANDS[command], "--resume"], own)
    if process.wait(timeout=600.0) != 0:
        return [f"resumed, it ends with {process.returncode}"]
    files, other = (_compared(folder) for folder in (reference, own / "out"))
    found = [f"resumed, {name} is not there" for name in sorted(files - other)]
    return found + [
        f"resumed, {name} differs"
        for name in sorted(files & other)
        if (reference / name).read_bytes() != (own / "out" / name).read_bytes()
    ]


def _compared(folder: Path) -> set[Path]:
    """Files that must be the same: neither the manifest, which has times, nor who wrote which cell of a sweep."""
    found = {path.relative_to(folder) for path in folder.rglob("*") if path.is_file()}
    return {path for path in found if path.name != "manifest.json" and path.parts[0] != "shards"}


def campaign(tries: int, seed: int, commands: list[str], folder: Path) -> dict[str, dict[str, int]]:
    """End each command so many times; returns tries and failures by command, and prints each failure."""
    draw, told = random.Random(seed), {}
    for command in commands:
        through = folder / f"{command}-through"
        through.mkdir()
        began = time.monotonic()
        start(COMMANDS[command], through).wait()
        seconds, count = time.monotonic() - began, Counter[str]()
        for number in range(tries):
            one = Try(command, draw.choice(SIGNALS), draw.uniform(0.3, 0.95 * seconds))
            own = folder / f"{command}-{number}"
            own.mkdir()
            faults = faults_after(one, own)
            if command in _GOES_ON and (own / "out" / _GOES_ON[command]).is_dir():
                count["resumed"] += 1
                faults += resumed_differs(command, own, through / "out")
            count["tries"] += 1
            count["failures"] += bool(faults)
            for fault in faults:
                print(f"{command} {number}: {one.number.name} after {one.after:.1f} s: {fault}", flush=True)
        told[command] = dict(count)
        print(f"{command}: {dict(count)}, {seconds:.0f} s where it runs through", flush=True)
    return told


def main() -> int:
    """Run the campaign; 1 where something was left."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--tries", type=int, default=20, help="of each command")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--commands", nargs="+", choices=list(COMMANDS), default=["run", "front", "parts", "sweep"])
    parser.add_argument("--json", type=Path, help="file for the figures")
    asked = parser.parse_args()
    with tempfile.TemporaryDirectory(prefix="kills-") as folder:
        told = campaign(asked.tries, asked.seed, asked.commands, Path(folder))
    if asked.json:
        asked.json.write_text(json.dumps(told, indent=2) + "\n")
    return int(any(count.get("failures") for count in told.values()))


if __name__ == "__main__":
    sys.exit(main())
