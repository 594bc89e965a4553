"""Atlas of modules: families of designs computed by processes here, kept by key, and the lightest design of each cell.

A family is a kind of module on a set of hardware. The key of its file is a hash of its study, of the records it stands
on, of what is asked, and of the version: after a change of a record only families that use it are computed again.
"""

from __future__ import annotations

import json
import os
import signal
import time
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from concurrent.futures import ProcessPoolExecutor, as_completed
from contextlib import contextmanager
from dataclasses import asdict, dataclass
from multiprocessing import active_children, get_context
from pathlib import Path
from typing import Any

from tvimdesign import __version__
from tvimdesign.base.atomic_files import atomic_write, make_folder
from tvimdesign.base.child_process import follow_parent
from tvimdesign.base.environment import ask_for_one_thread
from tvimdesign.base.errors import InputError, TvimError
from tvimdesign.base.processes import end_process_tree
from tvimdesign.simulation.working_cycle.device_functions import resolve_study
from tvimdesign.solve.nlp.solver_run import OPTIMAL
from tvimdesign.solve.pareto.tradeoff import ONE_POINT
from tvimdesign.solve.torque_time_map import CYCLE, EMPTY, HOT, MASS, TORQUE, UNANSWERED, map_of
from tvimdesign.study import Requirement, Study
from tvimdesign.study.atlas_studies import Atlas
from tvimdesign.study.written_studies import started_at
from tvimdesign.sweep.run_sweep import key_of, records_hash

FAMILIES = "families"  # Folder of the families in the folder of an atlas
OUTPUTS = (MASS, TORQUE, HOT, CYCLE, "cycle_energy", "envelope_diameter")
_ALIKE = 0.01  # Share of a cycle by which a design of the front must be faster than a denser one
_DRAWS = 256  # Cases of the assumed values from which an interval is drawn
Say = Callable[[str], None]


@dataclass(frozen=True)
class AtlasCell:
    """Answer for a kind, a torque to be held [N*m], and a longest cycle [s]."""

    kind: str
    torque: float
    cycle: float
    status: str
    hardware: str  # Set of hardware of the lightest design; of an empty cell that of the design that comes nearest
    values: Mapping[str, float]
    limits: tuple[str, ...]
    intervals: Mapping[str, tuple[float, float]]
    """Torque and cycle time with the assumed values anywhere in their ranges, of designs on the kind's front."""

    @property
    def has_design(self) -> bool:
        """Existence of a design that meets the cell."""
        return self.status == OPTIMAL

    @property
    def cycle_time(self) -> float:
        """Cycle time [s] of its design."""
        return self.values[CYCLE]

    @property
    def band(self) -> list[float] | None:
        """Ends of density and cycle time; None where the intervals were not drawn."""
        if {TORQUE, CYCLE} - set(self.intervals):
            return None
        share = self.density / self.values[TORQUE]
        return [share * end for end in self.intervals[TORQUE]] + list(self.intervals[CYCLE])

    @property
    def density(self) -> float:
        """Torque asked over mass [N*m/kg]."""
        return self.torque / self.values[MASS]

    @property
    def name(self) -> str:
        """Name of its study."""
        return f"{self.kind}-{self.torque:g}Nm-{self.cycle:g}s"


def compute(
    plan: Atlas, folder: Path, workers: int, say: Say, others: Sequence[Path] = ()
) -> tuple[dict[str, float], list[TvimError]]:
    """Compute the families that neither the folder has nor `others`; return counts, processor seconds, and failures."""
    make_folder(folder / FAMILIES)
    _copy_families(plan, others, folder)
    ask_for_one_thread()
    waiting = [family for family in plan.families if _known(plan, folder, *family) is None]
    say(f"{len(plan.families) - len(waiting)} of {len(plan.families)} families are there")
    with _pool(workers or os.cpu_count() or 1) as pool:
        # The largest hardware takes longest, and comes last in a plan.
        jobs = {family: (_answered, plan, folder, *family) for family in reversed(waiting)}
        seconds, failures = _run_jobs(pool, jobs, "family", say)
        bounds = {
            family: (_add_intervals, plan, folder, *family, places)
            for kind in plan.kinds
            for family, places in _without_intervals(plan, folder, kind).items()
        }
        more, others_failed = _run_jobs(pool, bounds, "intervals", say)
    counts = {"families": len(plan.families), "computed": len(waiting) - len(failures), "cpu_s": seconds + more}
    return counts, failures + others_failed


def _run_jobs(
    pool: ProcessPoolExecutor, calls: Mapping[tuple[str, str], tuple[Any, ...]], what: str, say: Say
) -> tuple[float, list[TvimError]]:
    """Call functions that return seconds, one of each family; return their sum, and the failures."""
    jobs = {pool.submit(*call): family for family, call in calls.items()}
    seconds, failures = 0.0, list[TvimError]()
    for done, job in enumerate(as_completed(jobs), start=1):
        kind, hardware = jobs[job]
        try:
            seconds += job.result()
        except Exception as error:  # of one family; the others go on
            failures.append(TvimError(f"{kind} on {hardware} hardware: {type(error).__name__}: {error}"))
        say(f"{what} {done} of {len(jobs)}: {kind} on {hardware} hardware")
    return seconds, failures


def _copy_families(plan: Atlas, others: Sequence[Path], folder: Path) -> None:
    """Copy families of today that the folder lacks from other atlases; raises InputError for a folder that is none."""
    for other in others:
        if not (other / FAMILIES).is_dir():
            raise InputError(f"--reuse {other}: no folder of an atlas; it has no {FAMILIES}/")
        for family in plan.families:
            if _known(plan, folder, *family) is None and _known(plan, other, *family) is not None:
                name = f"{'-'.join(family)}.json"
                atomic_write(folder / FAMILIES / name, (other / FAMILIES / name).read_bytes())


@contextmanager
def _pool(workers: int) -> Iterator[ProcessPoolExecutor]:
    """Start processes that end when this one does, and at once where it is interrupted."""
    with ProcessPoolExecutor(workers, get_context("spawn"), _begin_worker, (os.getpid(),)) as pool:
        try:
            yield pool
        except BaseException:
            for process in active_children():
                end_process_tree(process.pid or 0)
            pool.shutdown(wait=False, cancel_futures=True)
            raise


def _begin_worker(parent: int) -> None:
    follow_parent(parent)
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # an interrupt is the parent's to handle


def _key(plan: Atlas, study: Study) -> str:
    content = study.model_dump(mode="json", exclude={"name", "description"})
    return key_of([content, records_hash(study), plan.torques, plan.cycles, plan.softness, __version__])


def _known(plan: Atlas, folder: Path, kind: str, hardware: str) -> dict[str, Any] | None:
    """Return what the folder has of a family, if its key is that of today."""
    path = folder / FAMILIES / f"{kind}-{hardware}.json"
    if not path.exists():
        return None
    family: dict[str, Any] = json.loads(path.read_text(encoding="utf-8"))
    return family if family["key"] == _key(plan, plan.study(kind, hardware)) else None


def _answered(plan: Atlas, folder: Path, kind: str, hardware: str) -> float:
    """Compute a family into its file; return seconds of the processor."""
    began, study = time.process_time(), plan.study(kind, hardware)
    cells = map_of(study, plan.torques, plan.cycles, plan.softness, lambda _: None)
    names = dict.fromkeys([*OUTPUTS, *study.vary])
    rows = [
        {**asdict(cell), "values": {name: cell.values[name] for name in names if name in cell.values}} for cell in cells
    ]
    family = {"key": _key(plan, study), "cells": rows, "intervals": {}, "seconds": time.process_time() - began}
    _write(folder, kind, hardware, family)
    return time.process_time() - began


def _write(folder: Path, kind: str, hardware: str, family: Mapping[str, Any]) -> None:
    atomic_write(folder / FAMILIES / f"{kind}-{hardware}.json", json.dumps(family, indent=1).encode())


def _without_intervals(plan: Atlas, folder: Path, kind: str) -> dict[tuple[str, str], list[int]]:
    """Return by family the places of designs on the kind's front of torque over mass and cycle that lack intervals."""
    families = {hardware: _known(plan, folder, kind, hardware) for hardware in plan.hardware}
    optima = [
        (row["torque"] / row["values"][MASS], -row["cycle"], hardware, place)
        for hardware, family in families.items()
        for place, row in enumerate(family["cells"] if family else ())
        if row["status"] == OPTIMAL
    ]
    lacking: dict[tuple[str, str], list[int]] = {}
    for density, speed, hardware, place in optima:
        beaten = any(d >= density and s >= speed and (d, s) != (density, speed) for d, s, *_ in optima)
        family = families[hardware]
        if not beaten and family and str(place) not in family["intervals"]:
            lacking.setdefault((kind, hardware), []).append(place)
    return lacking


def _add_intervals(plan: Atlas, folder: Path, kind: str, hardware: str, places: Sequence[int]) -> float:
    """Add the intervals of torque and cycle time of designs to their family's file; return processor seconds."""
    from tvimdesign.solve.uncertainty.design_uncertainty import UncertaintyModel  # it loads the compiler

    began, model, family = time.process_time(), None, _known(plan, folder, kind, hardware)
    assert family
    for place in places:
        study = started_at(plan.study(kind, hardware), family["cells"][place]["values"], {})
        resolved = resolve_study(study)
        if model is None or not model.fits(resolved):
            model = UncertaintyModel(resolved, (TORQUE, CYCLE), tuple(study.vary))
        ranges = model.at(resolved, 0, _DRAWS).intervals
        family["intervals"][str(place)] = {
            name: (ranges[name].low, ranges[name].high) for name in (TORQUE, CYCLE) if name in ranges
        }
    _write(folder, kind, hardware, family)
    return time.process_time() - began


def study_of(plan: Atlas, cell: AtlasCell) -> Study:
    """Return the study of a cell with a design, started at that design."""
    study, soft = started_at(plan.study(cell.kind, cell.hardware), cell.values, {}), plan.softness * cell.torque
    limits = [
        Requirement(output=TORQUE, sense=">=", limit=cell.torque, text=f">= {cell.torque:g} N.m"),
        Requirement(output=HOT, sense="<=", limit=soft, text=f"<= {soft:g} N.m/rad"),
        Requirement(output=CYCLE, sense="<=", limit=cell.cycle, text=f"<= {cell.cycle:g} s"),
    ]
    others = [limit for limit in study.require if limit.output != CYCLE]
    return study.model_copy(update={"require": (*others, *limits), "name": cell.name})


def cells_of(plan: Atlas, folder: Path) -> list[AtlasCell]:
    """Return every cell of the atlas: the lightest of all designs of its kind that meet it, whatever they were for."""
    cells: list[AtlasCell] = []
    for kind in plan.kinds:
        families = {hardware: _known(plan, folder, kind, hardware) for hardware in plan.hardware}
        rows = [
            (hardware, row, family["intervals"].get(str(place), {}))
            for hardware, family in families.items()
            if family
            for place, row in enumerate(family["cells"])
        ]
        whole = all(families.values())
        cells += [
            _cell(plan, kind, torque, cycle, rows, whole=whole) for torque in plan.torques for cycle in plan.cycles
        ]
    return cells


def _cell(plan: Atlas, kind: str, torque: float, cycle: float, rows: list[Any], *, whole: bool) -> AtlasCell:
    """Return the answer of a cell, which is empty only if the kind's families are there as a `whole`."""
    meeting = [
        (row["values"][MASS], hardware, row, intervals)
        for hardware, row, intervals in rows
        if row["status"] == OPTIMAL and _meets(plan, row["values"], torque, cycle)
    ]
    if meeting:
        _, hardware, row, intervals = min(meeting, key=lambda entry: entry[0])
        return AtlasCell(kind, torque, cycle, OPTIMAL, hardware, row["values"], tuple(row["limits"]), intervals)
    here = [(hardware, row) for hardware, row, _ in rows if row["torque"] == torque and row["cycle"] == cycle]
    if not here:
        return AtlasCell(kind, torque, cycle, UNANSWERED, "", {}, (), {})
    status = EMPTY if whole and all(row["status"] == EMPTY for _, row in here) else UNANSWERED
    hardware, nearest = min(here, key=lambda entry: _distance(entry[1]["values"], torque, cycle))
    return AtlasCell(kind, torque, cycle, status, hardware, nearest["values"], tuple(nearest["limits"]), {})


def front_of(cells: Iterable[AtlasCell]) -> list[AtlasCell]:
    """Return the designs that no other holds more for its mass in less time than, the fastest first."""
    front: list[AtlasCell] = []
    for cell in sorted((cell for cell in cells if cell.has_design), key=lambda cell: -cell.density):
        if not front or cell.cycle_time < front[-1].cycle_time * (1.0 - _ALIKE):
            front.append(cell)
    return front[::-1]


def _meets(plan: Atlas, values: Mapping[str, float], torque: float, cycle: float) -> bool:
    return bool(
        values[TORQUE] >= torque * (1.0 - ONE_POINT)
        and values[CYCLE] <= cycle * (1.0 + ONE_POINT)
        and values[HOT] <= plan.softness * torque * (1.0 + ONE_POINT)
    )


def _distance(values: Mapping[str, float], torque: float, cycle: float) -> float:
    """Factor by which a design misses torque and cycle; infinite without a design."""
    if not values:
        return float("inf")
    return max(torque / values[TORQUE], 1.0) * max(values[CYCLE] / cycle, 1.0)
