"""Random choices of what a module is made of and bought from: refused by a named rule, or sound parts.

    python benchmarks/random_choices.py [--draws 200] [--seed 1] [--hands 2] [--inspect]

Each draw takes a shipped study and chooses heater, process, spring, fixtures and so on at random. Either the reader
refuses that in words, or all of 20,000 designs within the study's bounds break rules, which are counted, or the first
that keeps them all is built and checked as in random_designs.py. Ends with code 1 where one of those fails.
"""

from __future__ import annotations

import argparse
import os
import random
import re
import sys
from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import yaml
from random_designs import Draws, Tally, build

from tvimdesign.base.errors import InputError
from tvimdesign.catalog.catalog import Catalog
from tvimdesign.device import table_for
from tvimdesign.device.table.quantity import Choice
from tvimdesign.study import Study, read_study_text
from tvimdesign.study.design import Design

STUDIES = Path(__file__).resolve().parents[1] / "studies"
BASES = ("paper_shear", "rigid_modules", "finger", "compare_compression", "wrist_compression")
CHOSEN = (
    "stock_spring", "spring_material", "process", "peltier_module", "heater_fuse", "heater_wiring", "spreader_material",
    "liner_material", "link_screw", "link_fit", "tang_hold", "bearing", "axial_preload", "preload_adjuster", "cover",
    "sensor_flange",
)  # fmt: skip
"""What is drawn at random."""
OFTEN = 0.25
"""Share of the draws in which a choice is drawn; else it stays as the study says."""
NAMED = re.compile(r"module\.(\w+)|^(\w+) is")
"""What a refusal names first."""


@dataclass
class Outcome:
    """What came of the draws."""

    read: Counter[str] = field(default_factory=Counter)
    """Refusals by the reader, by the choice they name."""
    ruled: Counter[str] = field(default_factory=Counter)
    """Draws in which no design kept the rules, by the rule that most broke."""
    tally: Tally = field(default_factory=Tally)


def words_of(choice: Choice) -> list[str]:
    """All that a choice may be."""
    return [*choice.options, *(Catalog().names(choice.category) if choice.category else [])]


def drawn_study(draw: random.Random) -> Study:
    """A shipped study with random choices; raises InputError where the reader refuses them."""
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


def designs(draws: int, seed: int, outcome: Outcome) -> Iterator[Design]:
    """Those designs that keep every rule; what becomes of the others is counted."""
    for index in range(draws):
        try:
            draws_of = Draws(drawn_study(random.Random(1000 * seed + index)), seed=index)
        except InputError as error:
            named = NAMED.search(str(error))
            outcome.read[next(filter(None, named.groups())) if named else str(error)] += 1
            continue
        tally = Tally()
        design = draws_of.first(tally)
        if design is None:
            outcome.ruled[tally.refused.most_common(1)[0][0]] += 1
        else:
            yield design.model_copy(update={"name": f"draw {index}, {design.name}"})


def run(draws: int, seed: int, inspect: bool, hands: int) -> Outcome:
    """Draw, refuse, build and check."""
    outcome = Outcome()
    build(designs(draws, seed, outcome), outcome.tally, inspect, hands)
    return outcome


def main(arguments: Sequence[str]) -> int:
    """Run and print the counts; returns the exit code."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--draws", type=int, default=200)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--hands", type=int, default=os.cpu_count() or 1, help="designs that are built at once")
    parser.add_argument("--inspect", action="store_true", help="also walls, overhang, order of assembly ...")
    asked = parser.parse_args(arguments)
    outcome = run(asked.draws, asked.seed, asked.inspect, asked.hands)
    built = outcome.tally
    print(f"{asked.draws} draws: {sum(outcome.read.values())} refused by the reader, {sum(outcome.ruled.values())} "
          f"without a design that keeps the rules, {built.built} built, {len(built.failed)} faults")  # fmt: skip
    for text in built.failed:
        print(f"    {text}")
    for title, counts in (("refused", outcome.read), ("rule most broken", outcome.ruled), ("warnings", built.warned)):
        print(f"  {title}: {', '.join(f'{name} {count}' for name, count in counts.most_common()) or 'none'}")
    return int(bool(built.failed))


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
