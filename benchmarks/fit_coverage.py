"""How often a fit's interval of 95 % holds the value the data were made with: every kind, many seeds of noise.

    python benchmarks/fit_coverage.py [KIND ...] [--seeds 100] [--workers 2] [--kept FILE] [--faults]

fits each kind with noise of every seed. For each parameter it counts the seeds whose interval held the truth, and sets
the mean width against the scatter of the values found: an interval that always holds because it is far too wide is
wrong as well. Data are the product's own equations with normal noise: `made_measurements`. Fits are kept in a file with
the digest of the code that made them; a seed that the file has from this code is not fitted again, so that a count goes
on where it was left. With `--faults` the data have faults as well (`made_measurements/faults.py`), and a value is
right where its interval holds the truth or no record has it. Prints the table of `docs/measurements.md`.
"""

from __future__ import annotations

import argparse
import json
from collections.abc import Iterator, Mapping, Sequence
from concurrent.futures import ProcessPoolExecutor, as_completed
from functools import cache
from hashlib import sha256
from multiprocessing import get_context
from pathlib import Path
from typing import NamedTuple

import numpy as np
from made_measurements import MADE
from made_measurements.faults import FAULTS, IN_TIME

import tvimdesign
from tvimdesign.base.errors import InputError
from tvimdesign.simulation.measurement.kinds import heating_log
from tvimdesign.simulation.measurement.measure_files import kind_sheet, measure_of
from tvimdesign.simulation.measurement.reading.data_file import Block
from tvimdesign.simulation.measurement.record_file import as_recorded

heating_log.resolve_measured = cache(heating_log.resolve_measured)  # the module is one for all seeds
KEPT = Path("results/fit_coverage.jsonl")
_NORMAL = 1.959964  # deviations to the end of an interval of 95 % of a normal distribution
_PACKAGE = Path(tvimdesign.__file__).parent
_SOURCES = (_PACKAGE / "simulation" / "measurement", _PACKAGE / "physics", Path(__file__).parent / "made_measurements")


AS_RECORDED = {
    "linear_strain_melt": "linear_strain", "youngs_modulus": "stiffness", "moving_inertia": "inertia",
}  # fmt: skip
"""Values of records by the names of what the data were made with."""
OF_RELEASE = ("stiffness", "damping")
"""Values that records of a joint's release follow from."""
SIZES = {"torque_angle": {"wire_diameter": "1 mm", "coil_diameter": "1 mm", "coil_count": str(1e-9 / 64.0)}}
"""Of a spring whose modulus is its stiffness, in numbers."""


class Found(NamedTuple):
    """What one fit says of a parameter, beside what its data were made with [SI]; an end may be open."""

    truth: float
    value: float
    low: float | None
    high: float | None

    @property
    def held(self) -> bool:
        """Whether the interval holds the truth."""
        return (self.low is None or self.low <= self.truth) and (self.high is None or self.truth <= self.high)


Fits = dict[tuple[str, int], dict[str, Found]]
"""By kind and seed what each parameter was found to be."""


@cache
def code() -> str:
    """Digest of the equations, the fits and the made data."""
    found = sha256()
    for folder in _SOURCES:
        for path in sorted(folder.rglob("*.py")):
            found.update(path.read_bytes())
    return found.hexdigest()[:16]


def fit_of(kind: str, seed: int) -> dict[str, Found]:
    """Value and interval of all that is reported from the data of a seed; a mode that was not found is not there.

    Of a kind with a fault, `creep+slow`, what a record has: nothing where none is written.
    """
    kind, _, fault = kind.partition("+")
    blocks, given, truth = MADE[kind](np.random.default_rng(seed))
    if fault:
        return _recorded(kind, FAULTS[fault](kind, blocks, np.random.default_rng(seed)), given, truth)
    fit = measure_of(kind_sheet(kind))(blocks, kind_sheet(kind).values(given)).fit
    reported = {one.name: one for one in (*fit.parameters, *fit.derived)}
    return {name: Found(truth[name], one.value, one.low, one.high) for name, one in reported.items() if name in truth}


def _recorded(
    kind: str, blocks: Sequence[Block], given: Mapping[str, str], truth: Mapping[str, float]
) -> dict[str, Found]:
    sheet = kind_sheet(kind)
    try:
        measurement = measure_of(sheet)(blocks, sheet.values({**SIZES.get(kind, {}), **given}), profiles=False)
    except InputError:
        return {}
    if measurement.fit.misfit:
        return {}
    values = dict(measurement.record_values) or {
        each.name: each for each in measurement.fit.parameters if kind == "release" and each.name in OF_RELEASE
    }  # whose record needs a module
    values = {name: as_recorded(value) for name, value in values.items()}
    truth = {**truth, **{name: truth[of] for name, of in AS_RECORDED.items() if of in truth}}
    return {name: Found(truth[name], value.value, value.low, value.high)
            for name, value in values.items() if name in truth}  # fmt: skip


def kept_in(path: Path) -> Fits:
    """What a file has from this code, by kind and seed; a line that was cut short is left out."""
    found = {}
    for line in path.read_text().splitlines() if path.exists() else []:
        if line.endswith("}}"):
            one = json.loads(line)
            if one.get("code") == code():
                found[one["kind"], one["seed"]] = {name: Found(*kept) for name, kept in one["found"].items()}
    return found


def counted(kinds: Sequence[str], seeds: int, workers: int, path: Path) -> Fits:
    """Fit what the file has not, a seed of every kind after the other, and keep each as it comes."""
    found = kept_in(path)
    path.parent.mkdir(parents=True, exist_ok=True)
    lacking = [(kind, seed) for seed in range(seeds) for kind in kinds if (kind, seed) not in found]
    with ProcessPoolExecutor(workers, mp_context=get_context("spawn")) as hands, path.open("a") as file:
        asked = {hands.submit(fit_of, *one): one for one in lacking}
        for done in as_completed(asked):
            kind, seed = asked[done]
            found[kind, seed] = done.result()
            file.write(json.dumps({"code": code(), "kind": kind, "seed": seed, "found": found[kind, seed]}) + "\n")
            file.flush()
    return found


def width_over_scatter(found: Sequence[Found]) -> float:
    """Mean width of the closed intervals over that of 95 % of the values found; not a number below three."""
    widths = [one.high - one.low for one in found if one.low is not None and one.high is not None]
    if len(widths) < 3:
        return np.nan
    return float(np.mean(widths) / (2.0 * _NORMAL * np.std([one.value for one in found], ddof=1)))


def table(found: Fits) -> Iterator[str]:
    """Rows in Markdown: kind, seeds, and for each parameter the share held, with the width over the scatter."""
    yield from ("| kind | seeds | held the truth, % of the seeds (width over scatter) |", "|---|---|---|")
    for kind in dict.fromkeys(name for name, _ in found):
        fits = [one for (name, _), one in found.items() if name == kind]
        told = []
        for name in dict.fromkeys(name for fit in fits for name in fit):
            every = [fit[name] for fit in fits if name in fit]
            open_ = sum(one.low is None or one.high is None for one in every)
            ratio = f"{width_over_scatter(every):.2f}" + (f", {open_} open" if open_ else "")
            told.append(f"{name} {100.0 * sum(each.held for each in every) / len(fits):.1f} ({ratio})")
        if fits:
            yield f"| `{kind}` | {len(fits)} | {', '.join(told)} |"


def table_of_faults(found: Fits) -> Iterator[str]:
    """Rows in Markdown: kind, seeds, and for each fault the share that is right, of the worst value, and of records."""
    yield f"|kind|seeds|{'|'.join(FAULTS)}|"
    yield "|---" * (2 + len(FAULTS)) + "|"
    for kind in dict.fromkeys(name.partition("+")[0] for name, _ in found):
        cells, seeds = [], 0
        for fault in FAULTS:
            fits = [fit for (name, _), fit in found.items() if name == f"{kind}+{fault}"]
            names = {name for fit in fits for name in fit}
            right = min((sum(name not in fit or fit[name].held for fit in fits) for name in names), default=len(fits))
            seeds = max(seeds, len(fits))
            records = sum(map(bool, fits))
            cells.append(f"{100 * right // len(fits)}/{100 * records // len(fits)}" if fits else "")
        yield f"|`{kind}`|{seeds}|{'|'.join(cells)}|"


def main() -> None:
    """Count, and print the table."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("kinds", nargs="*", choices=[[], *MADE], default=[], metavar="KIND")
    parser.add_argument("--seeds", type=int, default=100)
    parser.add_argument("--workers", type=int, default=2)
    parser.add_argument("--kept", type=Path, default=KEPT)
    parser.add_argument("--faults", action="store_true")
    asked = parser.parse_args()
    kinds = asked.kinds or list(MADE)
    if asked.faults:
        kinds = [f"{kind}+{fault}" for fault in FAULTS for kind in kinds if fault != "slow" or kind in IN_TIME]
    show = table_of_faults if asked.faults else table
    print("\n".join(show(counted(kinds, asked.seeds, asked.workers, asked.kept))))


if __name__ == "__main__":
    main()
