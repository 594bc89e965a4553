"""Random choices of what a module is made of and bought from: refused by a named rule, or sound parts.

    python benchmarks/random_choices.py [--draws 200] [--seed 1] [--hands 2] [--inspect | --slivers] [--out FILE]

Each draw takes a shipped study and chooses heater, process, spring, fixtures and so on at random. Either the reader
refuses that in words, or all of 20,000 designs within the study's bounds break rules, which are counted, or the first
that keeps them all is built and checked as in random_designs.py, with `--slivers` for walls and slots alone. Ends with
code 1 where one of those fails. With `--out FILE` each draw is a line of the file as it ends, and a call that was ended
goes on from there.
"""

from __future__ import annotations

import argparse
import json
import os
import random
import re
import sys
import time
from collections import Counter
from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path
from typing import Any, Literal, NamedTuple

import yaml
from random_designs import Draws, Tally, built, slivers

from tvimdesign.base.errors import InputError
from tvimdesign.catalog.catalog import Catalog
from tvimdesign.device import table_for
from tvimdesign.device.table.quantity import Choice
from tvimdesign.study import Study, read_study_text
from tvimdesign.study.design import Design

STUDIES = Path(__file__).resolve().parents[1] / "studies"
BASES = ("elbow_printed", "elbow_machined", "finger", "wrist_joint", "wrist_compression")
CHOSEN = (
    "stock_spring", "spring_material", "process", "heater_module", "heater_fuse", "heater_wiring", "spreader_material",
    "liner_material", "link_screw", "link_fit", "tang_hold", "bearing", "axial_preload", "preload_adjuster", "cover",
)  # fmt: skip
"""What is drawn at random."""
OFTEN = 0.25
"""Share of the draws in which a choice is drawn; else it stays as the study says."""
NAMED = re.compile(r"module\.(\w+)|^(\w+) is")
"""What a refusal names first."""


class Ended(NamedTuple):
    """Result of a draw."""

    draw: int
    seed: int
    inspected: bool | str
    """True with everything that the process wants, `slivers` with walls and slots alone."""
    how: Literal["refused", "ruled", "built"]
    """By the reader; no design kept the rules; or a design was built."""
    by: str = ""
    """The choice that the refusal names, or the rule that was most broken."""
    faults: Sequence[str] = ()
    warnings: Sequence[str] = ()
    seconds: float = 0.0
    """Processor time of the building."""


def words_of(choice: Choice) -> list[str]:
    """Return the words of a choice."""
    return [*choice.options, *(Catalog().names(choice.category) if choice.category else [])]


def drawn_study(draw: random.Random) -> Study:
    """Return a shipped study with random choices; raise InputError where the reader refuses them."""
    name = draw.choice(BASES)
    text: dict[str, Any] = yaml.safe_load((STUDIES / f"{name}.yaml").read_text(encoding="utf-8"))
    module = text.setdefault("module", {})
    for choice in table_for(text["mode"]).choices:
        if choice.name in CHOSEN and draw.random() < OFTEN:
            module[choice.name] = draw.choice(words_of(choice))
            text["vary"].pop(choice.name, None)
    if module.get("stock_spring", "none") != "none":
        module.pop("spring_material", None)  # the spring brings its own
        for bought in ("wire_diameter", "coil_diameter", "coil_count"):
            text["vary"].pop(bought, None)
            module.pop(bought, None)
    return read_study_text(yaml.safe_dump(text, allow_unicode=True), name)


def drawn(index: int, seed: int, inspect: bool | str) -> Design | Ended:
    """Return the design to build of a draw, or why there is none."""
    try:
        draws = Draws(drawn_study(random.Random(1000 * seed + index)), seed=index)
    except InputError as error:
        named = NAMED.search(str(error))
        return Ended(index, seed, inspect, "refused", next(filter(None, named.groups())) if named else str(error))
    tally = Tally()
    design = draws.first(tally)
    if design is None:
        return Ended(index, seed, inspect, "ruled", tally.refused.most_common(1)[0][0])
    return design.model_copy(update={"name": f"draw {index}, {design.name}"})


def run(draws: Iterable[int], seed: int, inspect: bool, hands: int) -> Iterator[Ended]:
    """Draw, refuse, build and check; yields what came of each draw as it ends."""
    unbuilt: list[Ended] = []
    indices: dict[str, int] = {}

    def designs() -> Iterator[Design]:
        for index in draws:
            draw = drawn(index, seed, inspect)
            if isinstance(draw, Ended):
                unbuilt.append(draw)
            else:
                indices[draw.name] = index
                yield draw

    for end in built(designs(), inspect, hands):
        yield from unbuilt
        unbuilt.clear()
        yield Ended(indices[end.design.name], seed, inspect, "built", "", end.wrong, list(end.warned), end.seconds)
    yield from unbuilt


def measured(draws: Iterable[int], seed: int) -> Iterator[Ended]:
    """Draw, refuse, draw the parts and measure their walls and slots; yields what came of each draw."""
    for index in draws:
        draw = drawn(index, seed, "slivers")
        if isinstance(draw, Ended):
            yield draw
        else:
            began, thin = time.process_time(), slivers(draw)
            print(f"{draw.name}: {'; '.join(thin) or 'no sliver'}", file=sys.stderr, flush=True)
            yield Ended(index, seed, "slivers", "built", "", thin, [], time.process_time() - began)


def ended_before(path: Path | None) -> list[Ended]:
    """Return what earlier calls wrote to a file."""
    lines = path.read_text(encoding="utf-8").splitlines() if path and path.exists() else []
    return [Ended(**json.loads(line)) for line in lines]


def summary(ended: Sequence[Ended]) -> str:
    """Counts of all draws, and each fault."""
    of = {how: [draw for draw in ended if draw.how == how] for how in ("refused", "ruled", "built")}
    faults = [f"    draw {draw.draw} of seed {draw.seed}: {fault}" for draw in of["built"] for fault in draw.faults]
    counts = {
        "refused": Counter(draw.by for draw in of["refused"]),
        "rule most broken": Counter(draw.by for draw in of["ruled"]),
        "warnings": Counter(name for draw in of["built"] for name in draw.warnings),
    }
    rows = [f"  {title}: {', '.join(f'{name} {n}' for name, n in count.most_common()) or 'none'}"
            for title, count in counts.items()]  # fmt: skip
    first = (f"{len(ended)} draws: {len(of['refused'])} refused by the reader, {len(of['ruled'])} without a design "
             f"that keeps the rules, {len(of['built'])} built, {len(faults)} faults")  # fmt: skip
    return "\n".join([first, *faults, *rows])


def main(arguments: Sequence[str]) -> int:
    """Run and print the counts; returns the exit code."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--draws", type=int, default=200)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--hands", type=int, default=os.cpu_count() or 1, help="designs that are built at once")
    parser.add_argument("--inspect", action="store_true", help="also walls, overhang, order of assembly ...")
    parser.add_argument("--slivers", action="store_true", help="walls and slots of made parts alone")
    parser.add_argument("--out", type=Path, help="file to which each draw is appended; those in it are not drawn again")
    options = parser.parse_args(arguments)
    if options.out:
        options.out.parent.mkdir(parents=True, exist_ok=True)
    ended = ended_before(options.out)
    enough = (True, "slivers") if options.slivers else (options.inspect,)
    done = {past.draw for past in ended if past.seed == options.seed and past.inspected in enough}
    left = (index for index in range(options.draws) if index not in done)
    ends = measured(left, options.seed) if options.slivers else run(left, options.seed, options.inspect, options.hands)
    for draw in ends:
        ended.append(draw)
        if options.out:
            with options.out.open("a", encoding="utf-8") as file:
                file.write(json.dumps(draw._asdict()) + "\n")
    print(summary(ended))
    return int(any(past.faults for past in ended))


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
