"""Compare the working tree with the frozen oracle: the same outputs, parts, fits, messages and optima as before.

    python campaigns/same.py [--only outputs|parts|fit|messages|optima ...] [--studies NAME ...] [--tolerance 1e-9]

evaluates the frozen design of each study and compares every value bit for bit, or within the tolerance; draws the parts
of each and compares volumes and areas; fits the measurement files of the repository; and reads the bad studies.
`--only optima` searches the studies again instead, which takes half an hour.

Each difference is a line: study, quantity, frozen value, value now, relative difference. Names that changed on purpose
are listed in campaigns/frozen/renames.json: {"renamed": {"old": "new"}, "removed": [...], "added": [...]}.

`--freeze` writes the values of now in place of the frozen ones, at the frozen designs. `--freeze --only optima`
searches for new designs; with `--runs FOLDER` it takes them from FOLDER/NAME/design.json, which `tvimdesign run` wrote.
"""

from __future__ import annotations

import argparse
import subprocess
import sys
import time
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path

from oracle import optima, part_volumes, study_outputs
from oracle.compare import Difference, Renames, differences
from oracle.frozen_files import FOLDER, read_frozen, write_frozen
from oracle.subjects import FILES, KINDS, frozen_values, subjects

import tvimdesign

RENAMES = FOLDER / "renames.json"


@dataclass(frozen=True)
class Options:
    """Hold what is compared, and how."""

    studies: tuple[str, ...] = ()
    """The named ones; all if none is named."""
    tolerance: float = 0.0
    renames: Renames = field(default_factory=Renames)

    def tolerance_of(self, kind: str) -> float:
        """Return up to which relative difference values of a kind are the same."""
        return max(self.tolerance, part_volumes.VOLUME_TOLERANCE) if kind == "parts" else self.tolerance

    def renames_of(self, kind: str) -> Renames:
        """Return the renames that concern a kind: those of quantities and parts."""
        return self.renames if kind in {"outputs", "parts"} else Renames()


@dataclass
class Comparison:
    """Count what one kind of comparison compared and what differs."""

    kind: str
    subjects: int = 0
    values: int = 0
    differences: list[Difference] = field(default_factory=list)

    def add(self, values: int, changed: Sequence[Difference]) -> None:
        """Add a subject and print its differences."""
        self.subjects += 1
        self.values += values
        self.differences += changed
        for difference in changed:
            print(difference, flush=True)

    def __str__(self) -> str:
        """Format the count as part of the summary."""
        return f"{self.kind}: {self.subjects} compared, {self.values} values, {len(self.differences)} differ"


def compare(kind: str, options: Options) -> Comparison:
    """Compare all subjects of a kind with the frozen ones."""
    done, frozen = Comparison(kind), frozen_values(kind, options.studies)
    tolerance, renames = options.tolerance_of(kind), options.renames_of(kind)
    for name, compute in subjects(kind, options.studies, options.renames):
        expected = frozen.pop(name, None)
        try:
            now = compute()
        except Exception as error:  # the others are compared all the same
            reason = (str(error).splitlines() or [""])[0]
            done.add(1, [Difference(name, kind, "values", f"{type(error).__name__}: {reason}")])
            continue
        if expected is None:
            done.add(len(now), [Difference(name, kind, "not frozen", f"{len(now)} values")])
        else:
            done.add(len(now), list(differences(name, expected, now, tolerance=tolerance, renames=renames)))
    for name, expected in frozen.items():
        done.add(len(expected), [Difference(name, kind, f"{len(expected)} values", "lost")])
    return done


def compare_optima(options: Options) -> Comparison:
    """Search each study again and compare its optimum with the frozen one; name the better ones."""
    done = Comparison("optima")
    for name in options.studies or study_outputs.study_files():
        frozen = read_frozen(study_outputs.frozen_file(name))["optimum"]
        try:
            search = optima.search(name)
        except tvimdesign.TvimError as error:
            done.add(1, [Difference(name, "optimum:status", frozen["status"], type(error).__name__)])
            continue
        now = search.outcome["optimum"]
        done.add(1, list(optima.optimum_differences(name, frozen, now, options.renames)))
        change = optima.objective_change(frozen, now)
        better = "  BETTER" if change < -optima.OBJECTIVE_TOLERANCE else ""
        print(f"# {name}: objective {now['objective']}, {change:+.2e}, {search.seconds:.0f} s{better}", flush=True)
    return done


def freeze(kind: str, options: Options) -> None:
    """Write the values of now in place of the frozen ones, at the frozen designs; other studies keep theirs."""
    commit = code_version()
    frozen = {} if kind == "outputs" or not FILES[kind].exists() else read_frozen(FILES[kind])["values"]
    values = {name: compute() for name, compute in subjects(kind, options.studies, options.renames)}
    if kind == "outputs":
        for name, outputs in values.items():
            path = study_outputs.frozen_file(name)
            write_frozen(path, read_frozen(path) | {"commit": commit, "outputs": outputs})
    else:
        write_frozen(FILES[kind], {"commit": commit, "values": (frozen if kind == "parts" else {}) | values})
    print(f"froze {kind}: {len(values)} subjects, {sum(map(len, values.values()))} values", flush=True)


def freeze_optima(options: Options, runs: Path | None) -> None:
    """Write the optima of studies, from runs or searched, with the outputs there."""
    for name in options.studies or study_outputs.study_files():
        start = time.process_time()
        if runs:
            design = tvimdesign.read_design(runs / name / "design.json")
            chosen = study_outputs.chosen_by_search(study_outputs.load_study(name), design)
        else:
            chosen = dict(optima.search(name).outcome)
        write_frozen(study_outputs.frozen_file(name), {"commit": code_version(), **chosen})
        objective, seconds = chosen["optimum"]["objective"], time.process_time() - start
        print(f"froze the optimum of {name}: objective {objective}, {seconds:.0f} s", flush=True)
    study_outputs.evaluate_frozen.cache_clear()
    freeze("outputs", options)


def code_version() -> str:
    """Return the commit of the tree under test, with a plus if the package or the studies have other changes."""
    commit = _git("rev-parse", "HEAD").strip() or "no commit"
    return commit + ("+" if _git("status", "--porcelain", "--", "tvimdesign", "studies", "tests/studies") else "")


def _git(*words: str) -> str:
    command = ["git", "-C", str(study_outputs.CODE), *words]
    return subprocess.run(command, capture_output=True, text=True, check=False).stdout


def main(words: Sequence[str] | None = None) -> int:
    """Compare, or freeze; 1 if anything differs."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--only", nargs="+", choices=[*KINDS, "optima"], default=list(KINDS), help="what to compare")
    parser.add_argument("--studies", nargs="+", default=[], metavar="NAME", help="studies to compare; all unless given")
    parser.add_argument("--tolerance", type=float, default=0.0, help="relative; 0, the default, compares bit for bit")
    parser.add_argument("--renames", type=Path, default=RENAMES, help="file of names that changed on purpose")
    parser.add_argument("--freeze", action="store_true", help="write the values of now in place of the frozen ones")
    parser.add_argument("--runs", type=Path, help="with --freeze --only optima: folder of runs to take designs from")
    given = parser.parse_args(words)
    if unknown := set(given.studies) - set(study_outputs.study_files()):
        parser.error(f"no such study: {', '.join(sorted(unknown))}")
    options = Options(tuple(given.studies), given.tolerance, Renames.read(given.renames))
    if given.freeze:
        for kind in given.only:
            freeze_optima(options, given.runs) if kind == "optima" else freeze(kind, options)
        return 0
    done = [compare_optima(options) if kind == "optima" else compare(kind, options) for kind in given.only]
    different = sum(len(comparison.differences) for comparison in done)
    print(f"{'DIFFERENT' if different else 'same'}  " + "; ".join(map(str, done)))
    return int(different > 0)


if __name__ == "__main__":
    sys.exit(main())
