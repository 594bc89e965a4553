"""Random designs within a study's bounds: each violates a named rule and is refused, or its parts are sound.

Designs are drawn from the study's ranges (seeded); what a study does not vary is as it says. Those that violate a
rule of the table are counted by rule. The others are built, each in a process of its own with a time limit and checked:
one valid solid a part, a watertight mesh, the volumes of the model, nothing in each other's way at rest and through the
stroke; with `--inspect` also all that the process wants; with `--slivers` walls and slots of made parts alone. Ends
with code 1 where one that keeps the rules fails.
"""

from __future__ import annotations

import argparse
import contextlib
import multiprocessing as mp
import os
import sys
import time
from collections import Counter
from collections.abc import Collection, Iterable, Iterator, Sequence
from dataclasses import dataclass, field
from multiprocessing.connection import Connection
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import psutil
from numpy.typing import NDArray

from tvimdesign.base.errors import TvimError
from tvimdesign.device import Table, table_for
from tvimdesign.device.table.quantity import Output, Simulated, Supplied
from tvimdesign.study import Study, given, read_study
from tvimdesign.study.design import Design
from tvimdesign.study.study import Options

STUDIES = Path(__file__).resolve().parents[1] / "studies"
FRESH = {
    "elbow_of_polycarbonate": 6, "elbow_machined_own_pins": 5, "ankle_own_pins": 5, "finger_own_pins": 4,
    "wrist_joint_own_pins": 5, "wrist_compression_own_pins": 13, "machined_compression": 12,
}  # fmt: skip
"""Studies within whose ranges validation draws modules that nobody optimized, and how many of each."""
FRESH_BY_FE = FRESH | {
    "ankle_own_pins": 6,
    "wrist_joint_own_pins": 6,
    "wrist_compression_own_pins": 22,
    "machined_compression": 17,
}
"""The same for the structure, which FE solves."""
FRESH_SEED = 2026
_CHUNK = 20_000
"""Designs whose rules are worked out at once."""
_MOST = 5_000_000
"""Draws after which a study's bounds are taken to hold no design that keeps the rules."""
TIME_LIMIT = 120.0
"""Seconds of the processor for one design."""
SILENCE_LIMIT = 30.0 * TIME_LIMIT
"""Seconds by the clock for one design, whose process may wait for a processor, or for ever."""


@dataclass
class Tally:
    """Result of all draws."""

    drawn: int = 0
    refused: Counter[str] = field(default_factory=Counter)
    """Designs that broke a rule, by rule; one may break several."""
    built: int = 0
    failed: list[str] = field(default_factory=list)
    """What was wrong with designs that keep every rule."""
    warned: Counter[str] = field(default_factory=Counter)
    """Warnings of the inspection, by what was checked."""
    seconds: float = 0.0
    """Processor time of the building."""


class Built(NamedTuple):
    """Result of building a design."""

    design: Design
    wrong: list[str]
    warned: Sequence[str] = ()
    """Warnings of the inspection, by what was checked."""
    seconds: float = 0.0
    """Processor time of the building."""


class Draws:
    """Random designs within the bounds of a study."""

    def __init__(self, study: Study, seed: int) -> None:
        """`seed` makes the same designs again."""
        self.study = study
        self.table: Table = table_for(study.mode)
        self._known = given(study)
        if not study.vary:
            raise SystemExit(f"{study.name} varies nothing: choose a study with a vary section")
        self._random = np.random.default_rng(seed)
        self._rows = [row for row in self.table.outputs if _is_plain(row, self.table)]
        self._ruled = [row for row in self._rows if row.rules and not row.hidden]

    def keeping_rules(self, count: int, tally: Tally) -> Iterator[Design]:
        """Draw until `count` designs keep every rule; those that do not are counted by what they break."""
        count_kept = 0
        while count_kept < count:
            if tally.drawn >= _MOST:
                raise RuntimeError(f"{self.study.name}: of {tally.drawn} draws only {count_kept} keep the rules")
            drawn = self._draw(_CHUNK)
            feasible = self._keeping(drawn, tally)
            for index in feasible[: count - count_kept]:
                yield self._design(drawn, int(index), tally.drawn - _CHUNK)
            count_kept += len(feasible)

    def first(self, tally: Tally) -> Design | None:
        """Return the first design of one chunk that keeps every rule; None where none does."""
        drawn = self._draw(_CHUNK)
        feasible = self._keeping(drawn, tally)
        if not feasible.size:
            return None
        return self._design(drawn, int(feasible[0]), 0)

    def numbered(self, numbers: Collection[int]) -> Iterator[tuple[int, Design]]:
        """Yield the draws of these numbers, which `keeping_rules` names, whether they keep today's rules or not."""
        for before in range(0, 1 + max(numbers, default=-1), _CHUNK):
            drawn = self._draw(_CHUNK)
            for number in sorted(number for number in numbers if before <= number < before + _CHUNK):
                yield number, self._design(drawn, number - before, before)

    def _draw(self, count: int) -> dict[str, NDArray[np.float64]]:
        drawn = {}
        for name, allowed in self.study.vary.items():
            if isinstance(allowed, Options):
                numbers = [value for value in allowed.values if not isinstance(value, str)]
                if numbers:
                    drawn[name] = self._random.choice(np.array(numbers), count)
            else:
                drawn[name] = self._random.uniform(allowed.lower, allowed.upper, count)
        return drawn

    def _keeping(self, drawn: dict[str, NDArray[np.float64]], tally: Tally) -> NDArray[np.int64]:
        """Which of the draws keep every rule."""
        with np.errstate(all="ignore"):  # what cannot be drawn has no number, and so violates the rule
            values = self.table.evaluate(self._known | drawn, [row.name for row in self._ruled])
        count = len(next(iter(drawn.values())))
        keeps = np.ones(count, dtype=bool)
        for row in self._ruled:
            value = np.broadcast_to(np.asarray(values[row.name], dtype=float), (count,))
            for rule in row.rules:
                good = value >= rule.value if rule.sense == ">=" else value <= rule.value
                tally.refused[row.name] += int((~good).sum())
                keeps &= good
        tally.drawn += count
        return np.flatnonzero(keeps)

    def _design(self, chunk: dict[str, NDArray[np.float64]], index: int, before: int) -> Design:
        """Return a draw of a chunk, `before` draws on, with every number that follows from its inputs alone."""
        known: dict[str, Any] = self._known | {name: float(values[index]) for name, values in chunk.items()}
        visible = [row.name for row in self._rows if not row.hidden]
        values = {name: float(value) for name, value in known.items() if isinstance(value, int | float)}
        with np.errstate(all="ignore"):
            values |= {name: float(value) for name, value in self.table.evaluate(known, visible).items()}
        choices = {row.name: str(getattr(known[row.name], "name", known[row.name])) for row in self.table.choices}
        return Design(
            tvimdesign="0", name=f"{self.study.name}, draw {before + index}", mode=self.study.mode, status="evaluated",
            choices=choices, values=values, study={},
        )  # fmt: skip


def _is_plain(row: Output, table: Table) -> bool:
    """Return whether a row follows from the inputs alone, without an operating point and without a simulation."""
    behind = [table.by_name[name] for name in (row.name, *table.ancestors(row.name)) if name in table.by_name]
    return not any(
        isinstance(name, (*Supplied, Simulated)) or getattr(name, "per_point", False) or getattr(name, "instant", False)
        for name in behind
    )


def faults(design: Design, inspect: bool) -> tuple[list[str], list[str]]:
    """Build a design's parts; returns what is wrong with them, and what the inspection warns of."""
    from tvimdesign.cad.assembly.assembly import drawn_parts
    from tvimdesign.cad.export.mesh import solid_mesh
    from tvimdesign.cad.export.print_files import closed
    from tvimdesign.cad.geometry.dimensions import dimensions
    from tvimdesign.cad.geometry.kinds import is_of_structure
    from tvimdesign.cad.inspection.inspect import module_checks, part_checks, solid_check
    from tvimdesign.cad.inspection.size_checks import POSITIONS, clearance_checks, rest_checks

    dims = dimensions(design)
    drawn = drawn_parts(dims)
    checks = [*rest_checks(design, dims, drawn), *(solid_check(kind, solid) for kind, solid in drawn.items())]
    checks += [check for share in POSITIONS for check in clearance_checks(dims, drawn, share)]
    for kind, solid in drawn.items():
        closed(kind, solid_mesh(solid))
        if inspect and is_of_structure(kind):
            checks += part_checks(design, dims, kind, solid)
    if inspect:
        checks += module_checks(design, dims, drawn)
    wrong = [
        f"{check.text}: {check.value:.4g}, limit {check.limit:.4g}" for check in checks if check.level == "failure"
    ]
    return wrong, [check.name for check in checks if check.level == "warning"]


def slivers(design: Design) -> list[str]:
    """Walls and slots of a design's made parts under what its process makes; edges may taper to nothing."""
    from tvimdesign.cad.assembly.assembly import drawn_parts
    from tvimdesign.cad.export.mesh import solid_mesh
    from tvimdesign.cad.geometry.dimensions import dimensions
    from tvimdesign.cad.geometry.kinds import is_of_structure
    from tvimdesign.cad.inspection.inspect import sliver_checks
    from tvimdesign.cad.inspection.rays import Triangles

    dims = dimensions(design)
    made = {kind: solid for kind, solid in drawn_parts(dims).items() if is_of_structure(kind)}
    checked = [sliver_checks(dims, kind, solid, Triangles(solid_mesh(solid))) for kind, solid in made.items()]
    checks = [check for slot, wall, _ in checked for check in (slot, wall) if check.level != "pass"]
    return [f"{check.text}: {check.value:.4g}, limit {check.limit:.4g}" for check in checks]


def measured(study: Study, count: int, seed: int) -> Tally:
    """Draw, refuse, draw the parts and measure their walls and slots."""
    tally = Tally()
    for design in Draws(study, seed).keeping_rules(count, tally):
        thin = slivers(design)
        print(f"{design.name}: {'; '.join(thin) or 'no sliver'}", file=sys.stderr, flush=True)
        tally.built += 1
        tally.failed += [f"{design.name}: {text}" for text in thin]
    tally.seconds = time.process_time()
    return tally


def _child(design: Design, inspect: bool, mouth: Connection) -> None:
    try:
        wrong, warned = faults(design, inspect)
    except TvimError as error:
        wrong, warned = [str(error)], []
    except Exception as error:  # the kernel raises a dozen classes; each is a failure of the design it came from
        wrong, warned = [f"{type(error).__name__}: {error}"], []
    mouth.send((wrong, warned, time.process_time()))


def run(study: Study, count: int, seed: int, inspect: bool = False, hands: int = 1) -> Tally:
    """Draw, refuse, build and check, `hands` designs at once."""
    tally = Tally()
    for outcome in built(Draws(study, seed).keeping_rules(count, tally), inspect, hands):
        tally.built += 1
        tally.failed += [f"{outcome.design.name}: {text}" for text in outcome.wrong]
        tally.warned.update(outcome.warned)
        tally.seconds += outcome.seconds
    return tally


def built(designs: Iterable[Design], inspect: bool, hands: int) -> Iterator[Built]:
    """Build and check designs, each in a process of its own, `hands` at once."""
    # Not a plain fork: where this process has used the CAD kernel, its threads are missing in the child, which hangs.
    context: Any = mp.get_context("forkserver")
    context.set_forkserver_preload(["tvimdesign.cad.inspection.inspect", "tvimdesign.cad.inspection.size_checks"])
    at_work: list[tuple[Design, Any, Connection, float]] = []
    for design in designs:
        if len(at_work) == hands:
            yield _settled(*at_work.pop(0))
        ear, mouth = context.Pipe(duplex=False)
        child = context.Process(target=_child, args=(design, inspect, mouth), daemon=True)
        child.start()
        mouth.close()
        at_work.append((design, child, ear, time.monotonic()))
    for worker in at_work:
        yield _settled(*worker)


def _settled(design: Design, child: Any, ear: Connection, started: float) -> Built:
    """Take in what a child found, or end it when it has had its time."""
    outcome = Built(design, [f"no answer in {TIME_LIMIT:g} s of the processor, or {SILENCE_LIMIT:g} s by the clock"])
    try:
        if _answers(child, ear, started):
            outcome = Built(design, *ear.recv())
    except EOFError:
        child.join()
        outcome = Built(design, [f"its process ended with code {child.exitcode}"])
    child.kill()
    child.join()
    print(f"{design.name}: {'; '.join(outcome.wrong) or 'sound'}", file=sys.stderr, flush=True)
    return outcome


def _answers(child: Any, ear: Connection, started: float) -> bool:
    """Return whether a child answers, or ends, before its processor time is over, or it is silent for too long."""
    while not ear.poll(1.0):
        if time.monotonic() - started > SILENCE_LIMIT or _processor_time(child) > TIME_LIMIT:
            return ear.poll()
    return True


def _processor_time(child: Any) -> float:
    """Seconds of the processor a child has had; none once it has ended."""
    with contextlib.suppress(psutil.NoSuchProcess):
        taken = psutil.Process(child.pid).cpu_times()
        return float(taken.user + taken.system)
    return 0.0


def main(arguments: Sequence[str]) -> int:
    """Run for the studies named, print the counts; returns the exit code."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("studies", nargs="*", type=Path)
    parser.add_argument("--designs", type=int, default=100, help="that keep the rules and are built, for each study")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--hands", type=int, default=os.cpu_count() or 1, help="designs that are built at once")
    parser.add_argument("--inspect", action="store_true", help="also walls, overhang, order of assembly ...")
    parser.add_argument("--slivers", action="store_true", help="walls and slots of made parts alone")
    options = parser.parse_args(arguments)
    failed = False
    for path in options.studies or [STUDIES / "wrist_joint.yaml", STUDIES / "wrist_compression.yaml"]:
        study, many, seed = read_study(path), options.designs, options.seed
        tally = (
            measured(study, many, seed) if options.slivers else run(study, many, seed, options.inspect, options.hands)
        )
        each = tally.seconds / max(1, tally.built)
        print(
            f"{path.stem}: {tally.drawn} drawn, {tally.built} that keep the rules built, {each:.1f} s of processor each"
        )
        print(f"  {len(tally.failed)} faults")
        for text in tally.failed:
            print(f"    {text}")
        for title, counts in (("refused by rule", tally.refused), ("warnings", tally.warned)):
            reported = ", ".join(f"{name} {number}" for name, number in counts.most_common() if number)
            print(f"  {title}: {reported or 'none'}")
        failed = failed or bool(tally.failed)
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
