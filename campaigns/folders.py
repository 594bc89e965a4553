"""Runs commands into random folders with a user's files in them, and looks whether every byte of theirs is there.

    python campaigns/folders.py [--folders 10000] [--real 200] [--seed 1] [--commands run front ...]

A folder is empty, somebody's home, or has finished, failed or killed results in it, with files added, results edited,
links, and manifests of other programs. Then commands run into it, with and without `--overwrite` and `--resume`, and
may be killed at any write or rename, while the user goes on. Each command runs whole once; after that its files are
written again through the same results folder, in milliseconds. In the `--real` folders whole commands run.
"""

from __future__ import annotations

import argparse
import json
import os
import random
import shutil
import subprocess
import sys
import tempfile
from collections import Counter
from collections.abc import Iterator
from contextlib import contextmanager, redirect_stderr
from dataclasses import dataclass, field
from io import StringIO
from pathlib import Path
from typing import Any

from ended_commands import COMMANDS, FIRST, GOES_ON, NEEDS_FE, ROOT, SERVES

from tvimdesign.base.atomic_files import UNFINISHED
from tvimdesign.base.errors import TvimError
from tvimdesign.base.results_folder import PROGRESS, ResultsFolder
from tvimdesign.explore.state import FILE, State, open_history, write_history, written_digest

QUICK = ("fit", "simulate")
"""Commands of about a second, which run whole in the `--real` folders."""
FLAGS = ([], ["--overwrite"], ["--resume"])
_KILLED = 9
_COUNTED = {name: getattr(os, name) for name in ("replace", "rename", "fsync", "unlink", "link", "rmdir")}
_NAMES = (
    "notes.txt", "thesis/ch1.tex", "my.yaml", "results.csv", "report.html", "cad/mine.step", "plots/.a.part", "x.part",
    "front/progress/note.txt", "unfinished-1/old.txt", "shards/00001.jsonl", "explore.json",
    ".cells-host-1-x/a.step", ".verify-a/b.msh", "parts/mine.stl",
)  # fmt: skip
_MANIFESTS = (
    '{"name": "app", "icons": [{"src": "a.png"}]}', '{"status": "running"}', '{"files": {"thesis/ch1.tex": "x"}}',
    '{"status": "running", "files": {"notes.txt": ""}}', "[]", "",
)  # fmt: skip


@dataclass
class User:
    """Somebody who works in the same folders; `files` holds every text they wrote, which must stay somewhere.

    They leave alone the folder of an unfinished run, which is the program's.
    """

    draw: random.Random
    place: Path
    files: dict[str, Path] = field(default_factory=dict)

    def write(self, path: Path, before: str = "") -> None:
        """Write a file of their own, or change one."""
        text = f"{before}\nof the user, number {len(self.files)}, {self.draw.random()}\n"
        path = path.parent.resolve() / path.name
        if path.is_dir() or any(parent.is_file() for parent in path.parents):
            return
        path.parent.mkdir(parents=True, exist_ok=True)
        self.forget(path)
        path.write_text(text)
        self.files[text] = path

    def is_theirs(self, path: Path) -> bool:
        """Return whether a file holds a text of theirs, wherever it is now."""
        return path.is_file() and not path.is_symlink() and _text(path) in self.files

    def forget(self, path: Path) -> None:
        """Remove a file; a text of their own is then not to be looked for."""
        if self.is_theirs(path):
            del self.files[_text(path)]
        path.unlink(missing_ok=True)

    def act(self, out: Path) -> None:
        """Do one thing that people do."""
        inside = [path for path in out.rglob("*") if UNFINISHED not in path.relative_to(out).parts]
        files = (path for path in inside if path.is_file() and not path.is_symlink())
        every = sorted(path for path in files if not path.name.startswith(".") or "of the user" in _text(path))
        what = self.draw.choice(["add", "add", "edit", "edit", "link", "move", "delete", "manifest"])
        path = self.draw.choice(every) if every else out / "notes.txt"
        if what == "add":
            folders = [out, *(path for path in inside if path.is_dir() and not path.is_symlink())]
            self.write(self.draw.choice(folders) / self.draw.choice(_NAMES))
        elif what == "edit":
            self.write(path, _text(path)[:200] if every else "")
        elif what == "link":
            outside = self.place / f"outside-{len(self.files)}.txt"
            self.write(outside)
            if every:
                self.forget(path)
                path.symlink_to(outside)
        elif what == "move" and every and path.parent != out:
            elsewhere = self.place / f"elsewhere-{len(self.files)}"
            shutil.move(path.parent, elsewhere)
            path.parent.symlink_to(elsewhere)
            for moved in elsewhere.rglob("*"):  # results that somebody puts elsewhere are theirs
                if moved.is_file() and not moved.is_symlink() and not moved.name.startswith("."):
                    self.files[_text(moved)] = moved
        elif what == "delete" and every:
            self.forget(path)
        elif what == "manifest":
            self.write(out / "manifest.json", self.draw.choice(_MANIFESTS))

    def lost(self) -> list[str]:
        """Return what of theirs is nowhere any more, and what is changed of it outside the folders of results."""
        there = {_text(path) for path in self.place.rglob("*") if path.is_file() and not path.is_symlink()}
        gone = [f"{path.relative_to(self.place)} is gone" for text, path in self.files.items() if text not in there]
        outside = {text: path for text, path in self.files.items() if not path.is_relative_to(self.place / "out")}
        return gone + [
            f"{path.name}, which is outside, is changed"
            for text, path in outside.items()
            if not path.is_file() or _text(path) != text
        ]


def _text(path: Path) -> str:
    return path.read_bytes().decode(errors="replace")


@contextmanager
def killed_at(number: int) -> Iterator[None]:
    """End the process without a word at its n-th write or rename."""
    left, before = [number], {name: getattr(os, name) for name in _COUNTED}

    def counting(usual: Any) -> Any:
        def call(*words: Any, **more: Any) -> Any:
            left[0] -= 1
            if left[0] < 0:
                os._exit(_KILLED)
            return usual(*words, **more)

        return call

    for name, usual in _COUNTED.items():
        setattr(os, name, counting(usual if name != "fsync" else lambda _: None))  # nobody pulls the plug here
    try:
        yield
    finally:
        for name, usual in before.items():
            setattr(os, name, usual)


def replay(command: str, files: dict[str, bytes], out: Path, flags: list[str], meanwhile: Any) -> None:
    """Write a command's files through its results folder, as the command does; `meanwhile` is called in between."""
    if command == SERVES:
        history = open_history(out, b"study", State(way="evaluate"), overwrite="--overwrite" in flags)
        out.mkdir(parents=True, exist_ok=True)
        before = written_digest(out)
        meanwhile()
        write_history(out, history, before)
        return
    goes_on = GOES_ON.get(command, PROGRESS)
    with ResultsFolder(out, "--overwrite" in flags, "--resume" in flags, goes_on) as folder:
        if command == "front":
            folder.write(f"{PROGRESS}/0001.json", "{}")
        for number, (name, data) in enumerate(files.items()):
            if not (folder.path / name).exists():  # a cell that is continued from is not written again
                folder.write(name, data)
            if number == len(files) // 2:
                meanwhile()
        folder.remove(PROGRESS)
        folder.finish("replayed", {}, {})


def one_folder(
    number: int, seed: int, written: dict[str, dict[str, bytes]], place: Path, *, real: bool
) -> tuple[list[str], str]:
    """Try one folder; what is lost, and what was done."""
    draw = random.Random(f"{seed} {number}")
    user, out = User(draw, place), place / "out"
    done: list[str] = []
    if draw.random() < 0.15:  # a home, in which there are no results at first
        out.mkdir()
        for _ in range(draw.randint(1, 4)):
            user.act(out)
    for _ in range(draw.randint(1, 4)):
        command = draw.choice([name for name in written if not real or name in QUICK])
        flags = draw.choice(FLAGS) if command != "explorer" else draw.choice(FLAGS[:2])
        killed = draw.randint(0, 3 * len(written[command]) + 20) if draw.random() < 0.4 else None
        acts = draw.random() < 0.3
        done.append(f"{command} {' '.join(flags)}{'' if killed is None else f', killed at {killed}'}")
        if real:
            run_whole(command, [flag for flag in flags if flag != "--resume"], out)
        else:
            in_a_child(command, written[command], out, flags, user if acts else None, killed)
        for _ in range(draw.randint(0, 3)):
            if out.is_dir():
                user.act(out)
    return user.lost(), "; ".join(done)


def in_a_child(
    command: str, files: dict[str, bytes], out: Path, flags: list[str], user: User | None, killed: int | None
) -> None:  # fmt: skip
    """Replay a command in a process of its own, which may be killed; what the user did meanwhile is noted."""
    note = out.parent / "meanwhile.json"
    process = os.fork()
    if process:
        status = os.waitstatus_to_exitcode(os.waitpid(process, 0)[1])
        if status not in (0, _KILLED):
            raise SystemExit(f"{command} {flags}: the replay ends with {status}")
        if user and note.exists():
            user.files = {text: Path(path) for text, path in json.loads(note.read_text())}
            user.draw.random()
        note.unlink(missing_ok=True)
        return

    def meanwhile() -> None:
        if user and out.is_dir():
            with killed_at(sys.maxsize):
                user.act(out)
                note.write_text(json.dumps([[text, str(path)] for text, path in user.files.items()]))

    code = 1
    try:
        with redirect_stderr(StringIO()), killed_at(sys.maxsize if killed is None else killed):
            replay(command, files, out, flags, meanwhile)
        code = 0
    except TvimError:
        code = 0
    finally:
        os._exit(code)


def run_whole(command: str, flags: list[str], out: Path) -> int:
    """Run a command as people do; returns its exit code."""
    words = [word.replace("../swept/out", str(out.parent / "../swept/out")) for word in COMMANDS[command]]
    done = subprocess.run(
        [sys.executable, "-m", "tvimdesign", *words, *flags, "--out", str(out)],
        cwd=out.parent, env={**os.environ, "PYTHONPATH": str(ROOT)}, capture_output=True, text=True, check=False,
    )  # fmt: skip
    if "Traceback" in done.stderr:
        raise SystemExit(f"{command}: {done.stderr}")
    return done.returncode


def written_by(command: str, folder: Path) -> dict[str, bytes]:
    """Run a command whole into an empty folder; the files that it writes."""
    if command == SERVES:
        return {FILE: b"{}"}
    place = folder / f"of-{command}"
    place.mkdir()
    if command in FIRST and not (folder / FIRST[command][0]).exists():
        (folder / FIRST[command][0]).mkdir()
        COMMANDS["first"] = FIRST[command][1]
        run_whole("first", [], folder / FIRST[command][0] / "out")
    if code := run_whole(command, [], place / "out"):
        raise SystemExit(f"{command} ends with {code} in an empty folder")
    out = place / "out"
    names = json.loads((out / "manifest.json").read_text())["files"]
    there = {path.relative_to(out).as_posix() for path in out.rglob("*") if path.is_file()} - {"manifest.json"}
    if there != set(names):
        raise SystemExit(f"{command}: the manifest does not list {sorted(there ^ set(names))}")
    return {name: (out / name).read_bytes()[:2000] for name in names}


def campaign(folders: int, real: int, seed: int, commands: list[str]) -> Counter[str]:
    """Try so many folders; counts of folders and of losses, which are printed."""
    counts: Counter[str] = Counter()
    with tempfile.TemporaryDirectory(prefix="folders-") as folder:
        written = {}
        for command in commands:
            written[command] = written_by(command, Path(folder))
            print(f"{command}: {len(written[command])} files", flush=True)
        for number in range(folders + real):
            place = Path(folder) / str(number)
            place.mkdir()
            lost, done = one_folder(number, seed, written, place, real=number >= folders)
            counts["folders"] += 1
            counts["lost"] += bool(lost)
            for output in lost:
                print(f"folder {number}: {output} ({done})", flush=True)
            shutil.rmtree(place)
            if number % 1000 == 999:
                print(f"{number + 1} folders, {counts['lost']} with a loss", flush=True)
    return counts


def main() -> int:
    """Run the campaign; 1 where a byte of a user's was changed or removed."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--folders", type=int, default=10_000)
    parser.add_argument(
        "--real", type=int, default=200, help=f"folders that whole commands run into: {', '.join(QUICK)}"
    )
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--commands", nargs="+", choices=list(COMMANDS), help="all but the one that needs FE")
    options = parser.parse_args()
    commands = options.commands or [name for name in COMMANDS if name != NEEDS_FE]
    counts = campaign(options.folders, options.real, options.seed, commands)
    print(f"{counts['folders']} folders, {counts['lost']} in which something of the user's was changed or removed")
    return int(counts["lost"] > 0)


if __name__ == "__main__":
    sys.exit(main())
