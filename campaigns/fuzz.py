"""Hands in mutated inputs of every kind a user can: each is read, or refused in words.

    python campaigns/fuzz.py [--inputs 2000] [--seed 1] [--jobs 1] [--kinds studies designs ...] [--out FILE]

An input that ends in anything but an error of this package, takes more than two seconds of the processor, changes a
file outside its results, starts a process or opens a connection is a failure; it is printed, and kept in
campaigns/corpus/, whose files are tried first by the next campaign. An input is drawn from the kind, the seed and its
number alone, and inputs are handed in by chunks. A chunk that is done is a line of FILE, and is not done again: so a
campaign goes on where it was ended. For systems that fork.
"""

from __future__ import annotations

import argparse
import hashlib
import json
import multiprocessing
import random
import resource
import shutil
import sys
import tempfile
import time
import warnings
from collections import Counter, deque
from collections.abc import Iterable, Sequence
from dataclasses import asdict, dataclass, field
from multiprocessing.connection import Connection, wait
from pathlib import Path
from typing import Any

from fuzzing.designs import DESIGNS
from fuzzing.kind import Drawn, Kind
from fuzzing.measurements import COLUMN_MAPS, DATA_FILES, FITS
from fuzzing.messages import ANSWERS, MESSAGES
from fuzzing.studies import RECORD_FILES, SETTINGS, STUDIES, SWEEPS
from fuzzing.watched import ending

CORPUS = Path(__file__).with_name("corpus")
KINDS: dict[str, Kind] = {
    "studies": STUDIES, "settings": SETTINGS, "sweeps": SWEEPS, "records": RECORD_FILES, "designs": DESIGNS,
    "data_files": DATA_FILES, "column_maps": COLUMN_MAPS, "fits": FITS, "messages": MESSAGES, "answers": ANSWERS,
}  # fmt: skip
CHUNK = 1000
MOST_PROCESSOR = 1800  # s, of a chunk that no signal of Python's ends


@dataclass
class Chunk:
    """Inputs of a kind by their numbers, and what they came to."""

    kind: str
    seed: int
    first: int
    end: int
    inputs: int = 0
    """Messages of a conversation count each."""
    refused: int = 0
    seconds: float = 0.0
    """Of the processor."""
    most_memory: float = 0.0  # MB
    failures: list[str] = field(default_factory=list)

    @property
    def name(self) -> tuple[str, int, int]:
        """Return its kind, seed and first number."""
        return self.kind, self.seed, self.first


def drawn(kind: str, seed: int, number: int) -> Drawn:
    """Draw an input, by nothing but its kind, seed and number."""
    return KINDS[kind].draw(random.Random(f"{kind} {seed} {number}"))


def handed_in(kind: str, sample: Drawn, folder: Path) -> tuple[str, bool]:
    """Return what is wrong with how an input is taken, and whether it is refused; remove what it wrote."""
    path = sample.written(folder)
    verdict = ending(KINDS[kind], path)
    for there in folder.iterdir():
        shutil.rmtree(there) if there.is_dir() else there.unlink()
    return verdict


def done(chunk: Chunk, at: Any = None) -> Chunk:
    """Hand in a chunk here; `at` holds the number of the input that is in hand."""
    began, folder = time.process_time(), Path(tempfile.mkdtemp(prefix="fuzz-"))
    for number in range(chunk.first, chunk.end):
        if at is not None:
            at.value = number
        sample = drawn(chunk.kind, chunk.seed, number)
        fault, refused = handed_in(chunk.kind, sample, folder)
        chunk.inputs += sample.parts
        chunk.refused += refused
        if fault:
            chunk.failures.append(f"{number}: {fault}; kept as {stored(chunk.kind, sample)}")
    shutil.rmtree(folder)
    chunk.seconds = time.process_time() - began
    chunk.most_memory = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024.0
    return chunk


def stored(kind: str, sample: Drawn) -> str:
    """Keep an input in the corpus, by its hash."""
    where = CORPUS / kind / hashlib.sha256(sample.data).hexdigest()[:12]
    sample.written(where)
    return where.relative_to(CORPUS).as_posix()


def known_failures() -> list[str]:
    """Return the inputs that failed in an earlier campaign and still do."""
    failures = []
    for path in sorted(path for path in CORPUS.rglob("*") if path.is_file()):
        kind, number, *name = path.relative_to(CORPUS).parts
        with tempfile.TemporaryDirectory(prefix="fuzz-") as folder:
            fault, _ = handed_in(kind, Drawn("/".join(name), path.read_bytes()), Path(folder))
        if fault:
            failures.append(f"{kind}/{number}: {fault}")
    return failures


def _child(chunk: Chunk, at: Any, connection: Connection) -> None:
    resource.setrlimit(resource.RLIMIT_CPU, (MOST_PROCESSOR, MOST_PROCESSOR))
    connection.send(done(chunk, at))


def in_processes(chunks: Iterable[Chunk], jobs: int) -> Iterable[Chunk]:
    """Chunks as they are done, each in a child forked from this process; what ends a child is its input's failure."""
    forks, left = multiprocessing.get_context("fork"), deque(chunks)
    at_work: dict[int, tuple[Any, Chunk, Any, Connection]] = {}
    while left or at_work:
        while left and len(at_work) < jobs:
            chunk, at = left.popleft(), forks.Value("q", 0)
            mine, its = forks.Pipe(duplex=False)
            child = forks.Process(target=_child, args=(chunk, at, its))
            child.start()
            its.close()
            at_work[child.sentinel] = child, chunk, at, mine
        for ready in wait([*at_work, *(mine for *_, mine in at_work.values())]):
            key = (
                ready
                if isinstance(ready, int)
                else next((k for k, worker in at_work.items() if worker[3] is ready), None)
            )
            if key not in at_work:
                continue  # its end was heard before its word
            child, chunk, at, mine = at_work.pop(key)
            try:
                result: Chunk = mine.recv()
            except EOFError:
                child.join()
                number = int(at.value)
                sample = drawn(chunk.kind, chunk.seed, number)
                words = f"{number}: ends the process ({child.exitcode}); kept as {stored(chunk.kind, sample)}"
                result = Chunk(
                    chunk.kind, chunk.seed, chunk.first, number + 1, number + 1 - chunk.first, failures=[words]
                )
                if number + 1 < chunk.end:
                    left.append(Chunk(chunk.kind, chunk.seed, number + 1, chunk.end))
            child.join()
            yield result


def chunks_of(kinds: Sequence[str], inputs: int, seed: int, there: Sequence[Chunk]) -> list[Chunk]:
    """Return the chunks that are still to be done, the kinds by turns: a campaign cut short has some of each."""
    ends = {chunk.name: chunk.end for chunk in there}
    turns = []
    for kind in kinds:
        count, first = max(round(inputs * KINDS[kind].share), 1), 0
        size = max(round(CHUNK * KINDS[kind].share), 1)
        while first < count:
            end = ends.get((kind, seed, first))
            if end is None:
                end = min(first + size, count)
                turns.append((first / count, Chunk(kind, seed, first, end)))
            first = end
    return [chunk for _, chunk in sorted(turns, key=lambda turn: turn[0])]


def summary(chunks: Sequence[Chunk]) -> list[str]:
    """Return a line for each kind."""
    inputs, failures, seconds, refused, handed = (
        Counter[str](),
        Counter[str](),
        Counter[str](),
        Counter[str](),
        Counter[str](),
    )
    for chunk in chunks:
        inputs[chunk.kind] += chunk.inputs
        failures[chunk.kind] += len(chunk.failures)
        seconds[chunk.kind] += chunk.seconds
        refused[chunk.kind] += chunk.refused
        handed[chunk.kind] += chunk.end - chunk.first
    return [
        f"{kind}: {inputs[kind]} inputs, {failures[kind]} failures, {1.0 - refused[kind] / handed[kind]:.0%} taken, "
        f"{inputs[kind] / max(seconds[kind], 1e-9):.0f} a second of the processor"
        for kind in inputs
    ]


def main() -> int:
    """Run the campaign; 1 where an input failed."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--inputs", type=int, default=2000, help="of each kind; fits and answers get a share of it")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--jobs", type=int, default=1, help="processes at once")
    parser.add_argument("--kinds", nargs="+", choices=list(KINDS), default=list(KINDS))
    parser.add_argument("--out", type=Path, help="file to which each chunk that is done is appended")
    options = parser.parse_args()
    warnings.simplefilter("ignore")
    sys.dont_write_bytecode = True
    known = known_failures()
    print(*known, sep="\n", end="\n" * bool(known), flush=True)
    lines = options.out.read_text().splitlines() if options.out and options.out.exists() else []
    every = [Chunk(**json.loads(line)) for line in lines]
    for kind in options.kinds:  # imports and what is read once are no input's
        done(Chunk(kind, options.seed - 1, 0, 3))
    for chunk in in_processes(chunks_of(options.kinds, options.inputs, options.seed, every), options.jobs):
        every.append(chunk)
        print(
            *(f"{chunk.kind} {words}" for words in chunk.failures),
            sep="\n",
            end="\n" * bool(chunk.failures),
            flush=True,
        )
        if options.out:
            with options.out.open("a") as out:
                out.write(json.dumps(asdict(chunk)) + "\n")
    print(*summary(every), sep="\n")
    return int(bool(known) or any(chunk.failures for chunk in every))


if __name__ == "__main__":
    sys.exit(main())
