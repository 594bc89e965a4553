"""Share of fits whose interval of 95 % holds the value the data were made with: every kind, many seeds of noise.

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
FITS_FILE = Path("results/fit_coverage.jsonl")
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


class Estimate(NamedTuple):
    """Value and interval of a parameter in one fit, beside the true value [SI]; an end may be open."""

    truth: float
    value: float
    low: float | None
    high: float | None

    @property
    def held(self) -> bool:
        """Return whether the interval holds the truth."""
        return (self.low is None or self.low <= self.truth) and (self.high is None or self.truth <= self.high)


Fits = dict[tuple[str, int], dict[str, Estimate]]
"""By kind and seed what each parameter was found to be."""


@cache
def code() -> str:
    """Digest of the equations, the fits and the made data."""
    digest = sha256()
    for folder in _SOURCES:
        for path in sorted(folder.rglob("*.py")):
            digest.update(path.read_bytes())
    return digest.hexdigest()[:16]


def fit_of(kind: str, seed: int) -> dict[str, Estimate]:
    """Value and interval of all that is reported from the data of a seed; a mode that was not found is not there.

    Of a kind with a fault, `creep+slow`, what a record has: nothing where none is written.
    """
    kind, _, fault = kind.partition("+")
    blocks, given, truth = MADE[kind](np.random.default_rng(seed))
    if fault:
        return _recorded(kind, FAULTS[fault](kind, blocks, np.random.default_rng(seed)), given, truth)
    fit = measure_of(kind_sheet(kind))(blocks, kind_sheet(kind).values(given)).fit
    reported = {value.name: value for value in (*fit.parameters, *fit.derived)}
    return {
        name: Estimate(truth[name], value.value, value.low, value.high)
        for name, value in reported.items()
        if name in truth
    }


def _recorded(
    kind: str, blocks: Sequence[Block], given: Mapping[str, str], truth: Mapping[str, float]
) -> dict[str, Estimate]:
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
    return {name: Estimate(truth[name], value.value, value.low, value.high)
            for name, value in values.items() if name in truth}  # fmt: skip


def kept_in(path: Path) -> Fits:
    """Return what a file has from this code, by kind and seed; a line that was cut short is left out."""
    fits = {}
    for line in path.read_text().splitlines() if path.exists() else []:
        if line.endswith("}}"):
            line_data = json.loads(line)
            if line_data.get("code") == code():
                fits[line_data["kind"], line_data["seed"]] = {
                    name: Estimate(*numbers) for name, numbers in line_data["found"].items()
                }
    return fits


def counted(kinds: Sequence[str], seeds: int, workers: int, path: Path) -> Fits:
    """Fit what the file has not, a seed of every kind after the other, and keep each as it comes."""
    fits = kept_in(path)
    path.parent.mkdir(parents=True, exist_ok=True)
    lacking = [(kind, seed) for seed in range(seeds) for kind in kinds if (kind, seed) not in fits]
    with ProcessPoolExecutor(workers, mp_context=get_context("spawn")) as hands, path.open("a") as file:
        tasks = {hands.submit(fit_of, *task): task for task in lacking}
        for done in as_completed(tasks):
            kind, seed = tasks[done]
            fits[kind, seed] = done.result()
            file.write(json.dumps({"code": code(), "kind": kind, "seed": seed, "found": fits[kind, seed]}) + "\n")
            file.flush()
    return fits


def width_over_scatter(estimates: Sequence[Estimate]) -> float:
    """Mean width of the closed intervals over that of 95 % of the values found; not a number below three."""
    widths = [
        estimate.high - estimate.low for estimate in estimates if estimate.low is not None and estimate.high is not None
    ]
    if len(widths) < 3:
        return np.nan
    return float(np.mean(widths) / (2.0 * _NORMAL * np.std([estimate.value for estimate in estimates], ddof=1)))


def table(by_fit: Fits) -> Iterator[str]:
    """Rows in Markdown: kind, seeds, and for each parameter the share held, with the width over the scatter."""
    yield from ("| kind | seeds | held the truth, % of the seeds (width over scatter) |", "|---|---|---|")
    for kind in dict.fromkeys(name for name, _ in by_fit):
        fits = [fit for (name, _), fit in by_fit.items() if name == kind]
        shares = []
        for name in dict.fromkeys(name for fit in fits for name in fit):
            every = [fit[name] for fit in fits if name in fit]
            open_ = sum(estimate.low is None or estimate.high is None for estimate in every)
            ratio = f"{width_over_scatter(every):.2f}" + (f", {open_} open" if open_ else "")
            shares.append(f"{name} {100.0 * sum(each.held for each in every) / len(fits):.1f} ({ratio})")
        if fits:
            yield f"| `{kind}` | {len(fits)} | {', '.join(shares)} |"


def table_of_faults(by_fit: Fits) -> Iterator[str]:
    """Rows in Markdown: kind, seeds, and for each fault the share that is right, of the worst value, and of records."""
    yield f"|kind|seeds|{'|'.join(FAULTS)}|"
    yield "|---" * (2 + len(FAULTS)) + "|"
    for kind in dict.fromkeys(name.partition("+")[0] for name, _ in by_fit):
        cells, seeds = [], 0
        for fault in FAULTS:
            fits = [fit for (name, _), fit in by_fit.items() if name == f"{kind}+{fault}"]
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
    parser.add_argument("--kept", type=Path, default=FITS_FILE)
    parser.add_argument("--faults", action="store_true")
    options = parser.parse_args()
    kinds = options.kinds or list(MADE)
    if options.faults:
        kinds = [f"{kind}+{fault}" for fault in FAULTS for kind in kinds if fault != "slow" or kind in IN_TIME]
    show = table_of_faults if options.faults else table
    print("\n".join(show(counted(kinds, options.seeds, options.workers, options.kept))))


if __name__ == "__main__":
    main()
